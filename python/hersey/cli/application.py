"""The application: one module per command, loaded when it is called; errors end in one line."""

from __future__ import annotations

import importlib
import shlex
import sys
from contextlib import suppress
from typing import Annotated, Any

import typer
from typer.core import TyperCommand, TyperGroup

from hersey.cli.arranged import refuse_disorder
from hersey.cli.groups import option
from hersey.cli.interruption import INTERRUPTED
from hersey.cli.light_help import LightGroup, LightHelp
from hersey.cli.long_dashes import long_dashed
from hersey.cli.mistyped import (
    Commands,
    misread,
    missing,
    misused,
    printed,
    unknown_command,
    unknown_option,
    unknown_subcommand,
    unquoted,
    without_value,
)
from hersey.cli.one_speed import with_trend
from hersey.cli.terminal import hush, say, say_wrapped, warnings_said
from hersey.errors import ChannelError, HerseyError, UnitError, speak

#: The commands in the order of the help, in groups, each with the first sentence of its help. The sentences
#: are here too, so that the help lists them without loading the commands. Each command is a module of this
#: folder, with a function of that name.
PANELS = {
    "Everyday": {
        "report": "Write the report of a log as one HTML page, and print its decision.",
        "inspect": "Show what a log holds, what is wrong with it and what it can show, before a fit.",
        "app": "Open the app in the browser: choose logs, describe the machine, read the report.",
        "new": "Ask about log and machine, and write hersey.toml and the machine file.",
        "explain": "Explain a term of reports and docs, or list all terms.",
        "examples": "Copy the shipped examples into a new folder: logs, a machine file, a life test.",
    },
    "Deeper": {
        "fit": "Fit the damping surface B = a T^b w^c and print it with the lubrication regime.",
        "models": "Compare damping models on the same dwells and choose one.",
        "film": "Compute film thickness and lubrication regime, and compare them with a log.",
        "map": "Map over temperature and speed where the drive runs smoothly, sticks or stalls.",
        "posterior": "Estimate V*, stick speed, stiffness, mass and closure from log and machine file.",
        "plan": "Find the quickest start-up profile that ends in steady sliding.",
        "warmup": "Find the quickest warm-up whose drag stays within the limits of grip and motor.",
        "coastdown": "Find the friction torque from coast-downs: speed over time and a moment of inertia.",
        "cycles": "Find the slips of a stick-slip trace, and with --identify the drive behind them.",
        "hysteresis": "Find the speed range in which sticking depends on how the drive was started.",
        "simulate": "Simulate the motion at a drive speed or over a profile.",
        "sweep": "Simulate every combination of parameters and count the outcomes.",
        "design": "Propose the dwells or measurements to record next.",
        "trend": "Follow friction over time at one speed: run-in, growth, steady value and sudden jumps.",
    },
    "Several logs": {
        "compare": "Compare the damping of two logs: of two lubricants, ages or specimens.",
        "campaign": "Keep the runs of a life test, many specimens at many ages, in one file.",
        "life": "Predict which specimens of a life test fail first, how, and when.",
        "weibull": "Fit the law of ages at failure: B-lives with bounds, remaining life, fleet, next test.",
    },
    "Other tools": {
        "export": "Export the drive for Simulink, Amesim, Modelica and other tools.",
        "testbench": "Write a synthetic log with known true values, for tests and for learning.",
    },
}
#: The sentence of each command.
VERBS = {name: sentence for group in PANELS.values() for name, sentence in group.items()}
_EXIT_CODES = (
    "Exit codes: 0 done; 1 the answer is no, or some logs failed; 2 wrong use, bad input, or a result that "
    "cannot be written; 3 a fault of hersey; 130 interrupted."
)
#: Exit code of wrong use, and of a fault of the program.
MISTAKE, FAULT = 2, 3


def load(name: str) -> Any:
    """Return a command with all its options, from its module."""
    module = importlib.import_module(f"hersey.cli.{name}")
    verbs = getattr(module, name, None)
    if isinstance(verbs, typer.Typer):  # a command with subcommands
        verbs.info.context_settings, verbs.info.cls = _CONTEXT, Subcommands
        for subcommand in verbs.registered_commands:
            subcommand.cls = Command
        group = typer.main.get_command(verbs)
        for each in (group, *getattr(group, "commands", {}).values()):
            each.help = _paragraphs(each.help)
        return group
    verb = typer.Typer(add_completion=False, rich_markup_mode="rich", context_settings=_CONTEXT)
    verb.command(name, cls=Command)(verbs or getattr(module, f"{name}_"))
    loaded = typer.main.get_command(verb)
    loaded.help = _paragraphs(loaded.help)
    return loaded


def _paragraphs(text: str | None) -> str:
    """A docstring whose lines end only between paragraphs, so that the help can wrap it."""
    return "\n\n".join(" ".join(each.split()) for each in (text or "").split("\n\n"))


