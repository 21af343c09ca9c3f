"""Figs. 1 to 8 of a user's own machine and log, or of those of the example."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from hersey.charts.style import unchecked
from hersey.errors import HerseyError
from hersey.log.reading import read
from hersey.machine.machine import Machine, read_machine
from paper.cross_section import figure_1
from paper.damping import figure_3, figure_7
from paper.figure import PaperFigure
from paper.friction import figure_8
from paper.measured import Measured
from paper.nip import figure_5
from paper.system import figure_6
from paper.temperature import figure_4
from paper.torque import figure_2

_EXAMPLES = Path(__file__).parent.parent


def drive_figures(
    measured: Measured | None = None, machine: Machine | None = None
) -> tuple[tuple[PaperFigure, ...], tuple[str, ...]]:
    """Return those of Figs. 1 to 8 that a log and a machine can make, and why the others are left out.

    Figs. 1, 5, 6 and 8 need the machine, Figs. 2, 3, 4 and 7 the log; Fig. 8 shows both where both are given.
    """
    figures, left_out = [], []

    def make(number: int, figure: Callable[[], PaperFigure]) -> None:
        try:
            figures.append(figure())
        except HerseyError as error:
            left_out.append(f"Fig. {number} is left out: {error}")

    with unchecked():
        if machine is not None:
            make(1, lambda: figure_1(machine))
            make(5, lambda: figure_5(machine))
            make(6, lambda: figure_6(machine, measured))
            make(8, lambda: figure_8(machine, measured))
        else:
            left_out.append("Figs. 1, 5, 6 and 8 are left out: they need a machine file, --machine")
        if measured is not None:
            make(2, lambda: figure_2(measured, machine))
            make(3, lambda: figure_3(measured))
            make(4, lambda: figure_4(measured, machine))
            make(7, lambda: figure_7(measured))
        else:
            left_out.append("Figs. 2, 3, 4 and 7 are left out: they need a log, --log")
    return tuple(sorted(figures, key=lambda figure: figure.number)), tuple(left_out)


def shipped() -> tuple[Measured, Machine]:
    """Return the log of the virtual test stand and the machine file of the example."""
    machine = read_machine(_EXAMPLES / "machine.toml")
    points = read(_EXAMPLES / "bench.csv").steady(tare="standing")
    return Measured.of(points if machine.rest is None else points.without(machine.rest)), machine
