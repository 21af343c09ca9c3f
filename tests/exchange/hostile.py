"""Calls that no tool should make, one after the other: run by `test_c`, in a process that they may not end.

Prints the number of calls; ends with 0 if each was refused as it should be.
"""

from __future__ import annotations

import ctypes as c
import re
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

OK, DISCARD, ERROR = 0, 2, 3
Log3 = c.CFUNCTYPE(None, c.c_void_p, c.c_int, c.c_char_p, c.c_char_p)
Log2 = c.CFUNCTYPE(None, c.c_void_p, c.c_char_p, c.c_int, c.c_char_p, c.c_char_p)


class Callbacks2(c.Structure):
    """What an importer of FMI 2.0 is called back by."""

    _fields_ = (
        ("logger", Log2),
        ("allocate", c.c_void_p),
        ("free", c.c_void_p),
        ("finished", c.c_void_p),
        ("environment", c.c_void_p),
    )


class Hostile:
    """The library at a path, a unit's resources, and what was logged."""

    def __init__(self, library: str, resources: Path) -> None:
        """Load it."""
        self.library = c.CDLL(library)
        self.resources = resources
        self.logged: list[str] = []
        self.count = 0
        self.log3 = Log3(lambda _e, _s, _c, text: self.logged.append(text.decode()))
        self.log2 = Log2(lambda _e, _n, _s, _c, text: self.logged.append(text.decode()))
        self.callbacks2 = Callbacks2(self.log2, None, None, None, None)

    def call(self, name: str, *arguments: Any, kind: Any = c.c_int) -> Any:
        """Call a function; numbers are doubles, pointers what they are."""
        function = getattr(self.library, name)
        function.restype = kind
        self.count += 1
        return function(*(c.c_double(a) if isinstance(a, float) else a for a in arguments))

    def refuses(self, name: str, *arguments: Any, says: str = "", status: int = ERROR) -> None:
        """Expect a refusal, and one line that says why."""
        before = len(self.logged)
        found = self.call(name, *arguments)
        assert found == status, f"{name}{arguments} returned {found}"
        assert len(self.logged) == before + 1, f"{name}{arguments} logged {self.logged[before:]}"
        assert says in self.logged[-1], self.logged[-1]
        assert self.logged[-1].startswith(name), self.logged[-1]

    def version3(self, *, event_mode: bool = False, path: bytes | None = None) -> c.c_void_p:
        """An instance for FMI 3.0."""
        path = f"{self.resources}/".encode() if path is None else path
        flags = (c.c_bool(False), c.c_bool(False), c.c_bool(event_mode), c.c_bool(event_mode))
        rest = (None, c.c_size_t(0), None, self.log3, None)
        made = self.call(
            "fmi3InstantiateCoSimulation", b"one", b"{token}", path, *flags, *rest, kind=c.c_void_p
        )
        return c.c_void_p(made)

    def version2(self) -> c.c_void_p:
        """An instance for FMI 2.0."""
        uri = self.resources.as_uri().encode()
        arguments = (b"one", 1, b"{token}", uri, c.byref(self.callbacks2), 0, 0)
        return c.c_void_p(self.call("fmi2Instantiate", *arguments, kind=c.c_void_p))


def nothing_at_all(hostile: Hostile, names: list[str]) -> None:
    """Every function with nothing but null."""
    for name in names:
        makes = "Instantiate" in name
        found = hostile.call(name, *[None] * 14, kind=c.c_void_p if makes else c.c_int)
        tells = name.endswith(("GetVersion", "GetTypesPlatform", "FreeInstance"))
        assert tells or found == (None if makes else ERROR), f"{name} returned {found}"


def every_function(hostile: Hostile, names: list[str]) -> None:
    """Every function with an instance that is not begun, and null for all else: at worst it is refused."""
    for name in names:
        if "Instantiate" in name or name.endswith(("FreeInstance", "GetVersion", "GetTypesPlatform")):
            continue
        instance = hostile.version3() if name.startswith("fmi3") else hostile.version2()
        assert hostile.call(name, instance, *[None] * 12) in (OK, DISCARD, ERROR), name
        hostile.call(name[:4] + "FreeInstance", instance, kind=None)


