"""Formulas that a file carries: read by a grammar of our own, so that nothing in a file is ever run.

::

    sum      = product { ("+" | "-") product }
    product  = signed { ("*" | "/") signed }
    signed   = ("+" | "-") signed | power
    power    = atom [ ("^" | "**") signed ]
    atom     = number | name | function "(" sum { "," sum } ")" | "(" sum ")"

Source: the formulas of ASAM MDF are those of ASAM MCD-2 MC; of these, the ones that give a number.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import NamedTuple

import numpy as np

from hersey.arrays import FloatArray
from hersey.errors import UnreadableLogError

#: Characters of a formula, and brackets within brackets, at the most.
LONGEST, _DEEPEST = 2000, 40
_WORD = re.compile(
    r"\s*(?:([0-9]+\.?[0-9]*(?:[eE][-+]?[0-9]+)?|\.[0-9]+(?:[eE][-+]?[0-9]+)?)|(\w+)|(\*\*|.))", re.ASCII
)


def evaluate(formula: str, values: Mapping[str, object]) -> FloatArray:
    """Return the value of a formula in float64, shape (rows,), as its variables broadcast.

    Parameters
    ----------
    formula
        Numbers, the variables, ``+ - * / ^ **``, brackets and functions such as ``sqrt``.
    values
        Numbers or arrays by the name of the variable.

    Raises
    ------
    UnreadableLogError
        If it is anything else; it is then not evaluated at all.
    """
    if len(formula) > LONGEST:
        raise UnreadableLogError(f"has a formula of {len(formula)} characters; at most {LONGEST} are read")
    numbers = {name: np.asarray(value, dtype=float) for name, value in values.items()}
    stack: list[FloatArray] = []
    with np.errstate(all="ignore"):  # what is no number is a missing value
        for step in _Formula(formula, frozenset(numbers)).steps:
            if isinstance(step, _Call):
                arguments = [stack.pop() for _ in range(step.arguments)]
                stack.append(np.asarray(step.function(*reversed(arguments)), dtype=float))
            else:
                stack.append(numbers[step] if isinstance(step, str) else np.asarray(step))
    return np.broadcast_to(stack.pop(), np.broadcast_shapes(*(number.shape for number in numbers.values())))


class _Call(NamedTuple):
    """A function of so many of the values before it."""

    function: Callable[..., FloatArray]
    arguments: int


_ONE = ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log", "log10", "sqrt", "abs")
_FUNCTIONS = {
    **{name: _Call(getattr(np, name), 1) for name in _ONE},
    **{name: _Call(getattr(np, f"arc{name[-3:]}"), 1) for name in ("asin", "acos", "atan")},
    **{name: _Call(getattr(np, name), 1) for name in ("arcsin", "arccos", "arctan")},
    "ln": _Call(np.log, 1),
    "pow": _Call(np.power, 2),
    "arctan2": _Call(np.arctan2, 2),
}


class _Formula:
    """A formula, read to its end before any of it is evaluated.

    ``steps``: numbers, names of variables, and functions of the values before them.
    """

    def __init__(self, text: str, names: frozenset[str]) -> None:
        self.text, self.names, self.depth = text, names, 0
        self.words = [match.groups(default="") for match in _WORD.finditer(text.rstrip())]
        self.words.append(("", "", ""))
        self.place = 0
        self.steps: list[float | str | _Call] = []
        self._sum()
        if self.place < len(self.words) - 1:
            raise self._refused()

    def _refused(self) -> UnreadableLogError:
        return UnreadableLogError(
            f"has the formula {self.text[:80]!r}, which cannot be evaluated. Only numbers, X, + - * / "
            f"^, brackets and {', '.join(sorted(_FUNCTIONS))} are supported. Export the converted "
            "channel instead"
        )

    def _taken(self, *signs: str) -> str:
        """The sign that comes next, if it is one of these."""
        sign = self.words[self.place][2]
        if sign not in signs:
            return ""
        self.place += 1
        return sign

    @contextmanager
    def _within(self) -> Iterator[None]:
        """One bracket or power deeper."""
        self.depth += 1
        if self.depth > _DEEPEST:
            raise self._refused()
        yield
        self.depth -= 1

    def _sum(self) -> None:
        with self._within():
            self._product()
            while sign := self._taken("+", "-"):
                self._product()
                self.steps.append(_Call(np.add if sign == "+" else np.subtract, 2))

    def _product(self) -> None:
        self._signed()
        while sign := self._taken("*", "/"):
            self._signed()
            self.steps.append(_Call(np.multiply if sign == "*" else np.divide, 2))

    def _signed(self) -> None:
        negative = False
        while sign := self._taken("+", "-"):
            negative ^= sign == "-"
        self._power()
        if negative:
            self.steps.append(_Call(np.negative, 1))

    def _power(self) -> None:
        self._atom()
        if self._taken("^", "**"):
            with self._within():
                self._signed()
            self.steps.append(_Call(np.power, 2))

    def _atom(self) -> None:
        number, name, _ = self.words[self.place]
        if number or name in self.names:
            self.place += 1
            self.steps.append(float(number) if number else name)
        elif name in _FUNCTIONS:
            self.place += 1
            self._call(_FUNCTIONS[name])
        else:
            self._call(None)

    def _call(self, call: _Call | None) -> None:
        """What stands in brackets, as the arguments of a function if there is one."""
        if not self._taken("("):
            raise self._refused()
        self._sum()
        count = 1
        while call and self._taken(","):
            self._sum()
            count += 1
        if not self._taken(")") or (call and count != call.arguments):
            raise self._refused()
        if call:
            self.steps.append(call)
