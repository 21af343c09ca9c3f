"""A unit moves as the core does: at any step, through events, with inputs that change, saved and restored."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np
import pytest

import hersey
from hersey.arrays import FloatArray
from tests.exchange.instances import Instance, course, instance

TRAIN = hersey.Drivetrain(11_000.0, 11.0)
DRAG = hersey.Drag(14.0, 0.025, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=3e-4)
WARM = replace(
    DRAG,
    reference_temperature=405.0,
    temperature_zero=273.15,
    force_temperature_exponent=-0.3,
    speed_temperature_exponent=2.5,
    rest_force=6.0,
    rest_damping=4.0,
    rest_temperature_slope=-1e-3,
)
TABLE = hersey.DragTable((0.001, 0.01, 0.03, 0.1), (40.0, 20.0, 12.0, 17.0), stick_speed=5e-4)
CLOSURES = {
    "retained": {},
    "stiction": {"static_growth": 0.05, "static_growth_time": 0.01},
    "stribeck": {},
    "lugre": {"bristle_stiffness": 1e6, "bristle_damping": 1e3},
}
VERSIONS = ("3.0", "2.0")
#: Relative to the greatest value of a quantity.
AGREEMENT = 1e-9


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("units")


@cache
def mixed_drag() -> hersey.MixedDrag:
    machine = hersey.read_machine(Path(__file__).parents[2] / "examples" / "machine.toml")
    drag = machine.mixed_drag(423.15)
    assert isinstance(drag, hersey.MixedDrag)
    friction = replace(drag.contact.friction, slope=-2e-4, temperature=400.0)
    return replace(drag, contact=replace(drag.contact, friction=friction))


def far(ours: FloatArray, core: FloatArray) -> float:
    """Greatest difference, as a share of the greatest value."""
    return float(np.max(np.abs(ours - core)) / (np.max(np.abs(core)) or 1.0))


def settings() -> list[tuple[int, str, float]]:
    """Twenty drives by number, version and step: each step of 1e-4 to 0.1 s five times."""
    steps = (1e-4, 1e-3, 0.01, 0.1)
    return [(number, VERSIONS[number % 2], steps[number // 2 % 4]) for number in range(20)]


def drawn(number: int) -> tuple[hersey.Drivetrain, hersey.Drag | hersey.DragTable | hersey.MixedDrag]:
    """Drivetrain and drag of some kind: every closure, with and without temperature, table, mixed, grip."""
    rng = np.random.default_rng(number)
    train = hersey.Drivetrain(11_000.0 * rng.uniform(0.3, 3.0), 11.0 * rng.uniform(0.3, 3.0))
    if number == 18:
        return train, mixed_drag()
    if number == 19:
        return train, TABLE
    if number % 5 == 0:
        train = replace(train, grip=45.0)
    closure = tuple(CLOSURES)[number % 4]
    base = WARM if number % 3 == 0 else DRAG
    return train, replace(
        base,
        closure=closure,
        transition_force=14.0 * rng.uniform(0.5, 2.0),
        mixed_exponent=-rng.uniform(1.1, 1.6),
        **CLOSURES[closure],
    )


@pytest.mark.parametrize(("number", "fmi", "step"), settings())
def test_twenty_settings_at_steps_of_any_size(number: int, fmi: str, step: float, folder: Path) -> None:
    train, drag = drawn(number)
    temperature = 420.0 if drag.varies_with_temperature else None
    law = drag.law_at(temperature)
    speed = 1.2 * law.transition_speed * (0.5 if number % 2 else 1.0)
    duration = max(0.06, 6 * step) if step < 0.01 else 1.0
    count = round(duration / step)
    times = np.linspace(0.0, count * step, count + 1)
    # most of the time of a cycle the belt is held: begin where it is being released
    pull = min(0.98 * (train.grip or np.inf), 1.2 * law.holding_force)
    given = {"drive_speed": speed, "temperature": temperature}
    given["start"] = (0.8 * law.stick_speed, pull / train.stiffness)
    run = hersey.simulate(train, drag, duration=float(times[-1]), samples=count + 1, **given)
    unit = hersey.export_fmu(folder / f"{number}.fmu", train, drag, fmi=fmi, **given).path
    with instance(unit) as opened:
        got = course(opened, times, "belt_speed", "spring_force", "stretch", "mode", "slipping")
    assert run.events
    assert far(got[:, 0], run.belt_speed) < AGREEMENT
    assert far(got[:, 1], run.spring_force) < AGREEMENT
    assert far(got[:, 2], run.stretch) < AGREEMENT
    # a sample may fall on a change of mode to the last bit
    assert np.mean(got[:, 3] != run.mode_index) < 0.02
    assert np.mean(got[:, 4] != run.slipping) < 0.02


def steps(values: list[float], every: float) -> hersey.Schedule:
    """A quantity that jumps to the next value so often."""
    edges = np.arange(1, len(values)) * every
    times = [0.0, *np.repeat(edges, 2), len(values) * every]
    return hersey.Schedule(times, list(np.repeat(values, 2)))


@pytest.mark.parametrize("fmi", VERSIONS)
def test_inputs_jump_at_communication_points(fmi: str, folder: Path) -> None:
    """Drive and temperature change at some steps, with events between; the core knows of all before."""
    speeds = [0.3, 0.012, 0.5, 0.02, -0.1, 0.3, 0.0, 0.4]
    heats = [420.0, 420.0, 400.0, 390.0, 430.0, 430.0, 410.0, 420.0]
    every = 0.125
    unit = folder / f"jumps{fmi[0]}.fmu"
    hersey.export_fmu(unit, TRAIN, WARM, drive_speed=0.3, temperature=420.0, fmi=fmi)
    run = hersey.simulate(
        TRAIN,
        WARM,
        drive_speed=steps(speeds, every),
        temperature=steps(heats, every),
        duration=1.0,
        samples=8 * 25 + 1,
    )
    rows = []
    with instance(unit) as opened:
        rows.append(opened.get("belt_speed", "spring_force"))
        for number, (speed, heat) in enumerate(zip(speeds, heats, strict=True)):
            opened.set(drive_speed=speed, temperature=heat)
            for time in run.time[25 * number + 1 : 25 * number + 26]:
                opened.to(float(time))
                rows.append(opened.get("belt_speed", "spring_force"))
    got = np.array(rows)
    assert len(run.events) > 10
    assert far(got[:, 0], run.belt_speed) < AGREEMENT
    assert far(got[:, 1], run.spring_force) < AGREEMENT


def test_a_ramp_by_slopes_of_the_input(folder: Path) -> None:
    """FMI 2.0 gives an input its slope: the drive is then a straight line within the step."""
    unit = folder / "ramp.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG, fmi="2.0")
    times = np.linspace(0.0, 0.6, 7)
    speeds = 0.05 * times
    run = hersey.simulate(TRAIN, DRAG, drive_speed=hersey.Schedule(times, speeds), duration=0.6, samples=7)
    rows = []
    with instance(unit) as opened:
        for time, speed in zip(times[:-1], speeds[:-1], strict=True):
            opened.set(drive_speed=float(speed))
            opened.fmu.setRealInputDerivatives([opened.references["drive_speed"]], [1], [0.05])
            opened.to(float(time + 0.1))
            rows.append(opened.get("belt_speed", "spring_force"))
    got = np.array(rows)
    assert far(got[:, 0], run.belt_speed[1:]) < AGREEMENT
    assert far(got[:, 1], run.spring_force[1:]) < AGREEMENT


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_drive_by_torque(fmi: str, folder: Path) -> None:
    radius = 0.015
    torques = [2.0, 0.4, 2.5, -1.0]
    unit = folder / f"torque{fmi[0]}.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG, drive="torque", drive_torque=2.0, roll_radius=radius, fmi=fmi)
    forces = [torque / radius for torque in torques]
    run = hersey.simulate(TRAIN, DRAG, drive_torque=steps(forces, 0.1), duration=0.4, samples=41)
    rows = []
    with instance(unit) as opened:
        rows.append(opened.get("belt_speed", "spring_force"))
        for i, time in enumerate(run.time[1:]):
            opened.set(drive_torque=torques[i // 10])
            opened.to(float(time))
            rows.append(opened.get("belt_speed", "spring_force"))
    got = np.array(rows)
    assert run.events
    assert far(got[:, 0], run.belt_speed) < AGREEMENT
    assert far(got[:, 1], run.spring_force) < AGREEMENT


@pytest.mark.parametrize("closure", ["retained", "stiction"])
def test_event_mode_stops_at_every_change_of_mode(closure: str, folder: Path) -> None:
    drag = replace(DRAG, closure=closure)
    unit = folder / f"events-{closure}.fmu"
    hersey.export_fmu(unit, TRAIN, drag, drive_speed=0.03)
    run = hersey.simulate(TRAIN, drag, drive_speed=0.03, duration=0.5, samples=6)
    rows, times = [], []
    with instance(unit, events=True) as opened:
        for time in run.time[1:]:
            times += opened.to(float(time))
            rows.append(opened.get("belt_speed", "spring_force"))
    got = np.array(rows)
    assert len(times) == len(run.events) > 4
    assert np.abs(np.array(times) - [event.time for event in run.events]).max() < 1e-12
    assert far(got[:, 0], run.belt_speed[1:]) < AGREEMENT
    assert far(got[:, 1], run.spring_force[1:]) < AGREEMENT


def test_outputs_at_an_event_are_those_of_the_new_mode(folder: Path) -> None:
    unit = folder / "modes.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG, drive_speed=0.03)
    run = hersey.simulate(TRAIN, DRAG, drive_speed=0.03, duration=0.3, samples=2)
    names = ("ehl", "mixed", "microslip", "stuck")
    with instance(unit, events=True) as opened:
        for event in run.events:
            assert opened.get("mode")[0] == names.index(event.from_mode)
            assert opened.step(0.3)
            opened.fmu.enterEventMode()
            opened.handle()
            speed, stretch, mode, stuck = opened.get("belt_speed", "stretch", "mode", "stuck")
            assert mode == names.index(event.to_mode)
            assert stuck == (event.to_mode == "stuck")
            assert speed == pytest.approx(event.belt_speed, abs=1e-12)
            assert stretch == pytest.approx(event.stretch, abs=1e-12)


def test_fmpys_own_simulation_with_events(folder: Path) -> None:
    """FMPy's loop, not ours: input from a table, event mode, early return."""
    unit = folder / "fmpy.fmu"
    hersey.export_fmu(unit, TRAIN, WARM, temperature=420.0)
    signals = np.array(
        [(0.0, 0.03, 420.0), (0.2, 0.03, 420.0), (0.2, 0.05, 400.0), (0.5, 0.05, 400.0)],
        dtype=[("time", float), ("drive_speed", float), ("temperature", float)],
    )
    got = fmpy.simulate_fmu(
        str(unit),
        stop_time=0.5,
        output_interval=0.02,
        input=signals,
        use_event_mode=True,
        early_return_allowed=True,
        output=["belt_speed", "spring_force"],
    )
    run = hersey.simulate(
        TRAIN,
        WARM,
        drive_speed=hersey.Schedule([0.0, 0.2, 0.2, 0.5], [0.03, 0.03, 0.05, 0.05]),
        temperature=hersey.Schedule([0.0, 0.2, 0.2, 0.5], [420.0, 420.0, 400.0, 400.0]),
        duration=0.5,
        samples=26,
    )
    assert got.size > 26 + len(run.events)
    last = {
        round(row["time"] / 0.02): row
        for row in got
        if abs(row["time"] / 0.02 - round(row["time"] / 0.02)) < 1e-9
    }
    assert sorted(last) == list(range(26))
    ours = np.array([[last[i][name] for name in ("belt_speed", "spring_force")] for i in range(26)])
    assert far(ours[:, 0], run.belt_speed) < AGREEMENT
    assert far(ours[:, 1], run.spring_force) < AGREEMENT


