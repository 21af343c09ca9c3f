"""Random belts, each with one question, for the core in a page and the core in Python."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from hersey import Drag, _core
from hersey.arrays import FloatArray
from hersey.errors import HerseyError
from hersey.lubrication.mixed_drag import MixedDrag
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import AnyDrag, DragTable
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import simulate, stick_slip
from hersey.stability.hysteresis import hysteresis
from tests.lubrication.roll import MIXED, WARM

SAMPLES = 40
#: Smooth closures take a hundred times as long.
CLOSURES = ("retained",) * 10 + ("stiction",) * 7 + ("stribeck", "lugre")
QUESTIONS = ("motion",) * 4 + ("cycle",) * 3 + ("band", "edge", "forces")
#: What a question may take; some do not end within it, in a page as elsewhere.
MOST_STEPS = 10_000


@dataclass(frozen=True)
class Setting:
    """A belt, and a question about it."""

    question: str
    drag: AnyDrag
    temperature: float | None
    train: Drivetrain
    drive_speed: float
    start: str | list[float]
    rows: list[list[float]]
    duration: float

    def asked(self) -> dict[str, Any]:
        """What the page is asked."""
        own = vars(self) | {
            "drag": part(self.drag),
            "train": asdict(self.train),
            "speeds": self.speeds.tolist(),
        }
        return own | {"samples": SAMPLES, "most_steps": MOST_STEPS}

    @property
    def speeds(self) -> FloatArray:
        """Belt speeds at which drag is asked for."""
        return self.drag.law_at(self.temperature).transition_speed * np.geomspace(1e-3, 10.0, SAMPLES)

    @property
    def tolerance(self) -> float:
        """Relative difference that is rounding: of what is searched for to a tolerance, that."""
        if self.question in ("band", "edge"):
            return 1e-11
        if self.question == "cycle" and self.drag.closure in ("stribeck", "lugre"):
            return 1e-7
        # a belt whose static force grows may stick once in several laps, and the core closes those to this
        grows = isinstance(self.drag, Drag) and self.drag.static_growth > 0.0
        return 1e-9 if self.question == "cycle" and grows else 1e-12

    def answered(self) -> list[FloatArray] | str:
        """What the core answers here, each quantity for itself, or says against it."""
        try:
            return [np.atleast_1d(np.asarray(each, dtype=float)) for each in self._answered()]
        except HerseyError as error:
            return str(error)

    def _answered(self) -> list[Any]:
        if self.question == "motion":
            times, speeds = np.transpose(self.rows)
            run = simulate(
                self.train,
                self.drag,
                drive_speed=Schedule(times, speeds),
                temperature=self.temperature,
                duration=self.duration,
                samples=SAMPLES,
                start=self.start if isinstance(self.start, str) else (self.start[0], self.start[1]),
                most_steps=MOST_STEPS,
            )
            events = np.reshape([(e.time, e.stretch, e.belt_speed) for e in run.events], (-1, 3))
            return [run.belt_speed, run.spring_force, run.slipping, run.steps, *events.T]
        if self.question == "cycle":
            cycle = stick_slip(
                self.train,
                self.drag,
                drive_speed=self.drive_speed,
                temperature=self.temperature,
                start=str(self.start),
                most_steps=MOST_STEPS,
            )
            kind = _core.KINDS.index(cycle.kind)
            swings = [[cycle.speed_min, cycle.speed_max], [cycle.stretch_min, cycle.stretch_max]]
            durations = [cycle.slip_duration, cycle.stick_duration, cycle.grip_slip_duration]
            counts = [kind, cycle.laps_per_period]
            return [*swings, durations, cycle.frequency, cycle.drag_work, cycle.stuck_fraction, counts]
        if self.question == "forces":
            law = self.drag.law_at(self.temperature)
            return [law.holding_force, *law.force(self.speeds)]
        band = hysteresis(
            self.train, self.drag, temperature=self.temperature, sensitivity=False, most_steps=MOST_STEPS
        )
        if self.question == "band":
            return [band.lower, band.transition, band.upper, band.stalls]
        return [
            min(band.lower, band.transition),
            band.transition,
            max(band.upper, band.transition),
            band.stalls,
        ]


def part(drag: AnyDrag) -> dict[str, Any]:
    """The law as the page takes it, as the document has it where it does."""
    if not isinstance(drag, MixedDrag):
        return asdict(drag)  # type: ignore[call-overload, no-any-return]
    contact, oil = drag.contact, drag.contact.lubricant
    numbers = [float(number) for number in contact.numbers(np.asarray(drag.temperature))]
    own = {name: value for name, value in vars(drag).items() if name not in ("contact", "temperature")}
    return own | {
        "sharing": dict(zip(_core.SHARING, numbers, strict=True)),
        "viscosity": float(oil.viscosity(drag.temperature)),
        "viscosity_law": {"kind": oil.law.kind, **dict(oil.law.coefficients)},
        "reference_temperature": drag.temperature,
        "boundary_temperature_slope": float(contact.friction.slope / contact.friction.at(drag.temperature)),
    }


def settings(count: int, seed: int) -> list[Setting]:
    """So many random ones; drags that cannot be are left out."""
    random = np.random.default_rng(seed)
    found: list[Setting] = []
    while len(found) < count:
        try:
            found.append(_drawn(random))
        except HerseyError:
            continue
    return found


def _drawn(random: np.random.Generator) -> Setting:
    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    question, closure = str(random.choice(QUESTIONS)), str(random.choice(CLOSURES))
    if question in ("band", "edge") and closure != "stiction":
        closure = "retained"
    drag = _law(random, closure, question)
    temperature = None
    if isinstance(drag, MixedDrag):
        temperature = WARM + random.uniform(-20.0, 20.0)
    elif drag.varies_with_temperature:
        temperature = 273.15 + random.uniform(100.0, 220.0)
    law = drag.law_at(temperature)
    speed, mass = law.transition_speed, between(0.1, 50.0)
    impedance = law.transition_force / speed / between(0.05, 10.0)
    stiffness = impedance**2 / mass
    grip = between(1.02, 4.0) * law.holding_force if random.random() < 0.25 else None
    unit = float(np.sqrt(mass / stiffness))
    duration = unit * (10.0 if closure in ("stribeck", "lugre") else between(10.0, 100.0))
    drive = speed * between(0.3, 4.0)
    shares = np.sort(random.uniform(0.0, 0.8, random.integers(1, 5)))
    rows = [[duration * float(share), drive * between(0.5, 1.5)] for share in shares]
    train = Drivetrain(stiffness, mass, grip)
    start: str | list[float] = str(random.choice(["rest", "steady"]))
    if question == "motion" and start == "steady":
        # a motion that starts on a balance that none can keep is decided by the last bit
        start = [1.01 * drive, float(law.force(np.array([drive]))[0]) / stiffness]
    return Setting(question, drag, temperature, train, drive, start, rows, duration)


def _law(random: np.random.Generator, closure: str, question: str) -> AnyDrag:
    def between(low: float, high: float) -> float:
        return float(np.exp(random.uniform(np.log(low), np.log(high))))

    force, speed, shape = between(0.5, 100.0), between(1e-3, 1.0), random.random()
    stick = speed * between(1e-3, 0.2)
    near: dict[str, Any] = {"closure": closure}
    if closure == "lugre":
        near |= {"bristle_stiffness": 50.0 * force / stick, "bristle_damping": 0.2 * force / speed}
    if random.random() < 0.3:
        near["rest_force"] = force * between(0.1, 10.0)
    if shape < 0.1 and question in ("motion", "cycle", "forces") and closure != "lugre":
        return MixedDrag(MIXED, WARM, between(1e-4, 1e-3), **near)
    if random.random() < 0.1:
        near["rest_damping"] = 0.2 * force / speed * random.random()
    if shape < 0.25 and question != "edge":
        speeds = speed * np.array([0.05, 0.2, 0.5, 1.0, 2.0, 5.0])
        forces = force * np.array([between(2, 3), 1.7, between(1.2, 1.5), 1, 1.2, between(1.3, 2)])
        return DragTable(tuple(speeds), tuple(forces), 0.03 * speed, **near)
    mixed = random.uniform(-2.2, -1.05)
    if random.random() < 0.3:
        near["static_force"] = force * (stick / speed) ** (1 + mixed) * between(1.1, 4.0)
    if closure == "stiction" and random.random() < 0.3:
        near |= {"static_growth": between(0.01, 0.1), "static_growth_time": between(0.01, 1.0)}
    if random.random() < 0.6 or question == "edge":
        near |= {
            "reference_temperature": 273.15 + random.uniform(120.0, 200.0),
            "force_temperature_exponent": random.uniform(-1.0, 1.0),
            "speed_temperature_exponent": random.uniform(-1.0, 3.0),
            "temperature_zero": float(random.choice([0.0, 273.15])),
            "rest_temperature_slope": random.uniform(-1e-3, 1e-3),
        }
    return Drag(force, speed, random.uniform(-0.8, -0.2), mixed, stick, **near)
