"""The posterior against truths that are known: the stand's belt, and traces of the core's exact motion."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.decision import behaviour
from hersey.decision.behaviour import Working, _sensitivity
from hersey.log import TorqueLog
from hersey.log.own_tables import own_table
from hersey.log.text.column import split_unit
from hersey.log.torque_log import Run
from hersey.machine.uncertainty import Uncertainty
from hersey.posterior import BreakAway, Posterior, Start, StickSlip
from hersey.posterior.drives import DriveModel, Drives
from hersey.posterior.evidence import CycleFigures
from hersey.posterior.likelihood import break_away_force, log_likelihood, misfit
from hersey.posterior.priors import CLOSURES, DrivePriors
from hersey.posterior.result import edges_at
from hersey.posterior.sampling import decision_temperature, posterior
from hersey.posterior.traces import _stretches, evidence_of_log, evidence_of_trace
from hersey.posterior.typical import typical_drag, typical_draw, typical_of_all_temperatures
from hersey.stability import disturbance
from tests.conftest import ROOT

HOT = 453.15
#: V* at 180 degC of the drag in the demo's truth (`FullTruth.drag`), both closures.
TRUE = {"retained": 0.06128, "stiction": 0.12817}


@pytest.fixture(scope="module")
def machine() -> hersey.Machine:
    return hersey.read_machine(ROOT / "examples" / "machine.toml")


@pytest.fixture(scope="module")
def demo(machine: hersey.Machine) -> hersey.SteadyPoints:
    return hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing").without(machine.rest)


@pytest.fixture(scope="module")
def surface(demo: hersey.SteadyPoints) -> hersey.DampingSurface:
    return hersey.fit(demo)


@pytest.fixture(scope="module")
def alone(demo: hersey.SteadyPoints, surface: hersey.DampingSurface, machine: hersey.Machine) -> Posterior:
    """Dwells alone."""
    return posterior(demo, machine, surface=surface, evidence=(), draws=400)


@pytest.fixture(scope="module")
def whole(demo: hersey.SteadyPoints, surface: hersey.DampingSurface, machine: hersey.Machine) -> Posterior:
    """With the stick-slip that the log holds."""
    return posterior(demo, machine, surface=surface, draws=400)


def test_dwells_alone_leave_the_closure_open_and_hold_the_truth(alone: Posterior) -> None:
    chances = alone.closures()
    assert chances["retained"] == pytest.approx(0.45, abs=0.06)
    fold = alone.edges(HOT).fold
    for index, closure in enumerate(("retained", "stiction")):
        low, high = np.quantile(fold[alone.drives.closure == index], [0.025, 0.975])
        assert low < TRUE[closure] < high


def test_stick_slip_of_the_log_decides_the_closure_and_narrows_v_star(
    alone: Posterior, whole: Posterior
) -> None:
    assert [type(each) for each in whole.evidence] == [StickSlip]
    assert whole.closures()["retained"] > 0.97  # the stand's belt keeps its creep
    _, low, high = whole.fold_interval(HOT)
    _, wide_low, wide_high = alone.fold_interval(HOT)
    assert low < TRUE["retained"] < high
    assert np.log(high / low) < np.log(wide_high / wide_low) / 3.0
    assert whole.convergence.converged
    _, low, high = whole.intervals()["stick_speed"]
    assert low < 3e-3 < high


def test_the_core_agrees_with_its_motion_followed_event_by_event(alone: Posterior) -> None:
    """V* of the typical draw: laps of the curve against located events on its table."""
    train, drag = typical_drag(alone, HOT)
    exact = hersey.hysteresis(train, drag, sensitivity=False).upper
    [fine] = alone.model.folds(typical_draw(alone, HOT), HOT, accuracy=1e-5).upper
    assert exact == pytest.approx(fine, rel=0.01)
    [coarse] = alone.model.folds(typical_draw(alone, HOT), HOT).upper
    assert coarse == pytest.approx(fine, rel=0.015)  # as accurate as draws need


def test_the_typical_drive_varies_with_temperature_as_its_draw(whole: Posterior) -> None:
    drag, draw = typical_of_all_temperatures(whole), typical_draw(whole, HOT)
    for celsius in (100.0, 140.0, 180.0):
        kelvin = celsius + 273.15
        speeds = np.array([0.004, 0.02, 0.1])
        grid, curve = np.log(whole.model.speeds(kelvin)), whole.model.log_force(draw, kelvin)[0]
        force = np.exp(np.interp(np.log(speeds), grid, curve))
        constant, damping = whole.model.no_load(kelvin)
        # powers of temperature stand for the viscosity of the draw, and are exact at the headline's
        rel = 1e-3 if celsius == 180.0 else 0.03
        assert drag.force(speeds, temperature=kelvin) == pytest.approx(
            force + constant + damping * speeds, rel=rel
        )
    [fold] = whole.model.folds(draw, HOT, accuracy=1e-5).upper
    low, high = np.quantile(whole.edges(HOT).fold, [0.4, 0.6])
    assert low < fold < high


def test_starts_on_both_sides_bound_v_star(alone: Posterior, demo: hersey.SteadyPoints) -> None:
    model = alone.model
    starts = (Start(HOT, 0.11, slid=False), Start(HOT, 0.15, slid=True))
    found = posterior(demo, model.machine, surface=model.surface, evidence=starts, draws=400)
    _, low, high = found.fold_interval(HOT)
    assert low > 0.107
    assert high < 0.154
    assert found.closures()["retained"] < 0.1


def test_a_break_away_force_is_that_of_the_draws(alone: Posterior, demo: hersey.SteadyPoints) -> None:
    model = alone.model
    before = np.median(break_away_force(model, alone.drives, HOT))
    stated = (BreakAway(HOT, 0.8 * float(before), 0.02),)
    found = posterior(demo, model.machine, surface=model.surface, evidence=stated, draws=400)
    assert np.median(break_away_force(found.model, found.drives, HOT)) == pytest.approx(
        0.8 * before, rel=0.03
    )


def test_the_motion_of_draws_that_are_not_likely_enough_is_not_computed(
    whole: Posterior, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, drives, evidence = whole.model, whole.drives.take(np.arange(60)), whole.evidence
    found = log_likelihood(model, drives, evidence)
    moved: list[int] = []
    starts = DriveModel.starts

    def counted(self: DriveModel, some: Drives, *given: Any, **named: Any) -> Any:
        moved.append(len(some))
        return starts(self, some, *given, **named)

    monkeypatch.setattr(DriveModel, "starts", counted)
    least = np.where(np.arange(60) < 40, found - 0.1, np.inf)
    again = log_likelihood(model, drives, evidence, least)
    assert again[:40] == pytest.approx(found[:40], rel=1e-9)
    assert np.all(again[40:] == -np.inf)
    assert moved == [40]


def test_evidence_of_another_machine_does_not_count(whole: Posterior, demo: hersey.SteadyPoints) -> None:
    """A period ten times too long: it is named, and V* stays."""
    [seen] = whole.evidence
    assert isinstance(seen, StickSlip)
    assert seen.figures is not None
    assert misfit(whole.model, whole.drives, seen) < 10.0
    long = replace(seen.figures, period=(10.0 * seen.figures.period[0], 0.01))
    wrong = replace(seen, figures=long)
    found = posterior(demo, whole.model.machine, surface=whole.model.surface, evidence=(wrong,), draws=200)
    assert found.evidence == ()
    [contradicting] = found.warnings
    assert contradicting.kind == "evidence contradicts dwells and machine"
    assert str(contradicting) == (
        f"{seen.source}: stick-slip contradicts dwells and machine file. "
        "Check stiffness, mass and stick speed"
    )


def test_edges_draw_the_curves_once(alone: Posterior, monkeypatch: pytest.MonkeyPatch) -> None:
    drawn, log_force = [], DriveModel.log_force

    def counted(model: DriveModel, drives: Drives, *at: Any, **above: Any) -> Any:
        drawn.append(len(drives))
        return log_force(model, drives, *at, **above)

    monkeypatch.setattr(DriveModel, "log_force", counted)
    few = alone.drives.take(np.arange(30))
    edges = edges_at(alone.model, few, HOT)
    assert drawn == [30]
    assert edges.fold == pytest.approx(alone.edges(HOT).fold[:30], rel=2e-3)


def test_all_that_asks_for_the_band_of_the_typical_belt_shares_one(
    whole: Posterior, demo: hersey.SteadyPoints, monkeypatch: pytest.MonkeyPatch
) -> None:
    bands, hysteresis = [], behaviour.hysteresis

    def counted(*given: Any, **named: Any) -> Any:
        bands.append(given)
        return hysteresis(*given, **named)

    for module in (behaviour, disturbance):
        monkeypatch.setattr(module, "hysteresis", counted)
    monkeypatch.setattr(behaviour, "posterior", lambda *_, **__: whole)
    with Working(demo, whole.model.surface, whole.model.machine) as working:
        found = working.result()
    assert found.band is not None
    assert [point.disturbance is not None for point in found.points] == [True, True]
    assert len(bands) == 1


def test_stiffness_and_mass_move_v_star_alike_as_the_impedance_alone_counts(whole: Posterior) -> None:
    found = _sensitivity(whole)
    assert found["stiffness"] == pytest.approx(found["mass"], abs=0.003)
    assert -0.4 < found["stick_speed"] < -0.2


def test_sensitivities_are_as_exact_where_the_numbers_are_well_known(
    demo: hersey.SteadyPoints, surface: hersey.DampingSurface, machine: hersey.Machine
) -> None:
    """V* is known to 1e-4: steps as small as these uncertainties would show nothing else."""
    sure = {name: Uncertainty(share=1e-3) for name in ("stick_speed", "stiffness", "mass")}
    known = posterior(demo, replace(machine, uncertainty=sure), surface=surface, evidence=(), draws=400)
    found = _sensitivity(known)
    assert found["stiffness"] == pytest.approx(found["mass"], abs=0.003)
    assert abs(found["stiffness"]) < 0.01
    assert -0.3 < found["stick_speed"] < -0.1


def test_the_same_seed_gives_the_same_bits_and_the_rest_is_told(
    alone: Posterior, demo: hersey.SteadyPoints
) -> None:
    model = alone.model
    again = posterior(demo, model.machine, surface=model.surface, evidence=(), draws=400)
    assert np.array_equal(again.edges(HOT).fold, alone.edges(HOT).fold)
    threads = model.folds(alone.drives, HOT, threads=2).upper
    assert np.array_equal(threads, model.folds(alone.drives, HOT).upper)
    other = posterior(demo, model.machine, surface=model.surface, evidence=(), draws=400, seed=2)
    assert not np.array_equal(other.edges(HOT).fold, alone.edges(HOT).fold)
    for draws, seed in ((10, 1), (400, -1)):
        with pytest.raises(hersey.HerseyError, match="must be at least"):
            posterior(demo, model.machine, surface=model.surface, draws=draws, seed=seed)
    with pytest.raises(hersey.errors.ParameterError, match=r"argument 'thread'. Did you mean threads\?"):
        posterior(demo, model.machine, surface=model.surface, thread=2)  # type: ignore[call-arg]


def test_probabilities_add_up_and_follow_the_draws(alone: Posterior) -> None:
    edges = alone.edges(HOT)
    for speed in (0.01, 0.026, 0.06, 0.15, 0.5):
        chance = alone.probability(kelvin=HOT, speed=speed)
        assert chance.smooth + chance.from_above + chance.sticks + chance.stalls == pytest.approx(1.0)
        assert chance.smooth == np.mean(edges.fold < speed)
        assert chance.sticks == np.mean(speed < edges.transition)
    assert alone.probability(kelvin=HOT, speed=alone.safe_speed(HOT) * 1.0001).smooth >= 0.975


@pytest.mark.filterwarnings("ignore::FutureWarning")
def test_arviz_takes_the_draws(alone: Posterior) -> None:
    """Populations that agree have an R-hat near 1, and their own standard deviation as a summary's."""
    arviz = pytest.importorskip("arviz")
    data = alone.dataset()
    table = arviz.summary(data)
    assert set(table.index) == set(data.data_vars)
    assert table["r_hat"].max() < 1.1
    spread = float(np.std(alone.numbers()["stiffness"], ddof=1))
    assert float(arviz.summary(data, round_to="none")["sd"]["stiffness"]) == pytest.approx(spread, rel=0.01)


