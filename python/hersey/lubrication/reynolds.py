"""The film of a lubricated line contact, solved numerically: the judge of the film formulas.

Reynolds' equation with cavitation, the elastic surface and the load balance are solved together by Newton's
method (docs/theory/reynolds.md). Conventions: ``entrainment_speed`` is the mean u of the two surface speeds,
not their sum; ``effective_modulus`` is E' = 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2], so 2E/(1-nu^2) for one soft body
against a rigid one. E* = E'/2 is the contact modulus.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Literal

from hersey import _core
from hersey.arguments.frozen import explained
from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.result import Means
from hersey.schema.warning import Warning
from hersey.units import takes_si

#: Nodes between inlet and outlet.
NODES = 201
#: More than the core takes, so that it says so itself.
_MANY = 1_000_000
#: What an exponent can be asked of.
Quantity = Literal["damping", "torque", "minimum_thickness", "central_thickness", "base_traction"]
#: Share of a layer's thickness beyond which linear elasticity is a sketch.
_INDENTATION = 0.15
#: Share of the roll's radius up to which its parabola holds.
_HALF_WIDTH = 0.3
#: Error of the least film that asks for more nodes.
_GRID_ERROR = 0.01
#: What a solution has by the same name in the core.
_OF_THE_CORE = (
    *("x", "pressure", "film_thickness", "couette", "poiseuille", "greatest_pressure", "outlet", "offset"),
    *("length", "load_residual", "flow_residual", "grid_error", "iterations", "stations"),
)
#: Pressure above which Barus' law overstates viscosity, Pa.
_BARUS = 0.4e9


@takes_si(thickness="length")
@dataclass(frozen=True)
class ElasticLayer:
    """An elastic layer on a rigid base: ``thickness`` (m) and Poisson ratio ``poisson``, up to 0.5."""

    thickness: float
    poisson: float


@takes_si(viscosity="viscosity", pressure_viscosity="pressure-viscosity coefficient")
@dataclass(frozen=True)
class ThickeningFluid:
    """A lubricant that pressure thickens, at one temperature.

    Parameters
    ----------
    viscosity
        At zero pressure, Pa s.
    pressure_viscosity
        Coefficient alpha at zero pressure, 1/Pa; 0 in a rubber nip.
    thickening
        Law that alpha belongs to: ``roelands`` (pole at 6.31e-5 Pa s and -0.196 GPa) or ``barus``.
    compressible
        Whether the density follows Dowson and Higginson.
    """

    viscosity: float
    pressure_viscosity: float = 0.0
    thickening: Literal["roelands", "barus"] = "roelands"
    compressible: bool = False


@dataclass(frozen=True)
class LineExponents:
    """Exponents of the power laws that touch a solution: derivatives of logarithms.

    ``roll_traction`` is that of the force on the roll, hence of the drive torque. A traction that changes
    sign has no exponent: nan.
    """

    central_thickness: float
    minimum_thickness: float
    roll_traction: float
    base_traction: float


@explained
@dataclass(frozen=True, eq=False)
class LineContactSolution:
    """Pressure, film and friction of a line contact, SI.

    The tractions, along the motion, are ``-couette - poiseuille`` and ``couette - poiseuille``. They exclude
    the ruptured film beyond ``outlet``, where pressure is zero.
    """

    x: Annotated[FloatArray, Means("positions of the nodes from the axis, positive downstream", "m")]
    pressure: Annotated[FloatArray, Means("at the nodes", "Pa")]
    film_thickness: Annotated[FloatArray, Means("at the nodes", "m")]
    central_thickness: Annotated[float, Means("film under the axis", "m")]
    minimum_thickness: Annotated[float, Means("minimum film", "m")]
    couette: Annotated[float, Means("shear due to sliding", "N/m")]
    poiseuille: Annotated[float, Means("half the integral of film thickness times pressure gradient", "N/m")]
    roll_traction: Annotated[float, Means("shear force on the rotating wall per length", "N/m")]
    base_traction: Annotated[float, Means("shear force on the opposite surface per length", "N/m")]
    greatest_pressure: Annotated[float, Means(unit="Pa")]
    outlet: Annotated[float, Means("where the film ends", "m")]
    #: for a layer minus the approach of roll and base; for a half space it belongs to ``length``
    offset: Annotated[float, Means("film less parabola and deflection", "m")]
    length: Annotated[float, Means("unit of the logarithm in the deflection of a half space", "m")]
    load_residual: Annotated[float, Means("remaining relative error of the load balance")]
    flow_residual: Annotated[float, Means("remaining relative error of the flow")]
    grid_error: Annotated[float, Means("relative error of the minimum film, estimated from two grids")]
    by_speed: Annotated[LineExponents, Means("exponent of speed, both surfaces scaled together")]
    by_load: Annotated[LineExponents, Means("of load")]
    friction: Annotated[float, Means("magnitude of roll_traction over the load")]
    iterations: Annotated[int, Means("total number of Newton steps")]
    stations: Annotated[int, Means("intermediate solutions, starting from a rigid wall")]
    warnings: Annotated[tuple[Warning, ...], Means("where the model does not apply, or needs a finer grid")]


@takes_si(
    radius="length",
    load="load per length",
    entrainment_speed="belt speed",
    viscosity="viscosity",
    effective_modulus="pressure",
    sliding_speed="belt speed",
)
def solve_line_contact(
    radius: float,
    load: float,
    entrainment_speed: float,
    viscosity: float | ThickeningFluid,
    *,
    effective_modulus: float,
    layer: ElasticLayer | None = None,
    sliding_speed: float | None = None,
    nodes: int = NODES,
) -> LineContactSolution:
    """Return pressure, film and friction of a roll on an elastic surface, fully flooded and isothermal.

    Parameters
    ----------
    radius
        Radius of the roll, or reduced radius 1/(1/R1 + 1/R2), m.
    load
        Load per length, N/m.
    entrainment_speed
        Mean u of the surface speeds, m/s.
    viscosity
        Viscosity of a Newtonian lubricant, Pa s; or a `ThickeningFluid`.
    effective_modulus
        E' = 2/[(1-nu1^2)/E1 + (1-nu2^2)/E2], Pa; for a soft layer on its own 2E/(1-nu^2).
    layer
        An elastic layer bonded to a rigid base. Default: a half space.
    sliding_speed
        Speed of the roll minus that of the other surface, m/s. Default: 2u, the other surface at rest.
    nodes
        Number of nodes, 50 to 4001. The error of the film falls with its square.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name.
    UnfinishedError
        If no solution is found.

    Examples
    --------
    >>> layer = ElasticLayer(thickness=3.5e-3, poisson=0.49)
    >>> nip = solve_line_contact(0.015, 1136, 0.1, 0.1, effective_modulus=2.63e6, layer=layer)
    >>> round(nip.minimum_thickness * 1e6, 1), round(exponent("damping", nip), 2)  # um
    (8.0, -0.55)
    """
    fluid = viscosity if isinstance(viscosity, ThickeningFluid) else ThickeningFluid(viscosity)
    slide = 2.0 * entrainment_speed if sliding_speed is None else sliding_speed
    solution = _core.line_contact(
        (float(radius), 0.5 * float(effective_modulus), float(load)),
        None if layer is None else (float(layer.thickness), float(layer.poisson)),
        (float(entrainment_speed), float(slide)),
        (float(fluid.viscosity), float(fluid.pressure_viscosity), fluid.thickening, fluid.compressible),
        min(max(int(nodes), 0), _MANY),
    )
    for profile in (solution.x, solution.pressure, solution.film_thickness):
        profile.setflags(write=False)
    own = {name: getattr(solution, name) for name in _OF_THE_CORE}
    return LineContactSolution(
        **own,
        central_thickness=solution.central,
        minimum_thickness=solution.minimum,
        roll_traction=solution.traction_1,
        base_traction=solution.traction_2,
        by_speed=_exponents(solution.by_speed),
        by_load=_exponents(solution.by_load),
        friction=abs(solution.traction_1) / load,
        warnings=(
            *_of_the_shape(solution, radius, layer),
            *_of_the_numbers(solution, barus=fluid.thickening == "barus"),
        ),
    )


def exponent(quantity: Quantity, solution: LineContactSolution) -> float:
    """Return the exponent of entrainment speed of a quantity, at the speed of a solution.

    Parameters
    ----------
    quantity
        ``damping``: B = torque / angular speed, so that of ``torque`` less 1; ``torque``: of the force on the
        roll; ``base_traction``; ``minimum_thickness``; ``central_thickness``.
    solution
        From `solve_line_contact`. The derivative is that of the discrete equations, by their Jacobian; both
        surface speeds grow alike.

    Raises
    ------
    ParameterError
        If the quantity is not known.
    """
    by_speed = solution.by_speed
    known = {
        "damping": by_speed.roll_traction - 1.0,
        "torque": by_speed.roll_traction,
        "base_traction": by_speed.base_traction,
        "minimum_thickness": by_speed.minimum_thickness,
        "central_thickness": by_speed.central_thickness,
    }
    if quantity not in known:
        raise ParameterError(f"quantity {quantity!r} is not known: {', '.join(known)}")
    return known[quantity]


def _exponents(of: _core.Exponents) -> LineExponents:
    return LineExponents(of.central, of.minimum, of.traction_1, of.traction_2)


def _of_the_shape(
    solution: _core.LineContact, radius: float, layer: ElasticLayer | None
) -> Iterator[Warning]:
    """Yield what the shape of the contact does not allow the model."""
    indented = 0.0 if layer is None else -solution.offset / layer.thickness
    if indented > _INDENTATION:
        yield Warning(
            "layer indented deeply",
            "the layer is indented by {share:.0%} of its thickness. Linear elasticity holds up to "
            "{most:.0%}, so the result is only a rough estimate",
            severity="watch",
            share=indented,
            most=_INDENTATION,
        )
    if solution.outlet > _HALF_WIDTH * radius:
        yield Warning(
            "contact too wide for a parabola",
            "the contact extends to {share:.0%} of the radius from the axis, where a circle is no longer "
            "a parabola",
            severity="watch",
            share=solution.outlet / radius,
        )


def _of_the_numbers(solution: _core.LineContact, *, barus: bool) -> Iterator[Warning]:
    """Yield what grid and law of viscosity cost."""
    if solution.grid_error > _GRID_ERROR:
        yield Warning(
            "coarse grid",
            "the minimum film has an error of {error:.1%} on this grid",
            severity="watch",
            remedy="use more nodes",
            error=solution.grid_error,
        )
    if barus and solution.greatest_pressure > _BARUS:
        yield Warning(
            "pressure beyond Barus' law",
            "Barus' law overestimates viscosity at {pressure:.2g GPa}",
            severity="watch",
            remedy="use roelands",
            pressure=solution.greatest_pressure,
        )
