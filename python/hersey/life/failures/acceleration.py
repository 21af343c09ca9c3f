"""Life against temperature or load: what acts on ln age, and under which conditions the law is wanted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import ParameterError
from hersey.result import OPEN, Means, Record

#: Boltzmann's constant, eV/K (exact since 2019).
BOLTZMANN = 8.617333262e-5
Relation = Literal["arrhenius", "power"]


@dataclass(frozen=True)
class Acceleration(Record):
    """How life depends on stress: by Arrhenius (activation energy, eV) or by an inverse power (exponent).

    ``use`` is the stress for which ages are given; ``lowest`` and ``highest`` were tested. Temperatures are
    in K.
    """

    relation: Annotated[Relation, Means("arrhenius of a temperature, or power of a load")]
    effect: Annotated[float, Means("activation energy in eV, or exponent n of life ~ load^-n")]
    low: Annotated[float, OPEN]
    high: Annotated[float, OPEN]
    use: Annotated[float, Means("stress of use: K, or the unit of the load")]
    lowest: Annotated[float, Means("least stress tested")]
    highest: Annotated[float, Means("greatest stress tested")]
    unit: Annotated[str, Means("unit of the stress")]
    same_shape: Annotated[
        float | None, Means("p-value of one shape and one relation for all stresses, or null")
    ]

    @property
    def words(self) -> str:
        """The relation as a line of the summary."""
        span = f"[{self.low:.3g}, {self.high:.3g}]"
        text = f"Life varies as load^-n, n = {self.effect:.3g} {span}"
        if self.relation == "arrhenius":
            text = f"Activation energy {self.effect:.3g} {span} eV"
        if self.same_shape is None:
            return text
        return f"{text}; one shape and this relation at every stress: p = {self.same_shape:.2g}"


def covariate_of(relation: Relation, stress: FloatArray | float) -> FloatArray:
    """Return what acts on ln age in proportion to activation energy or exponent."""
    values = np.asarray(stress, dtype=float)
    if (values <= 0).any() or not np.isfinite(values).all():
        named = "temperature (K)" if relation == "arrhenius" else "load"
        raise ParameterError(f"a {named} of {values.min():g} must be greater than 0", quantity="stress")
    return 1.0 / (BOLTZMANN * values) if relation == "arrhenius" else -np.log(values)
