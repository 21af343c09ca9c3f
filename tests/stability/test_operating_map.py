"""The operating map: right against simulation, honest about its limits, legible as a picture."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.charts import PICTURES
from hersey.charts.operating_map import map_chart
from hersey.charts.operating_map.frame import Frame
from hersey.charts.operating_map.regions import bands_of
from hersey.charts.render import picture
from hersey.damping.candidates.shared_errors import Freedom
from hersey.damping.estimate import Estimate
from hersey.damping.surface import DampingSurface
from hersey.document.saved_fit import read_fit
from hersey.errors import InsufficientDataError, MissingFileError, OutputError, ParameterError
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine
from hersey.result import json_value
from hersey.stability.operating_map import STATES, OperatingMap
from tests.cli.command import run
from tests.conftest import ROOT
from tests.machines import map_of

#: What a belt settles to from rest and from steady sliding, by state of the map.
SETTLES_TO = {
    "creep": ("steady_sliding", "steady_sliding"),
    "stick_slip": ("stick_slip", "stick_slip"),
    "swing": ("stick_slip", "oscillation"),
    "bistable": ("stick_slip", "steady_sliding"),
    "smooth": ("steady_sliding", "steady_sliding"),
}
AT: dict[str, Any] = {"roll_radius": 0.015, "stick_speed": 3e-4}
#: Few draws: for tests that look at anything but the interval of V*.
QUICK: dict[str, Any] = {**AT, "draws": 2}


@pytest.fixture(scope="module")
def drawn(surface: DampingSurface, machine: Machine) -> OperatingMap:
    points = (*machine.points, OperatingPoint("cold <b>start</b>", 1.2, 350.0))
    return map_of(surface, machine.train, **AT, limits=machine.limits, points=points)


@pytest.fixture(scope="module")
def isothermal(surface: DampingSurface) -> DampingSurface:
    """The surface at its reference temperature, as an isothermal fit would have it."""
    keep = [0, 2, 3, 4]
    return replace(
        surface,
        b=None,
        reference_temperature=None,
        temperature_range=None,
        variables=tuple(surface.variables[i] for i in keep),
        values=surface.values[keep],
        covariance=surface.covariance[np.ix_(keep, keep)],
        freedoms=Freedom(surface.freedom, surface.covariance[np.ix_(keep, keep)]),
    )


def simulated(train: hersey.Drivetrain, drawn: OperatingMap, kelvin: Any, speed: Any) -> tuple[Any, Any]:
    """Kinds settled to from rest and from above on a grid, by simulation until the orbit closes."""
    laws = [drawn.drag.at(t) for t in kelvin.tolist()]
    own = {
        name: np.array([getattr(law, name) for law in laws])[:, None]
        for name in ("transition_force", "transition_speed", "stick_speed")
    }
    rest, steady = (
        hersey.sweep(train, laws[0], zip=True, start=start, drive_speed=speed[None, :], **own).kind.values
        for start in ("rest", "steady")
    )
    return rest, steady


@pytest.mark.parametrize("size", [20, 53])
def test_the_map_agrees_with_simulation_from_below_and_above(
    surface: DampingSurface, machine: Machine, size: int
) -> None:
    drawn = map_of(surface, machine.train, **QUICK)
    kelvin, speed = np.linspace(360.0, 466.0, size), np.geomspace(2e-4, 0.15, size)
    states = drawn.states(temperature=kelvin[:, None], speed=speed[None, :])
    assert {"creep", "stick_slip", "bistable", "smooth"} <= set(states.ravel())
    rest, steady = simulated(machine.train, drawn, kelvin, speed)
    padded = np.pad(states, 1, mode="edge")
    for i, j in np.ndindex(states.shape):
        near = padded[i : i + 3, j : j + 3]
        if np.all(near == states[i, j]):  # a boundary may pass within one cell of all others
            assert (rest[i, j], steady[i, j]) == SETTLES_TO[states[i, j]], (kelvin[i], speed[j])


def test_the_edges_part_what_simulation_finds_beside_them(surface: DampingSurface, machine: Machine) -> None:
    kelvin = np.array([430.0, 450.0, 468.0])
    drawn = map_of(surface, machine.train, **QUICK, temperatures=kelvin)
    for i, t in enumerate(kelvin):
        lower, bend, upper = drawn.lower[i], drawn.transition[i], drawn.upper[i]
        beside = [0.997 * lower, (lower * bend) ** 0.5, 1.003 * bend, 0.999 * upper, 1.001 * upper]
        expected = ["stick_slip", "swing", "bistable", "bistable", "smooth"]
        assert drawn.states(temperature=t, speed=beside).tolist() == expected
        for speed, state in zip(beside, expected, strict=True):
            rest, steady = simulated(machine.train, drawn, np.array([t]), np.array([speed]))
            assert (rest[0, 0], steady[0, 0]) == SETTLES_TO[state], (t, speed)


def test_below_the_stick_speed_the_belt_creeps(surface: DampingSurface, machine: Machine) -> None:
    kelvin = np.array([400.0, 435.85])
    drawn = map_of(surface, machine.train, **QUICK, temperatures=kelvin)
    for t, stick in zip(kelvin, drawn.stick_speed, strict=True):
        assert stick == drawn.drag.at(t).stick_speed
        assert drawn.states(temperature=t, speed=[0.1 * stick, 0.999 * stick, 1.001 * stick]).tolist() == [
            "creep",
            "creep",
            "stick_slip",
        ]
        for share, state in ((0.1, "creep"), (0.999, "creep"), (1.001, "stick_slip")):
            rest, steady = simulated(machine.train, drawn, np.array([t]), np.array([share * stick]))
            assert (rest[0, 0], steady[0, 0]) == SETTLES_TO[state], (t, share)


def test_where_the_roll_slips_a_belt_may_swing_without_sticking(
    surface: DampingSurface, machine: Machine
) -> None:
    """Just below V* of a roll whose grip is a little more than starts the belt."""
    kelvin = 453.15
    law = map_of(surface, machine.train, **QUICK, temperatures=[kelvin, 460.0]).drag.at(kelvin)
    limits = Limits(roll_friction=0.5, nip_load=2 * 1.02 * law.holding_force)
    drawn = map_of(surface, machine.train, **QUICK, limits=limits, temperatures=[kelvin, 460.0])
    state = drawn.state_at(temperature=kelvin, speed=0.9999 * drawn.upper[0])
    assert state.state == "bistable"
    assert "oscillates while the drive slips" in state.verdict()
    free = map_of(surface, machine.train, **QUICK, temperatures=[kelvin, 460.0])
    assert (
        "sticks if started from rest"
        in free.state_at(temperature=kelvin, speed=0.99 * free.upper[0]).verdict()
    )


def test_stall_is_where_the_drag_exceeds_the_limit(surface: DampingSurface, machine: Machine) -> None:
    grip = Limits(roll_friction=0.2, nip_load=250.0, motor_torque=8.0)  # too weak for a belt at rest
    drawn = map_of(surface, machine.train, **QUICK, limits=grip)
    assert (drawn.torque_limit, drawn.limited_by) == (pytest.approx(0.2 * 250 * 0.015), "grip")
    t, above, below = drawn.temperature[30], drawn.stall_above[30], drawn.stall_below[30]
    assert 0 < below < drawn.transition[30] < above < math.inf
    for speed in (above, below):
        assert float(drawn.drag.at(t).force(speed)) * 0.015 == pytest.approx(drawn.torque_limit, rel=1e-9)
    around = [0.999 * below, 1.001 * below, 0.999 * above, 1.001 * above]
    assert [s.moving == "stall" for s in drawn.look_up(temperature=t, speed=around)] == [
        True,
        True,
        False,
        True,
    ]
    # one that slides more slowly than the transition sticks sooner or later, and is held for good
    assert drawn.lower[30] == 0
    assert set(drawn.states(temperature=t, speed=around)) == {"stall"}
    motor = map_of(surface, machine.train, **QUICK, limits=replace(grip, motor_torque=0.74))
    assert (motor.torque_limit, motor.limited_by) == (0.74, "motor torque")
    free = map_of(surface, machine.train, **QUICK)
    assert motor.beyond == "motor"
    assert np.all(np.isinf(free.stall_above))
    assert np.all(free.stall_below == 0)
    assert free.starts.all()
    assert "no torque limit" in [each.kind for each in free.warnings]
    tight = map_of(surface, machine.train, **QUICK, limits=Limits(motor_torque=0.5))
    assert set(tight.states(temperature=t, speed=tight.speed)) == {"motor"}


@pytest.mark.parametrize(
    ("grip", "slow", "fast"), [(250.0, "stalled", "stalled"), (300.0, "stick_slip", "grip_slip")]
)
def test_what_the_roll_cannot_bear_simulation_finds_slipping(
    surface: DampingSurface, machine: Machine, grip: float, slow: str, fast: str
) -> None:
    """A belt at rest bears 288 N: a roll of 250 N starts none, one of 300 N slips where it runs heavier."""
    limits = Limits(roll_friction=0.5, nip_load=2 * grip)
    drawn = map_of(surface, machine.train, **QUICK, limits=limits, temperatures=[360.0, 453.15])
    assert drawn.starts.tolist() == [grip == 300.0] * 2
    assert drawn.holding == pytest.approx([0.015 * drawn.drag.at(t).holding_force for t in (360.0, 453.15)])
    gripping = replace(machine.train, grip=grip)
    for t, speed, kind in ((453.15, 0.01, slow), (360.0, 1.1 * drawn.stall_above[0], fast)):
        cycle = hersey.stick_slip(gripping, drawn.drag.at(t), drive_speed=speed)
        state = drawn.state_at(temperature=t, speed=speed)
        assert cycle.kind == kind
        assert (state.state == "stall") == (kind in ("stalled", "grip_slip"))
    smooth = drawn.state_at(temperature=453.15, speed=0.15)
    assert (smooth.state, smooth.moving) == ("smooth" if grip == 300.0 else "stall", "smooth")
    assert ("keeps sliding" in smooth.verdict()) == (grip == 250.0)
    started = [each for each in drawn.warnings if each.kind == "belt not started"]
    assert bool(started) == ("not started" in drawn.summary()) == (grip == 250.0)
    never = "the drive cannot start from rest at any temperature"
    assert [str(each) for each in started] == [never][: len(started)]
    own = map_of(surface, gripping, **QUICK, temperatures=[360.0, 453.15])  # the drivetrain's own grip
    assert own.torque_limit == pytest.approx(0.015 * grip)
    parts = bands_of(drawn, Frame.of(drawn))
    shown = {name for name, edges in parts.items() if any(np.any(high > low) for low, high in edges)}
    assert ("smooth" in shown) == (grip == 300.0)
    assert ("stall" in shown) == (grip == 250.0)  # beyond the speeds shown where the roll starts the belt


#: What a belt does from rest and from sliding in each state of one that moves.
DOES = {
    "stick_slip": ("sticks", "sticks"),
    "swing": ("sticks", "swings"),
    "bistable": ("sticks or swings", "slides"),  # close to V* the slipping roll may keep it from sticking
    "smooth": ("slides", "slides"),
    "stall": ("grip slip", "grip slip"),
}


def what_it_does(train: hersey.Drivetrain, drag: hersey.Drag, speed: float, start: Any) -> str:
    """Judged from the samples of the last third of a simulation."""
    run = hersey.simulate(train, drag, drive_speed=speed, duration=5.0, samples=12_001, start=start)
    belt, slips = run.belt_speed[8000:], run.slipping[8000:]
    creeps = belt <= drag.stick_speed * (1 + 1e-9)
    if slips.all() and np.ptp(belt) < 2e-3 * speed:
        return "stalls" if creeps.all() else "grip slip"
    if np.ptp(belt) < 2e-3 * speed:
        return "slides"
    return "sticks" if creeps.any() else "swings"


@pytest.mark.parametrize(("grip", "below_the_free"), [(150.0, True), (295.0, True), (1e4, False)])
def test_a_map_of_a_small_grip_is_what_simulation_does(
    surface: DampingSurface, machine: Machine, grip: float, below_the_free: bool
) -> None:
    """A belt at rest bears 288 N: 150 N start none but keep one going, 295 N slip in every lap."""
    train = replace(machine.train, stiffness=1.1e7, grip=grip)  # stiff: the spring swings far
    kelvin = [400.0, 453.15]
    free, drawn = (
        map_of(surface, t, **QUICK, temperatures=kelvin, limits=replace(machine.limits, motor_torque=None))
        for t in (replace(train, grip=None), train)
    )
    assert bool(drawn.upper[1] < free.upper[1]) == below_the_free
    drag = drawn.drag.at(453.15)
    edge = drawn.upper[1]
    for speed in (0.3 * drawn.lower[1], 0.98 * edge, 1.02 * edge, min(1.1 * drawn.stall_above[1], 3 * edge)):
        state = drawn.state_at(temperature=453.15, speed=speed)
        rest, sliding = DOES[state.moving]
        steady = (1.001 * speed, min(float(drag.force(speed)), grip) / train.stiffness)
        assert what_it_does(train, drag, speed, "rest") in (rest if state.starts else "stalls"), (
            speed,
            state,
        )
        assert what_it_does(train, drag, speed, steady) == sliding, (speed, state)


def test_contours_are_lines_of_equal_drag(drawn: OperatingMap) -> None:
    falling, rising = drawn.contour(1.2)
    for t, slow, fast in zip(drawn.temperature, falling, rising, strict=True):
        assert slow < fast
        assert (drawn.drag.at(t).force([slow, fast]) * 0.015).tolist() == pytest.approx([1.2, 1.2])
    assert np.all(drawn.contour(1e3)[0] == 0)


def test_points_are_judged(drawn: OperatingMap) -> None:
    judged = {p.name: p.at for p in drawn.points}
    assert judged["full speed"].state == "smooth"
    assert judged["thick paper"].state == "bistable"
    assert judged["cold <b>start</b>"].state == "motor"
    assert [p.extrapolated for p in judged.values()] == [False, False, True]
    said = [(each.where, each.kind) for each in drawn.warnings]
    assert ("thick paper", "verdict not certain") not in said  # only the fit is counted here
    assert ("cold <b>start</b>", "point extrapolated") in said
    assert str(drawn.warnings[0]).endswith("State the uncertainty of stick_speed")
    assert drawn.state_at(temperature=453.15, speed=0.12) == judged["full speed"]


def test_what_is_uncertain_widens_the_interval_of_the_fold(
    surface: DampingSurface, machine: Machine, drawn: OperatingMap
) -> None:
    at = np.array([450.0, 465.0])
    fit_only, all_of_it = (
        map_of(surface, machine.train, **AT, points=machine.points, temperatures=at, uncertainty=uncertainty)
        for uncertainty in ({}, machine.uncertainty)
    )
    assert all_of_it.uncertain == ("stiffness", "stick_speed")
    narrow, wide = (np.log(m.upper_interval[1] / m.upper_interval[0]) for m in (fit_only, all_of_it))
    assert np.all(wide > 3 * narrow)
    for m in (fit_only, all_of_it):
        assert np.all((m.upper_interval[0] < m.upper) & (m.upper < m.upper_interval[1]))
    (uncertain,) = (each for each in all_of_it.warnings if each.kind == "verdict not certain")
    assert (uncertain.where, uncertain.values["edge"]) == ("thick paper", "V*")
    # the whole map interpolates what these two temperatures computed
    assert np.interp(450.0, drawn.temperature, drawn.upper_interval[0]) == pytest.approx(
        fit_only.upper_interval[0, 0], rel=0.01
    )


def test_the_interval_of_the_transition_is_that_of_the_fit(surface: DampingSurface) -> None:
    reference = surface.reference_temperature
    draws = surface.drag_samples(20000, 1, **AT, temperature=reference)
    assert surface.transition is not None
    for name, estimate, scale in (
        ("transition_speed", surface.transition.speed, 0.015),
        ("ehl_exponent", surface.c, 1.0),
        ("mixed_exponent", surface.transition.mixed_exponent, 1.0),
    ):
        low, high = np.quantile(draws[name], [0.025, 0.975])
        width = scale * (estimate.high - estimate.low)
        assert abs(low - scale * estimate.low) < 0.05 * width
        assert abs(high - scale * estimate.high) < 0.05 * width


def test_draws_without_covariance_are_the_drag(surface: DampingSurface, isothermal: DampingSurface) -> None:
    for fit, t in ((surface, 365.0), (surface, 450.0), (isothermal, None)):
        speed = replace(fit.transition.speed, error=0.0)
        none = Freedom(fit.freedom, 0 * fit.covariance)
        certain = replace(fit.transition, speed=speed)
        exact = replace(fit, covariance=none.covariance, freedoms=none, transition=certain)
        drag = fit.drag(**AT, temperature=t)
        for name, values in exact.drag_samples(3, 0, **AT, temperature=t).items():
            assert values == pytest.approx(np.full(3, getattr(drag, name)), rel=1e-12)


def test_draws_are_seeded_and_go_together_across_temperatures(surface: DampingSurface) -> None:
    one, again = (surface.drag_samples(50, 7, **AT, temperature=400.0) for _ in range(2))
    other = surface.drag_samples(50, 7, **AT, temperature=440.0)
    for name in one:
        assert np.array_equal(one[name], again[name])
    assert np.array_equal(one["ehl_exponent"], other["ehl_exponent"])
    assert not np.array_equal(one["transition_speed"], other["transition_speed"])


def test_draws_without_a_falling_branch_are_counted(surface: DampingSurface) -> None:
    vague = surface.covariance.copy()
    vague[3, 3] = 0.3**2  # of c_mixed - c, which is -0.505: some draws do not fall
    with pytest.warns(UserWarning, match=r"\d+ of 600 draws of the fit had no falling branch") as caught:
        draws = replace(surface, covariance=vague).drag_samples(300, 0, **AT, temperature=400.0)
    assert len(caught) == 1
    assert draws["mixed_exponent"].size == 300
    assert np.all(draws["mixed_exponent"] < -1)
    assert np.all(draws["ehl_exponent"] > -1)
    hopeless = replace(surface, values=surface.values * [1, 1, 1, -1, 1])
    with pytest.raises(InsufficientDataError, match="have no falling branch"):
        hopeless.drag_samples(300, 0, **AT, temperature=400.0)


def test_a_transition_is_drawn_as_wide_as_its_interval(surface: DampingSurface) -> None:
    best = surface.transition.speed
    wide = Estimate(best.value, 0.1 * best.value, 0.82 * best.value, 1.22 * best.value)
    gradual = replace(surface, transition=replace(surface.transition, speed=wide))
    speeds = gradual.drag_samples(5000, 0, **AT, temperature=404.4)["transition_speed"]
    assert np.std(np.log(speeds)) == pytest.approx(0.1, rel=0.05)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"count": 0}, "count is 0"),
        ({"seed": -1}, "seed is -1"),
        ({"temperature": None}, "depends on temperature"),
        ({"temperature": 250.0}, "above 0 degC"),
        ({"temperature": float("nan")}, "temperature is NaN"),
        ({"stick_speed": 1.0}, "stick_speed"),
        ({"roll_radius": -1.0}, "transition"),
    ],
)
def test_bad_draws_are_refused(surface: DampingSurface, arguments: dict[str, Any], message: str) -> None:
    given = {"count": 5, "seed": 0, **AT, "temperature": 400.0, **arguments}
    with pytest.raises(ParameterError, match=message):
        surface.drag_samples(given.pop("count"), given.pop("seed"), **given)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"temperatures": [400.0]}, "at least two"),
        ({"temperatures": [400.0, 390.0]}, "ascend"),
        ({"temperatures": [260.0, 390.0]}, "above 0 degC"),
        ({"speeds": [0.0, 1.0]}, "above 0 and in ascending order"),
        ({"speeds": [0.2, 0.1]}, "ascend"),
        ({"speeds": {"fast": 1.0}}, "speeds is a dictionary"),
        ({"points": [OperatingPoint("freezer", 0.1, 255.0)]}, "255 K"),
        ({"stick_speed": 1.0}, "stick_speed"),
    ],
)
def test_bad_maps_are_refused(
    surface: DampingSurface, machine: Machine, arguments: dict[str, Any], message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        map_of(surface, machine.train, **{**QUICK, **arguments})


@pytest.mark.parametrize(
    ("temperature", "speed", "message"),
    [
        (400.0, 0.0, "speed is 0"),
        (400.0, float("nan"), "speed is"),
        (260.0, 0.1, "260 K"),
        (None, 0.1, "Give one"),
    ],
)
def test_bad_look_ups_are_refused(
    drawn: OperatingMap, temperature: float | None, speed: float, message: str
) -> None:
    with pytest.raises(ParameterError, match=message):
        drawn.state_at(temperature=temperature, speed=speed)


def test_without_a_falling_branch_there_is_no_map(surface: DampingSurface, machine: Machine) -> None:
    rising = replace(
        surface, transition=None, rejected_transition="a second branch is not supported by the data"
    )
    with pytest.raises(InsufficientDataError, match=r"not supported.*Record slower dwells"):
        map_of(rising, machine.train, **QUICK)


def test_an_isothermal_fit_has_a_map_of_one_column(isothermal: DampingSurface, machine: Machine) -> None:
    drawn = map_of(isothermal, machine.train, **QUICK, limits=machine.limits, points=machine.points)
    assert drawn.temperature is None
    assert drawn.lower.shape == (1,)
    assert drawn.transition_interval.shape == (2, 1)
    assert "isothermal fit" in [each.kind for each in drawn.warnings]
    assert drawn.state_at(temperature=None, speed=0.12).state == "smooth"
    assert "as in the log" in drawn.summary()
    with pytest.raises(ParameterError, match="isothermal"):
        drawn.state_at(temperature=400.0, speed=0.12)
    with pytest.raises(ParameterError, match="isothermal"):
        map_of(isothermal, machine.train, **QUICK, temperatures=[400.0, 410.0])
    svg = picture(map_chart(drawn, tooltips=False), ".svg").decode()
    assert "Operating map (isothermal fit)" in svg
    assert "Temperature" not in svg


def test_the_document_is_json_without_infinities(surface: DampingSurface, machine: Machine) -> None:
    drawn = map_of(surface, machine.train, **QUICK, points=machine.points)
    document = json.loads(json.dumps(drawn.to_dict(), allow_nan=False))
    assert document["stall_above"] == [None] * 61
    assert np.shape(document["torque"]) == (61, 81)
    assert document["upper"] == drawn.upper.tolist()
    assert document["points"][0]["at"]["state"] in STATES
    assert document["drag"]["transition_speed"] == drawn.drag.transition_speed


def texts(svg: str) -> list[str]:
    import re
    from html import unescape

    return [unescape(t) for t in re.findall(r">([^<>]+)</t(?:ext|span)>", svg)]


def test_the_picture_names_everything(drawn: OperatingMap) -> None:
    svg = picture(map_chart(drawn), ".svg").decode()
    shown = texts(svg)
    for text in ("Temperature (°C)", "Drive speed (mm/s)", "Speed (rpm)"):
        assert text in shown
    for text in (
        "smooth",
        "sticks",
        "stall: above the motor limit",
        "depends on start",
        "1 N·m",
    ):
        assert text in shown
    for text in ("full speed", "thick paper", "cold <b>start</b>", "drive limit"):
        assert text in shown
    assert any("stall beyond 4.5 N·m (motor torque)" in text for text in shown)
    assert "NaN" not in svg


def test_labels_do_not_overlap(surface: DampingSurface, machine: Machine) -> None:
    from hersey.charts.labels import Labels
    from hersey.charts.operating_map.chart import _layers
    from hersey.charts.operating_map.frame import HEIGHT, WIDTH

    crowd = tuple(OperatingPoint(f"point {i}", 0.04 + 0.004 * i, 450.0 + i) for i in range(6))
    drawn = map_of(surface, machine.train, **QUICK, limits=machine.limits, points=crowd)
    labels = Labels(WIDTH, HEIGHT)
    _layers(drawn, Frame.of(drawn), labels)
    boxes = [text.box for text in labels.texts]
    assert len(boxes) >= 10
    for i, a in enumerate(boxes):
        for b in boxes[i + 1 :]:
            assert not (a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3])


@pytest.mark.slow
def test_pictures_of_each_kind(drawn: OperatingMap) -> None:
    chart = map_chart(drawn)
    begins = {".html": b"<!doctype html>", ".svg": b"<svg", ".png": b"\x89PNG", ".pdf": b"%PDF"}
    assert set(begins) == set(PICTURES)
    for suffix, start in begins.items():
        assert picture(chart, suffix).startswith(start)
    assert b"<b>start" not in picture(chart, ".html")
    with pytest.raises(OutputError, match="no kind of picture"):
        picture(chart, ".docx")


@pytest.fixture(scope="module")
def fit_json(bench_csv: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("fit")
    printed = run("fit", bench_csv, "--tare", "standing", "--json", cwd=folder)
    assert printed.returncode == 0, printed.stderr
    path = folder / "fit.json"
    path.write_text(printed.stdout)
    return path


def test_a_fit_is_read_back_as_it_was(surface: DampingSurface, fit_json: Path) -> None:
    again = read_fit(fit_json)
    for name, value in vars(surface).items():
        if name == "_rounds":  # draws that are kept once they were asked for
            continue
        if isinstance(value, np.ndarray):
            assert np.array_equal(getattr(again, name), value), name
        elif name == "freedoms":
            assert json_value(getattr(again, name)) == json_value(replace(value, moved_by_untold=np.empty(0)))
        else:
            assert getattr(again, name) == value, name


def test_a_fit_knows_the_program_that_made_it(fit_json: Path, tmp_path: Path) -> None:
    document = json.loads(fit_json.read_text()) | {"hersey_version": "0.0.9"}
    path = tmp_path / "old.json"
    path.write_text(json.dumps(document))
    assert read_fit(path).version == "0.0.9"


@pytest.mark.parametrize(
    ("change", "field"),
    [
        (lambda fit: fit.pop("values"), "fit.values: Field required"),
        (lambda fit: fit["values"].pop(), "fit.values: it must be 5 numbers"),
        (lambda fit: fit["values"].__setitem__(0, "much"), "fit.values.0"),
        (lambda fit: fit["values"].__setitem__(2, -0.9), "fit.coefficients.c"),
        (lambda fit: fit["values"].__setitem__(4, 0.1), "fit.transition.speed"),
        (lambda fit: fit["covariance"].pop(), "fit.covariance"),
        (lambda fit: fit["covariance"][0].pop(), "fit.covariance"),
        (lambda fit: fit["covariance"][0].__setitem__(0, -1.0), "fit.covariance"),
        (lambda fit: fit["covariance"][0].__setitem__(1, 1.0), "fit.covariance"),
        (lambda fit: fit.update(reference_speed=-1.0), "fit.reference_speed"),
        (lambda fit: fit.update(reference_speed=float("nan")), "fit.reference_speed"),
        (lambda fit: fit.update(reference_temperature=None), "fit.reference_temperature"),
        (lambda fit: fit.update(temperature_range=None), "fit.temperature_range"),
        (lambda fit: fit.update(speed_range=[2.0, 1.0]), "fit.speed_range"),
        (lambda fit: fit.update(temperature_scale="degF"), "fit.temperature_scale"),
        (lambda fit: fit.update(transition=None), "fit.values"),
        (lambda fit: fit.update(points=5), "fit.points"),
        (lambda fit: fit["coefficients"].pop("a"), "fit.coefficients"),
        (lambda fit: fit["transition"]["mixed_exponent"].update(value=-1.1), "fit.transition.mixed_exponent"),
    ],
)
def test_a_broken_fit_is_refused_by_file_and_field(
    fit_json: Path, tmp_path: Path, change: Any, field: str
) -> None:
    document = json.loads(fit_json.read_text())
    change(document["fit"])
    path = tmp_path / "broken.json"
    path.write_text(json.dumps(document))
    with pytest.raises(ParameterError) as caught:
        read_fit(path)
    assert str(caught.value).startswith(f"broken.json: {field}")
    assert "\n" not in str(caught.value)


def test_what_is_no_fit_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "fit.json"
    for text in ("", "{", "[]", "{}", '"fit"', "[" * 100_000, "time,torque\n1,2\n"):
        path.write_text(text)
        with pytest.raises(ParameterError, match=r"^fit\.json: "):
            read_fit(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ParameterError, match=r"^fit\.json(: | is )"):
        read_fit(path)
    with pytest.raises(MissingFileError, match="File not found"):
        read_fit(tmp_path / "none.json")
    with pytest.raises(MissingFileError, match=r"is a folder. Name a file in it"):
        read_fit(tmp_path)


def test_the_command_maps_a_fit_and_overwrites_nothing(fit_json: Path, tmp_path: Path) -> None:
    machine = ROOT / "tests" / "stand" / "machine.toml"
    first = run("map", machine, "--fit", fit_json, cwd=tmp_path)
    assert first.returncode == 0, first.stderr
    assert "thick paper (45 mm/s, 180 °C" in first.stdout
    assert first.stdout.endswith("\nmap.html\n")
    assert [p.name for p in tmp_path.iterdir()] == ["map.html"]
    refused = run("map", machine, "--fit", fit_json, cwd=tmp_path)
    assert (refused.returncode, "--force" in refused.stderr) == (2, True)
    printed = run("map", machine, "--fit", fit_json, "--json", cwd=tmp_path)
    assert json.loads(printed.stdout)["limited_by"] == "grip"


def test_the_command_refuses_what_it_cannot_use(fit_json: Path, bench_csv: Path, tmp_path: Path) -> None:
    machine = ROOT / "tests" / "stand" / "machine.toml"
    for arguments, message in (
        ((machine,), "name a LOG, or give --fit"),
        ((machine, bench_csv, "--fit", fit_json), "name a LOG, or give --fit"),
        ((machine, "--fit", fit_json, "--tare", "standing"), "omit the options"),
        ((machine, "--fit", fit_json, "--out", "map.jpg"), "ends in .html"),
        ((machine, "--fit", fit_json, "--out", fit_json.with_suffix(".svg") / "a.svg"), "no directory"),
        ((machine, "--fit", machine), "machine.toml: document: not valid JSON"),
        ((tmp_path / "none.toml", bench_csv), "File not found"),
    ):
        result = run("map", *arguments, cwd=tmp_path)
        assert (result.returncode, result.stderr.count("\n")) == (2, 1), result.stderr
        assert message in result.stderr
    assert list(tmp_path.iterdir()) == []
