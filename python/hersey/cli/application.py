"""The application: one module per verb, loaded when it is called; mistakes end in one line."""

from __future__ import annotations

import importlib
import sys
from contextlib import suppress
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from hersey.cli.groups import option
from hersey.cli.interruption import INTERRUPTED
from hersey.cli.terminal import say, warnings_said
from hersey.errors import HerseyError, speak

#: The verbs in the order of the help, with the first sentence of each, which stands here too so that the list
#: of verbs is printed without loading them. Each is a module of this folder, with a function of that name.
VERBS = {
    "app": (
        "Open a page on this computer: drop logs, choose channels, describe the machine, read the report."
    ),
    "new": "Ask the few things that a log cannot tell, and write hersey.toml and the machine's file.",
    "explain": "Explain a term of reports and docs in plain words; without a term, list all of them.",
    "examples": "Copy the shipped examples into a new folder: logs, a machine file, a life test.",
    "report": (
        "Write a report: regime, damping surface, data quality and a stick-slip simulation, in one HTML page."
    ),
    "inspect": (
        "Show what a log holds before anything is fitted: clocks, channels, their faults, what it can tell."
    ),
    "fit": "Fit the damping surface B = a T^b w^c and print it, with the verdict on the regime.",
    "models": (
        "Fit every candidate law to the same dwells, choose one, and say why; energies and Hersey collapse."
    ),
    "film": "Say how thick the lubricant film is, which regime makes it, and what a log says of both.",
    "map": (
        "Map where the belt runs smoothly, sticks and slips, or stalls: temperature across, drive speed up."
    ),
    "posterior": (
        "Draw V*, stick speed, stiffness, mass and closure from everything that log and machine file show."
    ),
    "plan": (
        "Find the quickest profile of drive speed from rest that ends smooth, and say how surely it does."
    ),
    "warmup": "Find the quickest warm-up whose drag stays below grip and motor: slow until warm.",
    "compare": (
        "Compare two lubricants, ages or units: ratio of damping, change of exponents and of the transition."
    ),
    "campaign": "Keep the runs of a life test, many units at many ages, in one file: add, list, check.",
    "life": "Predict which units of a life test fail first, how, and when, and what to measure next.",
    "design": (
        "Propose the next dwells to record: those that make the fitted law, or one quantity, known best."
    ),
    "cycles": "Find the slips of a stick-slip trace, and with --identify the drive that makes them.",
    "simulate": (
        "Simulate the belt at a drive speed or over a profile: what it settles to (defaults: the paper's)."
    ),
    "sweep": "Find what every combination of parameters settles to, and count the outcomes.",
    "hysteresis": "Find the drive speeds between which the past decides whether the belt sticks.",
    "export": "Write the fitted drive for other tools: a unit that Simulink, Amesim or Modelica run.",
    "testbench": (
        "Write a log of the virtual test stand: synthetic, with a known truth, for tests and for learning."
    ),
}


def load(name: str) -> Any:
    """Return a verb's command with all its options, from its module."""
    module = importlib.import_module(f"hersey.cli.{name}")
    verbs = getattr(module, name, None)
    if isinstance(verbs, typer.Typer):  # a verb with verbs of its own
        verbs.info.context_settings = _CONTEXT
        return typer.main.get_command(verbs)
    verb = typer.Typer(add_completion=False, rich_markup_mode="rich", context_settings=_CONTEXT)
    verb.command(name)(verbs or getattr(module, f"{name}_"))
    return typer.main.get_command(verb)


class Verb(TyperCommand):
    """A verb as the list of verbs shows it; it is loaded when it is called."""

    def make_context(self, info_name: Any, args: Any, parent: Any = None, **extra: Any) -> Any:
        """Return the context of the loaded command, which then runs in this one's place."""
        return load(str(self.name)).make_context(info_name, args, parent, **extra)


class Verbs(TyperGroup):
    """The commands, of which only the one that is called is loaded."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        for name, sentence in VERBS.items():
            self.add_command(Verb(name, short_help=sentence))


_CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 110}
app = typer.Typer(
    cls=Verbs,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings=_CONTEXT,
    help=(
        "From a torque log to the lubrication state of a sliding drive.\n\n"
        "Example: [bold]hersey report examples/bench.csv[/bold]"
    ),
)


def main() -> None:
    """Run the command line."""
    speak("terminal")
    code: int | None = None
    try:
        with warnings_said():
            code = app(standalone_mode=False)
    except HerseyError as error:
        _fail(str(error))
    except typer.Abort:
        raise KeyboardInterrupt from None
    except OSError:  # stdout takes no more
        raise
    except Exception as error:
        usage = getattr(error, "format_message", None)  # click's own errors know how to say it
        if usage is None:
            raise
        _fail(usage())
    if code == INTERRUPTED:  # which is what typer makes of it
        raise KeyboardInterrupt
    sys.exit(code or 0)


def _fail(message: str) -> None:
    text = " ".join(message.split())
    if text:
        with suppress(OSError):  # a stderr that takes nothing
            say(f"hersey: {text}", file=sys.stderr)
    sys.exit(2)


@app.callback(invoke_without_command=True)
def _root(version: Annotated[bool, option("Print the version.", "--version")] = False) -> None:
    if version:
        from hersey import __version__

        say(f"hersey {__version__}")
        raise typer.Exit