def test_draws_are_an_arviz_data_set(alone: Posterior) -> None:
    data = alone.dataset()
    assert data.sizes == {"chain": 2, "draw": 200}
    assert data.fold_speed.attrs["units"] == "m/s"
    assert np.sort(data.fold_speed.to_numpy().ravel()) == pytest.approx(np.sort(alone.edges(HOT).fold))
    assert alone.to_frame().shape == (400, 7)
    named = [split_unit(name)[0] for name in alone.to_frame().columns]
    assert own_table(named) == "a table of the draws that 'hersey posterior' wrote"
    record = alone.to_dict()
    assert record["fold"]["low"] < record["fold"]["value"] < record["safe_speed"] == record["fold"]["high"]
    assert "V* at 180 degC" in alone.summary()


def test_ranges_of_the_machine_file_are_the_priors(machine: hersey.Machine) -> None:
    priors = DrivePriors.of(machine)
    stick = priors.range_of("stick_speed")
    # 95 % of a log-uniform range from 2 to 4 mm/s
    assert stick == pytest.approx((2e-3 * 2**0.025, 2e-3 * 2**0.975), rel=1e-3)
    assert priors.range_of("stiffness") == pytest.approx((11e3 / 1.1, 11e3 * 1.1), rel=1e-6)
    bare = DrivePriors.of(replace(machine, uncertainty={}))
    assert bare.range_of("mass") == pytest.approx((11.0 / 1.2, 11.0 * 1.2), rel=1e-6)
    assert bare.range_of("stick_speed")[1] < 9e-3
    assert sum(CLOSURES.values()) == pytest.approx(1.0)


