"""The closed table of what can go wrong for a user, each error also the matching built-in.

Also how a message quotes text of a stranger, what was probably meant by a name that is none, and what to set
to correct a mistake.
"""

from __future__ import annotations

import shlex
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal, Self

#: How alike (`difflib`) a name must be to one that is there to be proposed, and characters of it at the most.
_ALIKE, _LONGEST = 0.6, 100
#: How a person comes in: the way out is given in the words of it.
Way = Literal["python", "terminal", "page"]
_way: list[Way] = ["python"]


def speak(way: Way) -> None:
    """Give ways out in the words of this way in, in the whole process."""
    _way[0] = way


def way_in() -> Way:
    """Return the way in whose words a way out is given."""
    return _way[0]


@dataclass(frozen=True)
class Setting:
    """What a person sets to correct a mistake: an argument in Python, a flag in the terminal, a control.

    ``name`` is that of the argument, or the role of a ``channel`` or of its ``unit``; a ``switch`` is set
    or not. ``flag`` and ``argument`` are its names on the command line and in Python, where they differ.
    """

    name: str
    kind: Literal["option", "switch", "channel", "unit"] = "option"
    flag: str = ""
    argument: str = ""

    def to(self, value: str = "", *, python: str = "") -> str:
        """Return what to write for a value, or the name alone, in the words of the way in.

        ``python`` is the value as an expression, where it is not the text itself.
        """
        if way_in() == "terminal":
            flag = self.flag or f"--{self.name.replace('_', '-')}{'-unit' if self.kind == 'unit' else ''}"
            typed = shlex.quote(value) if self.kind == "option" else f"'{value}'"
            return f"{flag} {typed}" if value else flag
        if way_in() == "page":
            what = {"option": self.name.replace("_", " "), "channel": f"role {self.name}"}
            return f"{what.get(self.kind, f'unit of {self.name}')}" + (f" '{value}'" if value else "")
        held = python or (repr(value) if value else "True" if self.kind == "switch" else "...")
        by_role = {"channel": "channels", "unit": "units"}.get(self.kind, "")
        if by_role:
            return f"{by_role}={{'{self.name}': {held}}}"
        name = self.argument or self.name
        return f"{name}={held}" if held != "..." else name


#: Settings that more than one message names.
ISOTHERMAL = Setting("isothermal", "switch")
DROP_MISSING = Setting("drop_missing", "switch")
OVERWRITE = Setting("overwrite", "switch", "--force")
FORCE = Setting("force", "switch")
TARE = Setting("tare")
MAPPING = Setting("mapping")
ROTATION = Setting("rotation")


def turned(role: str) -> str:
    """How the sign of torque or speed is turned."""
    return Setting(f"{role}_sign", argument="signs").to("-1", python=f"{{'{role}': -1}}")


