"""The paper's Figs. 9 to 12 drawn anew, each with the paper's claims and how well they hold.

========  ====================================================================
sweep     what the paper varies; cycles along it; trends and their power laws
figure    a figure, its claims, their verdicts
judges    claims that a trend can bear out
panels    the charts that the figures are put together from
baseline  Fig. 9
trends    Figs. 10 to 12
files     writing them
========  ====================================================================

Every verdict follows from numbers computed when the figure is made, by the criterion that stands beside it.
Units are the paper's: inches, ounces of force, seconds.
"""

from __future__ import annotations

from collections.abc import Callable

from hersey.figures.baseline import figure_9
from hersey.figures.figure import Claim, PaperFigure, Verdict
from hersey.figures.files import as_json, markdown, write
from hersey.figures.trends import figure_10, figure_11, figure_12

__all__ = [
    "Claim",
    "PaperFigure",
    "Verdict",
    "as_json",
    "figure_9",
    "figure_10",
    "figure_11",
    "figure_12",
    "markdown",
    "paper_figures",
    "write",
]

#: In the order of the paper: a new figure joins here.
_MAKERS: tuple[Callable[[], PaperFigure], ...] = (figure_9, figure_10, figure_11, figure_12)


def paper_figures() -> tuple[PaperFigure, ...]:
    """Return the figures of the paper that are drawn anew."""
    return tuple(make() for make in _MAKERS)
