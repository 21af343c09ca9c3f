"""How far the transition speed and V* are known: from draws of the fit and of what is uncertain beside it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.surface import DampingSurface
from hersey.machine.machine import Machine
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.work import Work
from hersey.scale.tasks import done, in_order
from hersey.schema.warning import Warning
from hersey.stability.hysteresis_sweep import sweep_bands
from hersey.stability.operating_map.edges import law_at, laws_at, require_all

if TYPE_CHECKING:
    from distributed import Client

#: Draws for the interval of the transition speed, and for that of V*, which costs a fold each.
DRAWS, FOLD_DRAWS = 1000, 200
#: Temperatures at which the interval of V* is computed; between them it is interpolated.
FOLD_TEMPERATURES = 13
#: Transition speeds at which the search for V* ends.
_FARTHEST = 1e4
#: Share of the draws that must start the belt for V* to be that of these alone.
_COUNTED = 0.1
#: Drawn stick speeds stay below this share of the transition speed drawn with them.
_BELOW = 0.999


class Intervals(NamedTuple):
    """95 % of the draws at each temperature, shape (2, n): speeds in m/s, starting torque in N m.

    V* is that of the draws that start, where a tenth of them do.
    """

    transition: FloatArray
    upper: FloatArray
    holding: FloatArray
    uncertain: tuple[str, ...]
    warnings: tuple[Warning, ...]


@dataclass(frozen=True)
class Drawing:
    """What is drawn at every temperature alike; a task of its own draws the rest and looks for the folds."""

    surface: DampingSurface
    train: Drivetrain
    drag: Drag
    uncertain: Mapping[str, FloatArray]
    roll_radius: float
    rule: str
    seed: int
    draws: int

    @classmethod
    def of(cls, surface: DampingSurface, machine: Machine, drag: Drag, draws: int, seed: int) -> Drawing:
        """Return so many draws of what the machine says is uncertain of drivetrain and stick speed."""
        train = machine.train
        known = {**asdict(train), "stick_speed": drag.stick_speed}
        rng = np.random.default_rng(seed)
        uncertain = {
            name: spread.draw(rng, known[name], draws)
            for name, spread in machine.uncertainty.items()
            if name in known
        }
        radius, rule = machine.roll_radius, machine.stick_speed_rule
        return cls(surface, train, drag, uncertain, radius, rule, seed, draws)

    def drag_at(self, kelvin: float | None, count: int) -> tuple[dict[str, FloatArray], list[Warning]]:
        """Return so many draws of the drag at a temperature (K), and their warnings."""
        drawn, warned = self.surface.drawn_drag(
            count,
            self.seed,
            roll_radius=self.roll_radius,
            stick_speed=self.drag.stick_speed,
            temperature=kelvin,
            stick_speed_rule=self.rule,
        )
        return drawn, [
            Warning("draws of the fit", "{said}", severity="watch", said=str(each)) for each in warned
        ]


def intervals(
    drawing: Drawing, kelvin: FloatArray | None, *, threads: int = 1, client: Client | str | None = None
) -> Intervals:
    """Return the intervals at each temperature, from draws of the fit and of what is uncertain beside it."""
    levels: list[float | None] = [None] if kelvin is None else kelvin.tolist()
    warnings: dict[Warning, None] = {}
    edges = []
    for t in levels:
        drawn, warned = drawing.drag_at(t, DRAWS)
        edges.append(_middle(drawn["transition_speed"]))
        warnings.update(dict.fromkeys(warned))
    few = levels
    if kelvin is not None and kelvin.size > FOLD_TEMPERATURES:
        few = np.linspace(kelvin[0], kelvin[-1], FOLD_TEMPERATURES).tolist()
    # the threads are those of the core, which share the draws of one temperature
    task = partial(_folds, drawing, threads if client is None else 1)
    ratios, holdings = [], []
    for ratio, held, warned in in_order(done(task, few, client=client)):
        ratios.append(ratio)
        holdings.append(held)
        warnings.update(dict.fromkeys(warned))
    upper, holding = np.array(ratios).T, np.array(holdings).T
    if kelvin is not None:
        at = np.array(few, dtype=float)
        upper, holding = (
            np.array([np.exp(np.interp(kelvin, at, np.log(edge))) for edge in ends])
            for ends in (upper, holding)
        )
    laws = laws_at(drawing.drag, kelvin, drawing.rule)
    bend = np.array([law.transition_speed for law in laws])
    torque = holding * drawing.roll_radius
    return Intervals(np.array(edges).T, upper * bend, torque, tuple(drawing.uncertain), tuple(warnings))


def _folds(
    drawing: Drawing, threads: int, kelvin: float | None
) -> tuple[tuple[float, float], tuple[float, float], list[Warning]]:
    """V* over the transition speed and the starting force (N) at a temperature: 95 % of the draws."""
    law = law_at(drawing.drag, kelvin, drawing.rule)
    drawn, warned = drawing.drag_at(kelvin, drawing.draws)
    stick_speed = drawing.drag.stick_speed
    stick = drawing.uncertain.get("stick_speed", np.array(stick_speed)) * law.stick_speed / stick_speed
    below = np.minimum(stick, _BELOW * drawn["transition_speed"])
    band = sweep_bands(
        drawing.train,
        law,
        {**drawing.uncertain, **drawn, "stick_speed": below},
        zip=True,
        lower=False,
        work=Work(threads=threads),
    )
    require_all(band)
    # without stick-slip the belt slides from the transition speed up, if anything moves it
    upper = np.where(band.columns["upper"] > 0, band.columns["upper"], band.columns["transition"])
    starts = ~band.columns["stalls"]  # a belt that is not started has no V*
    counted = upper[starts] if np.count_nonzero(starts) >= _COUNTED * drawing.draws else upper
    low, high = _middle(counted / law.transition_speed)
    return (min(low, _FARTHEST), min(high, _FARTHEST)), _middle(_holding(law, stick, drawn)), warned


def _holding(law: Drag, stick: FloatArray, drawn: Mapping[str, FloatArray]) -> FloatArray:
    """Starting force (N) of each draw; unless stated it varies as the drag at the stick speed."""
    rest = law.holding_force - law.breakaway_force
    if law.static_force is not None:
        return np.full(drawn["transition_force"].size, law.holding_force)
    nominal = law.transition_force * (law.stick_speed / law.transition_speed) ** (1.0 + law.mixed_exponent)
    power = 1.0 + drawn["mixed_exponent"]
    slow = drawn["transition_force"] * (stick / drawn["transition_speed"]) ** power
    return np.asarray(law.breakaway_force * slow / nominal + rest)


def _middle(values: FloatArray) -> tuple[float, float]:
    """The interval that leaves 2.5 % of the draws on either side."""
    low, high = np.quantile(values, [0.025, 0.975], method="inverted_cdf")
    return float(low), float(high)
