"""A campaign of virtual units that age: a table of means for each unit and age, and the truth of all."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from hersey import _core
from hersey.errors import ParameterError, printable
from hersey.life.age import refuse_thousands
from hersey.life.oil_layer import STARVED
from hersey.result import json_value
from hersey.testbench.ageing import AgedTruth, Unit
from hersey.testbench.stand import PREAMBLE, Stand
from hersey.testbench.truth import RPM
from hersey.units import celsius

if TYPE_CHECKING:
    from hersey.machine.machine import Machine

#: The stand of a campaign: from a cold morning to the setpoint, dwells that repeat within 1 %.
STAND = Stand(temperatures_degC=(60.0, 90.0, 120.0, 150.0, 180.0), repeatability=0.01)
#: Oldest run, in pages: beyond it the laws of ageing leave all sense.
LATEST = 1e6
#: Age up to which an end is looked for, in ages of the last run.
_WITHIN = 6.0
_COLUMNS = "speed [rpm],temperature [degC],torque [N*m],torque error [N*m],approach"
_AGE = re.compile(r"(\d{1,12}(?:\.\d*)?)\s*([^\W\d_]*)")
_PAGES = {"pages": 1.0, "kpages": 1e3, "Mpages": 1e6}


@dataclass(frozen=True)
class Corners:
    """The states in which a unit ends, and the ``limit`` (N m) of its motor.

    ``full`` is the fastest point of the machine, ``cold`` that at the lowest temperature of the stand,
    ``slow`` the slowest point; each (rad/s, degC).
    """

    limit: float
    cold: tuple[float, float]
    full: tuple[float, float]
    slow: tuple[float, float]

    @classmethod
    def of(cls, machine: Machine, stand: Stand) -> Corners:
        """Return those of a machine.

        Raises
        ------
        ParameterError
            If it has no motor torque or no points.
        """
        limit = machine.limits.motor_torque
        if limit is None:
            raise ParameterError(
                'a specimen fails at the motor torque. Add motor_torque = "1 N*m" to [limits]'
            )
        if not machine.points:
            raise ParameterError(
                "a specimen fails at its operating points. Add [[points]] with speed and temperature"
            )
        by_speed = sorted(machine.points, key=lambda point: point.speed)
        slow, full = (
            (point.speed / machine.roll_radius, float(celsius(point.temperature)))
            for point in (by_speed[0], by_speed[-1])
        )
        return cls(limit, (full[0], min(stand.temperatures_degC)), full, slow)

    def ends(self) -> dict[str, Callable[[AgedTruth], float]]:
        """Return what is no longer below 0 once a unit has ended, by the way in which it ends."""
        return {
            "torque limit, cold and fast": partial(self._torque, self.cold),
            "torque limit, hot and slow": partial(self._torque, self.slow),
            "stick-slip range": self._falls,
            "starvation": self._starves,
        }

    def _torque(self, at: tuple[float, float], truth: AgedTruth) -> float:
        return float(truth.torque(*map(np.array, at))) - self.limit

    def _falls(self, truth: AgedTruth) -> float:
        """Fall of the contact's torque at the slow point: above 0 once the transition has passed it."""
        speed, temperature = self.slow
        below, above = truth.contact_torque(speed * np.array([0.999, 1.001]), np.full(2, temperature))
        return float(below - above)

    def _starves(self, truth: AgedTruth) -> float:
        return float(STARVED - truth.starvation(*map(np.array, self.full)))


