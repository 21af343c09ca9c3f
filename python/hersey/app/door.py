"""Limits on connections: nobody can block the owner of the app by holding connections open.

All clients have the address of this computer, so only the token tells the owner from a stranger. At most
`MOST` connections that have not shown it are kept: one more ends the oldest. The owner's page is
answered as soon as it asks, long before so many others have come. What comes too slowly is given up.
"""

from __future__ import annotations

import asyncio
from typing import Any

from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

#: Most connections that have not shown the token.
MOST = 64
#: Time that the head of a request may take, s.
HEAD = 10.0
#: Time that a body may take, s, and bytes for which it may take a second more.
BODY, BYTES_PER_SECOND = 30.0, 10_000


class SlowError(Exception):
    """A body that comes too slowly; the message is for the user."""


class Door:
    """The connections of strangers, oldest first, by the address of the other end."""

    def __init__(self, most: int = MOST, head: float = HEAD) -> None:
        """Begin with none; ``head`` is in s."""
        self.head, self._most = head, most
        self._strangers: dict[tuple[str, int], asyncio.Transport] = {}

    def enter(self, client: tuple[str, int], transport: asyncio.Transport) -> None:
        """Take in a connection, and end the oldest of a stranger if there are too many."""
        self._strangers[client] = transport
        if len(self._strangers) > self._most:
            oldest = next(iter(self._strangers))
            self._strangers.pop(oldest).abort()

    def know(self, client: tuple[str, int]) -> None:
        """Take a connection for the owner's: it has shown the token."""
        self._strangers.pop(client, None)

    def leave(self, client: tuple[str, int], transport: asyncio.Transport) -> None:
        """Let a connection go that has ended."""
        if self._strangers.get(client) is transport:
            del self._strangers[client]

    def protocol(self) -> type[asyncio.Protocol]:
        """Return what speaks HTTP on each connection that comes in here."""
        door = self

        class Watched(_Watched):
            def __init__(self, *args: Any, **settings: Any) -> None:
                super().__init__(*args, **settings)
                self.door = door

        return Watched


class _Watched(H11Protocol):
    """HTTP on a connection that has a time for each head."""

    door: Door
    _ends: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        super().connection_made(transport)
        if self.client is not None:
            self.door.enter(self.client, transport)
        self._watch()

    def connection_lost(self, exc: Exception | None) -> None:
        self._stop()
        if self.client is not None:
            self.door.leave(self.client, self.transport)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        super().data_received(data)
        self._watch()

    def _watch(self) -> None:
        """Give a head its time from its first byte on; what follows it has a time of its own."""
        if self._answers():
            self._stop()
        elif self._ends is None:
            self._ends = self.loop.call_later(self.door.head, self._give_up)

    def _answers(self) -> bool:
        return self.cycle is not None and not self.cycle.response_complete

    def _give_up(self) -> None:
        self._ends = None
        if not self._answers():
            self.transport.abort()

    def _stop(self) -> None:
        if self._ends is not None:
            self._ends.cancel()
            self._ends = None


class Patience:
    """Gives each body a time, longer the more of it has come."""

    def __init__(self, app: ASGIApp) -> None:
        """Take what reads the bodies."""
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with a body that comes in time."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        loop = asyncio.get_running_loop()
        began, size, more = loop.time(), 0, True

        async def in_time() -> Message:
            nonlocal size, more
            if not more:  # the end of the connection, for which any time is right
                return await receive()
            try:
                async with asyncio.timeout_at(began + BODY + size / BYTES_PER_SECOND):
                    message = await receive()
            except TimeoutError:
                more = False
                raise SlowError("the request came too slowly") from None
            size += len(message.get("body", b""))
            more = bool(message.get("more_body"))
            return message

        await self._app(scope, in_time, send)
