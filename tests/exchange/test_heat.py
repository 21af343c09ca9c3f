"""Heat of friction: powers, energies and ways of a unit against sums made here from its own samples."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.motion.drag import AnyDrag
from tests.exchange.instances import Instance, instance
from tests.exchange.test_against_core import CLOSURES, DRAG, TABLE, TRAIN, VERSIONS, WARM, mixed_drag

NAMES = (
    *("belt_speed", "spring_force", "stretch", "drag", "friction_power", "contact_power", "slip_power"),
    *("friction_energy", "contact_energy", "slip_energy", "belt_position", "drive_position"),
)
SPEED = 0.02


@contextmanager
def opened(tmp_path: Path, drag: AnyDrag, **settings: object) -> Iterator[Instance]:
    train = settings.pop("train", TRAIN)
    warm = {"temperature": 420.0} if drag.varies_with_temperature else {}
    given = {"drive_speed": SPEED, **warm, **settings}
    unit = hersey.export_fmu(tmp_path / "drive.fmu", train, drag, **given)  # type: ignore[arg-type]
    with instance(unit.path, events=settings.get("fmi") != "2.0") as found:
        yield found


def smooth_parts(found: Instance, until: float, step: float) -> list[dict[str, np.ndarray]]:
    """Samples at equal steps, cut where the mode changes: a list of stretches without a change in them."""
    references = [found.references[name] for name in NAMES]
    read = found.fmu.getReal if found.is_2 else found.fmu.getFloat64
    parts, rows = [], [[found.time, *read(references)]]
    while found.time < until - 1e-12:
        early = found.step(min(until, (round(found.time / step) + 1) * step))
        rows.append([found.time, *read(references)])
        if early:
            found.fmu.enterEventMode()
            found.handle()
            parts.append(np.array(rows))
            rows = [[found.time, *read(references)]]
    parts.append(np.array(rows))
    return [dict(zip(("time", *NAMES), part.T, strict=True)) for part in parts if len(part) > 1]


def summed(parts: list[dict[str, np.ndarray]], values: list[np.ndarray]) -> float:
    """Integral over all stretches, by cubic splines; the last sample of each is that after the change."""
    from scipy.interpolate import CubicSpline

    return sum(
        float(CubicSpline(part["time"][:-1], value[:-1]).integrate(part["time"][0], part["time"][-1]))
        if part["time"].size > 4
        else float(np.trapezoid(value, part["time"]))
        for part, value in zip(parts, values, strict=True)
    )


@pytest.mark.parametrize("kind", [*CLOSURES, "table", "mixed", "grip"])
def test_friction_power_is_what_the_drive_works_less_what_is_stored(kind: str, tmp_path: Path) -> None:
    """Over stick-slip, to 1e-6, from samples alone; the unit's own sum agrees with that."""
    drags: dict[str, AnyDrag] = {
        "table": TABLE,
        "mixed": mixed_drag(),
        "grip": replace(DRAG, rest_force=2.0, rest_damping=3.0),
    }
    drag = drags.get(kind) or replace(DRAG, rest_force=2.0, closure=kind, **CLOSURES[kind])
    law = drag.law_at(420.0 if drag.varies_with_temperature else None)
    train, speed, until = TRAIN, 0.8 * law.transition_speed, 0.3
    # near its release; of a smooth closure at rest, since it would give way faster than is sampled
    start = (0.0, 0.99 * (law.holding_force + drag.rest_force) / TRAIN.stiffness)
    if kind in ("stribeck", "lugre"):
        start, until = (0.0, 0.0), 0.6
    if kind == "grip":  # the roll slips until the belt is as fast
        train, speed, start = replace(TRAIN, grip=35.0), 0.3, (0.02, 0.0)
    with opened(tmp_path, drag, train=train, drive_speed=speed, start=start) as found:
        parts = smooth_parts(found, until, 5e-5)
    while parts[-1]["friction_power"][-1] <= 0:
        parts.pop()  # it would end while friction owes what it gave back
    last = {name: part[-1] for name, part in parts[-1].items()}
    work = summed(parts, [part["spring_force"] * speed for part in parts])
    springs = train.stiffness * (last["stretch"] ** 2 - start[1] ** 2)
    stored = 0.5 * (springs + train.mass * (last["belt_speed"] ** 2 - start[0] ** 2))
    heat = summed(parts, [part["friction_power"] for part in parts])
    slip = summed(parts, [part["slip_power"] for part in parts])
    assert len(parts) > 2
    assert heat > 0.05
    # a belt that stops dead gives up its speed at once, in no time: no power shows that
    speeds = [part["belt_speed"] for part in parts]
    stops = sum(one[-2] > 0 and then[0] == 0 for one, then in pairwise(speeds))
    at_once = stops * 0.5 * train.mass * law.stick_speed**2
    assert heat + slip + at_once == pytest.approx(work - stored, rel=1e-6)
    assert last["friction_energy"] == pytest.approx(heat + at_once, rel=1e-6)
    assert last["slip_energy"] == pytest.approx(slip, rel=1e-6, abs=1e-9)
    assert (last["slip_energy"] > 0) == (kind == "grip")


def test_heat_is_never_negative_and_what_is_given_back_is_set_off(tmp_path: Path) -> None:
    """The `retained` rule keeps a belt moving against a spring that pulls it back: friction gives."""
    with opened(tmp_path, DRAG, drive_speed=0.012) as found:
        parts = smooth_parts(found, 2.0, 1e-4)
    for name in ("friction_power", "contact_power"):
        assert min(part[name].min() for part in parts) >= 0
    taken = [part["drag"] * part["belt_speed"] for part in parts]
    assert min(value.min() for value in taken) < -1e-3
    energy = np.concatenate([part["friction_energy"] for part in parts])
    assert np.diff(energy).min() > -1e-12 * energy[-1]
    # at the end the debt is paid: what friction took is what the sum says
    assert parts[-1]["friction_power"][-1] > 0
    assert energy[-1] == pytest.approx(summed(parts, taken), rel=1e-6)