@dataclass(frozen=True)
class VirtualCampaign:
    """Units followed to some ages (pages) on a stand, and the truth of each."""

    units: tuple[Unit, ...]
    ages: tuple[float, ...]
    seed: int = 0
    stand: Stand = STAND

    def __post_init__(self) -> None:
        """Check the ages, and that the machine says where a unit ends."""
        for age in self.ages:
            if not (0 <= age <= LATEST and float(age).is_integer()):
                raise ParameterError(
                    f"age is {age:g} pages: it must be a whole number from 0 to {LATEST:.0f} pages"
                )
        if not self.ages or list(self.ages) != sorted(set(self.ages)):
            raise ParameterError("ages must ascend, each given once")
        if not self.units:
            raise ParameterError("a campaign needs at least one specimen")
        Corners.of(self.units[0].machine, self.stand)

    def files(self, progress: Callable[[int, int], None] | None = None) -> dict[str, str]:
        """Return the files by name: runs.csv, truth.json and the table of each unit and age.

        A dwell that takes more than the motor has is missing; a unit that stalls at all of them has no table.
        """
        contents, rows, truths = {}, ["log,unit,age"], []
        for number, unit in enumerate(self.units, 1):
            stalled = {}
            for age in self.ages:
                random = np.random.default_rng([self.seed, number, round(age)])
                table, missing = self._table(unit, age, random)
                if missing:
                    stalled[f"{age:.0f}"] = missing
                if table:
                    name = f"{unit.name}-{age:.0f}.csv"
                    contents[name] = table
                    rows.append(f"{name},{unit.name},{age:.0f} pages")
            if progress:
                progress(number, len(self.units))
            truths.append(self._truth(unit) | {"stalled dwells": stalled})
        return {
            "runs.csv": "\n".join([*rows, ""]),
            "truth.json": json.dumps(self._document(truths), indent=1) + "\n",
            **contents,
        }

    def _table(self, unit: Unit, age: float, random: np.random.Generator) -> tuple[str, int]:
        """The means of a run as text, empty if there are none, and the number of dwells that stalled."""
        stand, limit = self.stand, Corners.of(unit.machine, self.stand).limit
        rising = [(speed, "up") for speed in stand.speeds_rpm]
        steps = [*rising, *((speed, "down") for speed in stand.speeds_rpm[-2::-1])]
        count = len(steps) * len(stand.temperatures_degC)
        speeds = np.tile([speed for speed, _ in steps], len(stand.temperatures_degC))
        levels = np.repeat(stand.temperatures_degC, len(steps))
        true = unit.at(age).torque(speeds * RPM, levels)
        shown = true * (1.0 + stand.repeatability * random.standard_normal(count))
        rows = [
            f"{speed:g},{level:g},{torque:.5f},{stand.repeatability * torque:.5f},{steps[i % len(steps)][1]}"
            for i, (speed, level, torque) in enumerate(
                zip(speeds.tolist(), levels.tolist(), shown.tolist(), strict=True)
            )
            if true[i] <= limit
        ]
        head = f"{PREAMBLE}: means of unit {unit.name} at {age:.0f} pages, seed {self.seed}"
        return "\n".join([head, _COLUMNS, *rows, ""]) if rows else "", count - len(rows)

    def _truth(self, unit: Unit) -> dict[str, Any]:
        corners, within = Corners.of(unit.machine, self.stand), _WITHIN * max(self.ages[-1], 1.0)
        ends = {name: unit.age_where(above, within=within) for name, above in corners.ends().items()}
        reached = {name: age for name, age in ends.items() if age is not None}
        runs = []
        for age in self.ages:
            truth = unit.at(age)
            assert truth.mixed is not None
            runs.append(
                {
                    "age": age,
                    "supply": truth.supply,
                    "viscosity factor": truth.thickening,
                    "roughness": truth.mixed.contact.roughness,
                    "boundary friction": truth.mixed.friction.coefficient,
                    "rest, constant": truth.rest.constant.value,
                    "torque, cold and fast": corners.limit
                    + corners.ends()["torque limit, cold and fast"](truth),
                    "transition speed at the slow point, rpm": float(
                        truth.transition_speed(np.array(corners.slow[1])) / RPM
                    ),
                    "film over flooded, hot and fast": float(truth.starvation(*map(np.array, corners.full))),
                }
            )
        return {
            "unit": unit.name,
            "ageing": unit.ageing.numbers(),
            "ends": ends,
            "first": min(reached, key=lambda name: reached[name], default=None),
            "runs": json_value(runs),
        }

    def _document(self, truths: list[dict[str, Any]]) -> dict[str, Any]:
        unit = self.units[0]
        return {
            "synthetic": True,
            "seed": self.seed,
            "version": _core.VERSION,
            "unit of age": "page",
            "ends looked for until": _WITHIN * max(self.ages[-1], 1.0),
            "new": json_value(unit.at(0.0).to_dict() | {"supply": None}),
            "corners": asdict(Corners.of(unit.machine, self.stand)),
            "starved below": STARVED,
            "stand": {
                name: getattr(self.stand, name)
                for name in ("temperatures_degC", "speeds_rpm", "repeatability")
            },
            "units": truths,
        }


def ages_of(text: str) -> tuple[float, ...]:
    """Return ages in pages from ``"0, 50, 100 kpages"``; a unit after each is possible too.

    Raises
    ------
    ParameterError
        If one is no number of pages.

    Examples
    --------
    >>> ages_of("0, 50, 100 kpages")
    (0.0, 50000.0, 100000.0)
    """
    typed = [part.strip() for part in text.split(",")]
    parts = [_AGE.fullmatch(part) for part in typed]
    last = parts[-1][2] if parts[-1] else ""
    ages = []
    for part, given in zip(parts, typed, strict=True):
        unit = (part[2] or last) if part else ""
        if part is None or unit not in _PAGES:
            wrong = f"'{unit}' is not a unit" if unit else f"'{printable(given)}' is not a number"
            raise ParameterError(
                f"{wrong} of pages. Write e.g. '0, 50, 100 kpages' (units: {', '.join(_PAGES)})"
            )
        refuse_thousands(part[1], unit)
        ages.append(round(float(part[1]) * _PAGES[unit], 6))
    return tuple(ages)
