"""The paper's figures drawn anew and two of our own, each with claims and how well they hold.

Figs. 1 to 8 are drawn of a machine file and a log, in SI; Figs. 9 to 14 and our own of the paper's model,
in its units: inches, ounces of force, seconds.

=============  ====================================================================
sweep          what the paper varies; cycles along it; trends and their power laws
figure         a figure, its claims, their verdicts
judges         claims that a trend can bear out
panels         the charts that the figures are put together from
baseline       Fig. 9
trends         Figs. 10 to 12
hysteresis     Figs. 13 and 14
band           what lasts at each drive speed, and the edge between
chart          the band of any drive
measured       what Figs. 2 to 8 are drawn of: dwells, surface, branches
dwells         marks and lines of dwells
drawing        drawings to scale
cross_section  Fig. 1
torque         Fig. 2
damping        Figs. 3 and 7
temperature    Fig. 4
nip            Fig. 5
system         Fig. 6
friction       Fig. 8
drive          all of Figs. 1 to 8
files          writing them
=============  ====================================================================

Every verdict follows from numbers computed when the figure is made, by the criterion that stands beside it.
"""

from __future__ import annotations

from collections.abc import Callable

from hersey.charts.style import unchecked
from paper.band import band_figure
from paper.baseline import figure_9
from paper.chart import chart_figure
from paper.drive import drive_figures, shipped
from paper.figure import Claim, Figure, OwnFigure, PaperFigure, Verdict
from paper.files import as_json, markdown, write
from paper.hysteresis import figure_13, figure_14
from paper.measured import Measured
from paper.trends import figure_10, figure_11, figure_12

__all__ = [
    "Claim",
    "Figure",
    "Measured",
    "OwnFigure",
    "PaperFigure",
    "Verdict",
    "all_figures",
    "as_json",
    "band_figure",
    "chart_figure",
    "drive_figures",
    "figure_9",
    "figure_10",
    "figure_11",
    "figure_12",
    "figure_13",
    "figure_14",
    "markdown",
    "own_figures",
    "paper_figures",
    "shipped",
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
    """Return the figures of the paper that show its simulations."""
    return tuple(make() for make in _MAKERS)


def own_figures() -> tuple[OwnFigure, ...]:
    """Return the figures that go beyond the paper."""
    return band_figure(), chart_figure()


def all_figures() -> tuple[Figure, ...]:
    """Return the figures of the paper that show its simulations, then those beyond it."""
    with unchecked():
        return *paper_figures(), *own_figures()
