"""Rooms called like a verb: ``hersey.study(points)`` also works once `hersey.study` is imported."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any


class CallableRoom(ModuleType):
    """A package that can be called like the function of the same name inside it."""

    verb: tuple[str, str]  #: module and name of the function

    def __call__(self, *given: Any, **named: Any) -> Any:
        """Call the function; its module is imported by the first call."""
        module, name = self.verb
        return getattr(import_module(module), name)(*given, **named)


def make_callable(room: str, module: str, name: str) -> None:
    """Let calls of the package ``room`` go to the function ``name`` of ``module``."""
    package: Any = sys.modules[room]
    package.__class__, package.verb = CallableRoom, (module, name)
