"""What is to be known of a result: a kind with its numbers, and the words made of them where it is shown."""

from __future__ import annotations

import string
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from hersey.errors import Setting, printable
from hersey.schema.record import Means, Record, json_record
from hersey.units import celsius, rpm

#: How grave: nothing is wrong, worth knowing, look at it, something must be done.
Severity = Literal["good", "note", "watch", "act"]
#: What a warning is made of, as JSON holds it.
Value = float | int | str | None
#: From SI to the units in which words show a number.
_UNITS: dict[str, Callable[[Any], Any]] = {
    "%": lambda value: 100.0 * value,
    "rpm": rpm,
    "degC": celsius,
    "mm": lambda value: 1e3 * value,
    "mm/s": lambda value: 1e3 * value,
    "um": lambda value: 1e6 * value,
    "nm": lambda value: 1e9 * value,
    "GPa": lambda value: 1e-9 * value,
    "mN m": lambda value: 1e3 * value,
}


class _Words(string.Formatter):
    """Words with values: ``{speed:.3g rpm}`` is in that unit, ``{count:row|rows}`` one word of two."""

    def format_field(self, value: Any, spec: str) -> str:
        if "|" in spec:
            one, many = spec.split("|")
            return one if value == 1 else many
        if isinstance(value, Setting):
            return value.to(spec)
        form, _, unit = spec.partition(" ")
        if not unit:
            return str(super().format_field(value, spec))
        return f"{super().format_field(_UNITS[unit](value), form)} {unit}"


_words = _Words()


@dataclass(frozen=True, init=False)
class Warning(Record):
    """What is to be known of a result: a kind with its numbers, how grave it is, and what it concerns.

    Parameters
    ----------
    kind
        What it is: the same whatever the words. Code asks for it, never for the words.
    words, remedy
        What is wrong, and what to do where that is known apart; names of ``values`` stand in braces. Without
        capital and full stop, which `sentence` adds. A `Setting` is shown in the words of the way in.
    where
        File, channel, dwell, specimen or section that it concerns, where it does not concern all.
    title
        It in a few words, as ``words`` are, for the first screen.
    **values
        Numbers in SI, and names.

    Examples
    --------
    >>> words = "{film:.2g um} at {count} {count:dwell|dwells}"
    >>> thin = Warning("thin film", words, where="nip", film=2e-7, count=1)
    >>> thin.sentence, thin.values["film"]
    ('nip: 0.2 um at 1 dwell.', 2e-07)
    """

    also_stated = ("title", "text")
    not_stated = ("words", "remedy", "heading")

    kind: Annotated[str, Means("what it is, the same whatever the words")]
    severity: Annotated[Severity, Means("good, note, watch or act")]
    where: Annotated[str, Means("file, channel, specimen or section that it concerns, or empty")]
    values: Annotated[Mapping[str, Value], Means("its numbers in SI, and names")]
    words: str
    remedy: str
    heading: str

    def __init__(
        self,
        kind: str,
        words: str,
        /,
        *,
        severity: Severity = "note",
        title: str = "",
        where: str = "",
        remedy: str = "",
        **values: Any,
    ) -> None:
        given = {"kind": kind, "words": words, "severity": severity, "where": where, "values": values}
        for name, value in (given | {"remedy": remedy, "heading": title}).items():
            object.__setattr__(self, name, value)

    def within(self, where: str) -> Warning:
        """Return the same of what lies within ``where``, such as a file of a specimen."""
        inside = f"{where}: {self.where}" if self.where else where
        own: dict[str, Any] = dict(self.values)
        return Warning(
            self.kind,
            self.words,
            severity=self.severity,
            title=self.heading,
            where=inside,
            remedy=self.remedy,
            **own,
        )

    @property
    def title(self) -> Annotated[str, Means("it in a few words, or empty")]:
        """It in a few words, or empty."""
        return self._shown(self.heading)

    @property
    def text(self) -> Annotated[str, Means("what is wrong, and what to do")]:
        """What is wrong and what to do, in the words of the way in."""
        return self._shown(f"{self.words}: {self.remedy}" if self.remedy else self.words)

    @property
    def sentence(self) -> str:
        """What it concerns, what is wrong and what to do, as a sentence."""
        said = str(self)
        first = said if self.where or "_" in said.split(" ", 1)[0] else said[:1].upper() + said[1:]
        return first if first[-1:] in (".", "?", "!") else f"{first}."

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON: what it is, its numbers in SI, and the words."""
        values = {name: value for name, value in self.values.items() if not isinstance(value, Setting)}
        own = {"kind": self.kind, "severity": self.severity, "where": self.where, "values": values}
        return json_record({**own, "title": self.title, "text": self.text})

    def _shown(self, words: str) -> str:
        return printable(_words.vformat(words, (), self.values))

    def __str__(self) -> str:
        """Return what it concerns, what is wrong and what to do."""
        return f"{self.where}: {self.text}" if self.where else self.text

    def __hash__(self) -> int:
        """Return a hash of what is shown."""
        return hash((self.kind, str(self)))
