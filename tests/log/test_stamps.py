"""Time stamps in blocks, and clocks that count from a known day."""

from __future__ import annotations

import numpy as np
import polars as pl
import pytest

from hersey.log.text.stamps import Stamps, counted_since, is_clock_name, is_stamp, stamp_style


def stamps_of(*cells: str) -> Stamps:
    style = stamp_style(list(cells))
    assert style is not None
    return Stamps(style)


def seconds(stamps: Stamps, *cells: str | None) -> list[float]:
    found = stamps.values(pl.Series(cells, dtype=pl.String))
    assert found is not None
    return found.tolist()


def test_midnights_are_kept_from_block_to_block() -> None:
    stamps = stamps_of("23:59:58")
    assert seconds(stamps, "23:59:58", "23:59:59") == [0.0, 1.0]
    assert seconds(stamps, "00:00:01", "00:00:02") == [3.0, 4.0]
    assert stamps.midnights == 1
    assert seconds(stamps, "00:00:03", "23:59:59") == [5.0, 86401.0]
    assert seconds(stamps, "00:00:00", "00:00:01") == [86402.0, 86403.0]
    assert seconds(stamps, "00:00:02") == [86404.0]
    assert stamps.midnights == 2
    warning = stamps.warning("Clock")
    assert (warning.kind, warning.values["midnights"]) == ("time stamps read", 2)
    assert (
        str(warning)
        == "'Clock' contains a time of day and was read as seconds since 23:59:58, with 2 changes of day"
    )


def test_two_midnights_in_one_block() -> None:
    stamps = stamps_of("18:00:00")
    times = seconds(stamps, "18:00:00", "02:00:00", "12:00:00", "20:00:00", "01:00:00")
    assert times == [0.0, 28800.0, 64800.0, 93600.0, 111600.0]
    assert stamps.midnights == 2


def test_a_small_step_back_is_no_midnight() -> None:
    assert seconds(stamps_of("14:00:00"), "14:00:00", "13:59:59", "02:00:01") == [0.0, -1.0, -43199.0]


def test_a_block_of_missing_stamps_changes_nothing() -> None:
    stamps = stamps_of("23:59:58")
    assert np.isnan(seconds(stamps, "", None)).all()
    assert stamps.first is None
    assert seconds(stamps, "", "23:59:59")[1] == 0.0
    assert np.isnan(seconds(stamps, "", "")).all()
    assert seconds(stamps, "00:00:01", "") == pytest.approx([2.0, np.nan], nan_ok=True)


@pytest.mark.parametrize(
    ("cells", "times", "says"),
    [
        (
            ("2026-03-01 23:59:59.5", "2026-03-02 00:00:00,25"),
            [0.0, 0.75],
            "an ISO date and was read as seconds since 2026-03-01 23:59:59",
        ),
        (
            ("2026/3/1T12:00:00", "2026/3/1T12:01:00"),
            [0.0, 60.0],
            "an ISO date and was read as seconds since 2026-03-01 12:00:00",
        ),
        (
            ("2026-03-01T12:00:00+01:00", "2026-03-01T12:00:00Z", "2026-03-01T12:00:00 -0130"),
            [0.0, 3600.0, 9000.0],
            "an ISO date and was read as seconds since 2026-03-01 11:00:00",
        ),
        (
            ("1.3.2026 12:00:00", "02.03.2026 12:00:01"),
            [0.0, 86401.0],
            "a German date and was read as seconds since 2026-03-01 12:00:00",
        ),
        (
            ("1-Mar-2026 12:00:00", "02 march 2026 12:00:01", "03-MAR-2026 12:00:01.5"),
            [0.0, 86401.0, 172801.5],
            "a date with the month's name and was read as seconds since 2026-03-01 12:00:00",
        ),
    ],
)
def test_dates(cells: tuple[str, ...], times: list[float], says: str) -> None:
    stamps = stamps_of(*cells)
    assert seconds(stamps, *cells) == pytest.approx(times, abs=1e-6)
    assert str(stamps.warning("t")) == f"'t' contains {says}"


@pytest.mark.parametrize(
    ("cells", "times"),
    [
        (("59:59.8", "59:59.9", "00:00.0", "0:00.1"), [0.0, 0.1, 0.2, 0.3]),  # Excel shows no hours
        (("59:59,8", "00:00,0"), [0.0, 0.2]),
        (("59:59.5", "60:00.0", "100:00.0"), [0.0, 0.5, 2400.5]),
        (("0:00", "0:01", "1:00"), [0.0, 1.0, 60.0]),
        (("0:01:30", "00:01:30,5", "24:00:00", "25:00:00"), [0.0, 0.5, 86310.0, 89910.0]),
        (("00:00:01:500", "00:00:02:000"), [0.0, 0.5]),
        (("0 days 00:00:00.050000", "1 days 00:00:00"), [0.0, 86399.95]),
    ],
)
def test_clocks_without_a_date(cells: tuple[str, ...], times: list[float]) -> None:
    stamps = stamps_of(*cells)
    assert all(map(is_stamp, cells))
    assert seconds(stamps, *cells) == pytest.approx(times, abs=1e-6)
    assert (stamps.warning("t").severity == "watch") == ("." not in "".join(cells) and cells[0] == "0:00")


def test_changes_of_hour_are_counted() -> None:
    stamps = stamps_of("59:59.8")
    assert seconds(stamps, "59:59.8", "00:00.0") == pytest.approx([0.0, 0.2])
    assert seconds(stamps, "59:59.8", "00:00.0") == pytest.approx([3600.0, 3600.2])
    warning = stamps.warning("t")
    assert (warning.values["midnights"], warning.values["period"]) == (2, "hour")


def test_what_is_no_stamp() -> None:
    assert is_stamp("12:00:00.5")
    assert not is_stamp("12:0")
    assert not is_stamp("12:00,")
    assert not is_stamp("12.5")
    assert stamp_style(["12:00:00", "12:00:01", "x"]) is not None
    assert stamp_style(["12:00:00", "x"]) is None
    assert stamps_of("12:00:00").values(pl.Series(["12:00:00", "late"])) is None


def test_counts_since_1970_show_by_their_size() -> None:
    for scale, unit in ((1e9, "s"), (1e12, "ms"), (1e15, "us"), (1e18, "ns")):
        since = 1.7 * scale + np.arange(3.0)
        assert counted_since("Unix time", since) == (unit, f"{unit} since 1970")
        assert counted_since("torque", since) == ("", "")
    assert counted_since("time", np.array([2.49e9])) == ("s", "s since 1970")
    assert counted_since("time", np.array([2.51e9])) == ("", "")
    assert counted_since("time", np.array([0.9e9, 1.1e9])) == ("", "")
    assert counted_since("time", np.array([np.nan])) == ("", "")


def test_days_of_excel_need_the_name_of_a_date() -> None:
    days = np.array([45000.0, np.nan, 45000.1])
    assert counted_since("Datum", days) == ("d", "Excel days")
    assert counted_since("time", days) == ("", "")
    assert counted_since("Datum", np.array([2e4, 45000.0])) == ("", "")
    assert counted_since("Datum", np.array([45000.0, 7.1e4])) == ("", "")
    assert is_clock_name("Zeit")
    assert is_clock_name("serial")
    assert not is_clock_name("torque")


def test_a_millionth_of_a_day_of_excel_is_86_ms() -> None:
    wincc = 45356333333.333 + np.arange(5) / 0.0864 * 0.2
    assert counted_since("Time", wincc) == ("86.4 ms", "Excel days times a million")
    assert counted_since("torque", wincc) == ("", "")
