"""Access control: only a page of this server, on this computer, with the token of this start.

Names that another site makes lead here are refused by the Host, requests that another site sends by the
Origin and for lack of the token, which stands in no address that is sent: only in the fragment.
"""

from __future__ import annotations

import hmac
import json
from collections.abc import Sequence

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from hersey.app.door import Door

#: The policy of the app's page: its own files, nothing else; no text becomes markup.
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'; require-trusted-types-for 'script'"
)
#: What is added to that of a report: it is nobody's, so that nothing of this server is its own.
SANDBOX = "sandbox allow-scripts allow-downloads allow-modals allow-popups; frame-ancestors 'none'"
TOKEN_HEADER = "x-hersey-token"
_ALWAYS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cache-control": "no-store",
    "x-frame-options": "DENY",
    "cross-origin-resource-policy": "same-origin",
    "permissions-policy": "camera=(), microphone=(), geolocation=()",
}


class Guard:
    """Refuses, before anything else, requests that do not come from the page of this start."""

    def __init__(self, app: ASGIApp, *, token: str, port: int, door: Door | None = None) -> None:
        """Take the token, the port that is listened on, and where connections come in."""
        self._app, self._token, self._door = app, token, door
        self._hosts = (f"127.0.0.1:{port}", f"localhost:{port}")

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer, or pass on."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        if scope["type"] != "http":  # nothing here speaks another protocol
            return
        path = scope["path"]

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = list(message.get("headers", []))
                have = {name for name, _ in headers}
                added = _ALWAYS | ({} if path.startswith("/report/") else _OF_THE_PAGE)
                headers += [(n.encode(), v.encode()) for n, v in added.items() if n.encode() not in have]
                message = {**message, "headers": headers}
            await send(message)

        refusal = self._refusal(scope)
        if refusal is None:
            if self._door is not None and path.startswith("/api/"):  # the token was right
                self._door.know(scope["client"])
            await self._app(scope, receive, with_headers)
            return
        body = json.dumps({"error": refusal}).encode()
        length = (b"content-length", str(len(body)).encode())
        kind = (b"content-type", b"application/json")
        await with_headers(
            {
                "type": "http.response.start",
                "status": 403,
                "headers": [kind, length, (b"connection", b"close")],
            }
        )
        await with_headers({"type": "http.response.body", "body": body})

    def _refusal(self, scope: Scope) -> str | None:
        headers = scope["headers"]
        host = _values(headers, b"host")
        if len(host) != 1 or host[0] not in self._hosts:
            return "this server answers to 127.0.0.1 alone"
        origin = _values(headers, b"origin")
        own = f"http://{host[0]}"
        if any(each != own for each in origin):
            return "the request comes from another page"
        site = _values(headers, b"sec-fetch-site")
        if scope["method"] not in ("GET", "HEAD") and (not origin or site not in ([], ["same-origin"])):
            return "the request does not come from this page"
        if scope["path"].startswith("/api/"):
            given = _values(headers, TOKEN_HEADER.encode())
            if len(given) != 1 or not hmac.compare_digest(given[0].encode(), self._token.encode()):
                return "the token of this start is missing: open the address that hersey app printed"
        return None


_OF_THE_PAGE = {"content-security-policy": POLICY, "cross-origin-opener-policy": "same-origin"}


def _values(headers: Sequence[tuple[bytes, bytes]], name: bytes) -> list[str]:
    return [value.decode("latin-1") for key, value in headers if key == name]
