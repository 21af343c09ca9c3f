"""The posterior of a drive: draws, and what they say of V*, of a speed, and of what to measure."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from hersey.arrays import BoolArray, FloatArray, refuse_without_xarray
from hersey.damping.curves import LawWeight
from hersey.damping.curves.words import weight_lines
from hersey.damping.estimate import rounded
from hersey.errors import ParameterError
from hersey.posterior.drives import DriveModel, Drives
from hersey.posterior.evidence import Evidence
from hersey.posterior.priors import CLOSURES, NUMBERS
from hersey.result import Means, Record, Result, json_record
from hersey.schema.warning import Warning
from hersey.stability.operating_map.edges import GivenEdges
from hersey.units import celsius, takes_si

if TYPE_CHECKING:
    import polars as pl
    import xarray as xr

#: Probability with which the safe speed is smooth from any start.
SAFE = 0.975
#: Ratio of the medians and ends of V* of two populations from which a result counts as converged.
CONVERGED = 1.15
#: The same for a wide V*: a share of the width of its interval, in logarithms.
OF_WIDTH = 0.08
#: Temperatures of a map at which draws are followed; between them edges are interpolated.
MAP_TEMPERATURES = 9
#: Share of draws whose motion may be lost.
_LOST = 0.1
#: Units of the numbers of a drive.
_UNITS = {"stick_speed": "m/s", "stiffness": "N/m", "mass": "kg", "static_ratio": "1"}
#: V* beyond this many transition speeds is not looked for.
_FARTHEST = 1e4


@dataclass(frozen=True)
class Edges:
    """Speeds (m/s) and forces (N) of each draw at one temperature, shape (draws,).

    ``fold`` is V*, at least the transition; ``holding`` the force that starts a belt at rest. Where the
    roll's grip does not start the belt (``stalls``), V* is that of a roll that grips. ``turns_by`` is the
    speed up to which drag was seen to fall, where it still falls at the fastest dwell: transition and V* are
    not known then. It is infinite where drag turns among the dwells.
    """

    transition: FloatArray
    fold: FloatArray
    holding: FloatArray
    stalls: BoolArray
    turns_by: FloatArray


@dataclass(frozen=True)
class PointProbability:
    """How likely each outcome is at one operating point; they add up to one.

    ``smooth``: from any start. ``from_above``: only if it slides already, or starts gently. ``sticks``: from
    any start. ``stalls``: the roll's grip does not start the belt. ``unknown``: drag still falls at the
    fastest dwell, and no dwell shows what happens there.
    """

    smooth: float
    from_above: float
    sticks: float
    stalls: float
    unknown: float = 0.0


@dataclass(frozen=True)
class Convergence(Record):
    """How two populations that know nothing of each other compare.

    ``ratio`` is the greatest ratio of their quantiles of V* (5, 50 and 95 %), ``width`` that of the outer
    quantiles of all; ``accepted`` the share of moves
    in the last stage, ``distinct`` the share of draws that no other equals; ``counted`` is the degree to
    which the evidence is in, 1 where all of it is.
    """

    also_stated = ("converged",)

    ratio: Annotated[float, Means("largest ratio of their quantiles of V*")]
    width: Annotated[float, Means("ratio of the outer quantiles of all")]
    accepted: Annotated[float, Means("fraction of moves accepted in the last stage")]
    distinct: Annotated[float, Means("fraction of distinct draws")]
    stages: int
    log_evidence: tuple[float, ...]
    counted: Annotated[float, Means("degree to which the evidence is included; 1 is all of it")]

    @property
    def converged(self) -> bool:
        """Whether all evidence is in and the populations agree."""
        agree = self.ratio <= max(CONVERGED, self.width**OF_WIDTH)
        return agree and self.distinct >= 0.5 and self.counted >= 1.0


@dataclass(frozen=True, repr=False)
class Posterior(Result):
    """Draws of drag curve, closure and drive, given the dwells and other evidence.

    ``temperature`` (K; None if isothermal) is that of the headline. ``laws`` are the drag curves by weight,
    ``evidence`` what was used besides the dwells, ``warnings`` what was not, and why.
    """

    model: DriveModel = field(repr=False)
    drives: Drives = field(repr=False)
    temperature: float | None
    laws: tuple[LawWeight, ...]
    evidence: tuple[Evidence, ...]
    warnings: tuple[Warning, ...]
    convergence: Convergence
    seed: int
    chains: int

    @cached_property
    def _edges(self) -> dict[tuple[float | None, int], Edges]:
        return {}

    def edges(self, kelvin: float | None, *, most: int | None = None, threads: int = 1) -> Edges:
        """Return transition, V* and starting force of each draw at a temperature (K; None if isothermal).

        ``most`` takes so many draws, evenly spread.

        Raises
        ------
        ParameterError
            If the law has no meaning at this temperature, or V* of too many draws cannot be computed.
        """
        count = min(most or len(self.drives), len(self.drives))
        if (kelvin, count) not in self._edges:
            few = np.linspace(0, len(self.drives) - 1, count).astype(np.intp)
            self._edges[kelvin, count] = edges_at(self.model, self.drives.take(few), kelvin, threads=threads)
        return self._edges[kelvin, count]

    def keep(self, kelvin: float | None, edges: Edges) -> None:
        """Keep the edges of all draws at a temperature, which were computed before."""
        self._edges[kelvin, len(self.drives)] = edges

    @takes_si(kelvin="temperature")
    def fold_interval(self, kelvin: float | None) -> tuple[float, float, float]:
        """Return the median of V* (m/s) and the ends of its 95 % interval at a temperature (K)."""
        low, middle, high = quantiles(self.edges(kelvin).fold, (0.025, 0.5, 0.975))
        return middle, low, high

    @takes_si(kelvin="temperature")
    def safe_speed(self, kelvin: float | None) -> float:
        """Return the least drive speed (m/s) that is smooth from any start with 97.5 % probability."""
        return quantiles(self.edges(kelvin).fold, (SAFE,))[0]

    def map_edges(self, kelvin: FloatArray | None, *, most: int = 200, threads: int = 1) -> GivenEdges:
        """Return medians and intervals of the edges at temperatures (K; None if isothermal) for a map.

        They are drawn at some temperatures, from so many draws at most (from all at that of the headline),
        and interpolated between.
        """
        levels: list[float | None] = [None] if kelvin is None else kelvin.tolist()
        if kelvin is not None and kelvin.size > MAP_TEMPERATURES:
            drawn = np.linspace(kelvin[0], kelvin[-1], MAP_TEMPERATURES)
            if self.temperature is not None and kelvin[0] < self.temperature < kelvin[-1]:
                drawn = np.union1d(drawn, self.temperature)  # there the map says what the headline says
            levels = drawn.tolist()
        rows, failed = {}, list[ParameterError]()
        for level in levels:
            try:
                edges = self.edges(level, most=None if level == self.temperature else most, threads=threads)
            except ParameterError as error:  # beyond the dwells V* of many draws may be out of reach
                failed.append(error)
                continue
            speeds_and_force = edges.transition, edges.fold, edges.holding
            rows[level] = [quantiles(each, (0.5, 0.025, 0.975)) for each in speeds_and_force]
        if not rows:
            raise failed[0]
        table = np.array(list(rows.values()))
        if kelvin is not None:
            at = np.array(list(rows), dtype=float)
            table = np.exp(
                [
                    [np.interp(kelvin, at, column) for column in quantity]
                    for quantity in np.log(table).T.swapaxes(0, 1)
                ]
            )
        else:
            table = table.transpose(1, 2, 0)
        (turn, fold_, held) = table
        return GivenEdges(turn[0], fold_[0], held[0], turn[1:], fold_[1:], held[1:], NUMBERS)

    @takes_si(kelvin="temperature", speed="belt speed")
    def probability(self, *, kelvin: float | None, speed: float) -> PointProbability:
        """Return the probability of each outcome at a temperature (K) and drive speed (m/s)."""
        edges = self.edges(kelvin)
        stalls = edges.stalls
        smooth = ~stalls & (edges.fold < speed)
        sticks = ~stalls & (speed < np.minimum(edges.transition, edges.turns_by))
        unknown = ~stalls & ~sticks & np.isfinite(edges.turns_by)
        shares = [float(np.mean(each)) for each in (smooth, sticks, stalls, unknown)]
        return PointProbability(shares[0], max(1.0 - sum(shares), 0.0), *shares[1:])

    def closures(self) -> dict[str, float]:
        """Return the probability of each closure."""
        return {name: float(np.mean(self.drives.closure == i)) for i, name in enumerate(CLOSURES)}

    def numbers(self) -> dict[str, FloatArray]:
        """Return the draws of stick speed (m/s), stiffness (N/m), mass (kg) and static ratio."""
        return dict(zip(NUMBERS, self.model.numbers(self.drives).T, strict=True))

    def intervals(self) -> Mapping[str, tuple[float, float, float]]:
        """Return median and 95 % interval of each number of the drive, in SI."""
        return {
            name: (values[1], values[0], values[2])
            for name, draws in self.numbers().items()
            for values in [quantiles(draws, (0.025, 0.5, 0.975))]
        }

    def dataset(self) -> xr.Dataset:
        """Return the draws in the format of ArviZ: dimensions ``chain`` and ``draw``, units as attributes."""
        refuse_without_xarray("dataset()")
        import xarray as xr

        edges = self.edges(self.temperature)
        columns: dict[str, NDArray[Any]] = {
            **self.numbers(),
            "fold_speed": edges.fold,
            "transition_speed": edges.transition,
            "closure": self.drives.closure,
        }
        units = _UNITS | {"fold_speed": "m/s", "transition_speed": "m/s", "closure": "1"}
        shape = self.chains, len(self.drives) // self.chains
        kept = shape[0] * shape[1]
        variables = {
            name: (("chain", "draw"), values[:kept].reshape(shape), {"units": units[name]})
            for name, values in columns.items()
        }
        return xr.Dataset(
            variables,
            attrs={
                "seed": self.seed,
                "closures": ", ".join(CLOSURES),
                "temperature_K": self.temperature or 0.0,
            },
        )

    def to_dict(self) -> dict[str, Any]:
        """Return the posterior in SI; the draws are in `dataset`."""
        value, low, high = self.fold_interval(self.temperature)
        return json_record(
            {
                "temperature": self.temperature,
                "fold": {"value": value, "low": low, "high": high},
                "safe_speed": self.safe_speed(self.temperature),
                "closures": self.closures(),
                "numbers": {
                    name: {"value": v, "low": a, "high": b} for name, (v, a, b) in self.intervals().items()
                },
                "laws": [vars(law) for law in self.laws],
                "evidence": [{"kind": type(each).__name__, **vars(each)} for each in self.evidence],
                "warnings": self.warnings,
                "convergence": {**vars(self.convergence), "converged": self.convergence.converged},
                "draws": len(self.drives),
                "seed": self.seed,
            }
        )

    def to_frame(self) -> pl.DataFrame:
        """Return one row per draw, in SI."""
        import polars as pl

        edges = self.edges(self.temperature)
        names = list(CLOSURES)
        return pl.DataFrame(
            {
                **{f"{name} ({_UNITS[name]})": values for name, values in self.numbers().items()},
                "closure": [names[i] for i in self.drives.closure.tolist()],
                "transition_speed (m/s)": edges.transition,
                "fold_speed (m/s)": edges.fold,
            }
        )

    def headline(self) -> str:
        """Return V* with its interval."""
        value, low, high = (1e3 * v for v in self.fold_interval(self.temperature))
        where = "" if self.temperature is None else f" at {celsius(self.temperature):.0f} degC"
        return f"V*{where}: {value:.3g} mm/s [{low:.3g}, {high:.3g}]"

    def summary(self) -> str:
        """Return the posterior as text."""
        return "\n".join(_lines(self))


def edges_at(model: DriveModel, drives: Drives, kelvin: float | None, *, threads: int = 1) -> Edges:
    """Return transition, V* and starting force of draws at a temperature (K; None if isothermal).

    A draw whose motion cannot be followed counts as the worst of the others. V* of one whose drag still falls
    at the fastest dwell lies beyond all that is looked at.
    """
    model.surface.check_temperature(kelvin)
    curve = model.log_force(drives, kelvin)
    found = model.folds(drives, kelvin, threads=threads, curve=curve)
    upper, stalls = np.array(found.upper), np.flatnonzero(found.stalls)
    if stalls.size:
        held = model.folds(drives.take(stalls), kelvin, threads=threads, slips=False, curve=curve[stalls])
        upper[stalls] = held.upper
    upper = np.minimum(upper, _FARTHEST * found.transition)
    turns_by = model.turns_by(drives, kelvin, curve)
    upper = np.where(np.isfinite(turns_by), _FARTHEST * found.transition, upper)
    columns = [found.transition, np.fmax(upper, found.transition), found.holding]
    lost = np.any([np.isnan(each) for each in columns], axis=0)
    if np.mean(lost) > _LOST:
        why = f" ({found.failures[0].error})" if found.failures else ""
        raise ParameterError(
            f"V* cannot be computed for {100 * np.mean(lost):.0f} % of the draws{why}. Check stick "
            "speed, stiffness and mass"
        )
    transition, fold, holding = (np.where(lost, np.nanmax(each), each) for each in columns)
    return Edges(transition, fold, holding, found.stalls.astype(bool), turns_by)


#: Units of the numbers as people read them, and how many make one in SI.
_SHOWN = {
    "stick_speed": ("mm/s", 1e3),
    "stiffness": ("N/mm", 1e-3),
    "mass": ("kg", 1.0),
    "static_ratio": ("", 1.0),
}


def _lines(found: Posterior) -> list[str]:
    lines = [
        found.headline(),
        f"smooth from any start above {1e3 * found.safe_speed(found.temperature):.3g} mm/s (97.5 %)",
        "",
        "closure        "
        + ", ".join(f"{name} {100 * share:.0f} %" for name, share in found.closures().items()),
    ]
    for name, (value, low, high) in found.intervals().items():
        unit, factor = _SHOWN[name]
        shown = rounded(factor * value, factor * low, factor * high, unit)
        lines.append(f"{name.replace('_', ' '):14s} {shown}")
    lines += ["", "drag curves by weight", *weight_lines(found.laws)]
    counted = [type(each).__name__ for each in found.evidence]
    lines += ["", f"evidence besides the dwells: {', '.join(counted) or 'none'}"]
    lines += [f"  not used: {each}" for each in found.warnings]
    c = found.convergence
    state = "converged" if c.converged else "NOT converged, use more draws"
    agreement = f"quantiles of V* of {found.chains} populations agree within {100 * (c.ratio - 1):.0f} %"
    lines.append(f"{len(found.drives)} draws, seed {found.seed}; {state} ({agreement})")
    return lines


def quantiles(values: FloatArray, shares: tuple[float, ...]) -> tuple[float, ...]:
    """Return quantiles that are draws themselves, the next one up."""
    return tuple(float(v) for v in np.quantile(values, shares, method="higher"))
