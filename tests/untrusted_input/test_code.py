"""No formula, name, unit or comment of a file runs as code, and none that is not understood is read raw."""

from __future__ import annotations

import ctypes
import os
import signal
import socket
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import hersey
from hersey.errors import HerseyError
from hersey.log import list_channels
from hersey.log.formats import opening
from hersey.processes.child import Child, FailedError
from tests.untrusted_input.mdf_blocks import (
    RANGE_TO_TEXT,
    VALUE_TO_TEXT,
    Channel,
    Conversion,
    formula,
    mdf3,
    mf4,
)
from tests.untrusted_input.seeds import ROWS, SPEED, TEMPERATURE, TIME, hdf5, tdms

pytest.importorskip("asammdf")
RAW = np.arange(1, ROWS + 1, dtype="<u2")
#: What runs if anything does: P is a payload in Python, S a command of a shell, M the marker.
FORMULAS = [
    "\"'\"==P==\"'\"",
    "'\"'==P=='\"'",
    "\"'\"==exec(\"P\")==\"'\"",
    "X+\"'\"==P==\"'\"",
    "P",
    "X+P",
    "(P)",
    "sin(P)",
    "pow(X,P)",
    "where(P,X,X)",
    "P if 1 else X",
    "X and P",
    "X;P",
    "X\nP",
    "X\r\nP",
    "X # P",
    "X,P",
    "(X,P)",
    "[P for X in [1]][0]",
    "{P}",
    "(lambda:P)()",
    "(lambda X=P:X)",
    "(y:=P)",
    "import os;os.system('S')",
    "__import__('os').system('S')",
    "eval(\"P\")",
    "exec(\"P\")",
    "compile('M','M','exec')",
    "f\"{P}\"",
    "getattr(X,'__cl'+'ass__')",
    "X.__class__.__mro__",
    "X.tofile('M')",
    "X1.__init__.__globals__",
    "().__class__.__base__.__subclasses__()",
    "globals()['__builtins__']['open']('M','w')",
    "sympify(\"P\")",
    "Symbol('x').__class__",
    "lambdify(X,\"P\")(X)",
    "evaluate(\"P\")",
    "np.save('M',X)",
    "\N{FULLWIDTH LATIN SMALL LETTER O}pen('M','w')",
    "\N{FULLWIDTH LATIN SMALL LETTER E}val(\"P\")",
    "\N{CYRILLIC CAPITAL LETTER HA}+1",
    "X²",
    "٣*X",
    "1_000*X",
    "1j*X",
    "X%2",
    "X//2",
    "X<<2",
    "X&1",
    "X|1",
    "~X",
    "not X",
    "X@X",
    "X==1",
    "X()",
    "X(1)",
    "sin",
    "sin()",
    "sin(X,X)",
    "pow(X)",
    "X X",
    "2X",
    "1.2.3*X",
    "X+",
    "*X",
    "()",
    ")(",
    "Y",
    "X10",
    "$(S)",
    "`S`",
    "(" * 5000 + "X" + ")" * 5000,
    "-" * 1900 + "(" * 50 + "X" + ")" * 50,
    "X+" * 100_000 + "X",
    "X" * 100_000,
    "9" * 100_000,
    "sin(" * 60 + "X" + ")" * 60,
    "X^" * 60 + "X",
]  # fmt: skip
#: The same, where a formula may stand in an MF4 file.
PLACES: dict[str, Callable[[str], Conversion]] = {
    "in a table of values": lambda text: Conversion(VALUE_TO_TEXT, [formula(text), None], [RAW[0]]),
    "as the default of a table of values": lambda text: Conversion(VALUE_TO_TEXT, ["a", formula(text)], [0]),
    "in a table of ranges": lambda text: Conversion(RANGE_TO_TEXT, [formula(text), None], [0, 1e4]),
    "as the default of a table of ranges": lambda text: Conversion(
        RANGE_TO_TEXT, ["a", formula(text)], [-2, -1]
    ),
    "in a large table": lambda text: Conversion(VALUE_TO_TEXT, [formula(text)] * 200 + [None], range(1, 201)),
    "two tables deep": lambda text: Conversion(
        RANGE_TO_TEXT, [Conversion(VALUE_TO_TEXT, ["a", formula(text)], [0]), None], [0, 1e4]
    ),
}
EXECUTING = [text for text in FORMULAS if "P" in text][:6]


