"""The requests of the page, and the answers."""

from __future__ import annotations

import json
import secrets
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from importlib import resources
from typing import Any
from urllib.parse import unquote

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import ClientDisconnect, Request
from starlette.responses import FileResponse, JSONResponse, PlainTextResponse, Response
from starlette.routing import Route

from hersey.app.analysis import CORRECTIONS, Analysis
from hersey.app.door import Door, Patience, SlowError
from hersey.app.guard import SANDBOX, Guard
from hersey.app.session import NotNowError, Session, UnknownError
from hersey.app.uploads import TooMuchError
from hersey.app.view import line_of, view_of
from hersey.errors import HerseyError
from hersey.machine.questions import BY_KEY, MACHINE, POINT, Question

Handler = Callable[[Request], Awaitable[Response]]
#: Files of the page, and what each is.
_STATIC = {
    "": ("app", "app.html", "text/html; charset=utf-8"),
    "tokens.css": ("report", "tokens.css", "text/css; charset=utf-8"),
    "app.css": ("app", "app.css", "text/css; charset=utf-8"),
    "icon.svg": ("app", "icon.svg", "image/svg+xml"),
    "app.js": ("app", "app.js", "text/javascript; charset=utf-8"),
    "building.js": ("app", "building.js", "text/javascript; charset=utf-8"),
    "machine.js": ("app", "machine.js", "text/javascript; charset=utf-8"),
    "channels.js": ("app", "channels.js", "text/javascript; charset=utf-8"),
    "analyses.js": ("app", "analyses.js", "text/javascript; charset=utf-8"),
}


class BadRequestError(Exception):
    """A request body that is not a JSON object; the message says why."""


def application(session: Session, *, token: str, port: int, door: Door | None = None) -> Starlette:
    """Return the server of a session, for the port on which it listens.

    ``door`` is where its connections come in, if it has one.
    """
    routes = _Routes(session)

    @asynccontextmanager
    async def until_the_end(_app: Starlette) -> AsyncIterator[None]:
        try:
            yield
        finally:
            await session.close()

    one = "/api/analyses/{one}"
    return Starlette(
        routes=[
            *(Route(f"/{name}", _static(*file), methods=["GET"]) for name, file in _STATIC.items()),
            Route("/report/{number}", routes.report, methods=["GET"]),
            Route("/api/questions", routes.questions, methods=["GET"]),
            Route("/api/state", routes.state, methods=["GET"]),
            Route("/api/analyses", _safe(routes.new), methods=["POST"]),
            Route(one, _safe(routes.view), methods=["GET"]),
            Route(one, _safe(routes.remove), methods=["DELETE"]),
            Route(f"{one}/files", _safe(routes.drop), methods=["POST"]),
            Route(f"{one}/files/{{file}}", _safe(routes.remove_file), methods=["DELETE"]),
            Route(f"{one}/choices", _safe(routes.choices), methods=["POST"]),
            Route(f"{one}/machine", _safe(routes.machine), methods=["POST"]),
            Route(f"{one}/mend", _safe(routes.mend), methods=["POST"]),
            Route(f"{one}/run", _safe(routes.run), methods=["POST"]),
            Route(f"{one}/cancel", _safe(routes.cancel), methods=["POST"]),
            Route(f"{one}/hersey.toml", _safe(routes.mapping_file), methods=["GET"]),
            Route(f"{one}/machine.toml", _safe(routes.machine_file), methods=["GET"]),
            Route(f"{one}/recipe.toml", _safe(routes.recipe_file), methods=["GET"]),
            Route(f"{one}/report.html", _safe(routes.report_file), methods=["GET"]),
        ],
        middleware=[Middleware(Guard, token=token, port=port, door=door), Middleware(Patience)],
        lifespan=until_the_end,
    )


def new_token() -> str:
    """Return a random token that cannot be guessed."""
    return secrets.token_urlsafe(32)


def _static(room: str, name: str, kind: str) -> Handler:
    content = (resources.files(f"hersey.{room}") / "static" / name).read_bytes()

    async def answer(_request: Request) -> Response:
        return Response(content, media_type=kind)

    return answer


def _safe(handler: Handler) -> Handler:
    """A handler whose refusals are answers with words."""

    async def answer(request: Request) -> Response:
        try:
            return await handler(request)
        except Exception as error:
            for kinds, status, words in _REFUSALS:
                if isinstance(error, kinds):
                    return JSONResponse({"error": words or str(error)}, status_code=status)
            raise

    return answer