def _trace(folder: Path, speeds: list[float], closure: str, machine: hersey.Machine) -> TorqueLog:
    """Starts of the demo's true belt: 200 samples a second, 2 % noise, a slack spring before each."""
    rng = np.random.default_rng(5)
    drag = replace(machine.mixed_drag(HOT), closure=closure)
    rows, clock = [], 0.0
    for speed in speeds:
        run = hersey.simulate(
            machine.train,
            drag,
            drive_speed=speed,
            duration=8.0,
            samples=1600,
            temperature=HOT,
            tolerance=1e-8,
        )
        still = np.zeros(1000)
        force = np.concatenate([still, run.spring_force])
        drive = np.concatenate([still, np.full(1600, speed)]) / machine.roll_radius
        torque = force * machine.roll_radius * (1.0 + 0.02 * rng.standard_normal(force.size))
        for w, t in zip(drive.tolist(), torque.tolist(), strict=True):
            rows.append(f"{clock:.3f},{t:.6g},{w:.6g},180.0")
            clock += 0.005
    path = folder / "trace.csv"
    head = "Time [s],Torque [N*m],Speed [rad/s],Temperature [degC]"
    path.write_text("\n".join([head, *rows]) + "\n")
    return hersey.read(path)


def test_a_trace_of_starts_is_read(tmp_path: Path, machine: hersey.Machine) -> None:
    trace = _trace(tmp_path, [0.06, 0.1, 0.2], "stiction", machine)
    found = evidence_of_trace(trace, machine)
    starts = [each for each in found.evidence if isinstance(each, Start)]
    assert [round(each.drive_speed, 2) for each in starts] == [0.06, 0.1, 0.2]
    assert [each.slid for each in starts] == [False, False, True]  # V* of this belt is 0.125
    drag = replace(machine.mixed_drag(HOT), closure="stiction")
    held = drag.at(HOT).holding_force if hasattr(drag, "at") else None
    for each in starts:
        assert each.peak is not None
        assert each.rise == 0.0
        assert held is None or each.peak[0] > 0.97 * held
    slips = [each for each in found.evidence if isinstance(each, StickSlip)]
    assert len(slips) == 2
    assert all(isinstance(each.figures, CycleFigures) for each in slips)