class Trap:
    """Where a payload would leave a trace: marker files, and a socket that listens."""

    def __init__(self, here: Path) -> None:
        """Listen."""
        self.here = here
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.socket.setblocking(False)
        self.payloads = [
            "open('MARK','w')",
            f"open('{here}/MARK','w')",
            f"__import__('os').system('touch {here}/MARK /tmp/MARK-of-a-stranger')",
            f"__import__('socket').create_connection(('127.0.0.1',{self.socket.getsockname()[1]}))",
        ]

    def set_in(self, text: str, number: int = 0) -> str:
        """A formula, or any text, with a payload."""
        payload = self.payloads[number % len(self.payloads)]
        if '"P"' in text:
            payload = payload.replace('"', "'")
        return (
            text.replace("P", payload)
            .replace("S", f"touch {self.here}/MARK")
            .replace("'M'", f"'{self.here}/MARK'")
        )

    def assert_untouched(self) -> None:
        assert not list(self.here.rglob("MARK*"))
        assert not Path("/tmp/MARK-of-a-stranger").exists()
        with pytest.raises(BlockingIOError):
            self.socket.accept()


@pytest.fixture
def trap(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Trap]:
    monkeypatch.chdir(tmp_path)
    trap = Trap(tmp_path)
    yield trap
    trap.socket.close()


def channels(torque: Conversion | None, time: Conversion | None = None, **changed: Any) -> list[Channel]:
    return [
        Channel("t", TIME, "s", time, kind=2),
        Channel(**{"name": "Torque", "values": RAW, "unit": "N*m", "conversion": torque} | changed),
        Channel("Speed", RAW, "rpm", formula("60+X/2")),
        Channel("Temp", TEMPERATURE, "degC"),
    ]


def told(path: Path) -> str:
    """Why a log is refused; the sound channel beside is read rightly."""
    assert ("Torque", "N*m") in list_channels(path)
    with pytest.raises(HerseyError) as refused:
        hersey.read(path)
    inspection = hersey.inspect(path)
    assert [channel.name for channel in inspection.files[0].channels] == ["Speed", "Temp"]
    speed = inspection.files[0].channels[0].traits
    assert (speed.low, speed.high) == (60 + RAW[0] / 2, 60 + RAW[-1] / 2)
    return str(refused.value)


def plain(text: str) -> str:
    return text.replace("X1", "X").replace("x", "X").replace("eXp", "exp")


def assert_refused(message: str, text: str) -> None:
    """The channel is refused by its name, with the formula (asammdf writes an x large)."""
    text, message = plain(text), plain(message)
    assert "channel 'Torque' has " in message
    assert repr(text[:80]) in message or f"formula of {len(text)} characters" in message
    assert "\n" not in message


@pytest.mark.parametrize("number", range(len(FORMULAS)))
def test_a_formula_of_a_channel(number: int, trap: Trap) -> None:
    text = trap.set_in(FORMULAS[number], number)
    path = trap.here / "log.mf4"
    path.write_bytes(mf4(channels(formula(text))))
    message = told(path)
    trap.assert_untouched()
    assert_refused(message, text.replace("X1", "X"))


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("number", range(len(EXECUTING)))
def test_a_formula_within_a_table(place: str, number: int, trap: Trap) -> None:
    text = trap.set_in(EXECUTING[number], number)
    path = trap.here / "log.mf4"
    path.write_bytes(mf4(channels(PLACES[place](text))))
    message = told(path)
    trap.assert_untouched()
    assert_refused(message, text)


@pytest.mark.parametrize("number", range(len(EXECUTING)))
def test_a_formula_of_the_clock(number: int, trap: Trap) -> None:
    """None of the channels that it times is read: not the second, either, nor with raw times."""
    text = trap.set_in(EXECUTING[number], number)
    path = trap.here / "log.mf4"
    path.write_bytes(mf4(channels(formula("X"), formula(text))))
    with pytest.raises(HerseyError, match="formula") as refused:
        hersey.read(path)
    inspection = hersey.inspect(path)
    assert not inspection.files[0].channels
    assert sum("formula" in str(each) for each in inspection.files[0].warnings) == 3
    trap.assert_untouched()
    assert repr(plain(text)[:40])[1:-1] in plain(str(refused.value))