def instances(hostile: Hostile) -> None:
    """What does not become an instance."""
    assert not hostile.version3(path=b"/nowhere/at/all/").value
    assert "drive.txt" in hostile.logged[-1]
    assert not hostile.version3(path=b"\xff\xfe").value
    assert "UTF-8" in hostile.logged[-1]
    text = (hostile.resources / "drive.txt").read_text()
    broken = hostile.resources / "broken"
    broken.mkdir()
    for content, words in [
        (text.replace("mass = 1.0", "mass = -1.0"), "mass is -1"),
        (text.replace("token}", "other}"), "token"),
        ("\0\0\0", "line 1"),
        ("format = 1\nmass = \xe9\n" * 3, "line"),
    ]:
        (broken / "drive.txt").write_bytes(content.encode("latin-1"))
        assert not hostile.version3(path=str(broken).encode()).value
        assert words in hostile.logged[-1] or "UTF-8" in hostile.logged[-1], hostile.logged[-1]


def phases(hostile: Hostile) -> None:
    """Calls at the wrong time, with wrong references, lengths, times."""
    one, two = hostile.version3(event_mode=True), hostile.version2()
    size, outputs = c.c_size_t, (c.c_uint32 * 2)(10, 12)
    parameter, unknown, mode = (c.c_uint32 * 1)(101), (c.c_uint32 * 1)(4711), (c.c_uint32 * 1)(20)
    doubles = (c.c_double * 2)(1.0, 1.0)
    flags, last = [c.byref(c.c_bool()) for _ in range(3)], c.byref(c.c_double())
    get, put = "fmi3GetFloat64", "fmi3SetFloat64"
    hostile.refuses("fmi3DoStep", one, 0.0, 0.1, 0, *flags, last, says="before its initialization")
    hostile.refuses(get, one, outputs, size(2), doubles, size(2), says="before its initialization")
    hostile.refuses("fmi3EnterStepMode", one)
    hostile.refuses("fmi3ExitInitializationMode", one)
    hostile.refuses("fmi3Terminate", one)
    hostile.refuses("fmi3EnterInitializationMode", one, 1, float("nan"), 0.0, 0, 0.0, says="tolerance")
    hostile.refuses("fmi3EnterInitializationMode", one, 0, 0.0, float("inf"), 0, 0.0, says="start time")
    assert hostile.call("fmi3EnterInitializationMode", one, 0, 0.0, 0.0, 1, 5.0) == OK
    hostile.refuses("fmi3EnterInitializationMode", one, 0, 0.0, 0.0, 0, 0.0, says="in its initialization")
    hostile.refuses(put, one, outputs, size(2), doubles, size(2), says="computed")
    hostile.refuses(put, one, parameter, size(1), (c.c_double * 1)(float("nan")), size(1), says="finite")
    assert hostile.call(put, one, parameter, size(1), (c.c_double * 1)(-3.0), size(1)) == OK
    hostile.refuses("fmi3ExitInitializationMode", one, says="mass is -3")
    assert hostile.call(put, one, parameter, size(1), doubles, size(1)) == OK
    assert hostile.call("fmi3ExitInitializationMode", one) == OK
    hostile.refuses("fmi3DoStep", one, 0.0, 0.1, 0, *flags, last, says="at an event")
    hostile.refuses("fmi3UpdateDiscreteStates", one, *[None] * 6, says="null")
    assert hostile.call("fmi3EnterStepMode", one) == OK
    hostile.refuses("fmi3UpdateDiscreteStates", one, *[None] * 6, says="between two steps")
    hostile.refuses(put, one, parameter, size(1), doubles, size(1), says="fixed")
    hostile.refuses(get, one, unknown, size(1), doubles, size(1), says="no variable")
    hostile.refuses(get, one, mode, size(1), doubles, size(1), says="mode (value reference 20) is Enum")
    hostile.refuses(get, one, outputs, size(2), doubles, size(1), says="2 value references, but 1 values")
    hostile.refuses(get, one, None, size(2), doubles, size(2), says="null")
    hostile.refuses(get, one, outputs, size(2), None, size(2), says="null")
    hostile.refuses(get, one, c.c_void_p(1), size(2), doubles, size(2), says="no array")
    hostile.refuses(get, one, outputs, size(2**62), doubles, size(2**62), says="no array")
    hostile.refuses("fmi3GetInt32", one, mode, size(1), doubles, size(1), says="no variable is Int32")
    for begin, length in [(0.0, 0.0), (0.0, -1.0), (0.0, float("nan")), (0.5, 0.1), (0.0, 6.0)]:
        hostile.refuses("fmi3DoStep", one, begin, length, 0, *flags, last)
    hostile.refuses("fmi3DoStep", one, 0.0, 0.1, 0, None, None, None, None, says="null")
    assert hostile.call("fmi3DoStep", one, 0.0, 0.1, 0, *flags, last) == OK
    hostile.refuses("fmi3SetTime", one, 0.0, says="co-simulation only")
    hostile.refuses("fmi3SetDebugLogging", one, 1, size(1), (c.c_char_p * 1)(b"gossip"), says="no category")
    hostile.refuses("fmi2DoStep", two, 0.0, 0.1, 0)
    hostile.refuses("fmi2GetStatus", two, 0, None, status=DISCARD)
    orders = (c.c_int * 1)(2)
    hostile.refuses("fmi2SetRealInputDerivatives", two, (c.c_uint32 * 1)(1), size(1), orders, doubles)
    hostile.call("fmi3FreeInstance", one, kind=None)
    hostile.call("fmi2FreeInstance", two, kind=None)