def test_a_trace_decides_what_dwells_leave_open(
    tmp_path: Path, demo: hersey.SteadyPoints, surface: hersey.DampingSurface, machine: hersey.Machine
) -> None:
    """The other closure than that of the log: only the trace speaks."""
    trace = _trace(tmp_path, [0.1, 0.2], "stiction", machine)
    evidence = evidence_of_trace(trace, machine).evidence
    found = posterior(demo, machine, surface=surface, evidence=evidence, draws=400)
    assert found.closures()["retained"] < 0.02
    _, low, high = found.fold_interval(HOT)
    assert 0.9 * low < TRUE["stiction"] < 1.1 * high
    assert 0.1 < low < high < 0.2


def test_a_log_whose_drive_is_stiffer_gives_no_starts(
    alone: Posterior, demo: hersey.SteadyPoints, machine: hersey.Machine
) -> None:
    """Dwells held where this machine would stick: sliding there says nothing of its V*."""
    found = evidence_of_log(demo, alone.model.curves, machine)
    assert [type(each) for each in found.evidence] == [StickSlip]


def test_laws_are_drawn_in_proportion_to_their_weights(alone: Posterior) -> None:
    """The mean weight of a law's draws is one, so that its size does not count against it."""
    curves = alone.model.curves
    random = np.random.default_rng(11)
    for law in curves.laws:
        mean = float(np.mean(np.exp(law.log_weight(random.standard_normal((4000, law.size))))))
        assert mean == pytest.approx(1.0, abs=0.15)
    drawn = np.bincount(alone.drives.law, minlength=len(curves.laws)) / len(alone.drives)
    assert drawn == pytest.approx(curves.weights, abs=0.06)


