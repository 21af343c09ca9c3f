"""Start the app: a free port on the loopback address, a token and a private folder, until Ctrl-C."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import socket
import tempfile
import threading
import webbrowser
from collections.abc import Callable, Iterator
from pathlib import Path

import uvicorn

from hersey.app.door import Door
from hersey.app.server import application, new_token
from hersey.app.session import Session
from hersey.app.uploads import Bounds
from hersey.errors import OutputError, Setting

_PREFIX, _LOCK = "hersey-app-", "lock"
#: Opens the app: the token is in no list of processes, as the argument of a browser would be.
_OPENING = '<!doctype html><meta charset="utf-8"><meta name="referrer" content="no-referrer">\
<meta http-equiv="refresh" content="0;url={address}"><title>hersey</title>\n'


def serve(
    *, port: int, reports: Path, browser: bool, said: Callable[[str], None], bounds: Bounds | None = None
) -> None:
    """Serve the page until Ctrl-C.

    Parameters
    ----------
    port
        0 for any that is free.
    reports
        Where finished reports are kept.
    browser
        Whether to open the page.
    said
        Called with the address, once the page can be opened.

    Raises
    ------
    OutputError
        If the port is taken.
    """
    with _socket(port) as listening, private_folder() as folder:
        port, token = listening.getsockname()[1], new_token()
        door = Door()
        app = application(Session(folder, reports, bounds), token=token, port=port, door=door)
        config = uvicorn.Config(
            app,
            log_config=None,
            access_log=False,
            server_header=False,
            date_header=False,
            proxy_headers=False,
            loop="asyncio",
            http=door.protocol(),
            ws="none",
            timeout_graceful_shutdown=1,
        )
        address = f"http://127.0.0.1:{port}/#{token}"
        said(address)
        if browser:
            opening = folder / "open.html"
            opening.write_text(_OPENING.format(address=address), encoding="utf-8")
            threading.Thread(target=webbrowser.open, args=(opening.as_uri(),), daemon=True).start()
        with _own_signals():
            uvicorn.Server(config).run(sockets=[listening])


@contextlib.contextmanager
def _own_signals() -> Iterator[None]:
    """Let the server end by itself on Ctrl-C, before whoever else watches for it ends the process."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    wakeup = signal.set_wakeup_fd(-1)
    try:
        yield
    finally:
        signal.set_wakeup_fd(wakeup)


def _socket(port: int) -> socket.socket:
    listening = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
    try:
        if os.name == "posix":
            listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(("127.0.0.1", port))
    except (OSError, OverflowError) as error:
        listening.close()
        reason = getattr(error, "strerror", None) or "there is no such port"
        raise OutputError(
            f"{Setting('port').to(str(port))}: {reason}: omit it to use any free port"
        ) from None
    listening.listen(64)
    return listening


@contextlib.contextmanager
def private_folder() -> Iterator[Path]:
    """Yield a folder that only this user can look into; it goes at the end, or with the next start."""
    _sweep()
    folder = Path(tempfile.mkdtemp(prefix=_PREFIX))  # 0700
    held = _hold(folder / _LOCK)
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
        if held is not None:
            os.close(held)


def _hold(lock: Path) -> int | None:
    """Take a lock that ends with the process, or None where somebody has it."""
    try:
        import fcntl
    except ImportError:
        return None
    handle = os.open(lock, os.O_RDWR | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0), 0o600)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        os.close(handle)
        return None
    return handle


def _sweep() -> None:
    """Remove the folders of starts that were killed."""
    if not hasattr(os, "getuid"):
        return
    for folder in Path(tempfile.gettempdir()).glob(f"{_PREFIX}*"):
        with contextlib.suppress(OSError):
            lock = folder / _LOCK
            if folder.is_symlink() or folder.stat().st_uid != os.getuid() or not lock.is_file():
                continue
            held = _hold(lock)
            if held is not None:
                shutil.rmtree(folder, ignore_errors=True)
                os.close(held)