@pytest.mark.parametrize("number", range(len(EXECUTING)))
@pytest.mark.parametrize("place", ["torque", "clock"])
def test_a_formula_of_mdf_3(place: str, number: int, trap: Trap) -> None:
    text = trap.set_in(EXECUTING[number], number)
    told = [None, text.encode() + b"\0"] if place == "torque" else [text.encode() + b"\0", None]
    path = trap.here / "log.mdf"
    path.write_bytes(
        mdf3(
            [
                ("t", "s", TIME, told[0]),
                ("Torque", "N*m", RAW, told[1]),
                ("Speed", "rpm", SPEED, None),
                ("Temp", "degC", TEMPERATURE, None),
            ]
        )
    )
    with pytest.raises(HerseyError, match="formula") as refused:
        hersey.read(path)
    names = [channel.name for channel in hersey.inspect(path).files[0].channels]
    assert names == (["Speed", "Temp"] if place == "torque" else [])
    trap.assert_untouched()
    assert repr(plain(text)[:40])[1:-1] in plain(str(refused.value))


XML = '<!DOCTYPE x [<!ENTITY e SYSTEM "file:///etc/passwd">]><{0}><TX>&e;P</TX><formula><syntax>P</syntax></formula></{0}>'
BOMB = (
    "<!DOCTYPE x ["
    + "".join(f'<!ENTITY e{i + 1} "{f"&e{i};" * 10}">' for i in range(10))
    + '<!ENTITY e0 "aaaaaaaaaa">]><{0}><TX>&e10;</TX></{0}>'
)


@pytest.mark.parametrize("text", ["P", FORMULAS[0], "${P}", "{P}", "%s" * 50, "=cmd|'S'!A0", XML, BOMB])
@pytest.mark.parametrize("place", ["name", "unit", "comment", "header", "conversion"])
def test_words_of_a_file_are_words(place: str, text: str, trap: Trap) -> None:
    text = trap.set_in(text).replace(
        "{0}", {"header": "HDcomment", "conversion": "CCcomment"}.get(place, "CNcomment")
    )
    path = trap.here / "log.mf4"
    changed = {place: text} if place in ("name", "unit", "comment") else {}
    conversion = formula("X")
    if place == "conversion":
        conversion.comment, conversion.unit = text, text
    path.write_bytes(mf4(channels(conversion, **changed), comment=text if place == "header" else ""))
    for call in (list_channels, hersey.read, hersey.inspect):
        told = ""
        try:
            call(path)
        except HerseyError as error:
            told = str(error)
        assert "\n" not in told
        assert len(told) < 3000
    trap.assert_untouched()
    assert "root:" not in str(hersey.inspect(path))


def test_paths_in_names_of_other_formats_stay_names(trap: Trap) -> None:
    for name in (trap.payloads[2], "../../MARK", f"{trap.here}/MARK", "$(touch MARK)", "a\0b", "MARK\n"):
        (trap.here / "a.tdms").write_bytes(tdms([(name, "N*m", SPEED), ("Speed", "rpm", SPEED)]))
        assert len(list_channels(trap.here / "a.tdms")) == 2
    (trap.here / "a.h5").write_bytes(hdf5())
    assert list_channels(trap.here / "a.h5")
    trap.assert_untouched()


def values_of(path: Path) -> np.ndarray:
    torque: np.ndarray = hersey.read(path).runs[0].torque
    return torque


def test_what_a_sign_was_read_as_is_warned_of(tmp_path: Path) -> None:
    (tmp_path / "log.mf4").write_bytes(mf4(channels(formula("X^2"))))
    kind = "sign in a formula read as a power"
    (power,) = [each for each in hersey.read(tmp_path / "log.mf4").files[0].warnings if each.kind == kind]
    assert (power.values["channel"], power.values["formula"]) == ("Torque", "X^2")
    assert str(power) == "'Torque': '^' in its formula 'X^2' was read as a power."


