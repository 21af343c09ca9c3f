"""The operating map of a specimen when new, as last seen, and when it ends.

Torque between the dwells of a run is that of its `TorqueSurface`, without a law. To the end it is carried on
by a clock, the growth of the torque by its own growth law: at each speed and temperature ln torque
went with ln of the clock over the ages seen, and goes on so. That shows where the motor stops, not where
torque is least: the transition moves by a factor, the same at all temperatures, as it did over the ages seen.
It rises with temperature, as viscosity falls.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, NamedTuple

import numpy as np

from hersey.arrays import BoolArray, FloatArray, one_thread
from hersey.errors import InsufficientDataError, ParameterError, meant
from hersey.life.age import Age
from hersey.life.campaign.adding import as_kept
from hersey.life.growth.limit_ages import rounded
from hersey.life.indicators.run_dwells import read_runs_of
from hersey.life.indicators.shared_kernel import shared_kernel
from hersey.life.indicators.torque_surface import RunDwells, TorqueSurface
from hersey.life.map_edges import edges_of, measured_at, moved_edges
from hersey.machine.limits import OperatingPoint
from hersey.result import Means, Result
from hersey.schema.warning import Warning
from hersey.units import celsius

if TYPE_CHECKING:
    import polars as pl

    from hersey.damping.no_load_torque import NoLoadTorque
    from hersey.life.campaign import Campaign
    from hersey.life.time_to_failure.estimate import TimeToFailure
    from hersey.life.time_to_failure.first import SpecimenEnd
    from hersey.machine.machine import Machine

#: Temperatures and speeds of each map.
TEMPERATURES, SPEEDS = 21, 61
#: Kind of the mode whose growth is the clock.
CLOCK = "motor torque"
#: Temperatures (K) that are one, and how far beyond the dwells an operating point is drawn.
_APART, _BESIDE = 5.0, 10.0
#: Up to so many times the age last seen there is a map at the end.
_FARTHEST = 1.5
#: What is to be known of all maps, and of that at the end.
_WITHOUT_LAW = Warning(
    "torque without a law", "torque between the dwells is interpolated without a fitted law"
)
_EXTRAPOLATED = Warning(
    "torque extrapolated",
    "torque and transition are extrapolated along their growth, to the middle of the interval of that age",
    severity="watch",
    where="end",
)
_FALLING = Warning(
    "transition falls",
    "the dwells show a transition that falls with temperature, which no oil explains; it is drawn level",
    severity="watch",
)


@dataclass(frozen=True, repr=False)
class AgeingMaps(Result):
    """Operating maps of one specimen at several ages.

    ``when`` describes each age in a word. ``temperature`` (K, shape (n,)) and ``speed`` (m/s at the belt,
    shape (m,)) span the maps; ``torque`` (N m, shape (ages, n, m)) is that at the roll. Below ``transition``
    (m/s, shape (ages, n); 0 where torque never falls with speed) the belt cannot run smoothly; between it and
    ``upper`` the outcome depends on the start. Above ``torque_limit`` (N m; None if not stated) the motor
    stops.
    """

    unit: str
    age_unit: str
    ages: FloatArray
    when: Annotated[tuple[str, ...], Means("what each age is, in one word")]
    temperature: FloatArray
    speed: FloatArray
    torque: Annotated[FloatArray, Means("N m", shape="(ages, temperatures, speeds)", open=True)]
    transition: Annotated[
        FloatArray, Means("0 where torque never falls with speed", shape="(ages, temperatures)")
    ]
    upper: Annotated[
        FloatArray,
        Means(
            "V*, below which the outcome depends on the start; null above the search range",
            shape="(n, m)",
            open=True,
        ),
    ]
    measured: Annotated[
        BoolArray,
        Means("false where extrapolated: beyond the dwells of the run, or after it", shape="(ages, n, m)"),
    ]
    torque_limit: float | None
    points: tuple[OperatingPoint, ...]
    roll_radius: Annotated[float, Means(unit="m")]
    warnings: tuple[Warning, ...] = ()

    @property
    def names(self) -> list[str]:
        """Return the name of each map, e.g. "now, 170000 pages"."""
        ages = (str(Age(float(rounded(age)), self.age_unit)) for age in self.ages.tolist())
        return [f"{word}, {age}" for word, age in zip(self.when, ages, strict=True)]

    def state(self, index: int, point: OperatingPoint) -> str:
        """Return the state of the belt at an operating point in one of the maps, in a word or two."""
        column = int(np.argmin(np.abs(self.temperature - point.temperature)))
        torque = float(
            np.exp(np.interp(np.log(point.speed), np.log(self.speed), np.log(self.torque[index, column])))
        )
        if self.torque_limit is not None and torque > self.torque_limit:
            return "motor stops"
        if point.speed < self.transition[index, column]:
            return "stick-slip"
        return "depends on start" if point.speed < self.upper[index, column] else "smooth"

    def _stated(self, index: int, point: OperatingPoint) -> str:
        column = int(np.argmin(np.abs(self.temperature - point.temperature)))
        row = int(np.argmin(np.abs(np.log(self.speed / point.speed))))
        known = self.measured[index, column, row]
        return self.state(index, point) + ("" if known else " (extrapolated)")

    def headline(self) -> str:
        """Return the specimen and its ages."""
        return f"maps of {self.unit} at {'; '.join(self.names)}"

    def summary(self) -> str:
        """Return the state of the belt at each operating point and age as text."""
        states = (f"  {each}" for each in self.states())
        return "\n".join([self.headline(), *states, *(f"- {each}" for each in self.warnings)])

    def states(self) -> list[str]:
        """Return the state of the belt at each operating point and age, a line for each point."""
        lines = []
        for point in self.points:
            if self.temperature[0] <= point.temperature <= self.temperature[-1]:
                states = (f"{when} {self._stated(i, point)}" for i, when in enumerate(self.when))
                at = f"{1e3 * point.speed:.3g} mm/s at {celsius(point.temperature):.3g} degC"
                lines.append(f"{point.name}, {at}: {', '.join(states)}")
        return lines

    def to_frame(self) -> pl.DataFrame:
        """Return one row per age and temperature."""
        import polars as pl

        ages, columns = self.transition.shape
        return pl.DataFrame(
            {
                f"age ({self.age_unit or '1'})": np.repeat(self.ages, columns),
                "when": [word for word in self.when for _ in range(columns)],
                "temperature (K)": np.tile(self.temperature, ages),
                "transition (m/s)": self.transition.ravel(),
                "upper (m/s)": self.upper.ravel(),
                "least torque (N m)": self.torque.min(axis=2).ravel(),
            }
        )


def carried_on(log_torque: FloatArray, clock: FloatArray, to: float) -> FloatArray:
    """Return ln torque (runs, ...) carried on to where the clock stands at ``to``, in proportion to it.

    ``clock`` has a value for each run. From the last run on, by the slope of least squares over all runs.
    """
    away = clock - clock.mean()
    square = float(away @ away)
    if square == 0.0:
        return np.asarray(log_torque[-1])
    slope = np.tensordot(away, log_torque, axes=(0, 0)) / square
    return np.asarray(log_torque[-1] + slope * (to - clock[-1]))


@one_thread()
def ageing_maps(
    campaign: Campaign,
    machine: Machine,
    found: TimeToFailure,
    *,
    unit: str = "",
    excluded: Sequence[int] = (),
) -> AgeingMaps:
    """Return the maps of a specimen when new, as last seen and, if it has not ended yet, at its end.

    Parameters
    ----------
    campaign, machine
        Whose specimen it is, and what drives it.
    found
        What ends the specimens, and when.
    unit
        Its name; the specimen that ends next if left out.
    excluded
        Places of runs that are not used.

    Raises
    ------
    ParameterError
        If there is no such specimen.
    InsufficientDataError
        If its runs do not show torque against temperature.
    """
    end = _chosen(found, unit)
    if not machine.has_drivetrain:
        raise InsufficientDataError(
            "the machine file has no [drivetrain]",
            remedy="add it, with stiffness, mass, roll_radius and stick_speed",
        )
    runs = read_runs_of(campaign, machine.rest)
    usable = [each for each in runs.usable() if each[0] not in excluded]
    own = [(runs.runs.age[i], dwells, rest) for i, dwells, rest in usable if runs.runs.unit[i] == end.unit]
    if not own or any(not np.ptp(dwells.temperature) > _APART for _, dwells, _ in own):
        raise InsufficientDataError(f"the runs of {end.unit} do not show how torque depends on temperature")
    kernel = shared_kernel([dwells for _, dwells, _ in usable])
    hot, speed = _grid(own[0][1], machine)
    rolls = speed / machine.roll_radius
    every = [
        _Shown(float(age), "", np.log(_torques(TorqueSurface(dwells, kernel), hot, rolls)), rest, dwells)
        for age, dwells, rest in own
    ]
    shown = _measured_maps(every)
    edges = [edges_of(machine, each.belt, each.rest, hot, speed) for each in shown]
    warnings = [_WITHOUT_LAW, *([_FALLING] if any(each.falls for each in edges) else [])]
    ending, last = end.age.age.value, every[-1]
    if every[0].age < last.age < ending < np.inf:
        if ending > _FARTHEST * last.age:
            warnings.append(_too_far(ending, found.age_unit))
        else:
            ages = np.array([each.age for each in every])
            clock = _clock(found, end.unit, np.append(ages, ending))
            to_end = carried_on(np.array([each.belt for each in every]), clock[:-1], float(clock[-1]))
            shown.append(_Shown(ending, "end", to_end, last.rest, None))
            over_life = [edges_of(machine, each.belt, each.rest, hot, speed) for each in every]
            edges.append(moved_edges(over_life, ages, ending, speed))
            warnings.append(_EXTRAPOLATED)
    return AgeingMaps(
        unit=end.unit,
        age_unit=found.age_unit,
        ages=np.array([each.age for each in shown]),
        when=tuple(each.when for each in shown),
        temperature=hot,
        speed=speed,
        torque=np.array([_drive_torque(each, hot, rolls) for each in shown]),
        transition=np.array([each.transition for each in edges]),
        upper=np.array([each.upper for each in edges]),
        measured=np.array([measured_at(each.dwells, hot, rolls) for each in shown]),
        torque_limit=machine.limits.motor_torque,
        points=machine.points,
        roll_radius=machine.roll_radius,
        warnings=tuple(warnings),
    )


class _Shown(NamedTuple):
    """A map to be drawn: ln torque of the belt, and the dwells behind it; None if it is extrapolated."""

    age: float
    when: str
    belt: FloatArray
    rest: NoLoadTorque | None
    dwells: RunDwells | None


def _drive_torque(shown: _Shown, hot: FloatArray, rolls: FloatArray) -> FloatArray:
    """Torque of the whole drive at temperatures and speeds (rad/s), N m."""
    if shown.rest is None:
        return np.exp(shown.belt)
    no_load = np.array([shown.rest.torque(rolls, temperature=kelvin) for kelvin in hot.tolist()])
    return np.asarray(np.exp(shown.belt) + no_load)


def _measured_maps(own: Sequence[_Shown]) -> list[_Shown]:
    """The first and the last of the runs, with a word for each."""
    first, last = own[0], own[-1]
    shown = [first._replace(when="new" if first.age == 0.0 else "first")]
    return shown if last.age == first.age else [*shown, last._replace(when="now")]


def _too_far(age: float, unit: str) -> Warning:
    return Warning(
        "end beyond the map",
        "there is no map at the end, {shown}: that is more than {factor:g} times the age followed",
        remedy="measure again later",
        shown=str(Age(float(rounded(age)), unit)),
        factor=_FARTHEST,
    )


def _chosen(found: TimeToFailure, unit: str) -> SpecimenEnd:
    """The specimen of that name; else the one that ends next, or first if all have ended."""
    if unit:
        for each in found.units:
            if each.unit == as_kept(unit):
                return each
        known = [each.unit for each in found.units]
        near = meant(unit, known)
        way = f"did you mean '{near}'?" if near else f"its specimens are {', '.join(known)}"
        raise ParameterError(f"the campaign has no specimen '{unit}'", remedy=way)
    coming = [each for each in found.units if each.age.state == "running"]
    return min(coming or found.units, key=lambda each: each.age.age.value)


def _clock(found: TimeToFailure, unit: str, ages: FloatArray) -> FloatArray:
    """How far a specimen has aged at ages: ln of the growth of its torque, else the ages."""
    for mode in found.modes:
        if mode.kind == CLOCK and unit in mode.growth.units:
            return np.asarray(np.log(mode.growth.at(ages).median[mode.growth.units.index(unit)]))
    return ages


def _grid(dwells: RunDwells, machine: Machine) -> tuple[FloatArray, FloatArray]:
    """Temperatures (K) and speeds (m/s at the belt) that span dwells and the operating points beside them."""
    low, high = float(dwells.temperature.min()), float(dwells.temperature.max())
    points = [
        each.temperature for each in machine.points if low - _BESIDE < each.temperature < high + _BESIDE
    ]
    slow, fast = (float(v) * machine.roll_radius for v in (dwells.speed.min(), dwells.speed.max()))
    hot = np.linspace(min([low, *points]), max([high, *points]), TEMPERATURES)
    return hot, np.geomspace(slow, fast, SPEEDS)


def _torques(surface: TorqueSurface, hot: FloatArray, speed: FloatArray) -> FloatArray:
    """Torque of the belt alone (N m) at temperatures and speeds (rad/s), shape (temperatures, speeds)."""
    kelvin, rolls = np.meshgrid(hot, speed, indexing="ij")
    return surface.at(rolls.ravel(), kelvin.ravel()).torque.reshape(kelvin.shape)