def test_the_size_of_the_step_moves_no_bit(folder: Path) -> None:
    unit = folder / "bits.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG, drive_speed=0.03)
    ends = []
    for count, events in ((1, False), (1, True), (7, False), (3_000, False)):
        with instance(unit, events=events) as opened:
            for time in np.linspace(0.0, 0.6, count + 1)[1:]:
                opened.to(float(time))
            ends.append(opened.get("belt_speed", "spring_force", "drag"))
    assert ends == [ends[0]] * 4


@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize("closure", CLOSURES)
def test_saved_and_restored_to_the_bit(fmi: str, closure: str, folder: Path) -> None:
    """From a state saved while it moves, again and by another instance, after inputs have changed."""
    drag = replace(WARM, closure=closure, **CLOSURES[closure])
    unit = folder / f"saved-{closure}{fmi[0]}.fmu"
    hersey.export_fmu(unit, TRAIN, drag, drive_speed=0.03, temperature=420.0, fmi=fmi)
    times = np.linspace(0.2371, 0.45, 12)
    names = ("belt_speed", "spring_force", "drag", "stretch", "mode", "stuck", "slipping", "drive_speed")
    with instance(unit) as opened:
        opened.to(0.1)
        opened.set(drive_speed=0.05, temperature=410.0)
        opened.to(float(times[0]))
        state = opened.states()
        kept = opened.serialized(state)
        first = course(opened, times, *names)
        opened.set(drive_speed=0.0)
        opened.to(0.6)
        opened.restore(state)
        opened.time = float(times[0])
        again = course(opened, times, *names)
    with instance(unit) as other:
        other.restore(other.deserialized(kept))
        other.time = float(times[0])
        afresh = course(other, times, *names)
    assert np.ptp(first[:, 0]) > 0
    assert np.array_equal(first, again)
    assert np.array_equal(first, afresh)