class HerseyError(Exception):
    """A mistake that the user can correct: what is wrong, where, and what to do.

    ``remedy`` says what to do where that is known apart from what is wrong; ``setting`` is what to set.
    """

    def __init__(self, *message: object, remedy: str = "", setting: Setting | None = None) -> None:
        """Take what is wrong, and what to do about it."""
        super().__init__(*message)
        self.remedy, self.setting = remedy, setting

    @property
    def reason(self) -> str:
        """What is wrong on one line, whatever names and cells of a file it quotes."""
        return printable(" ".join(str(part) for part in self.args))

    def __str__(self) -> str:
        """Return what is wrong and what to do."""
        if not self.remedy:
            return self.reason
        if self.reason[-1:] in (".", "?"):
            return f"{self.reason} {printable(self.remedy[:1].upper() + self.remedy[1:])}"
        return f"{self.reason}: {printable(self.remedy)}"

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON: the error, reason, remedy, and name and kind of the setting or empty texts."""
        setting = self.setting or Setting("")
        return {
            "error": type(self).__name__,
            "reason": self.reason,
            "remedy": self.remedy,
            "setting": setting.name,
            "of": setting.kind,
        }

    def within(self, place: str) -> Self:
        """Return the same error, its message led by where it happened."""
        again = type(self)(f"{place}: {self.reason}")
        again.__dict__.update(self.__dict__)
        return again


class MissingFileError(HerseyError, FileNotFoundError):
    """A file that is not there, or is not a file."""


class UnreadableLogError(HerseyError, ValueError):
    """A log whose text cannot be read as a table of numbers."""


class ChannelError(HerseyError, LookupError):
    """A channel that cannot be found, or could be several.

    ``columns`` are the indices of those that it could be, where they are known.
    """

    def __init__(self, *message: object, columns: tuple[int, ...] = (), **remedy: Any) -> None:
        """Take the message, the columns, and ``remedy`` and ``setting``."""
        super().__init__(*message, **remedy)
        self.columns = columns


class UnitError(HerseyError, ValueError):
    """A unit that is missing, unknown or of the wrong dimension.

    ``columns`` holds the index of the column of a log that has it, where there is one.
    """

    def __init__(self, *message: object, columns: tuple[int, ...] = (), **remedy: Any) -> None:
        """Take the message, the column, and ``remedy`` and ``setting``."""
        super().__init__(*message, **remedy)
        self.columns = columns


class UnstatedRoleError(UnitError):
    """A radius or a normal load that a quantity needs and nobody stated.

    ``role`` is ``radius`` or ``load``, ``proposed`` the columns that are called so.
    """

    def __init__(
        self,
        *message: object,
        role: str = "",
        proposed: tuple[str, ...] = (),
        columns: tuple[int, ...] = (),
        **remedy: Any,
    ) -> None:
        """Take the message, what is needed, the column that needs it, and ``remedy`` and ``setting``."""
        super().__init__(*message, columns=columns, **remedy)
        self.role, self.proposed = role, proposed


class WrongKindError(UnitError):
    """A known unit, of another kind of quantity."""


class InsufficientDataError(HerseyError, ValueError):
    """Data that cannot answer the question asked of it."""


class ParameterError(HerseyError, ValueError):
    """A parameter outside what the physics allows.

    ``quantity`` names it as the message does, ``value`` and ``limit`` are in ``unit``; ``bound`` says where
    the value must lie: ``above`` the limit, ``at most`` at it or ``below`` it; ``index`` is the place among
    the sets or points of a call that takes many. Each is None where it is not known.
    """

    def __init__(
        self,
        *message: object,
        quantity: str | None = None,
        value: float | None = None,
        limit: float | None = None,
        unit: str | None = None,
        index: int | None = None,
        bound: str | None = None,
    ) -> None:
        """Take the message and what is known of the parameter."""
        super().__init__(*message)
        self.quantity, self.value, self.limit, self.unit, self.index = quantity, value, limit, unit, index
        self.bound = bound


class ForkedError(HerseyError, RuntimeError):
    """A process forked from one whose threads it would need."""


class UnfinishedError(HerseyError, RuntimeError):
    """A computation on sound input that did not come to its end.

    ``quantity`` and ``value`` (in ``unit``) tell where a solution was lost, ``time`` is that which a motion
    had reached; ``steps`` are those that were allowed, where they did not suffice; ``index`` as in
    `ParameterError`. Each is None where it is not known.
    """

    def __init__(
        self,
        *message: object,
        quantity: str | None = None,
        value: float | None = None,
        unit: str | None = None,
        time: float | None = None,
        steps: int | None = None,
        index: int | None = None,
    ) -> None:
        """Take the message and what is known of the end."""
        super().__init__(*message)
        self.quantity, self.value, self.unit = quantity, value, unit
        self.time, self.steps, self.index = time, steps, index


class OutputError(HerseyError, OSError):
    """A result that cannot be written, or would overwrite something."""


class ExistingFileError(OutputError, FileExistsError):
    """A result whose file is there already, and which nobody said to replace."""


class ExtrapolationWarning(UserWarning):
    """A fitted law is used outside the range of its data."""


class UntoldWarning(UserWarning):
    """Limits that hold for the visits recorded alone: the data do not tell how far visits scatter."""

    def __init__(self) -> None:
        """Say it."""
        super().__init__(
            "limits hold for the visits recorded: each temperature was visited once, and how far visits "
            "scatter is not told"
        )


class SandboxWarning(UserWarning):
    """Untrusted files are read without a whole sandbox; ``missing`` names what the system lacks.

    These are ``landlock`` (which files the reading process can open) and ``seccomp`` (which system calls
    it can make).
    """

    def __init__(self, missing: tuple[str, ...]) -> None:
        """Take what is missing."""
        super().__init__(missing)
        self.missing = missing

    def __str__(self) -> str:
        """Return it in words."""
        lacking = {
            "landlock": "could open other files (this system lacks Landlock)",
            "seccomp": "could start processes and change files (this system lacks seccomp)",
        }
        could = " and ".join(lacking.get(name, name) for name in self.missing)
        return f"Untrusted files are not fully sandboxed: one {could}. Open only files that you trust."


def printable(text: str, *, lines: bool = False) -> str:
    r"""Return a text in which what is no visible character stands as its code, as ``\x1b``.

    Blanks of every kind become a plain one; ends of lines stay where ``lines`` is true.

    Examples
    --------
    >>> print(printable("Torque\x1b[2J"))
    Torque\x1b[2J
    """
    if text.isprintable() and text.isascii():
        return text
    return "".join(c if c.isprintable() or (lines and c == "\n") else _code(c) for c in text)


def _code(char: str) -> str:
    if char == "\t" or unicodedata.category(char) == "Zs":
        return " "
    return char.encode("unicode_escape").decode()


def meant(name: str, known: Iterable[str]) -> str:
    """Return the known name that one with a slip is nearest to, or an empty text.

    Examples
    --------
    >>> meant("torqe", ["Time", "Torque"])
    'Torque'
    """
    from difflib import get_close_matches

    by_fold = {each.lower(): each for each in known if len(each) <= _LONGEST}
    match = get_close_matches(name.lower(), by_fold, n=1, cutoff=_ALIKE) if len(name) <= _LONGEST else []
    return by_fold[match[0]] if match else ""
