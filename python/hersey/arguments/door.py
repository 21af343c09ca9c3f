"""Names and types of the arguments of one function, checked as it is called."""

from __future__ import annotations

import ast
import inspect
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from numbers import Integral, Real
from typing import Any

from hersey.arguments.numbers import described, is_other, with_article
from hersey.errors import ArgumentError, meant, printable

#: How to get what an argument must be, by its class.
_SOURCES = {
    "TorqueLog": "hersey.read('bench.csv')",
    "SteadyPoints": 'log.steady(tare="standing")',
    "DampingSurface": "hersey.fit(points)",
    "ModelComparison": "hersey.compare_models(points)",
    "Machine": "hersey.read_machine('machine.toml')",
    "Drivetrain": "machine.train",
    "Drag": "surface.drag(**machine.belt)",
    "Study": "hersey.study(points, machine)",
    "Campaign": "hersey.Campaign.open('campaign.sqlite')",
    "Indicators": "hersey.indicators_of(campaign, machine)",
    "CycleRecord": "hersey.cycles(time, force, drive_speed='25 mm/s')",
    "StickSlipCycle": "hersey.stick_slip(train, drag, drive_speed='25 mm/s')",
    "RainflowCycles": "hersey.rainflow_cycles(signal)",
    "SNCurve": "hersey.SNCurve('12 N*m', 1e6, 5.0)",
    "Contact": "machine.contact",
    "Lubricant": "machine.lubricant",
    "MixedContact": "machine.mixed",
    "NoLoadTorque": "machine.rest or hersey.no_load_torque(points)",
    "HeatBalance": "hersey.HeatBalance(...)",
    "Schedule": "hersey.Schedule(times, values)",
}  # fmt: skip
#: Argument of which a plain number may lack its unit.
ROLL_RADIUS = "roll_radius"
#: Classes of which a function says itself what is missing: it knows what was given in their place.
_SAID_ELSEWHERE = ("SteadyPoints", "Study")
#: Classes that no function of the package makes, or makes under no name of its own.
_OTHERS = (
    *("Asperities", "BoundaryFriction", "ElasticLayer", "ThickeningFluid", "ShearThinning", "Limits"),
    *("Work", "SweepFolder", "CurveMixture", "LogMapping", "Sensors", "LifeTable", "GearTable", "DataFrame"),
)
#: Names in annotations that stand for classes, and the class that a base class is shown as.
_ALIASES = {
    "Train": ("Drivetrain", "Machine"),
    "StatedMachine": ("Machine",),
    "BeltDrag": ("AnyDrag", "FittedLaw"),
    "PowerDrag": ("Drag", "DragTable"),
    "Observations": ("Observations", "MeansTable"),
    "SharedLoad": ("MixedContact",),
}
_SHOWN = {"AnyDrag": "Drag", "FittedLaw": "DampingSurface"}
_SHOWN |= {"Observations": "SteadyPoints", "MeansTable": "SteadyPoints"}
_CLASSES = {*_SOURCES, *_OTHERS, *_SHOWN, *(name for names in _ALIASES.values() for name in names)}
#: Kinds of plain values, by the name in an annotation.
_PLAIN = {"float": "number", "int": "whole", "bool": "switch", "str": "text", "Path": "path", "None": "none"}
_COLLECTIONS = {"Mapping": "mapping", "dict": "mapping", "Sequence": "sequence", "tuple": "sequence"}
_COLLECTIONS |= {"list": "sequence", "Callable": "function"}
_PLAIN |= {"Share": "number", "Text": "text"}
_ARRAYS = ("ArrayLike", "FloatArray", "IntArray", "NDArray")
_IN_WORDS = {
    "number": "a number",
    "whole": "a whole number",
    "numbers": "a number or an array of numbers",
    "mapping": "a dictionary",
    "sequence": "a list or a tuple",
    "function": "a function",
    "switch": "True or False",
    "text": "text",
    "path": "a path",
}


def _kinds_of(node: ast.expr) -> Iterator[str]:
    """Kinds and class names that an annotation allows; ``anything`` for what is not checked."""
    if isinstance(node, ast.BinOp):
        yield from _kinds_of(node.left)
        yield from _kinds_of(node.right)
    elif isinstance(node, ast.Subscript):
        base, inside = ast.unparse(node.value).split(".")[-1], node.slice
        items = inside.elts if isinstance(inside, ast.Tuple) else [inside]
        if base == "Annotated":
            yield from _kinds_of(items[0])
        elif base in _ARRAYS or (
            base in ("tuple", "list", "Sequence")
            and all(ast.unparse(item) in ("float", "int", "...") for item in items)
        ):
            yield "numbers"
        else:
            yield _COLLECTIONS.get(base, "anything")
    else:
        name = ast.unparse(node).split(".")[-1].strip("'\"")
        if name in _ARRAYS:
            yield "numbers"
        elif name in _ALIASES or name in _CLASSES:
            yield from _ALIASES.get(name, (name,))
        else:
            yield _PLAIN.get(name, "anything")