COMMANDS = Commands(tuple(VERBS), load)


class Command(LightHelp, TyperCommand):
    """A command with all its options."""


class Verb(TyperCommand):
    """A command as the list of commands shows it; it is loaded when it is called."""

    def make_context(self, info_name: Any, args: Any, parent: Any = None, **extra: Any) -> Any:
        """Return the context of the loaded command, which then runs instead of this one."""
        command = load(str(self.name))
        if hasattr(command, "commands") or extra.get("resilient_parsing"):
            return command.make_context(info_name, args, parent, **extra)
        typed = list(args)
        context = command.make_context(info_name, args, parent, allow_extra_args=True, **extra)
        refuse_disorder(context, typed)
        return context


class Verbs(LightGroup, TyperGroup):
    """The commands, of which only the one that is called is loaded."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        for panel, group in PANELS.items():
            for name, sentence in group.items():
                self.add_command(Verb(name, short_help=sentence, rich_help_panel=panel))

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the command that is called; for a log or a misspelled command, fail with what to type."""
        name = args[0]
        if name not in VERBS and not name.startswith("-") and not ctx.resilient_parsing:
            ctx.fail(unknown_command(name, args[1:], COMMANDS))
        return super().resolve_command(ctx, args)


class Subcommands(LightGroup, TyperGroup):
    """The subcommands of a command."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """Return the subcommand that is called; fail with what to type instead of one that does not exist."""
        name = args[0]
        if name not in self.commands and not name.startswith("-") and not ctx.resilient_parsing:
            ctx.fail(unknown_subcommand(str(ctx.info_name), name, args[1:], list(self.commands)))
        return super().resolve_command(ctx, args)


_CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 110}
app = typer.Typer(
    cls=Verbs,
    no_args_is_help=True,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings=_CONTEXT,
    help=(
        "From a torque log to the lubrication state of a sliding drive, and the speeds at which it runs "
        "smoothly.\n\n"
        "Example: [bold]hersey report examples/bench.csv[/bold]"
    ),
    epilog=f"hersey COMMAND --help shows the options of a command.\n\n{_EXIT_CODES}",
)


def main() -> None:
    """Run the command line."""
    speak("terminal")
    hush(False)
    if said := long_dashed(sys.argv[1:], COMMANDS):  # else the option would be taken as a file
        _fail(said)
    code: int | None = None
    try:
        with warnings_said():
            code = app(standalone_mode=False)
    except HerseyError as error:
        _fail(_slip() or f"{with_trend(error, COMMANDS)}{_in_full(error)}")
    except typer.Abort:
        raise KeyboardInterrupt from None
    except OSError:  # stdout takes no more
        raise
    except Exception as error:
        usage = getattr(error, "format_message", None)  # click's own errors have it
        if usage is None:
            raise
        _fail(_slip() or _misuse(error) or usage())
    if code == INTERRUPTED:  # which is what typer makes of it
        raise KeyboardInterrupt
    sys.exit(code or 0)


def _in_full(error: HerseyError) -> str:
    """The command with all that several roles lack, to be typed as it is once that is right."""
    units = error.units if isinstance(error, UnitError) else {}
    options = [word for role, unit in units.items() for word in (f"--{role}-unit", unit)]
    if isinstance(error, ChannelError):
        options = [word for of, value in error.examples for word in shlex.split(of.to(value))]
    if len(options) < 3:
        return ""
    return f". In full: {shlex.join(['hersey', *sys.argv[1:], *options])}"


def _misuse(error: Any) -> str:
    """What to say of an option that does not exist, lacks its value or has a wrong one; else nothing."""
    if hasattr(error, "possibilities"):
        return unknown_option(error.option_name, error.ctx, COMMANDS)
    if hasattr(error, "option_name"):
        return misused(error.option_name, COMMANDS)
    if hasattr(error, "param_type"):
        return missing(error.param, error.ctx)
    return misread(error) if hasattr(error, "param") else ""


def _slip() -> str:
    """What to type where words belong together or apart, which can be the cause of any error."""
    words = sys.argv[1:]
    if typed := unquoted(words):
        return f"Put a number and its unit in quotes: {typed}"
    if flag := without_value(words, COMMANDS):
        return misused(flag, COMMANDS)
    typed = printed(words)
    return f"To write the result into a file type: --json > {typed}" if typed else ""


def _fail(message: str) -> None:
    """Print an error, on one line unless a terminal is narrower, and exit."""
    text = " ".join(message.split())
    if text:
        printed = say_wrapped if sys.stderr.isatty() else say
        with suppress(OSError):  # a stderr that is closed
            printed(f"hersey: {text}", file=sys.stderr)
    sys.exit(MISTAKE)


@app.callback(invoke_without_command=True)
def _root(version: Annotated[bool, option("Print the version.", "--version")] = False) -> None:
    if version:
        from hersey import __version__

        say(f"hersey {__version__}")
        raise typer.Exit
