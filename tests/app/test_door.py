"""Who only holds connections open, or sends slowly, keeps nobody out."""

from __future__ import annotations

import asyncio
import json
import socket
import urllib.request
from contextlib import ExitStack
from pathlib import Path
from typing import Any
from unittest import mock
from urllib.parse import urlsplit

import pytest
import uvicorn
from uvicorn.server import ServerState

from hersey.app import door as module
from hersey.app.door import MOST, Door
from tests.app.asking import Asked, run
from tests.app.conftest import end, start

HALF = b"GET / HTTP/1.1\r\nHost: 127"
#: Longer than anything here takes on a busy machine, s.
LONG = 120.0


def test_the_owner_is_served_beside_500_half_open_requests(tmp_path: Path) -> None:
    started = start(tmp_path)
    address = urlsplit(started.address)
    page = f"http://{address.netloc}"
    try:
        with ExitStack() as stack:
            held = []
            for _ in range(500):
                held.append(
                    stack.enter_context(socket.create_connection((address.hostname, address.port), LONG))
                )
                held[-1].sendall(HALF)
            token = {"x-hersey-token": address.fragment}
            with urllib.request.urlopen(page, timeout=LONG) as answer:
                assert answer.status == 200
            asked = urllib.request.Request(f"{page}/api/state", headers=token)
            with urllib.request.urlopen(asked, timeout=LONG) as answer:
                assert len(json.load(answer)["analyses"]) == 1
            for oldest in held[: 500 - MOST]:
                assert ended(oldest)
    finally:
        end(started)


def ended(connection: socket.socket) -> bool:
    """Wait until the other end has closed."""
    try:
        return connection.recv(1) == b""
    except ConnectionResetError:
        return True


def test_the_oldest_stranger_goes_first_and_the_owner_never() -> None:
    door = Door(most=2)
    transports = [mock.Mock(name=str(i)) for i in range(5)]
    clients = [("127.0.0.1", 1000 + i) for i in range(5)]
    for client, transport in zip(clients[:2], transports[:2], strict=True):
        door.enter(client, transport)
    door.know(clients[0])
    door.enter(clients[2], transports[2])
    assert not any(each.abort.called for each in transports)
    door.enter(clients[3], transports[3])
    assert [each.abort.called for each in transports] == [False, True, False, False, False]
    door.leave(clients[2], transports[2])
    door.enter(clients[4], transports[4])
    assert [each.abort.called for each in transports] == [False, True, False, False, False]


@pytest.mark.parametrize("drips", [False, True])
def test_a_head_has_its_time(drips: bool) -> None:
    async def course() -> bytes:
        config = uvicorn.Config(nothing, log_config=None, lifespan="off")
        config.load()
        speaks: Any = Door(head=0.05).protocol()
        state = ServerState()
        loop = asyncio.get_running_loop()
        server = await loop.create_server(
            lambda: speaks(config=config, server_state=state, app_state={}), "127.0.0.1", 0
        )
        reader, writer = await asyncio.open_connection(*server.sockets[0].getsockname())
        writer.write(HALF)
        while drips and not reader.at_eof():
            writer.write(b".")
            await asyncio.sleep(0.01)
        try:
            return await asyncio.wait_for(reader.read(), LONG)
        except ConnectionResetError:
            return b""
        finally:
            writer.transport.abort()
            server.close()

    assert run(course()) == b""


async def nothing(_scope: Any, _receive: Any, _send: Any) -> None:
    """An application that is never reached."""


@pytest.mark.parametrize("what", ["files", "choices"])
def test_a_slow_body_is_given_up(what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked(tmp_path)
    monkeypatch.setattr(module, "BODY", 0.0)
    course = asked.asked("POST", f"/api/analyses/{asked.first}/{what}", [b"{"], hangs=True, x_name="a.csv")
    answer = run(course)
    assert (answer.status, answer.json) == (408, {"error": "the request came too slowly"})
    assert not asked.session.analyses[asked.first].files
    assert [each for each in asked.session.folder.rglob("*") if each.is_file()] == []


def test_a_long_body_has_longer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked = Asked(tmp_path)
    monkeypatch.setattr(module, "BODY", 0.0)
    monkeypatch.setattr(module, "BYTES_PER_SECOND", 1e-6)  # any byte gives it time without end
    answer = run(asked.asked("POST", f"/api/analyses/{asked.first}/choices", [b"{", b" ", b"}"]))
    assert answer.status == 200