def test_a_broken_saved_state_is_refused(folder: Path) -> None:
    one, other = folder / "one.fmu", folder / "other.fmu"
    hersey.export_fmu(one, TRAIN, DRAG, drive_speed=0.03)
    hersey.export_fmu(other, TRAIN, replace(DRAG, transition_force=15.0), drive_speed=0.03)
    with instance(one) as opened:
        opened.to(0.2)
        kept = opened.serialized(opened.states())
    with instance(other) as opened:
        for wrong in (kept, kept[:-3], b"", bytes(len(kept))):
            with pytest.raises(fmpy.fmi1.FMICallException):
                opened.restore(opened.deserialized(wrong))
        opened.to(0.01)  # and it is as it was


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_parameter_is_changed_before_the_start(fmi: str, folder: Path) -> None:
    unit = folder / f"tuned{fmi[0]}.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG, fmi=fmi)
    run = hersey.simulate(
        replace(TRAIN, stiffness=20_000.0),
        replace(DRAG, transition_force=20.0),
        drive_speed=0.02,
        duration=0.4,
        samples=5,
    )
    with instance(
        unit, start={"stiffness": 20_000.0, "transition_force": 20.0, "drive_speed": 0.02}
    ) as opened:
        got = course(opened, run.time, "belt_speed", "spring_force")
        with pytest.raises(fmpy.fmi1.FMICallException):
            opened.set(stiffness=1.0)
    assert far(got[:, 0], run.belt_speed) < AGREEMENT
    assert far(got[:, 1], run.spring_force) < AGREEMENT


