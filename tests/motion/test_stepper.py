"""The motion from call to call: against `simulate`, and against a solution of scipy's that shares no code."""

import copy
import pickle

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hersey import Drag, Drivetrain, HerseyError, Schedule, Stepper, simulate
from hersey.errors import ParameterError, UnfinishedError

LAW = {"ehl_exponent": -0.7, "mixed_exponent": -1.2}
BASELINE = Drag(50, 1, stick_speed=0.01, **LAW)
WARM = Drag(
    50, 1, stick_speed=0.01, reference_temperature=373.15, force_temperature_exponent=-1.0,
    speed_temperature_exponent=6.0, **LAW,
)  # fmt: skip
TRAIN = Drivetrain(1000, 1)


def follow(stepper, until):
    """Return the state at `until` and the events on the way."""
    events = []
    while (state := stepper.advance(until)).event:
        events.append(state.event)
    return state, events


@pytest.mark.parametrize("closure", ["retained", "stiction", "stribeck"])
@pytest.mark.parametrize("step", [0.1, 0.0137, 1e-3])
def test_steps_of_any_length_read_the_motion_of_simulate(closure, step):
    drag = Drag(50, 1, stick_speed=0.01, closure=closure, rest_force=2.0, **LAW)
    train = Drivetrain(1000, 1, grip=60.0)
    count = round(0.8 / step)
    run = simulate(train, drag, drive_speed=0.8, duration=count * step, samples=count + 1)
    stepper, events = Stepper(train, drag, drive_speed=0.8), []
    for i, time in enumerate(run.time):
        state, seen = follow(stepper, time)
        events += seen
        assert state.belt_speed == pytest.approx(run.belt_speed[i], abs=1e-12)
        assert state.spring_force == pytest.approx(run.spring_force[i], abs=1e-9)
        assert (state.mode, state.slipping) == (run.mode[i], run.slipping[i])
        assert state.stuck == (run.mode[i] == "stuck")
    assert events == list(run.events)


def test_a_call_ends_at_the_first_event_with_the_state_just_after_it():
    stepper = Stepper(TRAIN, BASELINE, drive_speed=1.0)
    first = simulate(TRAIN, BASELINE, drive_speed=1.0, duration=2.0).events[0]
    state = stepper.advance(2.0)
    assert (state.event, state.time, state.mode) == (first, first.time, first.to_mode)
    assert stepper.state.event is None
    assert state.drag == pytest.approx(state.spring_force, rel=1e-12)  # at a release both are equal


@pytest.mark.parametrize("through", [copy.copy, lambda stepper: pickle.loads(pickle.dumps(stepper))])
def test_a_motion_that_was_saved_goes_on_to_the_last_bit(through):
    stepper = Stepper(TRAIN, WARM, drive_speed=1.0, temperature=380.0, start=(0.5, 0.01))
    for i in range(1, 40):
        stepper.set_inputs(
            drive=1.0 + 0.1 * (i % 3), temperature=380.0 + i % 5, temperature_rate=0.5 * (i % 2)
        )
        stepper.advance(stepper.state.time + 0.0171)
        other = through(stepper)
        assert other.state == stepper.state
        assert other.save() == stepper.save()
        until = stepper.state.time + 0.3
        assert follow(other, until) == follow(copy.copy(stepper), until)


def test_what_was_saved_brings_its_drive_and_temperature():
    """Into a stepper that began slower and colder, or was driven otherwise: as if nothing had happened."""
    stepper = Stepper(TRAIN, WARM, drive_speed=1.0, temperature=380.0)
    stepper.advance(0.2)
    saved = stepper.save()
    expected = follow(stepper, 1.5)
    for drive, temperature in ((1.0, 380.0), (0.3, 360.0), (2.0, 400.0)):
        other = Stepper(TRAIN, WARM, drive_speed=drive, temperature=temperature)
        other.advance(0.1)
        other.set_inputs(drive=0.7, temperature=390.0, temperature_rate=1.0)
        other.restore(saved)
        assert follow(other, 1.5) == expected


