"""Where the law of a mixed contact was checked against the full numerical solution (docs/theory/mixed.md)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import FloatArray
from hersey.lubrication.contact import Contact
from hersey.lubrication.film import inlet_length

#: Pressure of the asperities at F = 1 over that of the nip for which the law of a soft film was checked.
_STIFFNESS = (2.0, 60.0)
#: Half-width of the nip over thickness of the rubber for which it was.
_WIDTH = (0.6, 1.6)
#: Longest inlet over half-width for which it was.
_INLET = 0.05
#: Largest share of the load on the asperities for which it was.
_SHARE = 0.5
#: Largest share at which the law of a hard film is supported.
_HARD_SHARE = 0.1


def beyond_checked_range(
    contact: Contact, share: FloatArray, product: FloatArray, stiffness: float | None
) -> NDArray[np.bool_]:
    """Return where the law was not checked.

    Parameters
    ----------
    share
        Of the load on the asperities.
    product
        Viscosity times belt speed, Pa m, of the same shape.
    stiffness
        Pressure of the asperities at F = 1 over that of the nip; None for a hard film.
    """
    if stiffness is None:
        return np.asarray(share > _HARD_SHARE)
    nip = contact.nip
    width = nip.half_width / contact.rubber_thickness
    inlet = inlet_length(contact, 1.0, 0.5 * product) / nip.half_width
    nip_known = _STIFFNESS[0] <= stiffness <= _STIFFNESS[1] and _WIDTH[0] <= width <= _WIDTH[1]
    return np.asarray((share > _SHARE) | (inlet > _INLET) | (not nip_known))
