"""What is to be known of a result: a kind with its numbers, and the words made of them where it is shown."""

from __future__ import annotations

import string
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

from hersey.errors import Setting, capital, followed_by, printable, sentence
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.record import Means, Record, json_record
from hersey.units import celsius, rpm

#: How grave: nothing is wrong, worth knowing, look at it, something must be done.
Severity = Literal["good", "note", "watch", "act"]
#: Names that no value may have, as a warning is made with them.
_ARGUMENTS = frozenset({"severity", "title", "where", "remedy"})
#: What a warning is made of, as JSON holds it.
Value = float | int | str | None
#: A p-value below this is said to be below it.
_LEAST_P = 1e-12
#: From SI to the units in which words show a number.
_UNITS: dict[str, Callable[[Any], Any]] = {
    "rpm": rpm,
    "degC": celsius,
    "%": lambda value: 100.0 * value,
    "mm": lambda value: 1e3 * value,
    "mm/s": lambda value: 1e3 * value,
    "um": lambda value: 1e6 * value,
    "nm": lambda value: 1e9 * value,
    "GPa": lambda value: 1e-9 * value,
    "mN m": lambda value: 1e3 * value,
    "N m": lambda value: value,
    "rad/s": lambda value: value,
}
#: Names in words that stand for the quantity that was measured, and the speed against which it was.
_OF_DOMAIN = ("measured", "against")


class _Words(string.Formatter):
    """Words with values, which may be shown in a unit, as a choice of words, with a capital or as a p-value.

    Such as ``{speed:.3g rpm}``, ``{count:row|rows}``, ``{name:capital}`` and ``{chance:p}``. Where friction
    was measured ``{measured}`` names it, and what is in rpm or N m is shown in the units of the domain.
    """

    def __init__(self, values: Mapping[str, Any]) -> None:
        self._of = TORQUE
        if all(name in values for name in _OF_DOMAIN):
            self._of = Domain(*(str(values[name]) for name in _OF_DOMAIN))

    def get_value(self, key: int | str, args: Any, kwargs: Mapping[str, Any]) -> Any:
        if key in _OF_DOMAIN and key not in kwargs:
            return {"measured": self._of.quantity, "against": self._of.speed}[str(key)]
        return super().get_value(key, args, kwargs)

    def format_field(self, value: Any, spec: str) -> str:
        if isinstance(value, Setting):
            return value.to(spec)
        if "|" in spec:
            one, many = spec.split("|")
            return one if value == 1 else many
        if spec == "capital":
            return capital(str(value))
        if spec == "p":
            return f"p = {value:.1g}" if value > _LEAST_P else f"p < {_LEAST_P:.0e}"
        form, _, unit = spec.partition(" ")
        if not unit:
            return str(super().format_field(value, spec))
        if not self._of.is_torque and unit in ("mN m", "N m"):
            return self._of.amount(value, form)
        if not self._of.is_torque and unit in ("rpm", "rad/s"):
            return self._of.at(value, form)
        return f"{super().format_field(_UNITS[unit](value), form)} {unit}"


def is_value(name: Any, value: Any) -> bool:
    """Return whether name and value may be among those of a warning that was kept."""
    if not isinstance(name, str) or name in _ARGUMENTS:
        return False
    return value is None or isinstance(value, bool | int | float | str)


def _literal(text: str) -> str:
    """Words that show a text as it is."""
    return text.replace("{", "{{").replace("}", "}}")


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
        Numbers in SI, and names. Numbers beside a value called ``unit`` are in that unit.

    Examples
    --------
    >>> words = "{film:.2g um} at {count} {count:dwell|dwells}"
    >>> thin = Warning("thin film", words, where="nip", film=2e-7, count=1)
    >>> thin.sentence, thin.values["film"]
    ('nip: 0.2 um at 1 dwell.', 2e-07)
    """

    also_stated = ("title", "text")
    not_stated = ("words", "remedy", "heading")

    kind: Annotated[str, Means("identifies what the warning is about; independent of the wording")]
    severity: Annotated[Severity, Means("good, note, watch or act")]
    where: Annotated[str, Means("file, channel, specimen or section concerned, or empty")]
    values: Annotated[
        Mapping[str, Value], Means("numbers in SI (or in ``unit``, if that is among the values) and names")
    ]
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
        given = {"kind": kind, "words": words, "severity": severity, "values": values}
        given["where"] = printable(where)
        for name, value in (given | {"remedy": remedy, "heading": title}).items():
            object.__setattr__(self, name, value)

    @classmethod
    def said(
        cls, kind: str, text: str, *, title: str, severity: Severity, where: str, values: Mapping[str, Any]
    ) -> Warning:
        """Return one that was kept: its words are as they were shown, braces and all."""
        own: Any = {name: value for name, value in values.items() if is_value(name, value)}
        return cls(kind, _literal(text), severity=severity, title=_literal(title), where=where, **own)

    @classmethod
    def read(cls, part: Any) -> Warning:
        """Return one that a document holds."""
        own = {name: getattr(part, name) for name in ("title", "severity", "where", "values")}
        return cls.said(part.kind, part.text, **own)

    def number(self, name: str) -> float:
        """Return one of its numbers."""
        return float(self.values[name] or 0.0)

    def within(self, where: str) -> Warning:
        """Return the same of what lies within ``where``, such as a file of a specimen."""
        return self._with(where=f"{where}: {self.where}" if self.where else where)

    def about(self, of: Domain) -> Warning:
        """Return the same of what was measured: words and units are those of friction where it was."""
        return self if of.is_torque else self._with(measured=of.quantity, against=of.speed)

    def titled(self, title: str, *, section: str) -> Warning:
        """Return the same under a title, its evidence in a section; what it concerns leads the words."""
        words = f"{{concerns}}: {self.words}" if self.where else self.words
        return self._with(words=words, title=title, where=section, concerns=self.where)

    def _with(self, *, words: str = "", **changed: Any) -> Warning:
        own = {"severity": self.severity, "title": self.heading, "remedy": self.remedy, "where": self.where}
        return Warning(self.kind, words or self.words, **(own | dict(self.values) | changed))

    @property
    def title(self) -> Annotated[str, Means("short title, or empty")]:
        """It in a few words, or empty."""
        return self._shown(self.heading)

    @property
    def text(self) -> Annotated[str, Means("what is wrong, and what to do")]:
        """What is wrong and what to do, as sentences in the words of the way in."""
        return sentence(self._clause)

    @property
    def sentence(self) -> str:
        """What it concerns, what is wrong and what to do, as a sentence."""
        return sentence(str(self), named=bool(self.where))

    def to_dict(self) -> dict[str, Any]:
        """Return it as JSON: what it is, its numbers in SI, and the words."""
        values = {name: value for name, value in self.values.items() if not isinstance(value, Setting)}
        own = {"kind": self.kind, "severity": self.severity, "where": self.where, "values": values}
        return json_record({**own, "title": self.title, "text": self.text})

    @property
    def _clause(self) -> str:
        return followed_by(self._shown(self.words), self._shown(self.remedy))

    def _shown(self, words: str) -> str:
        return printable(_Words(self.values).vformat(words, (), self.values))

    def __str__(self) -> str:
        """Return what it concerns, what is wrong and what to do."""
        return ": ".join(part for part in (self.where, self.title, self._clause) if part)

    def __hash__(self) -> int:
        """Return a hash of what is shown."""
        return hash((self.kind, str(self)))
