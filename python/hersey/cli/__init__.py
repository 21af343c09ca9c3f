"""The commands: each mirrors a verb of the package and computes nothing of its own.

A mistake of the user's ends in one line on stderr and exit code 2.
"""

from hersey.cli import belt, compare, cycles, design, film, inspect, logs, machine, models, stand  # noqa: F401
from hersey.cli.shell import app, main

__all__ = ["app", "main"]
