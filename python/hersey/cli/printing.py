"""How much a command prints: its conclusion, all of its statistics, or only the files that it wrote."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from hersey.cli.groups import option
from hersey.cli.outputs import NOT_FOUND, Output, print_json
from hersey.cli.terminal import hush, say, say_wrapped
from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.schema.warning import Warning
    from hersey.stability.plan import Plan
    from hersey.stability.warm_up_result import WarmUp

#: Heading of these options in the help.
PANEL = "What is printed"
_JSON = "Print the whole result as JSON."
_VERBOSE = "Print the full statistics and notes too."
_QUIET = "Print only the names of the files written; errors still go to stderr."
#: Whether the result is printed as JSON.
AsJson = Annotated[bool, option(_JSON, "--json", panel=PANEL)]
#: How grave a warning is, the gravest first; the others are notes.
_GRAVE = ("act", "watch")


@dataclass(frozen=True)
class Quiet:
    """Whether a command prints more than the names of the files that it wrote."""

    quiet: Annotated[bool, option(_QUIET, "--quiet", "-q", panel=PANEL)] = False

    def prepare(self) -> None:
        """Make the notes on stderr follow --quiet."""
        hush(self.quiet)

    def text(self, *lines: str) -> None:
        """Print the conclusion, and a table that is the purpose of the command."""
        if lines and not self.quiet:
            say_wrapped(*lines)

    def files(self, *written: Path | None) -> None:
        """Print the name of each file that was written, a line each."""
        for path in written:
            if path is not None:
                say(str(path))


@dataclass(frozen=True)
class Printing(Quiet):
    """How much of a result is printed, and whether as JSON."""

    verbose: Annotated[bool, option(_VERBOSE, "--verbose", "-v", panel=PANEL)] = False
    as_json: AsJson = False

    def prepare(self) -> None:
        """Make the notes on stderr follow --quiet."""
        if self.quiet and self.verbose:
            raise ParameterError("--quiet and --verbose exclude each other: give one of them")
        super().prepare()

    @property
    def in_full(self) -> bool:
        """Whether more than the conclusion is printed: all statistics, or JSON."""
        return self.verbose or self.as_json

    def json(self, result: Any, **beside: Any) -> bool:
        """Print the result as JSON if that is asked for, and return whether it is."""
        if self.as_json:
            print_json(result, **beside)
        return self.as_json

    def details(self, *lines: str) -> None:
        """Print what only --verbose asks for."""
        if self.verbose:
            self.text(*lines)

    def conclusion(self, lines: Callable[[], list[str]], whole: str, *found: Warning) -> None:
        """Print lines and the warnings that need attention, or with --verbose a whole that has both."""
        if self.verbose:
            self.text(whole)
        else:
            self.text(*lines())
            self.warnings(*found)

    def warnings(self, *found: Warning) -> None:
        """Print the warnings that need attention, the gravest first; with --verbose the notes too."""
        self.text(*(f"- {each.sentence}" for each in self.chosen(found)))

    def chosen(self, found: Iterable[Warning]) -> list[Warning]:
        """Return the warnings that are printed, each once."""
        once = {each.sentence: each for each in found}.values()
        order = [*_GRAVE, *dict.fromkeys(each.severity for each in once)] if self.verbose else [*_GRAVE]
        return sorted(
            (each for each in once if each.severity in order), key=lambda w: order.index(w.severity)
        )


def write_course(
    found: Plan | WarmUp,
    outputs: tuple[Output, Output],
    printing: Printing,
    lines: Callable[[], list[str]],
    **chart: Any,
) -> None:
    """Write table and figure of a start-up profile or a warm-up, and print it.

    If there is none, nothing is written and the command ends with `NOT_FOUND`. ``lines`` returns its text,
    ``chart`` are further arguments of the chart.
    """
    table, figure = outputs
    if found.found:
        figure.draw(found, **chart)
        if table.path is not None:
            table.write(found.table())
    if not printing.json(found):
        printing.conclusion(lines, found.summary(), *found.warnings)
        if found.found:
            printing.files(table.path, figure.path)
    if not found.found:
        raise typer.Exit(NOT_FOUND)