SOUND: dict[str, Callable[[float], float]] = {
    "X/3": lambda x: x / 3,
    "1/X": lambda x: 1 / x,
    "7/2*X": lambda x: 3.5 * x,
    "X^2": lambda x: x * x,
    "X**2": lambda x: x * x,
    "2^3^2*X": lambda x: 512 * x,
    "-X^2": lambda x: -x * x,
    "2^-1*X": lambda x: 0.5 * x,
    "2*-X": lambda x: -2 * x,
    "10-4-3+X": lambda x: 3 + x,
    "64/4/2+X": lambda x: 8 + x,
    "X-100": lambda x: x - 100,
    "X*65536": lambda x: x * 65536,
    "((X))": lambda x: x,
    "1e-3*X+.5": lambda x: 0.001 * x + 0.5,
    "2.5E+1*X1": lambda x: 25 * x,
    " X \t+ 1 ": lambda x: x + 1,
    "exp(X/100)": lambda x: float(np.exp(x / 100)),
    "log(X)": lambda x: float(np.log(x)),
    "ln(X)": lambda x: float(np.log(x)),
    "log10(X)": lambda x: float(np.log10(x)),
    "sqrt(X)": lambda x: x**0.5,
    "abs(X-30)": lambda x: abs(x - 30),
    "pow(X,3)": lambda x: x**3,
    "sin(X)+cos(X)": lambda x: float(np.sin(x) + np.cos(x)),
    "atan(X)": lambda x: float(np.arctan(x)),
    "5": lambda _: 5.0,
}


@pytest.mark.parametrize("text", SOUND)
def test_a_sound_formula_gives_the_numbers_it_says(text: str, tmp_path: Path) -> None:
    wanted = [SOUND[text](float(x)) for x in RAW]
    (tmp_path / "log.mf4").write_bytes(mf4(channels(formula(text))))
    np.testing.assert_allclose(values_of(tmp_path / "log.mf4"), wanted, rtol=1e-14)
    told = text.replace("X1", "X").replace("X", "X1").replace("eX1p", "exp").encode() + b"\0"
    (tmp_path / "log.mdf").write_bytes(
        mdf3([("t", "s", TIME, None), ("Torque", "N*m", RAW, told), ("Speed", "rpm", SPEED, None),
              ("Temp", "degC", TEMPERATURE, None)])
    )  # fmt: skip
    np.testing.assert_allclose(values_of(tmp_path / "log.mdf"), wanted, rtol=1e-14)


@pytest.mark.parametrize("place", [place for place in PLACES if "in a table of values" not in place])
def test_a_sound_formula_within_a_table(place: str, tmp_path: Path) -> None:
    (tmp_path / "log.mf4").write_bytes(mf4(channels(PLACES[place]("X/4+1"))))
    np.testing.assert_allclose(values_of(tmp_path / "log.mf4"), RAW / 4 + 1, rtol=1e-14)


@pytest.mark.parametrize("text", ["9^9^9^9", "X^1e308", "1e999*X", "1/(X-X)", "log(-X)", "sqrt(-X)"])
def test_what_is_no_number_is_missing(text: str, tmp_path: Path) -> None:
    """Huge exponents cost no time: numbers are floating."""
    (tmp_path / "log.mf4").write_bytes(mf4(channels(formula(text))))
    with pytest.raises(HerseyError, match="'Torque'"):
        hersey.read(tmp_path / "log.mf4")


# What follows takes the grammar away: the wall around the process that reads has to hold by itself.

EVALUATING = """
import runpy
space = runpy.run_path({answering!r}, run_name="__main__")
from hersey.log.formats import mdf
mdf.evaluate = lambda formula, values: eval(formula, dict(values))
answer = space["answer"]
"""
TRYING = """
import ctypes, glob, mmap, os, runpy, signal, socket, subprocess, sys
runpy.run_path({answering!r}, run_name="__main__")

def answer(request, payload):
    return {{"value": repr(eval(request["code"]))}}, b""
"""


def landlock() -> int:
    """The version of Landlock, 0 where there is none."""
    if sys.platform != "linux":
        return 0
    return max(0, ctypes.CDLL(None).syscall(444, None, ctypes.c_size_t(0), 1))


def script(folder: Path, text: str) -> Path:
    path = folder / "script.py"
    path.write_text(text.format(answering=str(opening._SCRIPT)))
    return path


def needs_landlock(version: int) -> None:
    if landlock() < version:
        pytest.skip(f"the system has Landlock in version {landlock()}, and this wall is of version {version}")


def test_without_the_grammar_the_wall_holds(trap: Trap, monkeypatch: pytest.MonkeyPatch) -> None:
    needs_landlock(4)
    monkeypatch.setattr(opening, "_SCRIPT", script(trap.here, EVALUATING))
    monkeypatch.setattr(opening._Reader, "_waiting", [])
    path = trap.here / "log.mf4"
    path.write_bytes(mf4(channels(formula("X.sum()*2.0+X*0"))))
    assert values_of(path)[0] == RAW.sum() * 2.0, "the formula was to be evaluated as Python"
    for payload in trap.payloads:
        path.write_bytes(mf4(channels(formula(payload))))
        with pytest.raises(HerseyError):
            hersey.read(path)
        trap.assert_untouched()


