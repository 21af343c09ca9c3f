"""The application: one module per verb, loaded when it is called; mistakes end in one line."""

from __future__ import annotations

import importlib
import os
import signal
import sys
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from hersey.errors import HerseyError

#: The verbs in the order of the help; each is a module of this folder, with a function of that name.
VERBS = (
    "report",
    "inspect",
    "fit",
    "models",
    "film",
    "map",
    "plan",
    "compare",
    "design",
    "cycles",
    "simulate",
    "sweep",
    "hysteresis",
    "figures",
    "testbench",
)
#: Exit code after Ctrl-C, as shells have it.
INTERRUPTED = 130


class Verbs(TyperGroup):
    """The commands, of which only the one that is called is loaded."""

    def list_commands(self, ctx: Any) -> list[str]:  # noqa: ARG002 - as the base class has it
        """Return the verbs."""
        return list(VERBS)

    def get_command(self, ctx: Any, cmd_name: str) -> Any:  # noqa: ARG002
        """Return a verb's command, or None."""
        if cmd_name not in VERBS:
            return None
        module = importlib.import_module(f"hersey.cli.{cmd_name}")
        own = typer.Typer(add_completion=False, rich_markup_mode="rich", context_settings=_CONTEXT)
        own.command(cmd_name)(getattr(module, cmd_name, None) or getattr(module, f"{cmd_name}_"))
        return typer.main.get_command(own)


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
    signal.signal(signal.SIGTERM, _interrupt)
    code: int | None = None
    try:
        code = app(standalone_mode=False)
    except HerseyError as error:
        _fail(str(error))
    except (KeyboardInterrupt, typer.Abort):
        code = INTERRUPTED
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nothing is left to flush into it
        sys.exit(0)
    except OSError as error:
        _fail(f"cannot write the result: {error.strerror}")
    except Exception as error:
        usage = getattr(error, "format_message", None)  # click's own errors know how to say it
        if usage is None:
            raise
        _fail(usage())
    if code == INTERRUPTED:
        _fail("interrupted", code=INTERRUPTED)
    sys.exit(code or 0)


def _fail(message: str, code: int = 2) -> None:
    shown = "".join(c if c.isprintable() else "?" for c in " ".join(message.split()))
    if shown:
        print(f"hersey: {shown}", file=sys.stderr)
    sys.exit(code)


def _interrupt(_signal: int, _frame: object) -> None:
    raise KeyboardInterrupt


@app.callback(invoke_without_command=True)
def _root(version: Annotated[bool, typer.Option("--version", help="Print the version.")] = False) -> None:
    if version:
        from hersey import __version__

        print(f"hersey {__version__}")
        raise typer.Exit
