"""Which parameters of a law its data do not determine, each with what would."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.branched import LEAST_POWER, Law
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.no_load_law import RestLaw
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_load import BOUND, SharedLoadLaw
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.friction_curve.dwell_law import DwellFriction


def not_identified(fit: LawFit, data: Observations) -> dict[str, str]:
    """Return the parameters that the data do not determine, each with what would."""
    out: dict[str, str] = {}
    law = fit.law
    column = law.jacobian(fit.values, data.inputs) / fit.sigma[:, None]
    norms = np.linalg.norm(column, axis=0)
    _, singular, axes = np.linalg.svd(column / np.maximum(norms, 1e-300), full_matrices=False)
    for value, axis in zip(singular, axes, strict=True):
        if value < 1e-6 * singular[0]:
            for index in np.flatnonzero(np.abs(axis) > 0.1):
                out[law.names[index]] = "other parameters can compensate any change of it. Vary speed and "
                out[law.names[index]] += "temperature independently"
    if isinstance(law, StribeckLaw):
        for name, what in (("stick", "slower"), ("viscous", "faster")):
            part = law.index(name)  # a factor e of it, in standard errors of all dwells together
            if norms[part] < 2.0 or fit.covariance[part, part] > 1.0:
                out[name] = (
                    f"the part that it scales is too small in this log. Record dwells at {what} speeds"
                )
        return out
    if isinstance(law, ConstantPlusLaw):
        return out | _parts_shown(fit, norms)
    if isinstance(law, SharedLoadLaw):
        return out | _contact_shown(fit)
    if isinstance(law, RestLaw | DwellFriction):
        return out
    if law.broken:
        out |= _branches_shown(fit, data)
    if "q" in law.names:
        q, error = fit.values[law.index("q")], fit.error("q")
        if q <= 2.0 * error:
            out["q"] = "the data do not bound T0 from below. Record temperatures further apart"
    if "q" not in out and law.branches == "two branches, one Hersey number" and law.thermal:
        c = fit.values[law.index("c")]
        if 1.0 + c <= LEAST_POWER:
            out["at"] = (
                "torque above the transition hardly depends on viscosity (1 + c is at its bound), so "
                "the transition at other temperatures is unknown. Record faster speeds"
            )
    return out


def _parts_shown(fit: LawFit, norms: FloatArray) -> dict[str, str]:
    """Which part beside the film, or the film, hardly shows: a factor e of it is within the errors."""
    out: dict[str, str] = {}
    for name, what in (("rest", "constant"), ("viscous", "viscous")):
        part = fit.law.index(name) if name in fit.law.names else None
        if part is None or (norms[part] >= 2.0 and fit.covariance[part, part] <= 1.0):
            continue
        why = f"the {what} torque cannot be separated from the film. Record a wider speed range"
        out |= {lost: why for lost in (name, "r") if lost in fit.law.names}
    return out


def _contact_shown(fit: LawFit) -> dict[str, str]:
    """Which numbers of a contact the log hardly tells: a factor e of it is within the errors."""
    more = {
        "viscosity": "speeds at which the film carries the whole load, and the no-load torque separately",
        "roughness": "speeds on both sides of the transition",
        "boundary": "slower speeds, at which asperities carry more load",
    }
    return {
        name: f"uncertain by more than a factor of {np.e:.1f}. Record {what}"
        for name, what in more.items()
        if name in fit.law.names
        and (fit.error(name) > 1.0 or abs(fit.values[fit.law.index(name)]) >= 0.99 * BOUND)
    }


def _branches_shown(fit: LawFit, data: Observations) -> dict[str, str]:
    """Which parameters of a corner have too few speeds on either side."""
    assert isinstance(fit.law, Law)
    away = data.inputs.log_speed - fit.law.transition(fit.values, data.inputs)
    for side, what in ((away < 0, "slower"), (away >= 0, "faster")):
        levels = np.unique(np.round(np.sort(away[side]) / 0.03)).size
        if np.count_nonzero(side) < 3 or levels < 2:
            count = int(np.count_nonzero(side))
            where = "below" if what == "slower" else "above"
            reason = f"only {count} dwells lie {where} the transition. Record dwells at {what} speeds"
            lost = ["at", "c_mixed"] if what == "slower" else ["at", "c"]
            return {name: reason for name in lost if name in fit.law.names}
    if fit.error("at") > 0.25 * float(np.ptp(data.inputs.log_speed)):
        return {
            "at": "the branches differ too little to show where they meet. Record slower and faster speeds"
        }
    return {}