def test_outcomes_that_hardly_any_draw_shows_do_not_count(
    alone: Posterior, demo: hersey.SteadyPoints
) -> None:
    """Below the transition nothing slides from rest, at 2 m/s everything does: such recordings are named."""
    model, before = alone.model, alone.fold_interval(HOT)
    for wrong in (Start(HOT, 0.01, slid=True), StickSlip(HOT, 2.0, 20.0)):
        found = posterior(demo, model.machine, surface=model.surface, evidence=(wrong,) * 3, draws=400)
        assert found.evidence == ()
        assert [each.kind for each in found.warnings] == ["evidence contradicts dwells and machine"] * 3
        assert found.fold_interval(HOT)[0] == pytest.approx(before[0], rel=0.15)


def test_evidence_needs_the_temperature_that_the_fit_has(alone: Posterior, demo: hersey.SteadyPoints) -> None:
    model = alone.model
    for kelvin, said in ((None, "temperature is missing"), (270.0, "temperature is 270 K")):
        with pytest.raises(hersey.HerseyError, match=said):
            posterior(demo, model.machine, surface=model.surface, evidence=[Start(kelvin, 0.1, slid=True)])
    with pytest.raises(hersey.HerseyError, match="holds only above 0 degC"):
        alone.edges(float("nan"))


def test_a_stated_static_friction_holds_where_the_stick_speed_does(
    demo: hersey.SteadyPoints, surface: hersey.DampingSurface, machine: hersey.Machine
) -> None:
    """The ratio stated is that of 180 degC: what the draws need there agrees with it."""
    assert machine.contact is not None
    stated = replace(machine, static_friction=0.09)
    found = posterior(demo, stated, surface=surface, evidence=(), draws=400)
    [counted] = found.evidence
    assert counted.temperature == pytest.approx(HOT)
    force = float(np.median(break_away_force(found.model, found.drives, HOT)))
    assert force == pytest.approx(0.09 * machine.contact.load, rel=0.05)


def test_a_recording_given_twice_counts_once(whole: Posterior, demo: hersey.SteadyPoints) -> None:
    machine, log = whole.model.machine, demo.log
    assert isinstance(log, TorqueLog)
    found = posterior(demo, machine, surface=whole.model.surface, traces=[log], draws=200)
    assert [type(each) for each in found.evidence].count(StickSlip) == 1


def test_a_long_stretch_is_searched_in_proportion_to_its_length() -> None:
    """Looking at all blocks that came before made a day at one speed take minutes: now few are looked at."""
    time = np.arange(0.0, 20_000.0, 0.25)
    drift = 4.0 * np.exp(2e-6 * time)  # by 4 %, less than what makes another speed
    [stretch] = _stretches(Run("", time, time, drift, None))
    assert (stretch.first, stretch.last) == (0, time.size)
    step = np.where(time < 10_000.0, 4.0, 4.4)
    assert [each.first for each in _stretches(Run("", time, time, step, None))] == [0, 40_000]


