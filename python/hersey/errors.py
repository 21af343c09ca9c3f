"""Errors that a user can correct; each is also the matching built-in error.

Also: quoting untrusted text in messages, finding the known name closest to an unknown one, and naming the
setting that corrects a mistake.
"""

from __future__ import annotations

import shlex
import unicodedata
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, Self

#: How alike (`difflib`) a name must be to one that is there to be proposed, and characters of it at the most.
_ALIKE, _LONGEST = 0.6, 100
#: Ends of a sentence.
_ENDS = (".", "?", "!")
#: How a person comes in: the way out is given in the words of it.
Way = Literal["python", "terminal", "page"]
_way: list[Way] = ["python"]


def speak(way: Way) -> None:
    """Set the interface whose words remedies use, for the whole process."""
    _way[0] = way


def way_in() -> Way:
    """Return the interface whose words remedies use."""
    return _way[0]


@dataclass(frozen=True)
class Setting:
    """A setting that corrects a mistake: a Python argument, a command-line flag or a control of the app.

    ``name`` is the name of the argument, or the role of a ``channel`` or of its ``unit``; a ``switch`` takes
    no value. ``flag`` and ``argument`` are its names on the command line and in Python, if they differ.
    """

    name: str
    kind: Literal["option", "switch", "channel", "unit"] = "option"
    flag: str = ""
    argument: str = ""

    def to(self, value: str = "", *, python: str = "") -> str:
        """Return the text to type for a value, or for the name alone, in the words of the interface.

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
MOVING = Setting("moving", "switch")


#: The sign of the torque.
SIGN = Setting("torque_sign", argument="signs")


def turned(role: str) -> str:
    """Return the setting that flips the sign of torque or speed."""
    return Setting(f"{role}_sign", argument="signs").to("-1", python=f"{{'{role}': -1}}")


class HerseyError(Exception):
    """A mistake that the user can correct: what is wrong, where, and what to do.

    ``remedy`` says what to do, if it is not part of the message; ``setting`` is what to set, and ``likely``
    the value that was probably meant, if one is known.
    """

    def __init__(
        self, *message: object, remedy: str = "", setting: Setting | None = None, likely: str = ""
    ) -> None:
        """Take what is wrong, and what to do about it."""
        super().__init__(*message)
        self.remedy, self.setting, self.likely = remedy, setting, likely

    @property
    def reason(self) -> str:
        """What is wrong, on one line and with only printable characters."""
        return printable(" ".join(str(part) for part in self.args))

    def __str__(self) -> str:
        """Return what is wrong and what to do."""
        return followed_by(self.reason, printable(self.remedy))

    def to_dict(self) -> dict[str, Any]:
        """Return error, reason, remedy, and name and kind of the setting (or empty texts) as JSON."""
        setting = self.setting or Setting("")
        return {
            "error": type(self).__name__,
            "reason": self.reason,
            "remedy": self.remedy,
            "setting": setting.name,
            "of": setting.kind,
        }

    def within(self, place: str) -> Self:
        """Return the same error with the place in front of its message."""
        return self.saying(f"{place}: {self.reason}")

    def saying(self, reason: str) -> Self:
        """Return the same error with another reason."""
        again = type(self)(reason)
        again.__dict__.update(self.__dict__)
        return again


class MissingFileError(HerseyError, FileNotFoundError):
    """A file that does not exist, or is not a file.

    ``path`` is what does not exist, as it was given, if it is that.
    """

    def __init__(self, *message: object, path: str = "", **remedy: Any) -> None:
        """Take the message, the path, and ``remedy`` and ``setting``."""
        super().__init__(*message, **remedy)
        self.path = path


class UnreadableLogError(HerseyError, ValueError):
    """A log whose text cannot be read as a table of numbers."""


class TimeOrderError(UnreadableLogError):
    """A log whose rows are not in the order of their times."""


class ChannelError(HerseyError, LookupError):
    """A channel that cannot be found, or could be several.

    ``columns`` are the indices of the possible columns, if known; ``absent`` is whether no column comes near;
    ``examples`` are settings and values that state all that is open, where several roles are.
    """

    def __init__(
        self,
        *message: object,
        columns: tuple[int, ...] = (),
        absent: bool = False,
        examples: tuple[tuple[Setting, str], ...] = (),
        **remedy: Any,
    ) -> None:
        """Take the message, the columns, whether there is none, examples, ``remedy`` and ``setting``."""
        super().__init__(*message, **remedy)
        self.columns, self.absent, self.examples = columns, absent, examples


class UnitError(HerseyError, ValueError):
    """A unit that is missing, unknown or of the wrong dimension.

    ``columns`` holds the index of the column of a log that has it, where there is one; ``units`` a unit that
    it could have by role, where several columns lack one.
    """

    def __init__(
        self,
        *message: object,
        columns: tuple[int, ...] = (),
        units: Mapping[str, str] | None = None,
        **remedy: Any,
    ) -> None:
        """Take the message, the column, the units, and ``remedy`` and ``setting``."""
        super().__init__(*message, **remedy)
        self.columns, self.units = columns, dict(units or {})


class UnstatedRoleError(UnitError):
    """A radius or normal load that is needed but was not given.

    ``role`` is ``radius`` or ``load``; ``proposed`` are the columns with such a name.
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
    """Data that are not sufficient for the question."""


