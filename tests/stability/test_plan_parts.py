"""Parts of a plan by hand: profiles, courses, trials, draws, limits, the grid and what a plan says."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.charts.plan import plan_chart
from hersey.errors import ParameterError
from hersey.machine.limits import Limits
from hersey.machine.uncertainty import Uncertainty
from hersey.motion.schedule import Schedule
from hersey.motion.simulation import simulate
from hersey.stability.plan import Plan
from hersey.stability.plan.draws import Trials, drawn, lower_bound, most_failures, needed, neighbours
from hersey.stability.plan.grid import Room
from hersey.stability.plan.obstacles import Reach, _obstacle, speed_text
from hersey.stability.plan.proof import Unknown
from hersey.stability.plan.search import Search
from hersey.stability.plan.trial import (
    FINE,
    Follow,
    MachineSample,
    Shape,
    TemperatureProfile,
    outcomes,
    rounded,
)
from tests.machines import machine_of

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
WARM = replace(
    DRAG, reference_temperature=400.0, force_temperature_exponent=-2.0, speed_temperature_exponent=0.5
)
COLDER = replace(WARM, speed_temperature_exponent=4.0)
LAP = 2 * math.pi / math.sqrt(1000)


def test_durations_have_the_digits_of_a_table() -> None:
    assert rounded(1.23456789) == 1.23457
    assert rounded(1.23456111) == 1.23456
    assert rounded(1.23456111, up=True) == 1.23457
    assert rounded(1.23456, up=True) == 1.23456
    assert rounded(123456.7) == 123457.0
    assert rounded(0.000123456789, up=True) == 0.000123457
    assert (rounded(0.0), rounded(-1.0, up=True)) == (0.0, 0.0)


def test_a_shape_by_hand() -> None:
    shape = Shape(1.0, 3.0, 0.5, 0.25, 0.8, 2.0)
    assert (shape.ramps, shape.end) == (pytest.approx(1.55), pytest.approx(3.55))
    assert shape.acceleration == pytest.approx(6.0)
    assert Shape(1.0, 3.0, 1.0, 0.0, 0.25).acceleration == pytest.approx(8.0)
    assert Shape(1.0, 3.0, 0.0, 0.0, 0.25).acceleration == math.inf
    assert shape.points() == ([0.0, 2.0, 2.5, 2.75, 3.55], [0.0, 0.0, 3.0, 3.0, 1.0])
    assert shape.points(waited=False) == ([0.0, 0.5, 0.75, 1.55], [0.0, 3.0, 3.0, 1.0])
    jump = Shape(1.0, 1.0, 0.0, 5.0, 7.0)
    assert (jump.hold, jump.fall, jump.points()) == (0.0, 0.0, ([0.0, 0.0], [0.0, 1.0]))
    assert Shape(1.0, 0.5, 0.1).peak == 1.0
    steep = Shape(1.0, 2.0, 0.12345611, 0.12345611, 0.12345611, 0.12345611)
    assert (steep.rise, steep.hold, steep.fall, steep.wait) == (0.123457, 0.123456, 0.123457, 0.123457)
    assert np.asarray(shape.schedule().times).tolist() == shape.points()[0]


def test_a_course_by_hand() -> None:
    course = TemperatureProfile(Schedule([-5.0, 5.0, 10.0, 20.0], [300.0, 320.0, 310.0, 350.0]))
    assert course.end == 20.0
    assert course.levels == ((0.0, 310.0), (5.0, 320.0), (10.0, 310.0), (20.0, 350.0))
    assert course.at(7.5) == 315.0
    assert course.after(7.5) == [315.0, 310.0, 350.0]
    assert course.after(15.0) == [330.0, 350.0, 350.0]
    assert course.after(20.0) == [350.0]
    assert course.after(1.0) == [312.0, 310.0, 350.0]
    moved = course.from_time(4.0)
    assert moved is not None
    assert (moved.at(0.0), moved.at(1.0)) == (course.at(4.0), course.at(5.0))
    assert course.arguments(4.0, 273.0) == ([-9.0, 1.0, 6.0, 16.0], [27.0, 47.0, 37.0, 77.0], None)
    assert course.arguments(4.0, 0.0) == ([-9.0, 1.0, 6.0, 16.0], [300.0, 320.0, 310.0, 350.0], None)
    none = TemperatureProfile(None)
    assert (none.end, none.levels, none.at(3.0), none.after(1.0), none.arguments(1.0, 0.0)) == (
        0.0,
        (),
        None,
        [None],
        None,
    )
    assert TemperatureProfile(330.0).after(3.0) == [330.0]


def test_a_trial_is_the_motion() -> None:
    machine = MachineSample(TRAIN, DRAG)
    assert machine.lap == pytest.approx(LAP, rel=1e-12)
    shape = Shape(1.9, 3.0, 0.3, 0.4, 0.5)
    found = machine.trial(shape, TemperatureProfile(None), force=True)
    run = simulate(TRAIN, DRAG, drive_speed=shape.schedule(), duration=4.0, samples=80_001, tolerance=1e-11)
    released = [e.time for e in run.events if e.from_mode in ("stuck", "microslip")][-1]
    assert found.why == ""
    assert found.ready == pytest.approx(max(released, 1.2), rel=1e-6)
    assert found.peak_force == pytest.approx(np.abs(run.spring_force).max(), rel=1e-7)
    waited = machine.trial(replace(shape, wait=2.0), TemperatureProfile(None))
    assert waited.ready == pytest.approx(found.ready + 2.0, rel=1e-9)
    assert math.isnan(waited.peak_force)
    late = machine.trial(Shape(3.0, 3.0, 0.0), TemperatureProfile(None))
    steep = simulate(TRAIN, DRAG, drive_speed=3.0, duration=2.0, samples=3)
    assert late.ready == pytest.approx(
        [e.time for e in steep.events if e.from_mode in ("stuck", "microslip")][-1], rel=1e-6
    )


@pytest.mark.parametrize(("closure", "target"), [("retained", 1.9), ("stiction", 5.0)])
def test_a_trial_that_ends_early_ends_as_the_motion_does(closure: str, target: float) -> None:
    """What is ready, and when, is that of the motion followed for 40 laps; so are its ends."""
    drag = replace(DRAG, closure=closure)
    machine, course = MachineSample(TRAIN, drag), TemperatureProfile(None)
    rng = np.random.default_rng(4)
    kinds = set()
    for peak, rise, hold, fall in zip(
        rng.uniform(target, 2 * target, 12), *rng.uniform(0.02, 1.0, (3, 12)), strict=True
    ):
        shape = Shape(target, peak, rise, hold, fall)
        found = machine.trial(shape, course)
        run = simulate(TRAIN, drag, drive_speed=shape.schedule(), duration=shape.end + 40 * LAP, samples=2)
        released = [e.time for e in run.events if e.from_mode in ("stuck", "microslip")][-1]
        slides = released < shape.end + 30 * LAP
        assert (found.ready < math.inf) == slides
        if slides:
            assert found.ready == pytest.approx(max(released, shape.ramps), rel=1e-6)
            [late] = outcomes([machine], [shape], course, how=Follow(latest=found.ready))
            [soon] = outcomes([machine], [shape], course, how=Follow(latest=found.ready * 1.0001))
            assert (late.ready, soon.ready) == (math.inf, found.ready) or released <= shape.ramps
        kinds.add(slides)
    assert kinds == {True, False}


def test_the_number_of_threads_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    unknown = Unknown(TRAIN, DRAG, {"mass": Uncertainty(share=0.5)}, {}, 3)
    machines, shape = unknown.draws(1, 600), Shape(1.9, 2.8, 0.3, 0.3, 0.25)
    found = []
    for threads in (1, 3):
        monkeypatch.setattr("hersey.stability.plan.trial._THREADS", threads)
        for allowed in (9, 500):
            rows = outcomes(machines, [shape], TemperatureProfile(None), allowed=allowed)
            found.append([(row.ready, row.why) for row in rows])
    assert found[:2] == found[2:]
    assert 9 < sum(ready == math.inf for ready, _ in found[0]) < len(found[0]) < len(found[1]) == 600


def test_why_a_trial_fails() -> None:
    machine, straight = MachineSample(TRAIN, DRAG), Shape(1.9, 1.9, 0.5)
    sticks = machine.trial(straight, TemperatureProfile(None))
    assert (sticks.ready, sticks.why) == (math.inf, "stick-slip")
    over = Shape(1.9, 3.0, 0.3, 0.4, 0.5)
    peak = machine.trial(over, TemperatureProfile(None), force=True).peak_force
    broken = machine.trial(over, TemperatureProfile(None), 0.999 * peak, force=True)
    assert (broken.ready, broken.why) == (math.inf, "force")
    assert broken.peak_force == pytest.approx(0.999 * peak)
    assert machine.trial(over, TemperatureProfile(None), 1.001 * peak).why == ""


def test_what_comes_after_a_profile_counts() -> None:
    """A course that peaks later: the transition speed then passes the target, or the drag the limit."""
    later = TemperatureProfile(Schedule([0.0, 10.0, 20.0, 30.0], [400.0, 400.0, 520.0, 400.0]))
    held = TemperatureProfile(400.0)
    up = Shape(2.5, 2.5, 0.5)
    machine = MachineSample(TRAIN, COLDER)
    assert machine.trial(up, held).why == ""
    assert COLDER.at(520.0).transition_speed > 2.5
    refused = machine.trial(up, later)
    assert (refused.ready, refused.why) == (math.inf, "transition speed")
    cools = TemperatureProfile(Schedule([0.0, 10.0, 20.0], [400.0, 400.0, 250.0]))
    stiff = MachineSample(
        TRAIN, replace(WARM, force_temperature_exponent=-6.0, speed_temperature_exponent=0.0)
    )
    peak = stiff.trial(up, held, force=True).peak_force
    cold = float(stiff.drag.force(2.5, temperature=250.0))
    assert cold > 1.5 * peak
    assert stiff.trial(up, cools, force=True).peak_force == pytest.approx(cold, rel=1e-9)
    assert stiff.trial(up, cools, 0.99 * cold).why == "force"
    assert stiff.trial(up, cools, 1.01 * cold).why == ""
    assert stiff.at(250.0, 2.5) == pytest.approx((1.0, cold))


def test_draws_of_machines() -> None:
    uncertainties = {"mass": Uncertainty(share=0.2), "stick_speed": Uncertainty(limits=(0.005, 0.02))}
    samples = {
        "transition_force": [40.0, 60.0, 70.0],
        "transition_speed": [0.9, 1.1, 1.2],
        "mass": [1.0, 2.0, 3.0],
    }
    machines, _ = drawn(TRAIN, DRAG, uncertainties, samples, np.random.default_rng(4), 30)
    rng = np.random.default_rng(4)
    stick = uncertainties["stick_speed"].draw(rng, 0.01, 30)  # mass is among the samples, which hold
    picked = rng.integers(0, 3, 30)
    for i, machine in enumerate(machines):
        drag: Any = machine.drag
        assert drag.stick_speed == stick[i]
        assert drag.transition_force == samples["transition_force"][picked[i]]
        assert drag.transition_speed == samples["transition_speed"][picked[i]]
        assert machine.train == replace(TRAIN, mass=samples["mass"][picked[i]])
        assert drag.ehl_exponent == -0.7


def test_draws_that_are_no_belt_are_left_out_and_counted() -> None:
    """Stick speeds above the transition speed of 1: half of a range, a third, nearly all."""
    spread = {"stick_speed": Uncertainty(limits=(0.1, 10.0))}
    machines, none = drawn(TRAIN, DRAG, spread, {}, np.random.default_rng(4), 400)
    assert len(machines) == 400
    assert none == pytest.approx(0.5, abs=0.05)
    stick = [machine.drag.law_at(None).stick_speed for machine in machines]
    assert max(stick) < 1.0
    assert np.mean(np.array(stick) < 0.1**0.5) == pytest.approx(0.5, abs=0.08)
    lower = {"stick_speed": Uncertainty(limits=(0.05, 5.0))}
    _, none = drawn(TRAIN, DRAG, lower, {}, np.random.default_rng(4), 400)
    assert none == pytest.approx(math.log(5) / math.log(100), abs=0.05)
    with pytest.raises(ParameterError, match=r"almost no draw is possible. Give a smaller range"):
        drawn(
            TRAIN, DRAG, {"stick_speed": Uncertainty(limits=(0.9, 90.0))}, {}, np.random.default_rng(4), 400
        )
    with pytest.raises(ParameterError, match="uncertainty: a draw is impossible"):
        drawn(TRAIN, DRAG, {"mass": Uncertainty(limits=(-2.0, -1.0))}, {}, np.random.default_rng(4), 4)


def test_neighbours_differ_in_one_number_by_a_thousandth() -> None:
    first, *others = neighbours(TRAIN, DRAG)
    assert (first.train, first.drag) == (TRAIN, DRAG)
    own = {**vars(TRAIN), **vars(DRAG)}
    seen = []
    for machine in others:
        changed = {k: v for k, v in {**vars(machine.train), **vars(machine.drag)}.items() if v != own[k]}
        ((name, value),) = changed.items()
        seen.append((name, round(value / own[name] - 1, 9)))
    names = [
        "stiffness",
        "mass",
        "transition_force",
        "transition_speed",
        "ehl_exponent",
        "mixed_exponent",
        "stick_speed",
    ]
    assert sorted(seen) == sorted((name, by) for name in names for by in (-1e-3, 1e-3))
    beside = neighbours(TRAIN, replace(DRAG, static_force=400.0, rest_force=5.0))
    assert len(beside) == 2 * (len(names) + 2) + 1
    assert {vars(machine.drag)["rest_force"] for machine in beside} == {5.0, 5.0 * 0.999, 5.0 * 1.001}


def test_streams_of_draws_follow_seed_and_number() -> None:
    def masses(seed: int, stream: int) -> list[float]:
        unknown = Unknown(TRAIN, DRAG, {"mass": Uncertainty(share=0.2)}, {}, seed)
        return [machine.train.mass for machine in unknown.draws(stream, 5)]

    assert masses(1, 0) == masses(1, 0)
    rng = np.random.default_rng([1, 2])
    assert masses(1, 2) == Uncertainty(share=0.2).draw(rng, 1.0, 5).tolist()
    assert len({tuple(masses(seed, stream)) for seed in (1, 2) for stream in (0, 1)}) == 4
    known = Unknown(TRAIN, DRAG, {}, {}, 1)
    assert len(known.draws(0, 50)) == 1
    assert len(known.trials(0.95, TemperatureProfile(None), math.inf).machines) == 15


def test_how_many_draws_and_failures() -> None:
    for confidence, allowed in ((0.9, 2), (0.95, 2), (0.995, 0)):
        unknown = Unknown(TRAIN, DRAG, {"mass": Uncertainty(share=0.2)}, {}, 1)
        trials = unknown.trials(confidence, TemperatureProfile(None), math.inf)
        assert trials.allowed == allowed
        assert len(trials.machines) == needed(confidence, 0.999, allowed)
    assert needed(0.95, 0.999, 0) == math.ceil(math.log(0.001) / math.log(0.95))
    assert most_failures(0.95, 0.999, needed(0.95, 0.999, 4)) == 4
    assert lower_bound(50, 50, 0.95) == pytest.approx(0.05 ** (1 / 50), rel=1e-9)
    assert lower_bound(0, 50, 0.95) == 0.0


def test_a_proof_counts_its_failures() -> None:
    """A profile that half of the belts fail: share, bound, reasons and force, from the draws themselves."""
    unknown = Unknown(TRAIN, DRAG, {"mass": Uncertainty(share=0.5)}, {}, 3)
    shape, course = Shape(1.9, 2.8, 0.3, 0.3, 0.25), TemperatureProfile(None)
    proof = unknown.verify(shape, 1.2, course, math.inf, 0.8, 2)
    machines = unknown.draws(2, 1500)
    assert proof.draws == 1500
    found = [m.trial(shape, course, force=True, tolerance=1e-11) for m in machines[:200]]
    late = [o for o in found if o.ready > 1.2]
    assert 20 < len(late) < 180
    assert proof.share == pytest.approx(1 - len(late) / 200, abs=0.1)
    assert sum(proof.failures.values()) == round(1500 * (1 - proof.share))
    assert set(proof.failures) <= {"stick-slip", "sticks longer"}
    assert proof.share_low == pytest.approx(lower_bound(round(1500 * proof.share), 1500, 0.95))
    assert proof.accepted == (lower_bound(round(1500 * proof.share), 1500, 0.999) >= 0.8)
    forces = sorted(o.peak_force for o in found)
    assert forces[140] < proof.peak_force < forces[-1] * 1.2
    alone = Unknown(TRAIN, DRAG, {}, {}, 3).verify(
        Shape(1.9, 3.0, 0.3, 0.4, 0.5), 1.25, course, math.inf, 0.8, 1
    )
    assert (alone.draws, alone.share, alone.share_low, alone.accepted) == (1, 1.0, 1.0, True)
    assert Unknown(TRAIN, DRAG, {}, {}, 3).verify(shape, 0.1, course, math.inf, 0.8, 1).accepted is False


def test_a_high_confidence_takes_more_fresh_draws() -> None:
    unknown = Unknown(TRAIN, DRAG, {"mass": Uncertainty(share=0.5)}, {}, 3)
    proof = unknown.verify(Shape(1.9, 1.9, 0.3), 1.2, TemperatureProfile(None), math.inf, 0.995, 1)
    assert (proof.draws, proof.share, proof.share_low) == (2000, 0.0, 0.0)
    assert dict(proof.failures) == {"stick-slip": 2000}
    assert not proof.accepted


def test_trials_let_so_many_fail() -> None:
    masses = [1.0, 1.05, 0.95, 4.0]
    shape, course = Shape(1.9, 3.0, 0.3, 0.4, 0.5), TemperatureProfile(None)
    machines = [MachineSample(replace(TRAIN, mass=m), DRAG) for m in masses]
    ready = [m.trial(shape, course).ready for m in machines]
    for allowed in (0, 1, 2):
        trials = Trials(machines, allowed, course, math.inf)
        expected = sorted(ready)[len(ready) - 1 - allowed]
        assert trials.time(shape, tolerance=FINE) == expected
        peaks = [m.trial(shape, course, force=True) for m in machines]
        forces = sorted(p.peak_force if p.ready < math.inf else math.inf for p in peaks)
        assert trials.peak(shape) == forces[3 - allowed]
        assert trials.kept([4.0, 1.0, 3.0, 2.0]) == 4.0 - allowed
    strict = Trials(machines, 0, course, math.inf)
    worst = ready.index(max(ready))
    assert strict.time(shape, best=max(ready)) == math.inf
    assert strict.machines[0] is machines[worst]
    assert sorted(map(id, strict.machines)) == sorted(map(id, machines))


def test_reach_of_a_drive() -> None:
    limits = Limits(speed=4.0, acceleration=9.0, spring_force=150.0, motor_torque=2.0)
    reach = Reach.of(limits, 0.02)
    assert (reach.speed, reach.acceleration, reach.force) == (4.0, 9.0, 100.0)
    shape = Shape(1.0, 3.0, 0.5, 0.0, 0.4)
    assert reach.uses(shape, 80.0) == [
        ("speed", 4.0, 3.0),
        ("acceleration", 9.0, 6.0),
        ("spring_force", 150.0, 80.0),
        ("motor_torque", pytest.approx(2.0), pytest.approx(1.6)),
    ]
    assert reach.broken == "the motor torque is not sufficient"
    gripped = replace(limits, roll_friction=0.6, nip_load=100.0)
    assert (Reach.of(gripped, 0.02).force, Reach.of(gripped, 0.02, 50.0).force) == (pytest.approx(60.0), 50.0)
    assert Reach.of(gripped, 0.02).broken == "the drive slips"
    assert _obstacle("motor_torque", 2.0, 5.3821, held=True).text == (
        "The motor torque of 2 N m cannot start it; 5.39 N m is needed."
    )
    assert _obstacle("grip", 180.0, 434.0).text == "The grip is limited to 180 N, but 434 N would be enough."
    free = Reach.of(Limits(), None)
    assert (free.speed, free.acceleration, free.force, free.uses(shape, 80.0)) == (
        math.inf,
        math.inf,
        math.inf,
        [],
    )
    assert (speed_text(0.0254), speed_text(1.5)) == ("25.4 mm/s", "1.5 m/s")


def search_of(
    course: TemperatureProfile, drag: hersey.Drag = DRAG, room: Room | None = None, *, seed: int = 1
) -> Search:
    nominal = MachineSample(TRAIN, drag)
    return Search(
        nominal, Trials([nominal], 0, course, math.inf), course, 1.9, room or Room(4.0, 10.0), seed=seed
    )


def test_the_room_makes_ramps_as_long_as_they_must_be() -> None:
    room = Room(4.0, 10.0)
    shape = room.shape(1.9, 3.0, 0.1, 0.2, 0.05, 1.5)
    assert (shape.peak, shape.rise, shape.hold, shape.fall, shape.wait) == pytest.approx(
        (3.0, 0.4, 0.2, 0.16, 1.5)
    )
    assert room.allows(Shape(1.9, 4.0, 0.4, 0.0, 0.21))
    assert not room.allows(Shape(1.9, 4.0, 0.399, 0.0, 0.21))
    assert not room.allows(Shape(1.9, 4.0, 0.4, 0.0, 0.2))
    assert not room.allows(Shape(1.9, 4.01, 0.5, 0.0, 0.3))
    assert Room(4.0, math.inf).allows(Shape(1.9, 4.0, 0.0))


def test_the_grid_is_quickest_first_and_within_the_room() -> None:
    search = search_of(TemperatureProfile(None))
    grid = search.grid()
    ends = [shape.end for shape in grid]
    assert ends == sorted(ends)
    assert all(search.room.allows(shape) and shape.wait == 0.0 for shape in grid)
    peaks = sorted({shape.peak for shape in grid})
    np.testing.assert_allclose(peaks, [1.9, *(1.9 + 0.21 * k for k in range(1, 11))], rtol=1e-6)
    direct = sorted({round(shape.rise - 0.19, 6) for shape in grid if shape.peak == 1.9})
    assert direct[:4] == pytest.approx([0.0, 0.1 * LAP, 0.2 * LAP, 0.25 * LAP], abs=1e-5)
    longer = max(shape.rise - shape.peak / 10.0 for shape in search.grid(6.0))
    assert longer == pytest.approx(48 * LAP, rel=1e-4)
    narrow = search_of(TemperatureProfile(None), room=Room(1.9, 10.0)).grid()
    assert {shape.peak for shape in narrow} == {1.9}


def test_waits_are_where_the_temperature_has_moved_by_equal_shares() -> None:
    assert search_of(TemperatureProfile(None)).waits() == [0.0]
    assert search_of(TemperatureProfile(Schedule([0.0, 9.0], [400.0, 400.0]))).waits() == [0.0]
    waits = search_of(TemperatureProfile(Schedule([0.0, 10.0, 20.0], [300.0, 310.0, 340.0]))).waits()
    assert (waits[0], waits[-1]) == (0.0, 20.0)
    moved = [np.interp(w, [0, 10, 20], [0, 10, 40]) for w in waits]
    np.testing.assert_allclose(moved, np.linspace(0, 40, 24), atol=0.1)


def test_an_attempt_counts_only_if_it_is_quicker() -> None:
    search = search_of(TemperatureProfile(None))
    slow, quick = Shape(1.9, 3.0, 0.4, 1.5, 0.5), Shape(1.9, 3.0, 0.4, 0.4, 0.5)
    assert search.attempt(slow) == pytest.approx(
        MachineSample(TRAIN, DRAG).trial(slow, TemperatureProfile(None)).ready
    )
    assert search.best == slow
    time = search.attempt(quick)
    assert (search.best, search.time) == (quick, time)
    assert time < 2.0
    assert search.attempt(slow) == math.inf
    assert search.attempt(Shape(1.9, 1.9, 0.5)) == math.inf  # it sticks
    assert search.attempt(Shape(1.9, 4.5, 0.5)) == math.inf  # beyond the room
    assert search.best == quick
    assert search.count == 3


LIMITS = Limits(
    speed=4.0, acceleration=10.0, motor_torque=8.0, spring_force=500.0, roll_friction=0.3, nip_load=2000.0
)


@pytest.fixture(scope="module")
def plan() -> Plan:
    return hersey.plan_profile(
        machine_of(TRAIN, limits=LIMITS, roll_radius=0.02), DRAG, target_speed=1.9, confidence=0.9
    )


def test_the_seed_of_a_search_moves_what_is_tried(plan: Plan) -> None:
    other = hersey.plan_profile(
        machine_of(TRAIN, limits=LIMITS, roll_radius=0.02), DRAG, target_speed=1.9, seed=2
    )
    assert other.rows() != plan.rows()
    assert (plan.seed, other.seed) == (1, 2)
    assert other.duration == pytest.approx(plan.duration, rel=0.05)


def test_numbers_of_a_plan_belong_together(plan: Plan) -> None:
    band = hersey.hysteresis(TRAIN, DRAG, sensitivity=False)
    assert (plan.fold_speed, plan.transition_speed, plan.temperature) == (band.upper, band.transition, None)
    assert (plan.greatest_speed, plan.draws, plan.confidence, plan.target_speed) == (4.0, 1, 0.9, 1.9)
    assert plan.wait == 0.0
    rows = plan.rows()
    assert rows[-1] == (pytest.approx(plan.duration), 1.9)
    assert max(v for _, v in rows) == plan.peak_speed
    assert plan.rise + plan.hold + plan.fall <= plan.duration * (1 + 1e-9)
    assert (plan.share, plan.share_low, dict(plan.failures)) == (1.0, 1.0, {})
    uses = {use.name: (use.limit, use.used) for use in plan.uses}
    assert uses["speed"] == (4.0, plan.peak_speed)
    assert uses["spring_force"] == (500.0, plan.peak_force)
    assert uses["motor_torque"] == (pytest.approx(8.0), pytest.approx(0.02 * plan.peak_force))
    steepest = max(plan.peak_speed / plan.rise, (plan.peak_speed - 1.9) / plan.fall if plan.fall else 0.0)
    assert uses["acceleration"] == (10.0, pytest.approx(steepest))
    assert uses["grip"] == (600.0, plan.peak_force)
    assert plan.warnings == ()
    assert plan.response is not None
    assert not plan.response.slipping.any()
    assert plan.response.time[-1] == pytest.approx(1.15 * plan.duration + 2 * LAP)


def test_what_a_plan_says(plan: Plan) -> None:
    hold = f"hold for {plan.hold:.4g} s, " if plan.hold > 0 else ""
    assert plan.verdict() == (
        f"Accelerate to {plan.peak_speed:.4g} m/s in {plan.rise:.4g} s, {hold}slow down to 1.9 m/s in "
        f"{plan.fall:.4g} s. After {plan.duration:.5g} s the drive runs at the target "
        "and slides steadily."
    )
    drawn_often = replace(plan, draws=1500, share=0.97, share_low=0.96178)
    assert drawn_often.proof() == (
        "Smooth and within the limits for 97.0 % of 1500 new draws (95 % lower bound 96.1 %; 90 % required)."
    )
    waits = replace(plan, kind="direct", wait=3.0, rise=0.0, target_speed=0.05)
    assert waits.verdict().startswith("Wait 3 s. Accelerate directly to 50 mm/s at once. After")
    assert plan.proof() == "Checked at the nominal parameters only, which are assumed known within 0.1 %."
    assert plan.table().splitlines()[0] == "time [s],drive speed [m/s]"
    assert [tuple(map(float, line.split(","))) for line in plan.table().splitlines()[1:]] == [
        pytest.approx(row, rel=1e-11) for row in plan.rows()
    ]
    document = plan.to_dict()
    assert document["rows"] == [{"time": t, "drive_speed": v} for t, v in plan.rows()]
    assert document["warnings"] == [each.to_dict() for each in plan.warnings]
    assert document["failures"] == dict(plan.failures)
    assert document["share_low"] == plan.share_low
    assert document["uses"][0] == {"name": "speed", "limit": 4.0, "used": plan.peak_speed}
    assert replace(plan, fold_speed=math.inf).to_dict()["fold_speed"] is None


def test_what_forbids_a_plan_in_numbers() -> None:
    slow = hersey.plan_profile(machine_of(TRAIN, limits=Limits(speed=1.5)), DRAG, target_speed=1.9)
    assert (slow.obstacles[0].given, slow.obstacles[0].needed) == (1.5, 1.9)
    low = hersey.plan_profile(TRAIN, DRAG, target_speed=0.9)
    assert low.obstacles[0].text == (
        "The target speed 900 mm/s is not above the transition speed 1.001 m/s, so steady sliding is "
        "unstable there; choose a higher target."
    )
    assert low.obstacles[0].needed == pytest.approx(1.02, abs=0.005)
    assert (low.obstacles[0].limit, low.obstacles[0].given) == ("target_speed", 0.9)
    hot = hersey.plan_profile(TRAIN, WARM, target_speed=0.9, temperature=Schedule([0.0, 5.0], [380.0, 400.0]))
    assert "1.001 m/s at the final temperature of the profile, so steady" in hot.obstacles[0].text
    assert (hot.temperature, hot.share, hot.draws, hot.kind) == (400.0, 0.0, 0, "impossible")
    assert math.isnan(hot.duration)
    band = hersey.hysteresis(TRAIN, DRAG, sensitivity=False)
    assert low.greatest_speed == pytest.approx(3 * band.upper)


# --- the picture -------------------------------------------------------------------------------------------


def rows(layer: dict[str, Any]) -> list[dict[str, Any]]:
    found: list[dict[str, Any]] = layer["data"]["values"]
    return found


def test_the_chart_of_a_plan_in_numbers(plan: Plan) -> None:
    speeds, force = plan_chart(plan).to_dict(validate=False)["vconcat"]
    assert plan.response is not None
    data = next(rows(layer) for layer in speeds["layer"] if len(rows(layer)) > 100)
    belt = [(r["time"], r["value"]) for r in data if r["line"] == "sliding, nominal parameters"]
    np.testing.assert_allclose(belt, np.column_stack([plan.response.time, plan.response.belt_speed]))
    end = plan.response.time[-1]
    drive = [(r["time"], r["value"]) for r in data if r["line"] == "drive"]
    np.testing.assert_allclose(drive, [*plan.rows(), (end, 1.9)])
    marks = {
        r["name"]: r["value"]
        for layer in speeds["layer"]
        for r in rows(layer)
        if "name" in r and "value" in r
    }
    assert marks == {"transition": 1.0, "V*": pytest.approx(plan.fold_speed)}
    ready = [
        r["time"]
        for panel in (speeds, force)
        for layer in panel["layer"]
        for r in rows(layer)
        if "slides by" in r.get("name", "")
    ]
    assert set(ready) == {plan.duration}
    spring = next(rows(layer) for layer in force["layer"] if len(rows(layer)) > 100)
    np.testing.assert_allclose([r["value"] for r in spring], plan.response.spring_force)
    limits = {
        r["name"]: r["value"] for layer in force["layer"] for r in rows(layer) if "value" in r and "name" in r
    }
    assert limits == {
        "limit": pytest.approx(500.0),
        "motor limit": pytest.approx(400.0),
        "grip": pytest.approx(600.0),
    }
    axes = next(layer for layer in speeds["layer"] if len(rows(layer)) > 100)["encoding"]
    assert axes["x"]["scale"]["domain"] == pytest.approx([0.0, end])
    top = max(plan.peak_speed, plan.response.belt_speed.max())
    assert axes["y"]["scale"]["domain"][1] == pytest.approx(1.08 * top)


def test_a_chart_with_a_wait_and_a_course(plan: Plan) -> None:
    course = Schedule([-4.0, 5.0, 30.0], [300.0, 390.0, 400.0])
    assert plan.schedule is not None
    moved = Schedule(
        [0.0, *(np.asarray(plan.schedule.times) + 7.0)], [0.0, *np.asarray(plan.schedule.values)]
    )
    waits = replace(plan, wait=7.0, duration=plan.duration + 7.0, schedule=moved, target_speed=0.5)
    speeds, _, heat = plan_chart(waits, temperature=course).to_dict(validate=False)["vconcat"]
    assert waits.response is not None
    data = next(rows(layer) for layer in speeds["layer"] if len(rows(layer)) > 100)
    belt = [(r["time"], r["value"]) for r in data if r["line"] != "drive"]
    assert belt[0] == (0.0, 0.0)
    np.testing.assert_allclose(
        belt[1:], np.column_stack([7.0 + waits.response.time, 1e3 * waits.response.belt_speed])
    )
    end = 7.0 + waits.response.time[-1]
    start = 7.0 - 0.06 * (end - 7.0)
    x = next(layer for layer in speeds["layer"] if len(rows(layer)) > 100)["encoding"]["x"]
    assert x["scale"]["domain"] == pytest.approx([start, end])
    drive = [(r["time"], r["value"]) for r in data if r["line"] == "drive"]
    assert drive[0] == (pytest.approx(start), 0.0)
    assert drive[-1] == (pytest.approx(end), 500.0)
    line, rule, *_ = heat["layer"]
    for row in rows(line)[::40]:
        assert row["value"] == pytest.approx(course.at(row["time"]) - 273.15)
    assert (rows(line)[0]["time"], rows(line)[-1]["time"]) == (0.0, 30.0)
    assert rows(rule)[0]["time"] == 7.0


def test_each_proof_has_draws_of_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    """The search draws from stream 0; every proof asks for a stream that it has not seen."""
    asked: list[int] = []
    draw = Unknown.drawn

    def watched(self: Unknown, number: int, count: int) -> tuple[list[MachineSample], float]:
        asked.append(number)
        return draw(self, number, count)

    monkeypatch.setattr(Unknown, "drawn", watched)
    unknown = Unknown(TRAIN, DRAG, {"mass": Uncertainty(share=0.2)}, {}, 1)
    shape, steady = Shape(1.9, 3.0, 0.3, 0.4, 0.5), TemperatureProfile(None)
    unknown.trials(0.9, steady, math.inf)
    for number in (1, 2):
        unknown.verify(shape, 1.25, steady, math.inf, 0.5, number)
    assert asked == [0, 1, 2]
