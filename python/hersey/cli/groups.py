"""Options of a command: one with its help, and those that belong together as a frozen data class."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from dataclasses import MISSING, fields, is_dataclass
from typing import Any, get_type_hints

import typer

from hersey.errors import ParameterError
from hersey.files.patterns import files_of

#: Arguments that name logs: patterns among them stand for files.
_LOGS = {"logs", "runs"}
#: Parameters that take the logs of a recipe where none are typed.
_OF_A_RECIPE = ("logs", "log")
#: Parameter by which the command line says what was typed.
_CONTEXT = "context"


def option(words: str, *flags: str, **more: Any) -> Any:
    """Return an option with its help; its flag is the name of the parameter unless there are others."""
    return typer.Option(*flags, help=words, **more)


def argument(name: str, words: str) -> Any:
    """Return an argument, as help calls it, with its help."""
    return typer.Argument(metavar=name, help=words)


def grouped(command: Callable[..., None]) -> Callable[..., None]:
    """Give a command the options of each of its parameters that is a data class, in the place of that.

    A group with a method ``completed`` may name a recipe: what it states counts where nothing was typed.
    """
    given = inspect.signature(command, eval_str=True).parameters
    groups: dict[str, Any] = {n: p.annotation for n, p in given.items() if is_dataclass(p.annotation)}
    reading = next((name for name, group in groups.items() if hasattr(group, "completed")), "")
    needs_logs = bool(reading) and "logs" in given and given["logs"].default is inspect.Parameter.empty

    @functools.wraps(command)
    def run(**typed: Any) -> None:
        context = typed.pop(_CONTEXT, None)
        for logs in _LOGS & typed.keys():
            typed[logs] = typed[logs] and files_of(typed[logs])
        taken = {
            name: group(**{field.name: typed.pop(field.name) for field in fields(group)})
            for name, group in groups.items()
        }
        if reading:
            taken[reading], logs_of_recipe = taken[reading].completed(_chosen(context))
            typed |= {name: logs_of_recipe for name in _OF_A_RECIPE if name in typed and not typed[name]}
        if needs_logs and not typed["logs"]:
            raise ParameterError("name a LOG, or a recipe that names one: --recipe recipe.toml")
        command(**typed, **taken)

    shown = [
        each
        for name, parameter in given.items()
        for each in (_options(groups[name]) if name in groups else [parameter])
    ]
    if needs_logs:  # what is missing is refused above
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
