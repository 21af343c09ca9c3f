"""How the layer of oil of specimens thins with age, and how their oil thickens.

The layer thins by side flow and evaporation (`oil_layer`), viscosity grows as ``exp(g t)``. Each specimen
has its own layer when new, loss, viscosity when new, and g. The power of side flow and the share of
evaporation in the loss belong to all. By theory the power is 2, but where oil comes back from beside the
track, or grease feeds it, the loss slows down by another.

The loss is that of a layer as thick as the flooded film. A thick one is not seen, and thins to that film in
much the same time whatever it was, so that its loss when new may be anything.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import special

from hersey.arrays import FloatArray, IntArray
from hersey.life.film.starved_drag import Flooded, cubic
from hersey.life.oil_layer import BY_THEORY, log_layer, log_share_between

#: What a specimen has of its own, in this order: ln(h0/h), ln of the rate of loss of a layer h times T, ln of
#: the factor on viscosity when new, g T; and what all have in common: logit of the share of evaporation in
#: that loss, ln of the power of side flow, the change of ln viscosity from hot to cold, sharpness and fading
#: of starvation, and ln of the layer over the flooded film at which it begins. T is the greatest age, h the
#: flooded film at the reference.
(
    LAYER_NEW,
    LOSS,
    VISCOSITY_NEW,
    THICKENING,
    EVAPORATED,
    POWER,
    SENSITIVITY,
    SHARPNESS,
    FADING,
    STARVED_AT,
) = range(10)
#: Ends of ln of the power of side flow.
_POWERS = np.log([0.1, 10.0])


@dataclass(frozen=True)
class Depletion:
    """Draws of what specimens have, (draws, specimens, 10), and of all: means and spreads, (draws, 10)."""

    specimens: FloatArray
    mean: FloatArray
    spread: FloatArray
    greatest_age: float
    reference: Flooded
    rates: Rates

    def layer(self, own: FloatArray, age: FloatArray) -> FloatArray:
        """Return ln of the layer (m) of draws (..., 10) at ages in any unit; shape (..., ages)."""
        scaled, each = np.asarray(age) / self.greatest_age, own[..., None, :]
        return scale(self.reference) + self.rates.layer(each, scaled)

    def rate(self, own: FloatArray) -> dict[str, FloatArray]:
        """Return K (1/(m^2 age)), p, e and g (1/age) of draws (..., 10)."""
        flows, evaporation = self.rates.of(own)
        power = self.rates.power(own)
        square = 2.0 * scale(self.reference) + (2.0 - power) * own[..., LAYER_NEW]
        return {
            "K": 2.0 * flows * np.exp(-square) / self.greatest_age,
            "p": power,
            "e": evaporation / self.greatest_age,
            "g": own[..., THICKENING] / self.greatest_age,
        }

    def viscosity(self, own: FloatArray, age: FloatArray) -> FloatArray:
        """Return ln of the factor on viscosity of draws (..., 10) at ages; shape (..., ages)."""
        scaled = np.asarray(age) / self.greatest_age
        return own[..., VISCOSITY_NEW, None] + own[..., THICKENING, None] * scaled

    def over_flooded(self, own: FloatArray, age: FloatArray, point: Flooded) -> FloatArray:
        """Return ln of the layer over the flooded film at a point, of draws (..., 10) at ages."""
        at = self.viscosity(own, age) + own[..., SENSITIVITY, None] * point.steep.item()
        return self.layer(own, age) - cubic(point.film.reshape(4), at)[0]

    def over_starved(self, own: FloatArray, age: FloatArray, point: Flooded) -> FloatArray:
        """Return ln of the layer over that below which the film starves, of draws (..., 10) at ages."""
        return self.over_flooded(own, age, point) - own[..., STARVED_AT, None]

    def log_share(self, own: FloatArray, age: FloatArray, point: Flooded) -> FloatArray:
        """Return ln of the film over the flooded one at a point, of draws (..., 10) at ages."""
        sharpness, fading = own[..., SHARPNESS, None], own[..., FADING, None]
        return log_share_between(self.over_flooded(own, age, point), sharpness, fading)[0]


@dataclass(frozen=True)
class Rates:
    """The rates of side flow and evaporation in h and T, where known; None where specimens have their own.

    Where one is known, the loss of a specimen is that by the other.
    """

    side_flow: float | None = None
    evaporation: float | None = None

    def of(self, own: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the losses of a layer h by side flow and evaporation, 1/T, of what specimens have."""
        loss = np.exp(np.minimum(own[..., LOSS], 50.0))
        if self.side_flow is not None:
            flows = np.full_like(loss, 0.5 * self.side_flow)
            return flows, loss if self.evaporation is None else np.full_like(loss, self.evaporation)
        if self.evaporation is not None:
            return loss, np.full_like(loss, self.evaporation)
        evaporated = special.expit(own[..., EVAPORATED])
        return loss * (1.0 - evaporated), loss * evaporated

    def power(self, own: FloatArray) -> FloatArray:
        """Return the power of side flow, which is that by theory where its rate is known."""
        if self.side_flow is not None:
            return np.full_like(own[..., POWER], BY_THEORY)
        return np.exp(np.clip(own[..., POWER], *_POWERS))

    def layer(self, own: FloatArray, age: FloatArray) -> FloatArray:
        """Return ln of the layer over h at ages over T, of what specimens have."""
        flows, evaporation = self.of(own)
        power = self.power(own)
        new = np.exp(-power * own[..., LAYER_NEW])
        return log_layer(new, power * flows, evaporation, age, power)

    @property
    def free(self) -> IntArray:
        """What specimens have of their own."""
        unknown = (self.side_flow is None) + (self.evaporation is None)
        own = np.arange(EVAPORATED)
        return own if unknown else own[own != LOSS]

    @property
    def common(self) -> IntArray:
        """What all specimens have in common and is not known."""
        if self.side_flow is not None:
            return np.array([], dtype=np.intp)
        return np.array([EVAPORATED, POWER] if self.evaporation is None else [POWER])


def scale(reference: Flooded) -> float:
    """Logarithm of the flooded film of new oil at the reference, m."""
    return float(cubic(reference.film, np.zeros(()))[0].item())