@pytest.mark.parametrize("fmi", VERSIONS)
def test_it_starts_steady_with_the_drive_as_it_is_then(fmi: str, folder: Path) -> None:
    unit = folder / f"steady{fmi[0]}.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG, drive_speed=0.05, start="steady", fmi=fmi)
    with instance(unit, start={"drive_speed": 0.08}) as opened:
        opened.to(0.1)
        speed, force = opened.get("belt_speed", "spring_force")
    assert speed == pytest.approx(0.08, rel=1e-9)
    assert force == pytest.approx(float(DRAG.force(0.08)), rel=1e-9)


def test_a_thousand_instances_in_one_process(folder: Path) -> None:
    """They are stepped in turn, and none knows of the others."""
    unit = folder / "many.fmu"
    hersey.export_fmu(unit, TRAIN, DRAG)
    speeds = np.linspace(0.01, 0.06, 1_000)
    with TemporaryDirectory() as home:
        fmpy.extract(str(unit), home)
        opened = Instance(home, initialize=False)
        made = [opened.fmu.component]
        for _ in speeds[1:]:
            opened.fmu.instantiate()
            opened.fmu.enterInitializationMode()
            made.append(opened.fmu.component)
        ends = np.zeros((speeds.size, 2))
        for component, speed in zip(made, speeds, strict=True):
            opened.fmu.component = component
            opened.set(drive_speed=float(speed))
            opened.initialize()
        for time in (0.1, 0.2, 0.3):
            for i, component in enumerate(made):
                opened.fmu.component, opened.time = component, time - 0.1
                opened.step(time)
                ends[i] = opened.get("belt_speed", "spring_force")
        for component in made:
            opened.fmu.fmi3FreeInstance(component)
        opened.fmu.freeLibrary()
    for i in range(0, 1_000, 111):
        run = hersey.simulate(TRAIN, DRAG, drive_speed=float(speeds[i]), duration=0.3, samples=2)
        assert ends[i, 0] == pytest.approx(run.belt_speed[-1], rel=AGREEMENT, abs=1e-12)
        assert ends[i, 1] == pytest.approx(run.spring_force[-1], rel=AGREEMENT, abs=1e-9)
    assert np.unique(ends[:, 1]).size > 900
