"""A request to the app as a server sees it, without a socket."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Coroutine
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from hersey.app.server import application
from hersey.app.session import Session
from hersey.app.uploads import Bounds

PORT, TOKEN = 4711, "t0ken"
OWN = {"host": f"127.0.0.1:{PORT}", "origin": f"http://127.0.0.1:{PORT}", "x-hersey-token": TOKEN}


@dataclass(frozen=True)
class Answer:
    """What came back."""

    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)


def run(course: Coroutine[Any, Any, Any]) -> Any:
    """Run a course to its end, in a thread: the browser of another test may hold the loop of this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, course).result()


class Asked:
    """A session and its server."""

    def __init__(self, folder: Path, bounds: Bounds | None = None) -> None:
        (folder / "private").mkdir()
        self.session = Session(folder / "private", folder / "reports", bounds)
        self.app = application(self.session, token=TOKEN, port=PORT)
        self.first = next(iter(self.session.analyses))

    def ask(self, method: str, path: str, body: bytes = b"", **headers: str | None) -> Answer:
        """Ask with the headers of the page; ``None`` leaves one out, ``_`` stands for ``-``."""
        return run(self.asked(method, path, [body], **headers))

    async def asked(
        self, method: str, path: str, parts: list[bytes], *, hangs: bool = False, **headers: str | None
    ) -> Answer:
        """Ask with a body in parts, after which the page goes away, or with ``hangs`` says nothing more."""
        given = OWN | {name.replace("_", "-"): value for name, value in headers.items()}
        raw = [(name.encode(), value.encode()) for name, value in given.items() if value is not None]
        plain, _, query = path.partition("?")
        scope = {
            "type": "http", "http_version": "1.1", "asgi": {"version": "3.0"}, "method": method,
            "path": plain, "raw_path": plain.encode(), "query_string": query.encode(), "root_path": "",
            "scheme": "http", "headers": raw, "client": ("127.0.0.1", 1), "server": ("127.0.0.1", PORT),
        }  # fmt: skip
        waiting = [
            {"type": "http.request", "body": part, "more_body": hangs or i + 1 < len(parts)}
            for i, part in enumerate(parts)
        ]
        sent: list[dict[str, Any]] = []

        async def receive() -> dict[str, Any]:
            if hangs and not waiting:
                await asyncio.Event().wait()
            return waiting.pop(0) if waiting else {"type": "http.disconnect"}

        async def send(message: dict[str, Any]) -> None:
            sent.append(message)

        await self.app(scope, receive, send)
        start = sent[0]
        told = {name.decode(): value.decode() for name, value in start["headers"]}
        return Answer(start["status"], told, b"".join(message.get("body", b"") for message in sent[1:]))
