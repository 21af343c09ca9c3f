"""The part of a mixed contact: who carries the load, and where drag is least."""

from __future__ import annotations

from pydantic import Field

from hersey.parts.part import Holed, Numbers, Part


class AsperitiesPart(Part):
    """Summits of the two faces, as Greenwood and Tripp have them."""

    modulus: float = Field(description="contact modulus of the faces, Pa")
    sigma_beta_density: float
    sigma_over_beta: float


class BoundaryFrictionPart(Part):
    """Friction where asperities carry all."""

    coefficient: float
    slope: float = Field(description="1/K")
    temperature: float | None = Field(description="of the coefficient, K")


class MixedLawPart(Part):
    """The law by which film and asperities share the load."""

    regime: str
    reference: float = Field(description="eta U at which the film alone is as thick as the roughness, Pa m")
    film_exponent: float
    load_exponent: float
    edge: float = Field(description="mean pressure over K sqrt(l) of a soft nip at the reference; 0: none")
    roundness: float = Field(description="K^2 a/(2 p_max^2) of the dry pressure of a soft nip")
    stiffness: float
    shear: float = Field(description="of a film of lambda = 1 over the nip, N")
    rolling: float = Field(description="what inlet and pressure add, at the reference, N")
    rolling_exponent: float
    asperities: AsperitiesPart
    friction: BoundaryFrictionPart


class MixedPointsPart(Part):
    """Film and asperities at operating points."""

    speed: Numbers = Field(description="rad/s")
    temperature: Numbers = Field(description="K")
    viscosity: Numbers = Field(description="Pa s")
    lambda_ratio: Numbers
    minimum_ratio: Holed = Field(description="least film over roughness; null where no law of it is known")
    share: Numbers = Field(description="of the load that asperities carry")
    boundary_torque: Numbers = Field(description="N m")
    shear_torque: Numbers = Field(description="N m")
    rolling_torque: Numbers = Field(description="N m")
    torque: Numbers = Field(description="N m")
    beyond_checked_range: list[bool] = Field(description="whether the law was not checked there")


class MixedTransitionPart(Part):
    """Where drag is least at the temperature of each point; null where it never falls."""

    speed: Holed = Field(description="rad/s")
    belt_speed: Holed = Field(description="m/s")
    product: Holed = Field(description="eta U, Pa m")
    lambda_ratio: Holed
    torque: Holed = Field(description="N m")
    sensitivity: dict[str, Holed] = Field(description="d ln eta U by the logarithm of each number of the law")
    by_roughness: Holed = Field(description="d ln speed by the logarithm of roughness")


class MixedPart(Part):
    """A contact whose load film and asperities share."""

    law: MixedLawPart
    points: MixedPointsPart
    transition: MixedTransitionPart