def test_where_the_roll_does_not_start_the_belt_v_star_is_that_of_one_that_grips(alone: Posterior) -> None:
    """A grip of 1 N starts no draw: all stall, and V* is as without a limit."""
    machine = alone.model.machine
    weak = replace(machine, limits=replace(machine.limits, roll_friction=1.0, nip_load=1.0))
    assert weak.train.grip == 1.0
    few = alone.drives.take(np.arange(0, len(alone.drives), 20))
    slips = edges_at(replace(alone.model, machine=weak), few, HOT)
    free = replace(machine, limits=replace(machine.limits, roll_friction=None, nip_load=None))
    assert free.train.grip is None
    grips = edges_at(replace(alone.model, machine=free), few, HOT)
    assert slips.stalls.all()
    assert not grips.stalls.any()
    assert slips.fold == pytest.approx(grips.fold, rel=1e-12)
    assert slips.holding == pytest.approx(grips.holding, rel=1e-12)


def test_a_wide_v_star_converges_by_its_own_width(alone: Posterior) -> None:
    state = replace(alone.convergence, distinct=0.9, counted=1.0)
    assert replace(state, ratio=1.14, width=1.2).converged
    assert not replace(state, ratio=1.2, width=2.0).converged  # 2^0.08 is 1.06
    assert replace(state, ratio=1.19, width=10.0).converged  # 10^0.08 is 1.20
    assert not replace(state, ratio=1.22, width=10.0).converged


def test_a_belt_at_rest_bears_the_no_load_drag_too(alone: Posterior) -> None:
    """A constant torque of 30 mN m at a roll of 15 mm is 2 N more on every draw."""
    few = alone.drives.take(np.arange(0, 400, 40))
    forces = [
        break_away_force(replace(alone.model, surface=replace(alone.model.surface, rest=rest)), few, HOT)
        for rest in (None, NoLoadTorque.stated(constant=0.03))
    ]
    assert forces[1] - forces[0] == pytest.approx(np.full(10, 0.03 / 0.015), rel=1e-9)


def test_each_number_of_the_drive_has_its_own_range(machine: hersey.Machine) -> None:
    stated = {"stiffness": Uncertainty(share=0.1), "mass": Uncertainty(share=0.5)}
    priors = DrivePriors.of(replace(machine, uncertainty=stated))
    assert priors.range_of("stiffness") == pytest.approx((11e3 / 1.1, 11e3 * 1.1), rel=1e-6)
    assert priors.range_of("mass") == pytest.approx((11.0 / 1.5, 11.0 * 1.5), rel=1e-6)
    stick = machine.stick_speed  # of which nothing is stated: from a third to three times, evenly in ln
    assert priors.range_of("stick_speed") == pytest.approx(
        (stick / 3 * 9**0.025, stick / 3 * 9**0.975), rel=1e-3
    )


def test_the_decision_is_at_the_hottest_point_or_the_hottest_of_the_log(
    surface: hersey.DampingSurface, machine: hersey.Machine
) -> None:
    points = tuple(replace(machine.points[0], temperature=kelvin) for kelvin in (420.0, 450.0, 430.0))
    assert decision_temperature(surface, replace(machine, points=points)) == 450.0
    assert surface.temperature_range is not None
    bare = replace(machine, points=())
    assert decision_temperature(surface, bare) == max(surface.temperature_range)


def test_a_belt_is_let_go_when_the_drive_has_pulled_the_spring_so_far(alone: Posterior) -> None:
    """Of belts that stop abruptly, behind a ramp of 5 ms to 0.3 m/s: 0.75 mm less than without the ramp."""
    drives = alone.drives.take(np.flatnonzero(alone.drives.closure == 1))
    started = alone.model.start_ups(drives, HOT, [(0.0, 0.0), (5e-3, 0.3)])
    stiffness, force = alone.model.numbers(drives)[:, 1], break_away_force(alone.model, drives, HOT)
    by_hand = 2.5e-3 + force / (stiffness * 0.3)
    behind = by_hand > 5e-3
    assert np.count_nonzero(behind) > 20
    assert np.asarray(started.slides).all()
    assert np.asarray(started.released)[behind] == pytest.approx(by_hand[behind], rel=1e-3)