def steps_in_order(hostile: Hostile) -> None:
    """What a step says of itself: whole, or ended early at a change of mode, which waits for its event."""
    event, terminate, early = (c.c_bool(True) for _ in range(3))
    last, mode, count = c.c_double(), (c.c_int64 * 1)(), c.c_size_t(1)
    for event_mode in (False, True):
        one = hostile.version3(event_mode=event_mode)
        said = [c.byref(each) for each in (event, terminate, early, last)]
        hostile.call("fmi3EnterInitializationMode", one, 0, 0.0, 0.0, 0, 0.0)
        hostile.call("fmi3ExitInitializationMode", one)
        if event_mode:
            hostile.call("fmi3EnterStepMode", one)
        for begin, changes in ((0.0, False), (0.3, True)):
            assert hostile.call("fmi3DoStep", one, begin, 0.3, 0, *said) == OK
            stops = event_mode and changes
            assert (event.value, terminate.value, early.value) == (stops, False, stops)
            assert last.value == (begin + 0.3 if not stops else last.value)
            assert begin < last.value <= begin + 0.3
        hostile.call("fmi3GetInt64", one, (c.c_uint32 * 1)(20), count, mode, count)
        assert (last.value < 0.35, mode[0] == 3) == (event_mode, True)
        hostile.call("fmi3FreeInstance", one, kind=None)


def plain(hostile: Hostile) -> None:
    """The plain functions: what they return, and what they refuse."""
    text, why, value = (
        (hostile.resources / "drive.txt").read_bytes(),
        c.create_string_buffer(20),
        c.c_double(),
    )
    for wrong, room in ((b"", 20), (text[:60], 5), (None, 1), (b"\xff", 0)):
        assert not hostile.call("hersey_drive_read", wrong, why, c.c_size_t(room), kind=c.c_void_p)
        assert len(why.value) == max(room - 1, 0) or room == 0
    drive = c.c_void_p(hostile.call("hersey_drive_read", text, None, c.c_size_t(0), kind=c.c_void_p))
    assert hostile.call("hersey_set", drive, b"mass", 1.0) == OK
    assert hostile.call("hersey_begin", drive, 0.0) == OK
    refused = (
        ("hersey_set", (b"mass", 1.0), "fixed"),
        ("hersey_set", (b"grip", 1.0), "no variable 'grip'"),
        ("hersey_set", (None, 1.0), "name is null"),
        ("hersey_slope", (b"belt_speed", 1.0), "no input"),
        ("hersey_get", (b"mode", None), "value is null"),
        ("hersey_begin", (0.0,), "between two steps"),
        ("hersey_advance", (float("nan"), 0), "not after"),
        ("hersey_save", (None, c.c_size_t(10)), "needed"),
        ("hersey_restore", (text, c.c_size_t(80)), "no saved state"),
    )
    for name, arguments, words in refused:
        assert hostile.call(name, drive, *arguments) == -1, name
        said = hostile.call("hersey_why", drive, kind=c.c_char_p).decode()
        assert said.startswith(f"{name}: "), said
        assert words in said, said
        assert hostile.call(name, None, *arguments) == -1, name
    assert b"no drive" in hostile.call("hersey_why", None, kind=c.c_char_p)
    assert hostile.call("hersey_advance", drive, 0.4, 1) == 1
    assert hostile.call("hersey_advance", drive, 0.4, 0) == OK
    assert hostile.call("hersey_get", drive, b"time", c.byref(value)) == OK
    assert value.value == 0.4
    hostile.call("hersey_free", drive, kind=None)
    hostile.call("hersey_free", None, kind=None)


