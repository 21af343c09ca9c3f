"""An age: a number and what it counts."""

from __future__ import annotations

import sys

import pytest

from hersey.errors import ParameterError, UnitError
from hersey.life.age import COUNTS, Age
from hersey.units import conversion
from tests.cli.command import run_apart
from tests.conftest import ROOT


@pytest.mark.parametrize(
    ("text", "value", "unit"),
    [
        ("120000 pages", 120000.0, "pages"),
        ("2e6cycles", 2e6, "cycles"),
        (" 310 h ", 310.0, "h"),
        ("0 pages", 0.0, "pages"),
        ("1 A4-page", 1.0, "A4-page"),
    ],
)
def test_an_age_is_read(text: str, value: float, unit: str) -> None:
    assert Age.parse(text) == Age(value, unit)


def test_a_bare_number_takes_the_unit_of_the_heading() -> None:
    assert Age.parse("7", "pages") == Age(7.0, "pages")
    assert Age.parse("7 h", "pages") == Age(7.0, "h")


@pytest.mark.parametrize(
    "text", ["", "pages", "-1 pages", "1e999 h", "12,000 pages", "1.2.3 h", "nan h", "inf h"]
)
def test_what_is_no_age_is_refused(text: str) -> None:
    with pytest.raises(ParameterError):
        Age.parse(text)


@pytest.mark.parametrize(
    ("text", "ways"),
    [
        ("980,25", "'98025' or '980.25'"),
        ("1.250,5 h", "'12505 h' or '1250.5 h'"),
        ("120,000 pages", "'120000 pages' or '120 pages'"),
        ("1,234 pages", "'1234 pages' or '1.2340 pages'"),
        ("1 200 h", "'1200 h'"),
        ("1.250.000", "'1250000'"),
    ],
)
def test_separators_between_digits_are_refused_with_what_to_write(text: str, ways: str) -> None:
    with pytest.raises(ParameterError) as caught:
        Age.parse(text, "h")
    assert str(caught.value) == f"age '{text}' has separators between its digits. Write {ways}"
    for way in ways.split(" or "):
        assert Age.parse(way.strip("'"), "h").value > 0


@pytest.mark.parametrize("text", [".5,000 pages", "5.,000 pages", "-5,000 pages"])
def test_separators_that_say_nothing_are_answered_with_the_form_of_an_age(text: str) -> None:
    with pytest.raises(ParameterError) as caught:
        Age.parse(text)
    assert str(caught.value) == (
        f"age '{text}' is not a number with a unit. Write a number and what it counts, "
        "e.g. '120000 pages', '310 h' or '2e6 cycles'"
    )


@pytest.mark.parametrize("text", ["120000", "5 %", "5 pages per day", "5 /h", "5 " + 60 * "p", "5 \x1b[2J"])
def test_an_age_without_a_unit_that_is_a_word_is_refused(text: str) -> None:
    with pytest.raises(UnitError):
        Age.parse(text)


def test_times_are_converted_and_other_words_are_not() -> None:
    assert Age.parse("90 min").as_unit("h") == Age(1.5, "h")
    assert Age.parse("1 day").as_unit("h") == Age(24.0, "h")
    assert Age.parse("1 page").as_unit("pages") == Age(1.0, "pages")
    assert Age.parse("310 h").as_unit("h").value == 310.0
    for one, other in (("5 pages", "h"), ("5 h", "pages"), ("5 pages", "prints"), ("5 cycles", "pages")):
        with pytest.raises(UnitError, match=f"Give it in {other}"):
            Age.parse(one).as_unit(other)


@pytest.mark.parametrize(
    ("text", "ways"),
    [
        ("120.000 pages", ("120000 pages", "120 pages")),
        ("35.500 cycles", ("35500 cycles", "35.5 cycles")),
        ("1.125 kpages", ("1125 kpages", "1.1250 kpages")),
    ],
)
def test_a_point_that_may_stand_between_thousands_is_asked_about(text: str, ways: tuple[str, str]) -> None:
    with pytest.raises(ParameterError, match=f"Write '{ways[0]}' or '{ways[1]}'"):
        Age.parse(text)
    assert [Age.parse(way).value for way in ways] == [float(way.split()[0]) for way in ways]


def test_what_reads_in_one_way_is_read() -> None:
    for text, value in (
        ("0.125 kpages", 0.125),
        ("1.5 kpages", 1.5),
        ("1.125 h", 1.125),
        ("1.250 km", 1.25),
        ("1234.125 pages", 1234.125),
    ):
        assert Age.parse(text).value == value


@pytest.mark.parametrize("word", sorted(COUNTS | {f"{each}s" for each in COUNTS}))
def test_what_is_counted_is_no_time(word: str) -> None:
    with pytest.raises(UnitError):
        conversion("time", word)


def test_ages_that_count_alike_are_compared_without_pint() -> None:
    asked = """
import sys
from hersey.life.age import Age, one_of
assert Age(7.0, "bananas").as_unit("bananas") == Age(7.0, "bananas")
assert Age(7.0, "page").as_unit("pages") == Age(7.0, "pages")
assert one_of("pages") == "page"
assert "pint" not in sys.modules
"""
    done = run_apart("-c", asked, cwd=ROOT, command=[sys.executable])
    assert done.returncode == 0, done.stderr
