"""What is not known of a parameter, and what changes with time: numbers by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator

from hersey.errors import ParameterError, UnitError
from hersey.machine.uncertainty import Uncertainty, read_uncertainty
from hersey.motion.schedule import Schedule


def test_a_share_is_lognormal() -> None:
    drawn = Uncertainty(share=0.2).draw(np.random.default_rng(3), 7.0, 5)
    normal = np.random.default_rng(3).standard_normal(5)
    np.testing.assert_allclose(drawn, 7.0 * 1.2 ** (normal / 1.96), rtol=1e-12)
    many = Uncertainty(share=0.2).draw(np.random.default_rng(4), 7.0, 40_000)
    assert np.mean((many > 7.0 / 1.2) & (many < 7.0 * 1.2)) == pytest.approx(0.95, abs=0.004)
    assert np.median(many) == pytest.approx(7.0, rel=0.005)
    below = Uncertainty(share=0.2).draw(np.random.default_rng(3), -7.0, 5)
    np.testing.assert_allclose(below, -drawn, rtol=1e-12)


def test_a_range_is_even_in_logarithms() -> None:
    drawn = Uncertainty(limits=(1e-4, 1e-2)).draw(np.random.default_rng(3), 5.0, 6)
    even = np.random.default_rng(3).uniform(size=6)
    np.testing.assert_allclose(drawn, 10 ** (-4 + 2 * even), rtol=1e-12)
    negative = Uncertainty(limits=(-0.75, -0.65)).draw(np.random.default_rng(3), 0.0, 6)
    np.testing.assert_allclose(negative, -0.75 * (0.65 / 0.75) ** even, rtol=1e-12)


def test_draws_follow_the_generator() -> None:
    for spread in (Uncertainty(share=0.1), Uncertainty(limits=(1.0, 2.0))):
        one, other = (spread.draw(np.random.default_rng(seed), 1.0, 4) for seed in (1, 2))
        assert not np.any(one == other)


@pytest.mark.parametrize(
    ("parameter", "text", "expected"),
    [
        ("mass", "10 %", Uncertainty(share=0.1)),
        ("mass", "± 2.5%", Uncertainty(share=0.025)),
        ("mass", "+/- 20 %", Uncertainty(share=0.2)),
        ("stiffness", "1 N/mm to 2 N/mm", Uncertainty(limits=(1000.0, 2000.0))),
        ("stick_speed", "0.1 mm/s  to  1 mm/s", Uncertainty(limits=(1e-4, 1e-3))),
        ("transition_force", "2 N to 30 N", Uncertainty(limits=(2.0, 30.0))),
        ("ehl_exponent", "-0.75 to -0.65", Uncertainty(limits=(-0.75, -0.65))),
        ("mixed_exponent", "-1.5 to -1.1", Uncertainty(limits=(-1.5, -1.1))),
    ],
)
def test_spreads_as_people_write_them(parameter: str, text: str, expected: Uncertainty) -> None:
    found = read_uncertainty(parameter, text)
    assert found.share == pytest.approx(expected.share)
    assert found.limits == pytest.approx(expected.limits)


@pytest.mark.parametrize(
    ("parameter", "text", "words"),
    [
        ("weight", "10 %", "there is no such parameter"),
        ("mass", 0.1, "it is 0.1. Write a string such as '10 %'"),
        ("mass", "0 %", "'0 %' is not a share"),
        ("mass", "1.2.3 %", "'1.2.3 %' is not a share"),
        ("mass", "10", "'10' is neither a share"),
        (
            "mass",
            "2 kg to 1 kg",
            "begins with its upper end. Write '1 kg to 2 kg'",
        ),
        ("mass", "1 kg to 1 kg", "give the lower end first"),
        ("ehl_exponent", "-0.5 to 0.5", "both ends on the same side of 0"),
        ("ehl_exponent", "low to high", "is not a range of two numbers"),
    ],
)
def test_spreads_that_cannot_be(parameter: str, text: object, words: str) -> None:
    with pytest.raises(ParameterError) as caught:
        read_uncertainty(parameter, text)
    assert words in str(caught.value)


def test_a_range_in_the_wrong_unit() -> None:
    with pytest.raises(UnitError):
        read_uncertainty("mass", "1 mm to 2 mm")


def test_either_share_or_limits() -> None:
    for given in ({}, {"share": 0.1, "limits": (1.0, 2.0)}):
        with pytest.raises(ParameterError, match=r"^give either share or limits$"):
            Uncertainty(**given)  # type: ignore[arg-type]
    with pytest.raises(ParameterError, match=r"^share is 0: it must be greater than 0$"):
        Uncertainty(share=0)
    with pytest.raises(ParameterError, match="share is 100"):
        Uncertainty(share=100.0)
    with pytest.raises(ParameterError, match="lower end first"):
        Uncertainty(limits=(1.0, float("inf")))


TIMES, VALUES = [1.0, 2.0, 2.0, 4.0], [3.0, 5.0, 1.0, 2.0]


def test_straight_lines_held_at_the_ends() -> None:
    course = Schedule(TIMES, VALUES)
    at = [course.at(t) for t in (-5.0, 0.0, 1.0, 1.25, 1.999999, 3.0, 4.0, 9.0)]
    assert at == pytest.approx([3.0, 3.0, 3.0, 3.5, 5.0, 1.5, 2.0, 2.0], abs=1e-5)
    assert course.first == 3.0
    assert Schedule([-1.0, 1.0], [0.0, 4.0]).first == 2.0
    assert course.arguments == (TIMES, VALUES, None)


def test_smooth_without_overshoot() -> None:
    times, values = [0.0, 1.0, 3.0, 4.0], [0.0, 1.0, 1.0, 5.0]
    course, truth = Schedule(times, values, smooth=True), PchipInterpolator(times, values)
    for t in (0.3, 0.9, 2.0, 3.6):
        assert course.at(t) == pytest.approx(float(truth(t)), rel=1e-12)
    assert (course.at(-1.0), course.at(7.0)) == (0.0, 5.0)
    given_times, given_values, cubics = course.arguments
    assert (given_times, given_values) == (times, values)
    assert cubics is not None
    for i, row in enumerate(cubics):  # coefficients from the constant up, from the start of each piece
        x = 0.4 * (times[i + 1] - times[i])
        assert sum(c * x**k for k, c in enumerate(row)) == pytest.approx(
            float(truth(times[i] + x)), rel=1e-12
        )


def test_shifted_values() -> None:
    moved = Schedule(TIMES, VALUES).shifted(-2.0)
    assert np.asarray(moved.values).tolist() == [1.0, 3.0, -1.0, 0.0]
    assert np.asarray(moved.times).tolist() == TIMES
    assert Schedule([0, 1], [2, 3], smooth=True).shifted(1.0).smooth


def test_a_number_is_a_schedule_that_stays() -> None:
    held = Schedule.of(4)
    assert (held.at(-3.0), held.at(8.0)) == (4.0, 4.0)
    assert Schedule.of(held) is held


@pytest.mark.parametrize(
    ("times", "values", "smooth", "words"),
    [
        ([0, 1], [1], False, "schedule: 2 times, but 1 values"),
        ([], [], False, "schedule: there are no points"),
        ([0, np.nan], [1, 2], False, "schedule: a number is not finite"),
        ([0, 1], [1, np.inf], False, "schedule: a number is not finite"),
        ([0, 2, 1], [1, 1, 1], False, "schedule: times must ascend, but 1.0 follows 2.0"),
        ([0, 1, 1], [1, 2, 3], True, "schedule: times must ascend, but 1.0 follows 1.0"),
        ([0], [1], True, "schedule: a smooth schedule needs two points"),
    ],
)
def test_schedules_that_cannot_be(times: list[float], values: list[float], smooth: bool, words: str) -> None:
    with pytest.raises(ParameterError) as caught:
        Schedule(times, values, smooth)
    assert str(caught.value) == words
