"""Tables of failures and suspensions: what is read, and what is refused with file, line and column."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import hersey
from hersey.errors import ChannelError, HerseyError
from hersey.life.failures.table import read_fleet


def table(folder: Path, text: str) -> Path:
    path = folder / "failures.csv"
    path.write_text(text, encoding="utf-8")
    return path


def ends(path: Path) -> list[tuple[float, float, int]]:
    found = hersey.read_failures(path)
    return list(zip(found.low.tolist(), found.high.tolist(), found.count.tolist(), strict=True))


@pytest.mark.parametrize(
    "text",
    [
        "age [h],status,count\n10,failed,1\n20,running,3\n30,left,2\n",
        "Age (h);Event;Number\n10;F;1\n20;S;3\n30;before;2\n",
        "unit\tage\tstatus\tcount\nU1\t10 h\tfailed\t1\nU2\t20 h\tsuspended\t3\nU3\t30 h\tleft\t2\n",
        "low [h],high [h],count\n10,10,1\n20,,3\n,30,2\n",
        "last good,first failed,count\n600 min,10 h,1\n20 h,,3\n0 h,30 h,2\n",
    ],
)
def test_ages_exact_at_least_and_at_most(text: str, tmp_path: Path) -> None:
    path = table(tmp_path, text)
    found = ends(path)
    if "min" in text:  # the first unit is that of all
        found = [(low / 60, high / 60, count) for low, high, count in found]
    assert found == [(10, 10, 1), (20, math.inf, 3), (0, 30, 2)]


#: Sheets of other programs, with the same specimens: one failed, three that run, two found failed.
SHEETS = {
    "Minitab": "Hours,Cens,Freq\n10,F,1\n20,C,3\n30,left,2\n",
    "Minitab, arbitrary": "Start [h],End [h],Frequency\n10,10,1\n20,*,3\n*,30,2\n",
    "Weibull++": "Number in State,Last Inspected (h),State F or S,State End Time\n"
    "1,10,F,10\n3,0,S,20\n2,0,F,30\n",
    "R": '"","time [h]","event","n"\n"1",10,1,1\n"2",20,0,3\n"3",30,left,2\n',
    "R, both ends": "left [h],right,n\n10,10,1\n20,Inf,3\nNA,30,2\n",
}


@pytest.mark.parametrize("program", SHEETS)
def test_sheets_of_other_programs(program: str, tmp_path: Path) -> None:
    path = table(tmp_path, SHEETS[program])
    assert ends(path) == [(10, 10, 1), (20, math.inf, 3), (0, 30, 2)]
    assert hersey.read_failures(path).unit == ("hours" if program == "Minitab" else "h")


def test_numbers_of_rows_are_no_count_of_specimens(tmp_path: Path) -> None:
    text = "{},start,time [h],status\n1,5,100,F\n2,5,200,F\n3,5,300,S\n"
    with pytest.raises(ChannelError, match="column 'n' numbers the rows or counts specimens") as error:
        ends(table(tmp_path, text.format("n")))
    assert error.value.remedy == "name it 'id' or 'count'"
    assert ends(table(tmp_path, text.format("id"))) == [(100, 100, 1), (200, 200, 1), (300, math.inf, 1)]
    assert ends(table(tmp_path, text.format("count")))[2] == (300, math.inf, 3)


def test_own_names_go_before_those_of_other_programs(tmp_path: Path) -> None:
    text = "time,start,end,age [h],status,cens,n,count\n1,2,3,10,failed,S,7,1\n1,2,3,20,running,F,7,3\n"
    assert ends(table(tmp_path, text)) == [(10, 10, 1), (20, math.inf, 3)]


def test_one_and_zero_of_a_status_are_asked_about_and_the_advice_helps(tmp_path: Path) -> None:
    text = "time [h],status\n10,1\n20,0\n"
    with pytest.raises(HerseyError) as caught:
        ends(table(tmp_path, text))
    assert "line 2, column 'status' is '1': write failed or running in each row, or name the column" in str(
        caught.value
    )
    for name, failed in (("failed", 10.0), ("censored", 20.0)):
        assert f"'{name}' if 1 means" in str(caught.value)
        found = hersey.read_failures(table(tmp_path, text.replace("status", name)))
        assert found.low[found.failed].tolist() == [failed]


def test_failed_and_censored_say_it_too(tmp_path: Path) -> None:
    expected = [(10.0, 10.0, 1), (20.0, math.inf, 1)]
    for text in (
        "age [h],failed\n10,1\n20,0\n",
        "age [h],censored\n10,no\n20,yes\n",
        "age [h],mode\n10,wear\n20,\n",
        ",age [h],failed,count\n0,10.0,1.0,1.0\n1,20.0,0.0,1.0\n",
        "age [h],status\n,\n10,failed\n\n20,running\n , \n",
    ):
        assert ends(table(tmp_path, text)) == expected


def test_failure_modes_and_stress(tmp_path: Path) -> None:
    path = table(
        tmp_path,
        "age [h],status,mode,temperature [degC]\n10,failed,wear,80\n20,running,,60\n15,failed,seizure,60\n",
    )
    found = hersey.read_failures(path, arrhenius="temperature", use="40 degC")
    assert found.mode == ("wear", "", "seizure")
    assert found.modes == ("seizure", "wear")
    assert found.stress is not None
    assert found.stress.tolist() == pytest.approx([353.15, 333.15, 333.15])
    assert (found.relation, found.use) == ("arrhenius", pytest.approx(313.15))
    wear = found.of_mode("wear")
    assert (wear.failures, wear.low.tolist()) == (1, [10, 20, 15])


def test_a_failure_between_inspections_by_another_mode_outlived_the_first_one(tmp_path: Path) -> None:
    path = table(tmp_path, "low [h],high [h],mode\n10,20,wear\n30,40,seizure\n,50,seizure\n")
    wear = hersey.read_failures(path).of_mode("wear")
    assert (wear.low.tolist(), wear.high.tolist()) == ([10, 30], [20, math.inf])


#: Text of a table, and what is said of it.
REFUSED = {
    "age,status\n10,failed\n": "failures.csv, line 2, column 'age': age '10' has no unit",
    "Time,Event\n10,1\n": "line 2, column 'Time': age '10' has no unit",
    "age [h],failed\n10,F\n": "line 2, column 'failed' is 'F': write yes or no",
    "start [h],end [h],status\n10,,F\n": "line 2, column 'end' is empty, but it failed. Fill it in",
    "age status\n10 F\n": "'age status'. Separate columns by commas, e.g. 'age,status'",
    "Time [h],n,Lifetime (h),status\n9,1,9,F\n": "columns 'Time [h]' and 'Lifetime (h)' both say the age",
    "age [h]\n10\n": "failures.csv: no column says which specimens failed. Columns: 'age [h]'",
    "duration,status\n10,failed\n": "failures.csv: there is no column 'age'. Columns: 'duration', 'status'",
    "low [h]\n10\n": "failures.csv: there is no column 'high'. Columns: 'low [h]'",
    "age [h],low [h],high [h]\n1,1,1\n": "columns of 'age' and of 'low' or 'high'",
    "age [h],status,failed\n1,failed,1\n": "column 'failed' says again which specimens failed",
    "age [h],status,event\n1,failed,1\n": "columns 'status' and 'event' both say the status",
    "age [h],status\n10,failed\n20,1\n": "line 3, column 'status' is '1': write failed or running",
    "age [h],status\n10,\n": "line 2, column 'status' is empty: write failed or running",
    "age [h],failed\n10,maybe\n": "line 2, column 'failed' is 'maybe': write yes or no",
    "age [h],status\n,failed\n": "line 2, column 'age' is empty. Fill it in",
    "age [h],status\nten,failed\n": "line 2, column 'age': age 'ten' is not a number",
    "age [h],status\n-3,failed\n": "line 2, column 'age': an age is -3 h: it must be 0 (new) or greater",
    "age [h],status\n0,failed\n": "line 2, column 'age': age 0 h must be greater than 0",
    "age,status\n10 h,failed\n20 pages,failed\n": "line 3, column 'age': an age is in pages",
    "age [pages],status\n1.500,failed\n": "line 2, column 'age': age '1.500 pages' can be read in two ways",
    "low [h],high [h]\n20,10\n": "line 2, column 'high': 10 h is less than low, 20 h. Swap them",
    "low [h],high [h],count\n,,3\n": "line 2: columns 'low' and 'high' are empty. Fill one in",
    "age [h],status,count\n10,failed,0\n": "line 2, column 'count' is '0': write a whole number",
    "age [h],status,count\n10,failed,2.5\n": "line 2, column 'count' is '2.5': write a whole number",
    "age [h],status,mode\n10,failed,\n": "line 2, column 'mode' is empty, but it failed",
    "age [h],status\n": "failures.csv lists no specimens",
    "": "there is no column 'age'. Line 1 is empty",
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_a_table_lacks_is_said_with_its_place(text: str, tmp_path: Path) -> None:
    with pytest.raises(HerseyError) as caught:
        hersey.read_failures(table(tmp_path, text))
    assert REFUSED[text] in str(caught.value)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"arrhenius": "heat", "use": "40 degC"}, "there is no column 'heat'"),
        ({"arrhenius": "count", "use": "40 degC"}, "there is no column 'count'"),
        ({"arrhenius": "bare", "use": "40 degC"}, "column 'bare' has no unit"),
        ({"arrhenius": "temperature"}, "arrhenius=... needs the stress of use"),
        ({"arrhenius": "temperature", "use": "40"}, "use=... is '40': write a number in degC"),
        ({"arrhenius": "temperature", "use": "-300 degC"}, "it must be above absolute zero"),
        ({"power": "load", "use": "3 kg"}, "write a number in N"),
        ({"power": "load", "use": "-3 N"}, "it must be greater than 0"),
        ({"use": "3 N"}, "needs the column of the stress"),
        ({"arrhenius": "temperature", "power": "load", "use": "3 N"}, "exclude each other"),
    ],
)
def test_what_a_stress_lacks_is_said(settings: dict[str, str], words: str, tmp_path: Path) -> None:
    path = table(
        tmp_path,
        "age [h],status,count,temperature [degC],load [N],bare\n10,failed,1,80,2,3\n20,running,1,60,3,3\n",
    )
    with pytest.raises(HerseyError) as caught:
        hersey.read_failures(path, **settings)
    said = f"{caught.value} {caught.value.remedy}".replace("arrhenius needs", "arrhenius=... needs")
    assert words in said.replace("use is", "use=... is")


def test_failures_at_one_stress_show_no_dependence(tmp_path: Path) -> None:
    path = table(tmp_path, "age [h],status,load [N]\n10,failed,2\n20,failed,2\n30,running,1\n")
    with pytest.raises(HerseyError, match="specimens failed at one stress only"):
        hersey.weibull(hersey.read_failures(path, power="load", use="1 N"))


def test_a_fleet_is_read_in_the_unit_of_the_law(tmp_path: Path) -> None:
    ages, count = read_fleet(table(tmp_path, "age,count\n60 min,5\n2 h,7\n"), "h")
    np.testing.assert_allclose(ages, [1.0, 2.0])
    assert count.tolist() == [5, 7]
    with pytest.raises(
        HerseyError, match="line 2, column 'age': an age is in pages, but the others are in h"
    ):
        read_fleet(table(tmp_path, "age\n3 pages\n"), "h")
    with pytest.raises(HerseyError, match="there is no column 'age'"):
        read_fleet(table(tmp_path, "count\n3\n"), "h")
