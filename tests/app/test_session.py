"""Runs of a session, without the processes that compute them."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any

import pytest

from hersey.app import session as module
from hersey.app.analysis import Analysis
from hersey.app.looking import look
from hersey.app.session import NotNowError, Session
from hersey.app.view import line_of, view_of
from hersey.app.workers import EndedError, Refused
from hersey.errors import HerseyError
from tests.app.asking import run
from tests.app.test_mistakes import log

Said = Callable[[str, float | None], None]
Work = Callable[[dict[str, Any], Said], Coroutine[Any, Any, dict[str, Any]]]


async def ready(folder: Path, work: Work, monkeypatch: pytest.MonkeyPatch) -> tuple[Session, Analysis]:
    """A session with an analysis of one log, whose runs are ``work``."""

    async def ask(request: dict[str, Any], _folder: Path, said: Said) -> dict[str, Any]:
        return look(Path(request["path"])) if request["task"] == "look" else await work(request, said)

    async def chunks() -> Any:
        yield log()

    monkeypatch.setattr(module, "ask", ask)
    (folder / "private").mkdir()
    session = Session(folder / "private", folder / "reports")
    (one,) = session.analyses.values()
    await session.drop(one, "drive.csv", None, chunks())
    while one.waiting:
        await asyncio.sleep(0.01)
    assert line_of(one)["ready"], one.faults
    return session, one


async def over(one: Analysis) -> None:
    while one.busy:
        await asyncio.sleep(0.01)


async def drawn(request: dict[str, Any], said: Said) -> dict[str, Any]:
    said("drawing the page", 0.9)
    Path(request["report"]).write_text(f"report of {request['command']}")
    Path(request["report"]).with_suffix(".toml").write_text('logs = ["drive.csv"]\n')
    return {"signal": "good", "words": "run", "warnings": 0}


def test_a_finished_run_is_kept_under_a_name_that_is_free(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def course() -> None:
        session, one = await ready(tmp_path, drawn, monkeypatch)
        for _ in range(2):
            await session.run(one)
            await over(one)
            assert (one.state, line_of(one)["signal"]) == ("done", "good")
            assert session.shown[one.report].read_text().startswith("report of hersey report drive.csv")
            assert len(session.shown) == 1  # the report before has no address any more
        kept = {path.name: path.read_text() for path in (tmp_path / "reports").iterdir()}
        assert set(kept) == {"drive.html", "drive-2.html"}
        assert (line_of(one)["left"], line_of(one)["spent"]) == (None, None)
        (file,) = one.files.values()
        session.remove(one)
        assert not file.path.exists()
        assert not session.shown

    run(course())


def test_a_cancelled_run_is_not_done_and_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended: list[str] = []

    async def endless(_request: dict[str, Any], said: Said) -> dict[str, Any]:
        said("reading", 0.1)
        try:
            await asyncio.sleep(3600)
        finally:
            ended.append("killed")
        return {}

    async def course() -> None:
        session, one = await ready(tmp_path, endless, monkeypatch)
        await session.run(one)
        while one.step != "reading":
            await asyncio.sleep(0.01)
        assert line_of(one)["spent"] >= 0.0
        assert line_of(one)["left"] is None  # nothing like it has ended yet
        with pytest.raises(NotNowError, match="cancel it first"):
            await session.change(one, {"options": {"isothermal": True}})
        session.cancel(one)
        await asyncio.sleep(0.05)
        assert (one.state, one.report, one.result, ended) == ("editing", "", {}, ["killed"])
        assert not session.shown
        assert not (tmp_path / "reports").exists()

    run(course())


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (Refused("too few dwells", HerseyError("too few dwells").to_dict()), "too few dwells"),
        (EndedError("x"), "Is there enough memory?"),
    ],
)
def test_a_run_that_fails_says_why_and_is_not_done(
    error: Exception, reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def fails(_request: dict[str, Any], _said: Said) -> dict[str, Any]:
        raise error

    async def course() -> None:
        session, one = await ready(tmp_path, fails, monkeypatch)
        await session.run(one)
        await over(one)
        assert one.state == "stopped"
        assert reason in one.reason
        assert not session.shown

    run(course())


def test_what_is_chosen_reaches_the_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    seen: dict[str, Any] = {}

    async def seeing(request: dict[str, Any], said: Said) -> dict[str, Any]:
        seen.update(request, text=Path(request["mapping"]).read_text())
        return await drawn(request, said)

    async def course() -> None:
        session, one = await ready(tmp_path, seeing, monkeypatch)
        await session.change(one, {"units": {"Torque": "mN*m"}, "roles": {"Temperature": ""}})
        with pytest.raises(NotNowError, match="choose the temperature channel"):
            await session.run(one)
        assert seen == {}
        await session.change(one, {"options": {"isothermal": True, "tare": "standing"}})
        await session.run(one)
        await over(one)

    run(course())
    assert (seen["isothermal"], seen["tare"], seen["against"], seen["machine"]) == (
        True,
        "standing",
        None,
        None,
    )
    assert [Path(path).name for path in seen["logs"]] == ["drive.csv"]
    assert 'channel = "Torque"' in seen["text"].split("[speed]")[0]
    assert 'unit = "mN*m"' in seen["text"].split("[speed]")[0]
    json.dumps(seen)  # as it goes to another process


def test_the_folder_of_an_analysis_is_private(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    async def course() -> None:
        _, one = await ready(tmp_path, drawn, monkeypatch)
        (file,) = one.files.values()
        assert {oct(path.stat().st_mode & 0o777) for path in (one.folder, file.path.parent)} == {"0o700"}

    run(course())


def test_how_much_of_a_file_has_come_is_seen(tmp_path: Path) -> None:
    async def course() -> None:
        (tmp_path / "private").mkdir()
        session = Session(tmp_path / "private", tmp_path / "reports")
        (one,) = session.analyses.values()
        seen: list[dict[str, Any]] = []

        async def chunks() -> Any:
            for _ in range(4):
                yield b"x" * 250
                seen.append(view_of(one)["files"][0])

        await session.drop(one, "notes.toml", 1000, chunks())
        assert [file["state"] for file in seen] == ["arriving"] * 4
        assert [file["received"] / file["total"] for file in seen] == [0.25, 0.5, 0.75, 1.0]

    run(course())
