"""Units in which warnings show the numbers of a drive, by the unit of its trace."""

from __future__ import annotations

#: Format that converts a number from SI, and its unit, of each kind of number, by the unit of the trace.
_SHOWN = {
    "N": {"slope": (" N/s", ""), "stiffness": ("", " N/mm"), "mass": (" kg", ""), "force": (" N", "")},
    "N m": {
        "slope": (" N m/s", ""),
        "stiffness": (" N m/rad", ""),
        "mass": (" kg m^2", ""),
        "force": (" N m", ""),
        "speed": (" rad/s", ""),
    },
    "1": {
        "slope": (" of the weight per s", ""),
        "stiffness": (" of the weight per m", ""),
        "mass": (" s^2/m", ""),
        "force": (" of the weight", ""),
    },
}
_SHOWN["N"]["speed"] = _SHOWN["1"]["speed"] = ("", " mm/s")
#: Kinds of the parameters of a drive; exponents have none.
_KINDS = {
    "stiffness": "stiffness",
    "mass": "mass",
    "transition_force": "force",
    "transition_speed": "speed",
    "stick_speed": "speed",
}
#: Of a trace whose unit is not known.
_UNKNOWN = {"slope": " (unit of the trace) per s", "speed": " (SI)"}
_SOME = " (SI if the trace is)"


def kind_of(parameter: str) -> str:
    """Return the kind of number that a parameter of a drive is; empty for an exponent."""
    return _KINDS.get(parameter, "")


def field(value: str, kind: str, unit: str, *, digits: int = 4) -> str:
    """Return the words of a warning that show one of its values, of a kind, with its unit.

    Examples
    --------
    >>> field("agreed", "speed", "N"), field("fitted", "stiffness", "N m")
    ('{agreed:.4g mm/s}', '{fitted:.4g} N m/rad')
    """
    if not kind:
        return f"{{{value}:.{digits}g}}"
    behind, converted = _SHOWN.get(unit, {}).get(kind, (_UNKNOWN.get(kind, _SOME), ""))
    return f"{{{value}:.{digits}g{converted}}}{behind}"
