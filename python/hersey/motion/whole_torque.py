"""The whole torque, of film and drive together, where the machine states a no-load torque to subtract."""

from __future__ import annotations

from typing import NoReturn

from hersey.errors import ParameterError

#: How to go on without subtracting anything.
_KEPT = "keep the whole torque by machine = dataclasses.replace(machine, rest=None)"


def refuse_whole_torque(holder: str, stated: object, write: str, otherwise: str = _KEPT) -> NoReturn:
    """Refuse what holds the whole torque.

    Parameters
    ----------
    holder
        What holds it, as the subject of the sentence with its verb.
    stated
        The no-load torque of the machine.
    write, otherwise
        What to write to subtract it, and to go on without.

    Raises
    ------
    ParameterError
        Always.
    """
    raise ParameterError(
        f"{holder} the whole torque, but the machine states a no-load torque to subtract: {stated}",
        quantity="no-load torque",
        remedy=f"{write}, or {otherwise}",
    )
