"""Units in which warnings show the numbers of a drive, by the unit of its trace."""

from __future__ import annotations

#: Unit of each kind of number by the unit of the trace, and how many of it make one in SI.
_SHOWN = {
    "N": {
        "slope": ("N/s", 1.0),
        "stiffness": ("N/mm", 1e-3),
        "mass": ("kg", 1.0),
        "force": ("N", 1.0),
        "speed": ("mm/s", 1e3),
    },
    "N m": {
        "slope": ("N m/s", 1.0),
        "stiffness": ("N m/rad", 1.0),
        "mass": ("kg m^2", 1.0),
        "force": ("N m", 1.0),
        "speed": ("rad/s", 1.0),
    },
    "1": {
        "slope": ("of the weight per s", 1.0),
        "stiffness": ("of the weight per m", 1.0),
        "mass": ("s^2/m", 1.0),
        "force": ("of the weight", 1.0),
        "speed": ("mm/s", 1e3),
    },
}
#: Of a trace whose unit is not known.
_UNKNOWN = {"slope": ("(unit of the trace) per s", 1.0), "speed": ("(SI)", 1.0)}
_OTHERS = ("(SI if the trace is)", 1.0)
#: Kinds of the parameters of a drive; exponents have none.
_KINDS = {
    "stiffness": "stiffness",
    "mass": "mass",
    "transition_force": "force",
    "transition_speed": "speed",
    "stick_speed": "speed",
}


def kind_of(parameter: str) -> str:
    """Return the kind of number that a parameter of a drive is; empty for an exponent."""
    return _KINDS.get(parameter, "")


def in_unit(number: float, kind: str, unit: str, *, digits: int = 4) -> str:
    """Return a number of a kind, in SI, with its unit, for people.

    Examples
    --------
    >>> in_unit(0.02, "speed", "N"), in_unit(1980.1, "stiffness", "N"), in_unit(3.0, "stiffness", "N m")
    ('20 mm/s', '1.98 N/mm', '3 N m/rad')
    """
    if not kind:
        return f"{number:.{digits}g}"
    name, factor = _SHOWN.get(unit, _UNKNOWN).get(kind, _OTHERS)
    return f"{factor * number:.{digits}g} {name}"
