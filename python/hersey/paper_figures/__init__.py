"""The paper's Figs. 9 to 14 drawn anew and two of our own, each with claims and how well they hold.

==========  ====================================================================
sweep       what the paper varies; cycles along it; trends and their power laws
figure      a figure, its claims, their verdicts
judges      claims that a trend can bear out
panels      the charts that the figures are put together from
baseline    Fig. 9
trends      Figs. 10 to 12
hysteresis  Figs. 13 and 14
band        what lasts at each drive speed, and the edge between
chart       the band of any drive
files       writing them
==========  ====================================================================

Every verdict follows from numbers computed when the figure is made, by the criterion that stands beside it.
Units are the paper's: inches, ounces of force, seconds.
"""

from __future__ import annotations

from collections.abc import Callable

from hersey.charts.style import unchecked
from hersey.paper_figures.band import band_figure
from hersey.paper_figures.baseline import figure_9
from hersey.paper_figures.chart import chart_figure
from hersey.paper_figures.figure import Claim, Figure, OwnFigure, PaperFigure, Verdict
from hersey.paper_figures.files import as_json, markdown, write
from hersey.paper_figures.hysteresis import figure_13, figure_14
from hersey.paper_figures.trends import figure_10, figure_11, figure_12

__all__ = [
    "Claim",
    "Figure",
    "OwnFigure",
    "PaperFigure",
    "Verdict",
    "all_figures",
    "as_json",
    "band_figure",
    "chart_figure",
    "figure_9",
    "figure_10",
    "figure_11",
    "figure_12",
    "figure_13",
    "figure_14",
    "markdown",
    "own_figures",
    "paper_figures",
    "write",
]

#: In the order of the paper: a new figure joins here.
_MAKERS: tuple[Callable[[], PaperFigure], ...] = (
    figure_9,
    figure_10,
    figure_11,
    figure_12,
    figure_13,
    figure_14,
)


def paper_figures() -> tuple[PaperFigure, ...]:
    """Return the figures of the paper that are drawn anew."""
    return tuple(make() for make in _MAKERS)


def own_figures() -> tuple[OwnFigure, ...]:
    """Return the figures that go beyond the paper."""
    return band_figure(), chart_figure()


def all_figures() -> tuple[Figure, ...]:
    """Return the figures of the paper, then those beyond it."""
    with unchecked():
        return *paper_figures(), *own_figures()
