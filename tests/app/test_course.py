"""How long a run takes."""

from __future__ import annotations

import pytest

from hersey.app.course import Courses


def test_what_is_left_is_told_once_a_run_like_it_has_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    now = [100.0]
    monkeypatch.setattr("hersey.app.course.time.monotonic", lambda: now[0])
    courses = Courses()
    first = courses.begin("alike")
    for step, at in (("reading", 101.0), ("fitting", 104.0), ("fitting", 105.0)):
        now[0] = at
        first.step(step)
        assert first.ends is None
    now[0] = 110.0
    courses.keep("alike", first)
    second, other = courses.begin("alike"), courses.begin("another")
    now[0] = 118.0
    for course in (second, other):
        course.step("fitting")
    assert other.ends is None
    assert second.ends == 118.0 + 6.0 * 8.0 / 4.0  # twice as slow so far
