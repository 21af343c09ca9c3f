"""The curve of a contact that the machine file states: film and asperities share its load.

Drag of film and asperities over boundary friction, against ln(viscosity speed/reference), comes from the core
once, as a table. A draw moves it along speed and torque, and makes the film's part larger or smaller, as
other viscosity, roughness and boundary friction would.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hersey import _core
from hersey.arrays import FloatArray
from hersey.damping.candidates.shared_load import SharedLoad
from hersey.damping.curves.shapes import Prior, Shape

#: Ends of the table in ln(viscosity speed/reference), and the distance of its points.
_ENDS, _STEP = (-16.0, 16.0), 0.02
#: Standard deviation of ln of the film's part over the stated one.
_FILM = 0.7


def shared_load_shape(contact: SharedLoad, kelvin: float) -> Shape:
    """Return the curve of a contact, `hersey.lubrication.mixed.MixedContact`, as a law of drag curves.

    Boundary friction is that at a temperature (K).
    """
    grid = np.arange(_ENDS[0], _ENDS[1] + _STEP, _STEP)
    numbers = dict(zip(_core.SHARING, contact.numbers(np.array([kelvin])), strict=True))
    given = [
        np.broadcast_to(np.asarray(numbers[name], dtype=np.float64), grid.shape) for name in _core.SHARING
    ]
    product = numbers["reference"] * np.exp(grid)
    state = _core.mixed_contact([np.ascontiguousarray(each) for each in (product, *given)])
    most = float(np.max(state.boundary))
    asperities, film = state.boundary / most, np.log((state.shear + state.rolling) / most)

    prior = Prior("ln film", 0.0, _FILM)
    curve = _Drag(grid, asperities, film)
    return Shape("mixed", "film and asperities of the machine's contact", (prior,), curve)


@dataclass(frozen=True)
class _Drag:
    """Drag of asperities, and ln of that of the film, over boundary friction."""

    grid: FloatArray
    asperities: FloatArray
    film: FloatArray

    def __call__(self, x: FloatArray, own: FloatArray) -> FloatArray:
        """Return ln of the drag of both at places, for draws of the film's part."""
        at = np.clip(x, self.grid[0], self.grid[-1])
        # np.interp would search the place of each anew, for either
        row = (np.nan_to_num(at - self.grid[0]) / _STEP).astype(np.intp)
        row -= at < self.grid.take(row)
        row += at >= self._ends.take(row)
        beyond = at - self.grid.take(row)
        carried, film = (
            slopes.take(row) * beyond + values.take(row)
            for values, slopes in zip((self.asperities, self.film), self._slopes, strict=True)
        )
        return np.asarray(np.log(carried + np.exp(film + own[:, :1])))

    @cached_property
    def _ends(self) -> FloatArray:
        """Where each row of the table ends; the last has no end."""
        return np.append(self.grid[1:], np.inf)

    @cached_property
    def _slopes(self) -> tuple[FloatArray, FloatArray]:
        """Slopes of asperities and film from each point to the next; the last goes on level."""
        steps = np.diff(self.grid)
        asperities, film = (np.append(np.diff(each) / steps, 0.0) for each in (self.asperities, self.film))
        return asperities, film


def least(shape: Shape) -> tuple[float, float]:
    """Return where the curve of a contact is least, ln(viscosity speed/reference), and ln drag there."""
    grid = np.arange(_ENDS[0], _ENDS[1] + _STEP, _STEP)
    drag = shape.curve(grid[None], np.zeros((1, 1)))[0]
    at = int(np.argmin(drag))
    return float(grid[at]), float(drag[at])