class Words(tuple[str, ...]):
    """The words that an argument can be, named in `takes_si` where the kind of a quantity would be."""

    __slots__ = ()


class Keys(tuple[str, ...]):
    """The keys that a dictionary can have, named in `takes_si` where the kind of a quantity would be.

    ``example`` is such a dictionary as text. ``suffix`` is what a user may put behind a key to make an
    argument of it, e.g. ``torque_unit``.
    """

    example: str
    suffix: str

    def __new__(cls, keys: Iterable[str], example: str, suffix: str = "") -> Keys:
        """Take the keys, the example and the suffix."""
        made = super().__new__(cls, keys)
        made.example, made.suffix = example, suffix
        return made

    def of(self, name: str) -> str:
        """Return the key that an argument of such a name is meant to set, or an empty text."""
        return next((key for key in self if name in (f"{key}{self.suffix}", f"{key}{self.suffix}s")), "")


@dataclass
class _Argument:
    """A parameter, and what it may be."""

    name: str
    kinds: tuple[str, ...]
    required: bool
    by_position: bool
    words: tuple[str, ...] = ()  #: all that a text may be, if they are few
    example: str = ""  #: a dictionary that it may be, as text
    passed: set[type] = field(default_factory=set)  #: types that need no further look

    @cached_property
    def classes(self) -> tuple[str, ...]:
        """Names of the classes that it may be of."""
        return tuple(kind for kind in self.kinds if kind in _CLASSES)

    @cached_property
    def wanted(self) -> str:
        """What it may be, in words."""
        in_words = _IN_WORDS | ({"text": " or ".join(map(repr, self.words))} if self.words else {})
        if self.example:
            in_words["mapping"] += f", e.g. {self.name}={self.example}"
        known = [in_words[kind] for kind in self.kinds if kind in in_words]
        return " or ".join(
            [*map(with_article, dict.fromkeys(_SHOWN.get(name, name) for name in self.classes)), *known]
        )

    def fits(self, value: Any) -> bool:
        """Whether a value is of a type that the argument may be; of numbers, not yet their values."""
        if "anything" in self.kinds or type(value) in self.passed:
            return True
        if value is None:
            return "none" in self.kinds
        if isinstance(value, bool) or type(value).__name__ == "bool":
            return "switch" in self.kinds or "numbers" in self.kinds
        if isinstance(value, str | os.PathLike):
            return "path" in self.kinds or ("text" in self.kinds and isinstance(value, str))
        fits = (
            self.is_made(value)
            or ("mapping" in self.kinds and isinstance(value, Mapping))
            or ("sequence" in self.kinds and hasattr(value, "__getitem__") and not isinstance(value, Mapping))
            or ("function" in self.kinds and callable(value))
            or ("whole" in self.kinds and isinstance(value, Integral))
            or ("number" in self.kinds and isinstance(value, Real))
        )
        if fits:
            self.passed.add(type(value))
        return fits or (self.takes_numbers and not is_other(value))

    def is_made(self, value: Any) -> bool:
        """Whether a value is of one of its classes: a plain number may be that of any argument."""
        return any(each.__name__ in self.classes for each in type(value).__mro__)

    def converts(self, value: Any) -> bool:
        """Whether a value without units is to be looked at as numbers."""
        return "anything" not in self.kinds and not isinstance(value, bool | str | os.PathLike)

    @cached_property
    def takes_numbers(self) -> bool:
        """Whether numbers, arrays of them or quantities are among what it takes."""
        return "numbers" in self.kinds or "number" in self.kinds


