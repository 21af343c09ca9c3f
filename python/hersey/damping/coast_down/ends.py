"""What a law fitted to coasts shows to be none: rows at their ends, and whole stretches that are driven."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from hersey.damping.coast_down.closed_form import speeds
from hersey.damping.coast_down.coasts import FEWEST_ROWS, Coast, noise_of_rows
from hersey.damping.coast_down.fitting import CoastFit, Trace, fit_coasts
from hersey.log.white_noise import MEDIAN_MAGNITUDE

#: Shares of a coast at its beginning and its end that are looked at.
_BEGINNING, _END = 0.02, 0.06
#: As many neighbouring rows beyond so many standard deviations of the others are no part of the coast.
_ROWS, _BEYOND = 3, 4.0
#: Rows next to them that are left out, too: a drive does not let go at once.
_MARGIN = 3
#: Least share of a fall that is not at its ends.
_INNER = 0.5
#: Scatter about the law, as a share of the fall, that is no noise of a sensor, over so many rows.
_UNEVEN, _SMOOTHED = 0.04, 5


def without_ends(coasts: Sequence[Coast]) -> list[Coast]:
    """Return coasts without rows at their ends that depart from a law fitted to the rows between."""
    inner = [slice(int(_BEGINNING * c.rows), c.rows - int(_END * c.rows)) for c in coasts]
    parts = [(c.time[rows], c.speed[rows]) for c, rows in zip(coasts, inner, strict=True)]
    fit = fit_coasts([Trace(time - time[0], speed) for time, speed in parts])
    cut = []
    for index, (coast, rows) in enumerate(zip(coasts, inner, strict=True)):
        time = coast.time - coast.time[rows.start]
        after = speeds(fit.law, float(fit.first[index]), time[rows.start :])[0]
        before = speeds(fit.law, float(fit.first[index]), time[: rows.start + 1][::-1])[0][::-1]
        rest = coast.speed - np.concatenate([before[:-1], after])
        scale = float(np.median(np.abs(rest[rows]))) / MEDIAN_MAGNITUDE
        odd = np.abs(rest) > _BEYOND * scale
        run = np.convolve(odd, np.ones(_ROWS), mode="valid") >= _ROWS
        first = int(np.flatnonzero(run[: rows.start])[-1]) + _ROWS if run[: rows.start].any() else 0
        late = run[rows.stop :]
        last = rows.stop + int(np.argmax(late)) - 1 if late.any() else coast.rows
        first, last = first + _MARGIN * (first > 0), last - _MARGIN * (last < coast.rows)
        cut.append(_part(coast, first, last) if last - first >= FEWEST_ROWS else coast)
    return cut


def is_free(coast: Coast) -> bool:
    """Return whether a law of friction describes a fall of speed, as it does not where a drive sets it.

    Noise of single rows is averaged; the last turns, in which gears make the speed swing, do not count.
    """
    whole = coast.speed[0] - coast.speed[-1]
    (coast,) = without_ends([coast])
    if coast.speed[0] - coast.speed[-1] < _INNER * whole:
        return False
    fit = _physical([Trace(coast.time, coast.speed)])
    rest = coast.speed - fit.predicted(0, coast.time)
    smooth = np.convolve(rest, np.ones(_SMOOTHED) / _SMOOTHED, mode="valid")
    noise = 2.0 * noise_of_rows(coast.speed) / np.sqrt(_SMOOTHED)
    allowed = np.hypot(_UNEVEN * float(coast.speed[0] - coast.speed[-1]), noise)
    return bool(np.median(np.abs(smooth)) < MEDIAN_MAGNITUDE * allowed)


def _physical(traces: Sequence[Trace]) -> CoastFit:
    """A law without a negative term, as friction is."""
    fit = fit_coasts(traces)
    while (fit.law < 0).any():
        fit = fit_coasts(traces, (fit.law > 0).tolist())
    return fit


def _part(coast: Coast, first: int, last: int) -> Coast:
    """Some rows of a coast."""
    time = coast.time[first:last]
    return replace(
        coast,
        start=coast.start + float(time[0]),
        end=coast.start + float(time[-1]),
        stops=coast.stops and last == coast.rows,
        time=time - time[0],
        speed=coast.speed[first:last],
    )
