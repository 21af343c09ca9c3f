"""Options of a command: one with its help, and several that belong together as a data class."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import MISSING, fields, is_dataclass
from typing import Any, get_type_hints

import typer

from hersey.cli.named_logs import logs_of
from hersey.errors import ParameterError

#: Arguments that name logs, in which patterns are allowed.
_LOGS = {"logs", "runs"}
#: Options that name a table to write.
_TABLES = ("each", "out")
#: Parameters that take the logs of a recipe if none are typed.
_OF_A_RECIPE = ("logs", "log")
#: Parameter that shows which options were typed.
_CONTEXT = "context"


def option(words: str, *flags: str, panel: str | None = None, **more: Any) -> Any:
    """Return an option with its help, under a heading of its own if there is a ``panel``.

    Its flag is the name of the parameter unless there are others.
    """
    shown = words.replace("  [default:", "  \\[default:")  # which is markup else
    return typer.Option(*flags, help=shown, rich_help_panel=panel, **more)


def argument(name: str, words: str) -> Any:
    """Return an argument with its name in the help, and its help."""
    return typer.Argument(metavar=name, help=words)


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Replace each parameter that is a data class by the options of that class.

    A group with a method ``completed`` can name a recipe, whose settings hold unless an option was typed.
    The method ``prepare`` of a group is called before the command runs.
    """
    given = inspect.signature(command, eval_str=True).parameters
    groups: dict[str, Any] = {n: p.annotation for n, p in given.items() if is_dataclass(p.annotation)}
    reading = next((name for name, group in groups.items() if hasattr(group, "completed")), "")
    needs_logs = bool(reading) and "logs" in given and given["logs"].default is inspect.Parameter.empty

    @functools.wraps(command)
    def run(**typed: Any) -> None:
        context = typed.pop(_CONTEXT, None)
        for logs in _LOGS & typed.keys():
            typed[logs] = typed[logs] and logs_of(typed[logs], [typed.get(name) for name in _TABLES])
        taken = {
            name: group(**{field.name: typed.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        for group in taken.values():
            if hasattr(group, "prepare"):
                group.prepare()
        if reading:
            taken[reading], logs_of_recipe = taken[reading].completed(_chosen(context))
            typed |= {name: logs_of_recipe for name in _OF_A_RECIPE if name in typed and not typed[name]}
        if needs_logs and not typed["logs"]:
            raise ParameterError("name a LOG, or a recipe that names one with --recipe recipe.toml")
        command(**typed, **taken)

    shown = [
        each
        for name, parameter in given.items()
        for each in (_options(groups[name]) if name in groups else [parameter])
    ]
    if needs_logs:  # a missing log is refused above
        shown = [each.replace(default=None) if each.name == "logs" else each for each in shown]
    keyword = inspect.Parameter.KEYWORD_ONLY
    if reading:
        shown.append(inspect.Parameter(_CONTEXT, keyword, annotation=typer.Context))
    run.__signature__ = inspect.Signature([each.replace(kind=keyword) for each in shown])  # type: ignore[attr-defined]
    return run


def _chosen(context: typer.Context) -> set[str]:
    """Names of the parameters that were typed, not left at their default."""
    sources = {name: context.get_parameter_source(name) for name in context.params}
    return {name for name, source in sources.items() if source is not None and source.name != "DEFAULT"}


def _options(group: Any) -> list[inspect.Parameter]:
    """The fields of a group, as parameters of a command."""
    types = get_type_hints(group, include_extras=True)
    return [
        inspect.Parameter(
            field.name,
            inspect.Parameter.KEYWORD_ONLY,
            default=inspect.Parameter.empty if field.default is MISSING else field.default,
            annotation=types[field.name],
        )
        for field in fields(group)
    ]
