"""Units as people write them: factors, spellings of the field, counts of an encoder."""

from __future__ import annotations

import math
import re

from hersey.errors import UnitError
from hersey.units.kinds import KINDS, meant

#: Counts of one revolution of an encoder, as an example.
COUNTS = 2000
# Spellings of the field that pint does not know, or reads as something else.
_SPELLINGS = (
    (r"(?i:(°|º|deg(\.|rees?)?)[\s_]*C|℃|celsius)|C", "degC"),
    (r"(?i:(°|º|deg(\.|rees?)?)[\s_]*F|℉|fahrenheit)|F", "degF"),
    (r"°\s*K|deg\s*K|(?i:kelvin)", "K"),
    (r"(?i:ozf?s?[\s.*·-]?in|in[\s.*·-]?ozf?s?)", "ozf*in"),
    (r"(?i:lbf?s?[\s.*·-]?in|in[\s.*·-]?lbf?s?)", "lbf*in"),
    (r"(?i:lbf?s?[\s.*·-]?ft|ft[\s.*·-]?lbf?s?)", "lbf*ft"),
    (r"(?i:rpm|(U|r|rev|tr|giri|1)?\s*/\s*min|min(\^|\*\*)?\(?-1\)?|min⁻¹)", "rpm"),
    (r"U/s|r/s", "rev/s"),
    (r"rad\s+s(\^|\*\*)?-1|rad\s+s⁻¹", "rad/s"),
    (r"([mcdknuµμ]?)N[\s.·*-]?([mc]?m)((?:[\s.·*]s)?/[A-Za-z°]+)?", r"\1N*\2\3"),
    (r"(?i:sec)", "s"),
    (r"(?i:pro ?mille|per ?mille)", "‰"),
    (r"mils?", "thou"),
)
_ALPHABET = re.compile(r"[A-Za-z0-9_°ºµμΩ%‰℃℉\s.·*/^()⁻¹²³-]{0,60}")
#: Characters of a unit at the most: the patterns below take longer than linear.
LONGEST_UNIT = 100
#: A number as text.
NUMBER = r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?"
#: Dots of other keyboards and scripts that stand for a product.
_DOTS = str.maketrans(dict.fromkeys("\u2022\u2219\u22c5\u30fb\uff65", "\u00b7"))
_FACTORED = re.compile(rf"\s*({NUMBER})?\s*\*?\s*([A-Za-z°ºµμ%‰℃℉/(1].*?)\s*(?:/\s*({NUMBER}))?\s*")
#: A factor of which a reader cannot tell whether it multiplies the unit or has multiplied the numbers.
_COUNT = rf"10\^[-+]?[0-9]{{1,2}}|{NUMBER}"
_TIMES = re.compile(rf"[x\u00d7]\s*({_COUNT})\s*([A-Za-z°%].*)|([A-Za-z°%].*?)\s*[x\u00d7]\s*({_COUNT})")
_POWER = re.compile(r"(?<=[A-Za-z)])(\*\*|\^)-?[1-4](?![\d.^]|\*\*)")
#: Counts of an encoder in a time, or alone.
_COUNTS = re.compile(
    r"(?:counts?|cn?ts?|puls(?:es?)?|ticks?|in[ck]r?|increments?|inkremente?|imp|impulses?|steps?|[cp]ps)"
    r"(?:\s*/\s*(s|ms|sec|second|min))?",
    re.IGNORECASE,
)


def of_encoder(unit: str) -> str:
    """Return the unit of a speed in counts of an encoder, `COUNTS` a revolution; nothing for any other unit.

    Examples
    --------
    >>> of_encoder("counts/s"), of_encoder("inc/min"), of_encoder("rpm")
    ('rev/s/2000', 'rev/min/2000', '')
    """
    match = _COUNTS.fullmatch(unit.strip())
    return f"rev/{(match[1] or 's').lower()}/{COUNTS}" if match else ""


def split_factor(text: str, unit: str, kind: str) -> tuple[float, str]:
    """Return factor and plain unit, which holds no digits but small powers: it cannot run for ever."""
    text = text.translate(_DOTS)
    if times := _TIMES.fullmatch(text):
        number, plain = (times[1], times[2]) if times[1] else (times[4], times[3])
        number = number.replace("10^", "1e")
        raise UnitError(
            f"unit '{unit}' is ambiguous. Write '{number} {plain}' if 1 in the file means {number} "
            f"{plain}, or '{plain} / {number}' if the numbers are {number} times too large"
        )
    match = _FACTORED.fullmatch(text)
    if match is None or _ALPHABET.fullmatch(re.sub(NUMBER, "", text)) is None:
        if not text:
            raise UnitError("the unit is missing", remedy=f"write one such as {KINDS[kind][1]}")
        raise UnitError(f"unknown unit '{unit[:40]}'", remedy=meant(kind, unit))
    factor = float(match[1] or 1.0) / (float(match[3] or 1.0) or math.nan)
    plain = f"1{match[2]}" if match[2].startswith("/") else match[2]
    if plain == "1":
        return factor, plain
    for spelling, standard in _SPELLINGS:
        if re.fullmatch(spelling, plain):
            return factor, re.sub(f"^(?:{spelling})$", standard, plain)
    plain = re.sub(r"(?<=[A-Za-z])[.·](?=[A-Za-z])", "*", plain)
    if re.search(r"\d", _POWER.sub("", re.sub(r"^1\s*/", "/", plain))):
        raise UnitError(f"unknown unit '{unit}'", remedy=meant(kind, unit))
    return factor, plain


def without_factor(unit: str) -> str:
    """Return a unit without the number that multiplies or divides it; one that cannot be read as it is.

    Examples
    --------
    >>> without_factor("9.84 mN*m / 100"), without_factor("-1 rpm"), without_factor("1/min")
    ('mN*m', 'rpm', '1/min')
    """
    match = _FACTORED.fullmatch(unit) if len(unit) <= LONGEST_UNIT else None
    if match is None or match[2].startswith(("/", "1")):
        return unit
    return match[2]
