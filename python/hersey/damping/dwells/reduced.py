"""What to write where steady points are needed and the log, its file or something else is given."""

from __future__ import annotations

import json
from pathlib import Path

from hersey.damping.dwells.points import SteadyPoints
from hersey.damping.no_load_torque import NoLoadTorque
from hersey.errors import ParameterError
from hersey.log.formats.frame import is_frame
from hersey.log.means import MeansTable
from hersey.log.torque_log import TorqueLog
from hersey.motion.whole_torque import refuse_whole_torque

#: How a log becomes steady points; the tare changes every torque, so nobody chooses it but the user.
_REDUCED = '.steady(tare="standing")'


def require_points(given: object, call: str) -> None:
    """Refuse what is not the steady points of a log.

    Parameters
    ----------
    given
        What a function was given.
    call
        Its call as it should be written, with ``{points}`` where the points stand.

    Raises
    ------
    ParameterError
        With the line to write.

    Examples
    --------
    >>> require_points("bench.csv", "hersey.fit({points})")
    Traceback (most recent call last):
        ...
    hersey.errors.ParameterError: hersey.fit needs steady points, not a file name. Write \
hersey.fit(hersey.read("bench.csv").steady(tare="standing")), or tare="none" if the torque is zeroed already
    """
    if isinstance(given, SteadyPoints):
        return
    refuse_unfitted(given, call, "steady points")


def require_film(points: SteadyPoints, stated: NoLoadTorque | None, call: str) -> None:
    """Refuse points of the whole torque where the machine states a no-load torque; ``call`` as above.

    Raises
    ------
    ParameterError
        With the line to write.
    """
    if stated is None or points.rest is not None:
        return
    points.refuse_subtracted()
    refuse_whole_torque("points hold", stated, f"write {call.format(points='points.without(machine.rest)')}")


def refuse_unfitted(given: object, call: str, needed: str) -> None:
    """Refuse what is not yet what a function needs; ``call`` as in `require_points`.

    Raises
    ------
    ParameterError
        With the line to write.
    """
    what, points = _written(given)
    function = call.split("(", 1)[0]
    zeroed = ', or tare="none" if the torque is zeroed already' if _REDUCED in points else ""
    raise ParameterError(f"{function} needs {needed}, not {what}. Write {call.format(points=points)}{zeroed}")


def _written(given: object) -> tuple[str, str]:
    """What was given, and the expression of the steady points that it leads to."""
    if isinstance(given, SteadyPoints):
        return "steady points", "points"
    if isinstance(given, TorqueLog):
        return "a log", f"log{_REDUCED}"
    if isinstance(given, MeansTable):
        return "a table of means", "hersey.SteadyPoints.from_table(table)"
    if isinstance(given, str | Path):
        name = json.dumps(str(given), ensure_ascii=False)
        return "a file name", f"hersey.read({name}){_REDUCED}"
    if is_frame(given):
        return "a frame", f"hersey.read(frame){_REDUCED}"
    return f"a {type(given).__name__}", f"log{_REDUCED}"