class Door:
    """The arguments of one function, checked as it is called.

    ``quantities`` names those that are quantities, or one of a few `Words`; ``read`` brings one to SI.
    """

    def __init__(
        self,
        signature: inspect.Signature,
        title: str,
        quantities: Mapping[str, Any],
        read: Callable[..., Any],
    ) -> None:
        """Take signature and name of the function, the kinds of its quantities, and what reads them."""
        self.signature, self.title, self.read = signature, title, read
        self.words = {name: each for name, each in quantities.items() if isinstance(each, Words)}
        self.keys = {name: each for name, each in quantities.items() if isinstance(each, Keys)}
        special = self.words.keys() | self.keys.keys()
        self.quantities = {name: each for name, each in quantities.items() if name not in special}

    @cached_property
    def arguments(self) -> dict[str, _Argument]:
        """The parameters by name, in order; without those that collect others."""
        found = {}
        for name, each in self.signature.parameters.items():
            if each.kind in (each.VAR_KEYWORD, each.VAR_POSITIONAL):
                continue
            kinds: tuple[str, ...] = ("anything",)
            if isinstance(each.annotation, str) and name not in ("self", "cls"):
                kinds = tuple(_kinds_of(ast.parse(each.annotation, mode="eval").body))
            if each.default is None:
                kinds = (*kinds, "none")
            by_position = each.kind is not each.KEYWORD_ONLY
            required, words = each.default is each.empty, self.words.get(name, ())
            example = self.keys[name].example if name in self.keys else ""
            found[name] = _Argument(name, kinds, required, by_position, words, example)
        return found

    @cached_property
    def collected(self) -> dict[str, _Argument]:
        """The dictionaries of known keys that are among other keywords which the function takes."""
        return {
            name: _Argument(name, ("mapping", "none"), False, False, example=keys.example)
            for name, keys in self.keys.items()
            if name not in self.signature.parameters
        }

    @cached_property
    def positions(self) -> tuple[str, ...]:
        """Names of the arguments that may be given by position."""
        return tuple(name for name, each in self.arguments.items() if each.by_position)

    @cached_property
    def required(self) -> frozenset[str]:
        """Names of the arguments without a default."""
        return frozenset(name for name, each in self.arguments.items() if each.required)

    @cached_property
    def open(self) -> bool:
        """Whether the function takes other keywords."""
        return any(each.kind is each.VAR_KEYWORD for each in self.signature.parameters.values())

    def admit(self, given: tuple[Any, ...], named: dict[str, Any]) -> dict[str, Any]:
        """Return all arguments by name, with quantities in SI.

        Raises
        ------
        ArgumentError
            If one is missing, unknown, given twice or of a wrong type; the message names it.
        UnitError, ParameterError
            If a quantity has no or a wrong unit, or is no number.
        """
        if len(given) > len(self.positions):
            raise self._too_many(given)
        values = dict(zip(self.positions, given, strict=False))
        for name in named:
            if name in values:
                raise ArgumentError(f"{self.title} got {name} twice, by position and by name")
            if name not in self.arguments and (self._entry(name) or not self.open):
                raise self._unknown(name, named[name])
        values |= named
        if not values.keys() >= self.required:
            raise self._missing(
                next(name for name in self.arguments if name in self.required - values.keys())
            )
        for name, value in values.items():
            argument = self.arguments.get(name) or self.collected.get(name)
            kind, type_ = self.quantities.get(name), type(value)
            plain = type_ is int or (type_ is float and value == value)
            if (
                plain
                and kind != "temperature"
                and name != ROLL_RADIUS
                and (argument is None or argument.takes_numbers)
            ):
                continue
            if argument is not None and not (kind and isinstance(value, str)) and not argument.fits(value):
                wrong = self._wrong(argument, value, values)
                if wrong is None:
                    return values
                raise wrong
            if name in self.keys and isinstance(value, Mapping):
                self._refuse_entries(name, value)
            if value is None or (argument and type_ in argument.passed and not isinstance(value, Real)):
                continue
            if kind or (argument is not None and argument.takes_numbers and argument.converts(value)):
                one = (
                    argument is not None
                    and "numbers" not in argument.kinds
                    and "anything" not in argument.kinds
                )
                values[name] = self.read(name, kind, value, one=one)
        return values

    def _refuse_entries(self, name: str, given: Mapping[Any, Any]) -> None:
        """Refuse an entry of a dictionary of texts that is none."""
        example = self.keys[name].example
        if not all(isinstance(each, str) for each in ast.literal_eval(example).values()):
            return
        for key, value in given.items():
            if not isinstance(value, str):
                what = f"{self.title}: {name} has {described(value)} for {key!r}. It must be text"
                raise ArgumentError(what, remedy=f"write e.g. {name}={example}")

    @property
    def own(self) -> list[str]:
        """The arguments that a user gives, without the object of a method."""
        return [name for name in self.arguments if name not in ("self", "cls")]

    def call(self, *shown: str) -> str:
        """Return how the function is called: what it needs, and what else is to be shown."""
        positions = [name for name in self.positions if name in self.own]
        last = max((positions.index(n) for n in positions if n in self.required or n in shown), default=-1)
        named = [n for n in self.own if n not in positions and (n in self.required or n in shown)]
        public = self.title in getattr(sys.modules.get("hersey"), "__all__", ())
        written = ", ".join([*positions[: last + 1], *(f"{name}=..." for name in named)])
        return f"{'hersey.' * public}{self.title}({written})"

    def _entry(self, name: str) -> tuple[str, str] | None:
        """The dictionary and its key that an argument which is none of the function's is meant to set."""
        if name in self.quantities:
            return None
        return next(((each, key) for each, keys in self.keys.items() if (key := keys.of(name))), None)

    def _unknown(self, name: str, value: Any) -> ArgumentError:
        if entry := self._entry(name):
            held = repr(value) if isinstance(value, str | int) else "..."
            remedy = f"write {entry[0]}={{'{entry[1]}': {held}}}"
            return ArgumentError(f"{self.title} has no argument '{name}'", remedy=remedy)
        near = nearest_argument(name, self.own)
        did = f"Did you mean {near}? " if near else ""
        takes = f"{did}Its arguments are {', '.join(self.own)}" if self.own else "It takes none"
        return ArgumentError(f"{self.title} has no argument '{printable(name)}'", remedy=takes)

    def _missing(self, name: str) -> ArgumentError:
        argument = self.arguments[name]
        what = f", {argument.wanted}" if argument.classes else ""
        return ArgumentError(
            f"{self.title} needs the argument {name}{what}",
            remedy=f"write {self.call()}{self._sources(name)}",
        )

    def _too_many(self, values: tuple[Any, ...]) -> ArgumentError:
        count = len(values)
        positions = [name for name in self.positions if name in self.own]
        behind = [name for name in self.own if name not in positions]
        most, given = len(positions), count - len(self.positions) + len(positions)
        what = f"takes {most} argument{'s' * (most != 1)} by position, not {given}"
        if positions[-1:] == ["paths"] and all(isinstance(each, str | os.PathLike) for each in values):
            listed = ", ".join(repr(os.fspath(each)) for each in values)
            return ArgumentError(f"{self.title} {what}", remedy=f"write hersey.{self.title}([{listed}])")
        if not behind:
            return ArgumentError(f"{self.title} {what}", remedy=f"write {self.call(*self.own)}")
        if not most:
            return ArgumentError(
                f"{self.title} takes its arguments by name", remedy=f"write {self.call(*behind[:2])}"
            )
        shown = [name for name in behind if name in self.required] or behind[:2]
        return ArgumentError(f"{self.title} {what}", remedy=f"give the others by name: {self.call(*shown)}")

    def _wrong(self, argument: _Argument, value: Any, given: Mapping[str, Any]) -> ArgumentError | None:
        """What is wrong with a value; None if the function says it better."""
        what = f"{self.title}: {argument.name} is {described(value)}. It must be {argument.wanted}"
        call = self.call(argument.name)
        for name, other in given.items():
            taker = self.arguments.get(name)
            if taker and taker is not argument and argument.classes and argument.is_made(other):
                if taker.fits(value):
                    remedy = f"swap {argument.name} and {name}: write {self.call(argument.name, name)} with"
                    remedy += f" {argument.name} = {described(other)}, {name} = {described(value)}"
                    return ArgumentError(what, remedy=remedy)
                what += f", which was given as {name}"
        if not argument.classes:
            return ArgumentError(what)
        if argument.classes[0] in _SAID_ELSEWHERE:
            return None
        return ArgumentError(what, remedy=f"write {call}{self._sources(argument.name, value)}")

    def _sources(self, name: str, value: Any = None) -> str:
        """How to get what an argument must be, from what was given in its place."""
        made = dict.fromkeys(_SHOWN.get(each, each) for each in self.arguments[name].classes)
        ways = [_SOURCES[each] for each in made if each in _SOURCES]
        if type(value).__name__ == "TorqueLog":
            ways = [way.replace("(points", f"({_SOURCES['SteadyPoints']}") for way in ways]
        return f" with {name} = {' or '.join(ways)}" if ways else ""


def nearest_argument(name: str, known: list[str]) -> str:
    """Return the known argument that an unknown one is meant for, or an empty text.

    Examples
    --------
    >>> nearest_argument("temp", ["train", "temperature"]), nearest_argument("speed", ["drive_speed"])
    ('temperature', 'drive_speed')
    """
    parts = [each for each in known if len(name) > 2 and (name.lower() in each or each in name.lower())]
    return parts[0] if len(parts) == 1 else meant(name, known)