class OneSpeedError(InsufficientDataError):
    """A log of one speed: no dependence on speed can be fitted, but friction can be followed over time.

    ``files`` are the names of its files, without folders.
    """

    def __init__(self, *message: object, files: tuple[str, ...] = (), **remedy: Any) -> None:
        """Take the message, the names of the files, and ``remedy`` and ``setting``."""
        super().__init__(*message, **remedy)
        self.files = files


class ParameterError(HerseyError, ValueError):
    """A parameter outside what the physics allows.

    ``quantity`` is its name in the message, ``value`` and ``limit`` are in ``unit``; ``bound`` says where the
    value must lie: ``above`` the limit, ``at most`` the limit or ``below`` it; ``index`` is the index of the
    set or point in a call with many. Each is None if unknown.
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
        remedy: str = "",
    ) -> None:
        """Take the message and what is known of the parameter."""
        super().__init__(*message, remedy=remedy)
        self.quantity, self.value, self.limit, self.unit, self.index = quantity, value, limit, unit, index
        self.bound = bound


class ArgumentError(ParameterError, TypeError):
    """An argument that is missing, unknown or of the wrong type."""


class ForkedError(HerseyError, RuntimeError):
    """A forked process that would need threads of its parent."""


class UnfinishedError(HerseyError, RuntimeError):
    """A computation on valid input that did not finish.

    ``quantity`` and ``value`` (in ``unit``) say where a solution was lost, ``time`` how far a motion got;
    ``steps`` is the number allowed, if it was too small; ``index`` as in `ParameterError`. Each is None if
    unknown.
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
    """A result whose file exists and was not to be replaced."""


class ExtrapolationWarning(UserWarning):
    """A fitted law was used outside the range of its data."""


class UntoldWarning(UserWarning):
    """Limits that hold only for the recorded visits, because the scatter between visits is unknown."""

    def __init__(self) -> None:
        """Say it."""
        super().__init__(
            "Limits are known only for the recorded visits: each temperature was visited once, so the "
            "scatter between visits is unknown."
        )


class PlausibilityWarning(UserWarning):
    """A value that is possible, but so unusual that its unit is probably wrong."""


class SandboxWarning(UserWarning):
    """Untrusted files are read in an incomplete sandbox; ``missing`` names what the system does not have.

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
            "landlock": "open other files (this system has no Landlock)",
            "seccomp": "start processes and change files (this system has no seccomp)",
        }
        could = " and ".join(lacking.get(name, name) for name in self.missing)
        return (
            f"The sandbox for untrusted files is incomplete. A file could {could}. Open only files you trust."
        )


def capital(text: str) -> str:
    """Return a text with its first letter, and no other, as a capital."""
    return f"{text[:1].upper()}{text[1:]}"


def followed_by(text: str, remedy: str) -> str:
    """Return what is wrong and, in a sentence of its own, what to do; either may be empty."""
    if not (text and remedy):
        return text or capital(remedy)
    return f"{text}{'' if text.endswith(_ENDS) else '.'} {capital(remedy)}"


def sentence(text: str, *, named: bool = False) -> str:
    """Return a clause as a sentence; a name that it begins with, as of a file or a key, stays as it is.

    An empty text stays empty, and a sentence stays as it is.

    Examples
    --------
    >>> sentence("the belt sticks"), sentence("bench.csv is cut off"), sentence("is it?")
    ('The belt sticks.', 'bench.csv is cut off.', 'Is it?')
    """
    if not text:
        return ""
    named = named or any(sign in text.split(" ", 1)[0].rstrip(":.") for sign in "_.")
    first = text if named else capital(text)
    return first if first.endswith(_ENDS) else f"{first}."


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
