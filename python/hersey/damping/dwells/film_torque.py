"""The torque of the film alone: that of dwells less the no-load torque."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hersey.arrays import BoolArray, FloatArray
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import InsufficientDataError
from hersey.units import rpm

#: Standard errors by which a torque must exceed the no-load torque, so that a film is left.
_BEYOND = 2.0
#: Share of the dwells that may miss that; if more do, the no-load torque is not the one of this log.
_FEW = 0.25


def film_torque(
    speed: FloatArray,
    torque: FloatArray,
    variance: FloatArray,
    kelvin: FloatArray | None,
    rest: NoLoadTorque,
    logs: Sequence[str],
) -> tuple[FloatArray, FloatArray, BoolArray]:
    """Return the torque of the film, its errors by the no-load torque, and which dwells show none.

    Parameters
    ----------
    speed, torque, variance
        Of each dwell, rad/s, N m and N² m², shape (dwells,).
    kelvin
        Their temperatures, if the no-load torque depends on them.
    rest
        The no-load torque.
    logs
        The name of the log of each dwell.

    Raises
    ------
    InsufficientDataError
        If nothing is left for the film at one dwell, or nothing beyond its errors at a quarter of them.
    """
    taken, errors = rest.torque(speed, temperature=kelvin), rest.errors(speed, temperature=kelvin)
    film = torque - taken
    forward = np.sign(speed) * film
    unsure = _BEYOND * np.sqrt(variance + np.sum(errors**2, axis=1))
    hidden = ~(forward > unsure)
    if np.count_nonzero(hidden) > _FEW * hidden.size or (forward < -unsure).any():
        at = int(np.argmin(forward - unsure))
        raise InsufficientDataError(
            f"{logs[at]}: at {rpm(abs(float(speed[at]))):.3g} rpm torque is "
            f"{1e3 * abs(float(torque[at])):.3g} mN m and no-load torque "
            f"{1e3 * abs(float(taken[at])):.3g} mN m ({rest.source}), which leaves nothing for "
            "the film. Check its unit, and that it was recorded without the film"
        )
    return film, errors, hidden