@pytest.mark.parametrize("fmi", VERSIONS)
def test_steady_sliding_heats_by_drag_times_speed(fmi: str, tmp_path: Path) -> None:
    """At 80 mm/s: drag of the law, of which the no-load torque heats no film."""
    drag = replace(DRAG, rest_force=6.0, rest_damping=4.0)
    with opened(tmp_path, drag, drive_speed=0.08, start="steady", fmi=fmi) as found:
        found.to(0.5)
        friction, contact, slip = found.get("friction_power", "contact_power", "slip_power")
        total, film, slipped = found.get("friction_energy", "contact_energy", "slip_energy")
        ways = found.get("belt_position", "drive_position")
    in_contact = 14.0 * (0.08 / 0.025) ** (1 - 0.7) * 0.08
    in_all = in_contact + (6.0 + 4.0 * 0.08) * 0.08
    assert [friction, contact, slip] == pytest.approx([in_all, in_contact, 0.0], rel=1e-9)
    assert [total, film, slipped] == pytest.approx([0.5 * in_all, 0.5 * in_contact, 0.0], rel=1e-9)
    assert ways == pytest.approx([0.04, 0.04], rel=1e-12)


def test_ways_add_up_through_jumps_ramps_and_slip(tmp_path: Path) -> None:
    """The drive goes 10 mm, then 15 mm by a ramp; the belt lags by stretch, and by what the roll slips."""
    drag, train = DRAG, replace(TRAIN, grip=35.0)
    with opened(tmp_path, drag, train=train, drive_speed=0.1, fmi="2.0") as found:
        found.to(0.1)
        found.set(drive_speed=0.1)
        found.fmu.setRealInputDerivatives([found.references["drive_speed"]], [1], [1.0])
        found.to(0.2)
        drive, belt, stretch, slip = found.get("drive_position", "belt_position", "stretch", "slip_energy")
    assert drive == pytest.approx(0.01 + 0.015, rel=1e-12)
    assert slip > 0
    # the roll slips at the force of its grip
    assert drive - belt - stretch == pytest.approx(slip / 35.0, rel=1e-9)


@pytest.mark.parametrize("closure", CLOSURES)
def test_heat_does_not_depend_on_the_size_of_the_step(closure: str, tmp_path: Path) -> None:
    drag = replace(DRAG, closure=closure, **CLOSURES[closure])
    unit = hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, drag, drive_speed=SPEED).path
    ends = []
    for count in (1, 7, 600):
        with instance(unit) as found:
            for time in np.linspace(0.0, 0.6, count + 1)[1:]:
                found.to(float(time))
            ends.append(found.get("friction_energy", "contact_energy", "belt_position"))
    assert ends[1:] == [pytest.approx(ends[0], rel=1e-7)] * 2


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_saved_state_takes_heat_and_ways_along(fmi: str, tmp_path: Path) -> None:
    drag = replace(WARM, closure="retained")
    unit = hersey.export_fmu(
        tmp_path / "drive.fmu",
        replace(TRAIN, grip=35.0),
        drag,
        drive_speed=0.3,
        temperature=420.0,
        fmi=fmi,
        start=(0.02, 0.0),
    ).path
    with instance(unit) as found:
        found.to(0.05)
        kept = found.serialized(found.states())
        before = found.get(*NAMES)
        found.to(0.6)
        end = found.get(*NAMES)
    with instance(unit) as other:
        other.restore(other.deserialized(kept))
        assert other.get(*NAMES) == before
        other.time = 0.05
        other.to(0.6)
        assert other.get(*NAMES) == end
    assert end[NAMES.index("friction_energy")] > before[NAMES.index("friction_energy")] > 0


def test_a_thermal_loop_closed_outside_follows_that_of_the_core(tmp_path: Path) -> None:
    """Two bodies, stepped here by the heat of each step, against temperature as a state of the motion."""
    from scipy.linalg import expm

    step, count = 0.005, 400
    heat = hersey.HeatBalance(
        film_capacity=0.5, roll_capacity=2.0, exchange=0.4, film_loss=0.05, roll_loss=0.1,
        surroundings=400.0, heater_power=2.0, film_temperature=400.0, roll_temperature=400.0,
    )  # fmt: skip
    drag = replace(WARM, closure="stiction")
    core = hersey.simulate(TRAIN, drag, drive_speed=0.3, temperature=heat, duration=step * count, samples=3)
    rates = np.array([[-0.45 / 0.5, 0.4 / 0.5], [0.4 / 2.0, -0.5 / 2.0]])
    decay = expm(rates * step)
    gain = np.linalg.solve(rates, decay - np.eye(2))
    warmer = np.zeros(2)  # over the surroundings
    with opened(tmp_path, drag, drive_speed=0.3, temperature=400.0, fmi="2.0") as found:
        energy = 0.0
        for i in range(count):
            found.set(temperature=400.0 + float(warmer[0]))
            found.to((i + 1) * step)
            (now,) = found.get("contact_energy")
            warmer = decay @ warmer + gain @ np.array([(2.0 + (now - energy) / step) / 0.5, 0.0])
            energy = now
    assert core.film_temperature is not None
    assert core.film_temperature[-1] > 405
    # explicit: each step takes the temperature of its beginning
    assert 400.0 + warmer[0] == pytest.approx(core.film_temperature[-1], abs=0.02)