#: What refuses a request, the first that an error is one of: its status, and the words if not its own.
_REFUSALS: tuple[tuple[type[Exception] | tuple[type[Exception], ...], int, str], ...] = (
    (UnknownError, 404, "this is no longer open in the app"),
    (TooMuchError, 413, ""),
    (NotNowError, 409, ""),
    (ClientDisconnect, 400, "the page went away"),
    (BadRequestError, 400, ""),
    (SlowError, 408, ""),
    ((ValueError, TypeError, KeyError), 400, "this cannot be chosen"),
    (HerseyError, 409, ""),
)


class _Routes:
    """The handlers."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def _one(self, request: Request) -> Analysis:
        return self._session.get(request.path_params["one"])

    async def _json(self, request: Request) -> dict[str, Any]:
        body = b""
        async for chunk in request.stream():
            body += chunk
            if len(body) > self._session.bounds.request:
                raise TooMuchError("the request is too long")
        try:
            given = json.loads(body or b"{}")
            if not isinstance(given, dict):
                raise BadRequestError("the request is no JSON object")
            json.dumps(given, ensure_ascii=False).encode()  # which no half of a character survives
        except RecursionError:
            raise BadRequestError("the JSON of the request is nested too deeply") from None
        except ValueError as error:
            raise BadRequestError(f"the request is no JSON: {error}") from None
        return given

    async def questions(self, _request: Request) -> Response:
        return JSONResponse(
            {
                "machine": [_question(q) for q in MACHINE],
                "point": [_question(q) for q in POINT],
                "corrections": [_question(BY_KEY[key]) for key in CORRECTIONS],
                "most": self._session.bounds.file,
            }
        )

    async def state(self, _request: Request) -> Response:
        earlier = [each.line() for each in await self._session.earlier()]
        lines = [line_of(one) for one in self._session.analyses.values()]
        return JSONResponse({"analyses": lines, "earlier": earlier})

    async def new(self, _request: Request) -> Response:
        return JSONResponse(view_of(self._session.new()))

    async def view(self, request: Request) -> Response:
        return JSONResponse(view_of(self._one(request)))

    async def remove(self, request: Request) -> Response:
        self._session.remove(self._one(request))
        return JSONResponse({})

    async def drop(self, request: Request) -> Response:
        one = self._one(request)
        length = request.headers.get("content-length", "")
        name = unquote(request.headers.get("x-name", ""))
        await self._session.drop(one, name, int(length) if length else None, request.stream())
        return JSONResponse(view_of(one))

    async def remove_file(self, request: Request) -> Response:
        one = self._one(request)
        await self._session.remove_file(one, request.path_params["file"])
        return JSONResponse(view_of(one))

    async def choices(self, request: Request) -> Response:
        one = self._one(request)
        given = await self._json(request)
        given.pop("remove", None)
        await self._session.change(one, given)
        return JSONResponse(view_of(one))

    async def machine(self, request: Request) -> Response:
        one = self._one(request)
        refused = await self._session.take_machine(one, await self._json(request))
        return JSONResponse(view_of(one) | {"refused": refused})

    async def mend(self, request: Request) -> Response:
        one = self._one(request)
        given = await self._json(request)
        act = self._session.keep if given.get("keep") else self._session.mend
        await act(one, str(given["fault"]))
        return JSONResponse(view_of(one))

    async def run(self, request: Request) -> Response:
        one = self._one(request)
        await self._session.run(one)
        return JSONResponse(view_of(one))

    async def cancel(self, request: Request) -> Response:
        one = self._one(request)
        self._session.cancel(one)
        return JSONResponse(view_of(one))

    async def mapping_file(self, request: Request) -> Response:
        return PlainTextResponse(self._one(request).mapping_file())

    async def machine_file(self, request: Request) -> Response:
        return PlainTextResponse(self._one(request).machine_file())

    async def recipe_file(self, request: Request) -> Response:
        path = self._session.shown.get(self._one(request).report)
        recipe = None if path is None else path.with_suffix(".toml")
        if recipe is None or not recipe.is_file():
            return PlainTextResponse("This recipe is no longer available.", status_code=404)
        return PlainTextResponse(recipe.read_text(encoding="utf-8"))

    async def report_file(self, request: Request) -> Response:
        return self._report(self._one(request).report)

    async def report(self, request: Request) -> Response:
        return self._report(request.path_params["number"])

    def _report(self, number: str) -> Response:
        path = self._session.shown.get(number)
        if path is None or not path.is_file():
            return PlainTextResponse("This report is no longer available.", status_code=404)
        return FileResponse(path, media_type="text/html", headers={"content-security-policy": SANDBOX})


def _question(question: Question) -> dict[str, Any]:
    names = (
        *("key", "section", "field", "called", "words", "example", "bare_example"),
        *("unit", "letter", "first"),
    )
    return {name: getattr(question, name) for name in names}
