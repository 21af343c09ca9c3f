"""Duration of runs: the time left of a run is estimated once a similar run has ended."""

from __future__ import annotations

import time
from collections.abc import Hashable


class Courses:
    """When each step of the runs of one start began, by what makes runs similar."""

    def __init__(self) -> None:
        """Begin without any run."""
        self._ended: dict[Hashable, dict[str, float]] = {}

    def begin(self, like: Hashable) -> Course:
        """Return the course of a run that begins now; runs with the same ``like`` are similar."""
        return Course(self._ended.get(like))

    def keep(self, like: Hashable, course: Course) -> None:
        """Keep the course of a run that has just finished."""
        self._ended[like] = course.ended()


class Course:
    """One run: ``began`` and ``ends`` on the monotonic clock; the end is None while it is unknown."""

    def __init__(self, before: dict[str, float] | None) -> None:
        """Begin now, with the steps of the last similar run."""
        self.began = time.monotonic()
        self.ends: float | None = None
        self._before = before
        self._steps: dict[str, float] = {}

    def step(self, name: str) -> None:
        """Record the beginning of a step, and scale the rest by the time so far against last time."""
        if name in self._steps:
            return
        now = time.monotonic() - self.began
        self._steps[name] = now
        if self._before is not None and self._before.get(name, 0.0) > 0.0:
            then = self._before[name]
            self.ends = self.began + now + (self._before[""] - then) * now / then

    def ended(self) -> dict[str, float]:
        """Return when each step began, s, and the duration of the run under an empty name."""
        return {**self._steps, "": time.monotonic() - self.began}
