"""The reference of the commands: what ``--help`` says, and ``templates/commands.md`` beside it."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

from hersey.cli.application import VERBS, load
from website.text import joined, sections, table, wrapped

TEMPLATE = Path(__file__).parent / "templates" / "commands.md"
#: Groups of options that several commands share: the class that holds them, and the title of their section.
SHARED = {"Reading": "Reading a log", "Belt": "Describing a belt", "Printing": "What is printed"}
#: Sections of the template that stand before the groups.
BESIDE_OPTIONS = ("Exit codes", "The cache")
#: What an option takes, where it does not say so itself.
_TAKES = {int: "N", float: "NUMBER", str: "TEXT", Path: "FILE"}
_EXAMPLE = re.compile(r"^Example: \[bold\](.+?)\[/bold\]$", re.DOTALL | re.MULTILINE)
_DEFAULT = re.compile(r"\s*\[default: (.+?)\]")


def page() -> str:
    """Return the page.

    Raises
    ------
    ValueError
        If the template has a section for no command and no group of options.
    """
    head, beside = sections(TEMPLATE.read_text(encoding="utf-8"))
    loaded = {verb: load(verb) for verb in VERBS}
    parts = [head, _overview(loaded)]
    for name, title in SHARED.items():
        if options := _shared(loaded, name):
            parts += [f"## {title}", beside.pop(title, ""), *_tables(options)]
    for verb, command in loaded.items():
        parts += _section(f"hersey {verb}", command, beside.pop(f"hersey {verb}", ""))
    parts[2:2] = [part for title in BESIDE_OPTIONS for part in (f"## {title}", beside.pop(title))]
    if beside:
        raise ValueError(f"{TEMPLATE.name} has sections for nothing: {', '.join(beside)}")
    return joined(parts)


def _overview(loaded: dict[str, Any]) -> str:
    rows = [(f"[`hersey {verb}`](#hersey-{verb})", _paragraphs(each)[0]) for verb, each in loaded.items()]
    return table(("command", "what it does"), rows)


def _section(title: str, command: Any, beside: str, level: str = "##") -> Iterator[str]:
    """Heading, help, example, what the template says, and the tables of a command."""
    first, *others = _paragraphs(command)
    yield f"{level} {title}"
    yield wrapped(first)
    yield f"```sh\n{example(command)}\n```"
    yield from (wrapped(each) for each in others)
    yield beside
    below = getattr(command, "commands", {})
    if not below:
        yield f"Usage: `{' '.join([title, *_arguments(command), '[OPTIONS]'])}`"
        arguments = [each for each in command.params if each.param_type_name == "argument"]
        rows = [(f"`{each.metavar or each.name.upper()}`", _said(each.help)) for each in arguments]
        if any(said for _, said in rows):
            yield table(("argument", "meaning"), rows)
        shared = {name: options for name, options in _groups(command).items() if name in SHARED}
        own = [each for each in _options(command) if not any(each.name in of for of in shared.values())]
        yield from _tables(own)
        if shared:
            links = [
                f"[{title}](#{title.lower().replace(' ', '-')})"
                for name, title in SHARED.items()
                if name in shared
            ]
            yield f"Also the options of {' and '.join(links)}."
    for name, each in below.items():
        yield from _section(f"{title} {name}", each, "", "###")


def example(command: Any) -> str:
    """Return the line that the help of a command types as its example."""
    found = _EXAMPLE.search(command.help or "")
    return " ".join(found[1].split()) if found else ""


def _paragraphs(command: Any) -> list[str]:
    """The help of a command without its example, a line each."""
    whole = inspect.cleandoc(_EXAMPLE.sub("", command.help or ""))
    return [_said(" ".join(part.split())) for part in re.split(r"\n\s*\n", whole) if part.strip()]


def _said(words: str | None) -> str:
    """Words of the help in Markdown: no markup of the terminal, flags and asterisks as they are typed."""
    plain = re.sub(r"\[/?bold\]", "", words or "").replace("\\[", "[")
    plain = _DEFAULT.sub("", plain).strip()
    plain = re.sub(r"(?<![\w`'/-])(--[a-z][a-z-]*)", r"`\1`", plain)
    plain = re.sub(r"(\[\[?[a-z]+\]\]?)(?!\()", r"`\1`", plain)
    return re.sub(r"(?<!`)\*", r"\\*", plain)


def _arguments(command: Any) -> list[str]:
    return [
        each.metavar or each.name.upper() for each in command.params if each.param_type_name == "argument"
    ]


def _options(command: Any) -> list[Any]:
    return [each for each in command.params if each.param_type_name == "option" and each.name != "help"]


def _shared(loaded: dict[str, Any], group: str) -> list[Any]:
    """The options of a group, as the first command has them that takes it."""
    for command in loaded.values():
        for each in (command, *getattr(command, "commands", {}).values()):
            if group in (groups := _groups(each)):
                return [option for option in _options(each) if option.name in groups[group]]
    return []


def _groups(command: Any) -> dict[str, set[str]]:
    """The data classes of options that a command takes, by name, with the names of their options."""
    if command.callback is None:
        return {}
    given = inspect.signature(inspect.unwrap(command.callback), eval_str=True).parameters.values()
    kinds = [each.annotation for each in given if is_dataclass(each.annotation)]
    return {kind.__name__: {field.name for field in fields(kind)} for kind in kinds}


def _tables(options: list[Any]) -> Iterator[str]:
    """A table for each heading that the help has."""
    panels = dict.fromkeys(each.rich_help_panel for each in options)
    for panel in panels:
        if panel and len(panels) > 1:
            yield f"**{panel}**"
        rows = [_row(each) for each in options if each.rich_help_panel == panel]
        yield table(("option", "takes", "meaning", "default"), rows)


def _row(option: Any) -> tuple[str, str, str, str]:
    flags = ", ".join(f"`{flag}`" for flag in (*option.opts, *option.secondary_opts))
    said = _DEFAULT.search(option.help or "")
    default = said[1] if said else ""
    if not default and option.default not in (None, False, "", (), []):
        default = f"`{option.opts[0]}`" if option.is_flag else f"`{option.default}`"
    takes = "" if option.is_flag else f"`{option.metavar or _taken(option)}`"
    return flags, takes, _said(option.help), "needed" if option.required else default


def _taken(option: Any) -> str:
    return _TAKES.get(option.type_descriptor.annotation, "TEXT")
