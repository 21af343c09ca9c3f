"""The charts of a life test, by name, in the order of its page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from hersey.charts import chart_of
from hersey.charts.life_failures import failures_chart
from hersey.charts.render import write_pictures
from hersey.charts.style import Chart, unchecked

if TYPE_CHECKING:
    from hersey.life.following import LifeTest

#: Failure modes whose growth is drawn, the likeliest first.
_GROWN = 3


def life_charts(answer: LifeTest) -> dict[str, Chart]:
    """Return the charts of a life test."""
    found = answer.time_to_failure
    likely = sorted(
        found.modes, key=lambda mode: -sum(each.first.get(mode.name, 0.0) for each in found.units)
    )
    with unchecked():
        made = {"ends": chart_of(found)}
        for number, mode in enumerate(likely[:_GROWN], 1):
            made[f"growth_{number}"] = chart_of(
                mode.growth, ages=mode.ages, si=mode.si, stretches=mode.stretches
            )
        for name in ("drift", "film", "maps"):
            if (part := getattr(answer, name)) is not None:
                made[name] = chart_of(part)
        if found.curve is not None:
            made["population"] = failures_chart(found.units, found.curve, found.age_unit)
        if found.replacement is not None:
            made["replacement"] = chart_of(found.replacement)
    return made


def life_chart(answer: LifeTest) -> Chart:
    """Return the chart of the time to failure of each specimen."""
    return chart_of(answer.time_to_failure)


def write_life_figures(answer: LifeTest, folder: Path, *, overwrite: bool = True) -> list[Path]:
    """Write every chart as SVG, PNG and PDF and return the paths; all are drawn before one is written."""
    return write_pictures(life_charts(answer), folder, overwrite=overwrite)
