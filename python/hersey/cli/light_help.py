"""Help without what typer loads for it in vain, half of its time: pydantic, Markdown and tracebacks."""

from __future__ import annotations

import importlib
import sys
from types import ModuleType
from typing import Any

from hersey.cli.loading import loading

#: Classes that typer imports for its help, by their modules, and that load others' parsers and lexers.
_UNUSED = {"rich.markdown": "Markdown", "rich.traceback": "Traceback"}


class _Later(type):
    """A class that is loaded when it is first used."""

    def _loaded(cls) -> Any:
        return getattr(importlib.import_module(cls.__module__), cls.__name__)

    def __call__(cls, *values: Any, **named: Any) -> Any:
        return cls._loaded()(*values, **named)

    def __getattr__(cls, name: str) -> Any:
        return getattr(cls._loaded(), name)


def _load_help() -> None:
    """Load typer's help; what it does not use stands in until it is imported, and is not kept as a module."""
    absent = _UNUSED.keys() - sys.modules.keys()
    for name in absent:
        module = sys.modules[name] = ModuleType(name)
        setattr(module, _UNUSED[name], _Later(_UNUSED[name], (), {"__module__": name}))
    try:
        with loading():
            import typer.rich_utils  # noqa: F401
    finally:
        for name in absent:
            del sys.modules[name]


class LightHelp:
    """A command whose help loads little."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        _load_help()
        super().format_help(ctx, formatter)  # type: ignore[misc]


class LightGroup(LightHelp):
    """A group of commands whose help loads little, and theirs."""

    def get_params(self, ctx: Any) -> Any:
        """Return the options; a flag not typed is False, since typer loads pydantic to convert None."""
        options = super().get_params(ctx)  # type: ignore[misc]
        for each in options:
            if getattr(each, "is_flag", False) and each.default is None:
                each.default = False
        return options