TRIES = {
    "read a file": "open({secret!r}).read()",
    "read a file of the system": "open('/etc/passwd').read()",
    "list a folder": "os.listdir({here!r})",
    "read the memory of the parent": "open('/proc/{parent}/mem', 'rb').read(1)",
    "read the environment of the parent": "open('/proc/{parent}/environ', 'rb').read()",
    "write a file": "open({marker!r}, 'w')",
    "write a file in the folder": "open('MARK', 'w')",
    "write over a file": "open({secret!r}, 'r+')",
    "make a folder": "os.mkdir({marker!r})",
    "make a link": "os.symlink('/etc/passwd', {marker!r})",
    "make a hard link": "os.link({secret!r}, {marker!r})",
    "make a pipe": "os.mkfifo({marker!r})",
    "remove a file": "os.remove({secret!r})",
    "rename a file": "os.rename({secret!r}, {marker!r})",
    "cut a file": "os.truncate({secret!r}, 0)",
    "write to what is open": "os.write(os.open('/proc/self/comm', os.O_WRONLY), b'x')",
    "run a program": "subprocess.run(['/bin/sh', '-c', 'true'], check=True)",
    "run Python": "os.execv(sys.executable, [sys.executable, '-c', '1'])",
    "connect": "socket.create_connection(('127.0.0.1', {port}), 5)",
    "listen": "socket.create_server(('127.0.0.1', 0))",
    "kill the parent": "os.kill({parent}, signal.SIGUSR1)",
    "trace the parent": "1 / (ctypes.CDLL(None).ptrace(16, {parent}, 0, 0) + 1)",
    "open a device": "open('/dev/zero', 'rb')",
    "connect to a socket in the file system": "socket.socket(socket.AF_UNIX).connect({socket!r})",
    "connect to a socket in the abstract": "socket.socket(socket.AF_UNIX).connect('\\0' + {abstract!r})",
    "send a datagram": "socket.socket(socket.AF_INET, socket.SOCK_DGRAM).sendto(b'x', ('127.0.0.1', {udp}))",
}


@pytest.mark.parametrize("what", TRIES)
def test_code_in_the_process_that_reads_can_do_nothing(what: str, trap: Trap) -> None:
    needs_landlock(6)
    (trap.here / "secret.txt").write_text("secret")
    places = {"unix": socket.AF_UNIX, "abstract": socket.AF_UNIX, "udp": socket.AF_INET}
    kinds = {"unix": socket.SOCK_STREAM, "abstract": socket.SOCK_STREAM, "udp": socket.SOCK_DGRAM}
    ends = {name: socket.socket(family, kinds[name]) for name, family in places.items()}
    abstract = f"hersey-{os.getpid()}-{trap.here.name}"
    ends["unix"].bind("unix.sock")
    ends["abstract"].bind("\0" + abstract)
    ends["udp"].bind(("127.0.0.1", 0))
    ends["unix"].listen()
    ends["abstract"].listen()
    signals: list[int] = []
    before = signal.signal(signal.SIGUSR1, lambda number, _: signals.append(number))
    code = TRIES[what].format(
        secret=str(trap.here / "secret.txt"), marker=str(trap.here / "MARK"), here=str(trap.here),
        parent=os.getpid(), port=trap.socket.getsockname()[1], socket=str(trap.here / "unix.sock"),
        abstract=abstract, udp=ends["udp"].getsockname()[1],
    )  # fmt: skip
    child = Child(script(trap.here, TRYING))
    try:
        assert child.ask({"code": "1 + 1"})[0] == {"value": "2"}
        with pytest.raises(FailedError) as failed:
            child.ask({"code": code})
        assert failed.value.kind in ("PermissionError", "OSError", "ZeroDivisionError", "FileNotFoundError")
    finally:
        child.stop()
        signal.signal(signal.SIGUSR1, before)
        for end in ends.values():
            end.close()
    trap.assert_untouched()
    assert not signals
    assert (trap.here / "secret.txt").read_text() == "secret"
