"""Each slip as a warning: its runs, specimens, ages and factor, and the words made of them."""

from __future__ import annotations

from typing import Any

from hersey.errors import FORCE
from hersey.life.diagnostics import slips
from hersey.life.diagnostics.measured import MeasuredRuns
from hersey.life.diagnostics.slips import Slip
from hersey.schema.warning import Warning


def warning_of(runs: MeasuredRuns, slip: Slip) -> Warning:
    """Return a slip as a warning; its ``factor`` is what multiplied the right ages or torques."""
    first, last = slip.runs[0], slip.runs[-1]
    of_run = {"unit": runs.unit[first], "run": runs.number[first], "age": float(runs.age[first])}
    other = {
        "other_unit": runs.unit[last],
        "other_run": runs.number[last],
        "other_age": float(runs.age[last]),
    }
    values: dict[str, Any] = {**of_run, "age_unit": runs.age_unit, "how": FORCE}
    of_factor = {"factor": slip.factor, "times": max(slip.factor, 1.0 / slip.factor)}
    if slip.kind == slips.EXCHANGED:
        return _exchanged(values | other)
    if slip.kind == slips.REORDERED:
        return _reordered(values | other)
    if slip.kind == slips.SAME:
        return _same(values | other)
    if slip.kind in (slips.AGES, slips.TORQUES):
        whole = {"unit": of_run["unit"], "how": FORCE, "runs": len(slip.runs), **of_factor}
        return (_ages if slip.kind == slips.AGES else _torques)(whole)
    if slip.kind == slips.AGE:
        return _age(values | of_factor)
    if slip.kind == slips.TORQUE:
        return _torque(values | of_factor)
    return _machine(values | of_factor) if slip.kind == slips.MACHINE else _lubricant(values)


def _exchanged(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.EXCHANGED,
        "logs of {unit} and {other_unit} at {age:.10g} {age_unit} look exchanged"
        if values["age"] == values["other_age"]
        else "logs of {unit} at {age:.10g} and {other_unit} at {other_age:.10g} {age_unit} look exchanged",
        remedy="if they are, add both again with the right specimens and {how}",
        severity="act",
        **values,
    )


def _reordered(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.REORDERED,
        "logs of {unit} at {age:.10g} and {other_age:.10g} {age_unit} look exchanged",
        remedy="if they are, add both again with the right ages and {how}",
        severity="act",
        **values,
    )


def _same(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.SAME,
        "logs of {unit} at {age:.10g} {age_unit} and {other_unit} at {other_age:.10g} {age_unit} "
        "hold the same torques",
        remedy="one is a copy: replace it by the right log, and add that with {how}",
        severity="act",
        **values,
    )


def _ages(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.AGES,
        "ages of {unit} look {times:.4g} times smaller than those of the others"
        if values["factor"] < 1.0
        else "ages of {unit} look {times:.4g} times larger than those of the others",
        remedy="if they are, add its logs again with the right ages and {how}",
        severity="act",
        **values,
    )


def _age(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.AGE,
        "the age of {unit} in run {run}, {age:.10g} {age_unit}, looks {times:.4g} times too small"
        if values["factor"] < 1.0
        else "the age of {unit} in run {run}, {age:.10g} {age_unit}, looks {times:.4g} times too large",
        remedy="if it is, add the log again with the right age and {how}",
        severity="act",
        **values,
    )


def _torque(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.TORQUE,
        "torque of {unit} at {age:.10g} {age_unit} looks {times:.4g} times too small, as in other units"
        if values["factor"] < 1.0
        else "torque of {unit} at {age:.10g} {age_unit} looks {times:.4g} times too large, as in other units",
        remedy="if it is, add the log again with the right unit and {how}",
        severity="act",
        **values,
    )


def _torques(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.TORQUES,
        "torques of {unit} look {times:.4g} times smaller than those of the others, as in another unit"
        if values["factor"] < 1.0
        else "torques of {unit} look {times:.4g} times larger than those of the others, as in another unit",
        remedy="if they are, add its logs again with the right unit and {how}",
        severity="act",
        **values,
    )


def _machine(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.MACHINE,
        "torque of {unit} at {age:.10g} {age_unit} is {factor:.3g} times what its other runs show, "
        "at all speeds and temperatures alike, as on another machine",
        remedy="check where the log is from; if it is wrong, add the right one with {how}",
        severity="act",
        **values,
    )


def _lubricant(values: dict[str, Any]) -> Warning:
    return Warning(
        slips.LUBRICANT,
        "torque of {unit} at {age:.10g} {age_unit} depends on speed and temperature otherwise than in its "
        "other runs, as with another lubricant or on another machine",
        remedy="check where the log is from; if it is wrong, add the right one with {how}",
        severity="act",
        **values,
    )