def test_inputs_that_change_on_the_way_are_a_schedule():
    times, speeds = [0.0, 0.3, 0.3, 0.7, 0.9], [0.5, 0.5, 1.2, 0.2, 1.0]
    warmth = [380.0, 380.0, 372.0, 372.0, 390.0]
    drive, temperature = Schedule(times, speeds), Schedule(times, warmth)
    run = simulate(TRAIN, WARM, drive_speed=drive, temperature=temperature, duration=1.3, samples=1301)
    stepper = Stepper(TRAIN, WARM, drive_speed=0.5, temperature=380.0)
    changes = {0.3: (1.2, -2.5, 372.0, 0.0), 0.7: (0.2, 4.0, 372.0, 90.0), 0.9: (1.0, 0.0, 390.0, 0.0)}
    for i, time in enumerate(run.time):
        for change in [t for t in changes if t <= time]:
            follow(stepper, change)
            speed, rate, warm, warming = changes.pop(change)
            stepper.set_inputs(drive=speed, drive_rate=rate, temperature=warm, temperature_rate=warming)
        state, _ = follow(stepper, time)
        assert state.belt_speed == pytest.approx(run.belt_speed[i], abs=1e-8)
        assert state.spring_force == pytest.approx(run.spring_force[i], abs=1e-6)


@pytest.mark.parametrize("closure", ["retained", "stiction"])
def test_a_jump_of_torque_moves_a_held_belt_as_force_over_mass_says(closure):
    drag = Drag(14, 0.025, stick_speed=3e-4, closure=closure, **LAW)
    train, force = Drivetrain(11e3, 11), 2 / 0.015
    course = Schedule([0, 0.1, 0.1, 0.2], [force, force, force / 5, force / 5])
    run = simulate(train, drag, drive_torque=course, duration=0.2, samples=20001)
    at = int(np.searchsorted(run.time, 0.1))
    # the spring is as long as just before, and the belt gains what the net force gives it, but for drag
    assert run.spring_force[at] == pytest.approx(run.spring_force[at - 1], abs=1e-4)
    net = force / 5 - run.spring_force[at]
    assert -net > 2 * drag.holding_force
    gain = (run.belt_speed[at + 1] - run.belt_speed[at]) / (run.time[1] * net / train.mass)
    assert 0.5 < gain < 1.5
    assert abs(run.energy.residual) < 1e-6


class Alone:
    """A belt of the retained closure that moves forward, by scipy's DOP853 from one condition to the next."""

    def __init__(self, stiffness, mass):
        self.k, self.m = stiffness, mass
        self.v, self.s, self.stuck = 0.0, 0.0, True
        self.drive, self.warm = 0.0, 1.0

    def law(self, v):
        f_t, v_t, v_s = 50 / self.warm, self.warm**6, 0.01 * self.warm**6
        if v < v_s:
            at_stick = f_t * (v_s / v_t) ** (1 - 1.2)
            return at_stick * np.e * np.exp(-v / v_s)
        return f_t * (v / v_t) ** (1 + (-0.7 if v >= v_t else -1.2))

    def set(self, drive, warm):
        self.drive, self.warm = drive, warm
        slow = self.v < 0.01 * self.warm**6
        holds = abs(self.k * self.s) <= self.law(self.v)
        self.stuck = holds and (self.stuck or slow)

    def advance(self, span):
        while span > 0:
            v_s, v_t = 0.01 * self.warm**6, self.warm**6
            if self.stuck:
                rate = self.drive - self.v
                left = (self.law(self.v) / self.k - self.s) / rate
                if left > span:
                    self.s += rate * span
                    return
                self.s, self.stuck, span = self.s + rate * left, False, span - left
            # the side of each speed on which the belt is about to be
            edge = 1 - 1e-13 if self.k * self.s < self.law(self.v * (1 + 1e-12)) else 1 + 1e-13
            side = self.v * edge

            low, high = (0, v_s) if side < v_s else (v_s, v_t) if side < v_t else (v_t, 1e9)

            def rates(_, y, low=low, high=high):
                u = min(max(y[0], low), np.nextafter(high, 0))
                return [(self.k * y[1] - self.law(u)) / self.m, self.drive - y[0]]

            ends = [lambda _, y, v=v: y[0] - v for v in (v_s, v_t)]
            if side < v_s:
                ends.append(lambda t, y: abs(self.k * y[1]) - self.law(y[0]) if t > 1e-9 else 1.0)
            for end in ends:
                end.terminal = True
            solved = solve_ivp(
                rates, (0, span), [side, self.s], "DOP853", events=ends, rtol=1e-11, atol=1e-13
            )
            self.v, self.s = solved.y[:, -1]
            span -= solved.t[-1]
            if solved.status == 1 and len(solved.t_events[0]) and side > v_s:
                self.v, self.stuck = v_s, abs(self.k * self.s) <= self.law(v_s)
            if solved.status == 1 and side < v_s and len(ends) == 3 and len(solved.t_events[2]):
                self.stuck = True


