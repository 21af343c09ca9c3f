"""How long a run takes: what is left of one is told once one like it has ended, and not before."""

from __future__ import annotations

import time
from collections.abc import Hashable


class Courses:
    """The courses of the runs of one start: when each of their steps began, by what they are alike in."""

    def __init__(self) -> None:
        """Start without any."""
        self._ended: dict[Hashable, dict[str, float]] = {}

    def begin(self, like: Hashable) -> Course:
        """Return the course of a run that begins now; ``like`` is what it is alike in to others."""
        return Course(self._ended.get(like))

    def keep(self, like: Hashable, course: Course) -> None:
        """Keep the course of a run that has just ended well."""
        self._ended[like] = course.ended()


class Course:
    """One run: ``began`` and ``ends`` by the monotonic clock; the end is None while nothing tells it."""

    def __init__(self, before: dict[str, float] | None) -> None:
        """Begin now, with the steps of the last run that was like it."""
        self.began = time.monotonic()
        self.ends: float | None = None
        self._before = before
        self._steps: dict[str, float] = {}

    def step(self, name: str) -> None:
        """Take the beginning of a step: the rest takes longer than the last time as what is done did."""
        if name in self._steps:
            return
        now = time.monotonic() - self.began
        self._steps[name] = now
        if self._before is not None and self._before.get(name, 0.0) > 0.0:
            then = self._before[name]
            self.ends = self.began + now + (self._before[""] - then) * now / then

    def ended(self) -> dict[str, float]:
        """Return when each step began, s, and under an empty name the whole."""
        return {**self._steps, "": time.monotonic() - self.began}