def states(hostile: Hostile) -> None:
    """Saved states that are none, damaged, or of something else."""
    one, state, size = hostile.version3(), c.c_void_p(), c.c_size_t()
    assert hostile.call("fmi3GetFMUState", one, c.byref(state)) == OK
    assert hostile.call("fmi3GetFMUState", one, c.byref(state)) == OK  # in place of the first
    assert hostile.call("fmi3SerializedFMUStateSize", one, state, c.byref(size)) == OK
    saved = c.create_string_buffer(size.value)
    assert hostile.call("fmi3SerializeFMUState", one, state, saved, size) == OK
    hostile.refuses("fmi3SerializeFMUState", one, state, saved, c.c_size_t(size.value - 1), says="needed")
    hostile.refuses("fmi3SetFMUState", one, None, says="no saved state")
    hostile.refuses("fmi3SetFMUState", one, one, says="no saved state")
    other = c.c_void_p()
    for damage in range(0, size.value, 7):
        garbage = bytearray(saved.raw)
        garbage[damage] ^= 0xFF
        hostile.refuses("fmi3DeserializeFMUState", one, bytes(garbage), size, c.byref(other), says="no saved")
    for length in (0, 1, size.value - 8):
        hostile.refuses("fmi3DeserializeFMUState", one, saved, c.c_size_t(length), c.byref(other))
    assert hostile.call("fmi3DeserializeFMUState", one, saved, size, c.byref(other)) == OK
    assert hostile.call("fmi3SetFMUState", one, other) == OK
    for each in (state, other):
        assert hostile.call("fmi3FreeFMUState", one, c.byref(each)) == OK
        assert each.value is None
        assert hostile.call("fmi3FreeFMUState", one, c.byref(each)) == OK
    hostile.call("fmi3FreeInstance", one, kind=None)


def calls_out_of_the_logger(hostile: Hostile) -> None:
    """A logger that calls the instance that it hears of."""
    depth, answers = iter(range(3)), []

    def back(_environment: object, _status: int, _category: bytes, _text: bytes) -> None:
        if next(depth, None) is not None:
            answers.append(hostile.call("fmi3Terminate", instance))

    before, hostile.log3 = hostile.log3, Log3(back)
    instance = hostile.version3()
    assert hostile.call("fmi3Terminate", instance) == ERROR
    assert answers == [ERROR] * 3
    hostile.call("fmi3FreeInstance", instance, kind=None)
    hostile.log3 = before


def a_thousand(hostile: Hostile) -> None:
    """A thousand instances at once, from four threads: each goes its own way, and all come out the same."""
    made = [hostile.version3() for _ in range(1000)]
    ends: list[float] = []

    def follow(some: list[c.c_void_p]) -> None:
        flags, last = [c.byref(c.c_bool()) for _ in range(3)], c.byref(c.c_double())
        speed = (c.c_double * 1)()
        for instance in some:
            hostile.call("fmi3EnterInitializationMode", instance, 0, 0.0, 0.0, 0, 0.0)
            hostile.call("fmi3ExitInitializationMode", instance)
        for step in range(4):
            for instance in some:
                hostile.call("fmi3DoStep", instance, step * 0.1, 0.1, 0, *flags, last)
        for instance in some:
            reference = (c.c_uint32 * 1)(10)
            hostile.call("fmi3GetFloat64", instance, reference, c.c_size_t(1), speed, c.c_size_t(1))
            ends.append(speed[0])
            hostile.call("fmi3FreeInstance", instance, kind=None)

    threads = [threading.Thread(target=follow, args=(made[i::4],)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(ends) == 1000
    assert len(set(ends)) == 1
    assert ends[0] > 1.0


def main() -> None:
    """Run all of them."""
    library, resources, header = sys.argv[1:]
    hostile = Hostile(library, Path(resources))
    names = re.findall(r"\b(fmi[23][A-Z]\w+)", header)
    rounds: tuple[Callable[[], None], ...] = (
        lambda: nothing_at_all(hostile, names),
        lambda: every_function(hostile, names),
        lambda: instances(hostile),
        lambda: phases(hostile),
        lambda: steps_in_order(hostile),
        lambda: plain(hostile),
        lambda: states(hostile),
        lambda: calls_out_of_the_logger(hostile),
        lambda: a_thousand(hostile),
    )
    for each in rounds:
        each()
    print(hostile.count)  # noqa: T201 - for the test that runs it


if __name__ == "__main__":
    main()