@pytest.mark.parametrize("seed", range(6))
def test_a_solution_that_shares_no_code_agrees(seed):
    random = np.random.default_rng(seed)
    alone, stepper = Alone(1000.0, 1.0), Stepper(TRAIN, WARM, drive_speed=0.0, temperature=373.15)
    modes = set()
    for i in range(25):
        drive, warm = random.uniform(0.2, 0.9), random.choice([1.0, 0.98, 1.02])
        alone.set(drive, warm)
        stepper.set_inputs(drive=drive, temperature=373.15 * warm)
        span = random.uniform(0.01, 0.09)
        alone.advance(span)
        state, _ = follow(stepper, stepper.state.time + span)
        modes.add(state.mode)
        assert state.belt_speed == pytest.approx(alone.v, abs=2e-7), (i, state)
        assert state.stretch == pytest.approx(alone.s, abs=2e-8), (i, state)
        assert state.stuck == alone.stuck
    assert modes >= {"ehl", "stuck"}


def test_what_cannot_be_is_refused():
    stepper = Stepper(TRAIN, BASELINE, drive_speed=1.0)
    follow(stepper, 0.5)
    before = stepper.save()
    for wrong in (
        lambda: stepper.advance(0.1),
        lambda: stepper.advance(float("nan")),
        lambda: stepper.advance("soon"),
        lambda: stepper.set_inputs(drive=float("inf")),
        lambda: stepper.set_inputs(temperature=300.0),
        lambda: stepper.set_inputs(drive_rate=1.0),
        lambda: stepper.restore(before[:-1]),
        lambda: stepper.restore(("x", *before[1:])),
        lambda: stepper.restore((*before[:3], 9.0, *before[4:])),
        lambda: stepper.restore((*before[:11], float("nan"), *before[12:])),
        lambda: Stepper(TRAIN, BASELINE),
        lambda: Stepper(TRAIN, BASELINE, drive_speed=1.0, drive_torque=1.0),
        lambda: Stepper(TRAIN, BASELINE, drive_speed=1.0, temperature=300.0),
        lambda: Stepper(TRAIN, WARM, drive_speed=1.0),
        lambda: Stepper(TRAIN, BASELINE, drive_speed=float("nan")),
        lambda: Stepper(TRAIN, BASELINE, drive_speed=1.0, tolerance=1.0),
    ):
        with pytest.raises(HerseyError):
            wrong()
    assert stepper.save() == before
    with pytest.raises(UnfinishedError):
        follow(Stepper(TRAIN, BASELINE, drive_speed=1.0, most_steps=1), 1.0)
    with pytest.raises(ParameterError, match="drive"):
        stepper.set_inputs(drive=1.0, drive_rate=float("nan"))


def test_units_are_read_at_the_door():
    stepper = Stepper(TRAIN, WARM, drive_speed="1 m/s", temperature="100 degC")
    same = Stepper(TRAIN, WARM, drive_speed=1.0, temperature=373.15)
    assert stepper.advance("500 ms") == same.advance(0.5)
    assert stepper.set_inputs(drive="50 mm/s") == same.set_inputs(drive=0.05)
    assert follow(stepper, 1.0) == follow(same, 1.0)


def test_the_drag_of_a_belt_that_creeps_is_the_pull_less_its_inertia():
    """Held while it moves on at 7 mm/s, and drawn back ever harder: m dv/dt by differences, m = 1 kg."""
    stepper = Stepper(TRAIN, BASELINE, drive_speed=0.3)
    while (event := (state := stepper.advance(3.0)).event) and event.to_mode != "stuck":
        pass
    assert state.belt_speed > 5e-3
    stepper.set_inputs(drive=-0.3)
    assert stepper.advance(3.0).mode == "microslip"
    step = 1e-5
    states = [stepper.advance(state.time + i * step) for i in range(1, 401)]
    assert {each.mode for each in states} == {"microslip"}
    speed, pull, drag = np.array([(s.belt_speed, s.spring_force, s.drag) for s in states]).T
    gained = (speed[2:] - speed[:-2]) / (2 * step)
    assert gained.max() < -0.01
    np.testing.assert_allclose((drag - pull)[1:-1], -1.0 * gained, rtol=1e-6)
