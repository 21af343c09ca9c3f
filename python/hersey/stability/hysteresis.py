"""The band of drive speeds where the past decides: steady sliding from above, stick-slip from below.

Three speeds divide the behaviour (Figs. 13-14 of the paper). Below ``lower`` every start ends in
stick-slip. Between there and the transition speed a small oscillation without sticking survives. Between the
transition speed and ``upper``, the fold V*, a belt that slides goes on sliding and one that sticks goes on
sticking; above, stick-slip dies out.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey import _core
from hersey.arguments.frozen import explained
from hersey.arrays import FloatArray, numbers_of, together
from hersey.errors import ParameterError
from hersey.motion.belt import BeltDrag, Drivetrain, Train, belt_of
from hersey.motion.drag import AnyDrag, Drag
from hersey.motion.parameters import MOST_STEPS, OF_THE_BELT, whole
from hersey.result import OPEN, Means, Result, table_of
from hersey.stability.hysteresis_sweep import PARAMETER_KINDS, TOLERANCE, BandRules
from hersey.units import argument, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Relative step of the derivatives.
_STEP = 1e-3
#: What a band has by the same name in the core.
_SHARED = ("lower", "transition", "upper", "stalls", "lower_accuracy", "upper_accuracy", "deeper", "laps")


@dataclass(frozen=True, repr=False)
class HysteresisBand(Result):
    """Drive speeds that separate sliding and stick-slip, with their accuracy.

    ``lower_accuracy`` and ``upper_accuracy`` are relative. ``method`` is ``half laps`` (slip motions
    forward and backward in time that meet) or ``simulation`` (from rest, by bisection). If ``deeper``,
    the stick-slip that survives to the highest speed is released above the stick speed
    (docs/theory/hysteresis.md). ``sensitivity`` holds the relative change of ``upper`` per relative
    change of each parameter, and ``lower_sensitivity`` the same for ``lower``; both are empty if not
    requested. ``interval`` and ``lower_interval`` enclose 95 % of the folds of the samples given,
    ``share_bistable`` is the share of them that have a band. ``upper`` is infinite beyond 10,000
    transition speeds.
    """

    also_stated = ("bistable", "verdict")

    lower: Annotated[float, OPEN]
    transition: float
    upper: Annotated[float, Means("0, as is lower, where no stick-slip cycle exists", open=True)]
    stalls: Annotated[bool, Means("whether the grip cannot start it from rest")]
    closure: str
    method: Annotated[str, Means("half laps, or simulation")]
    lower_accuracy: Annotated[float, Means("relative", open=True)]
    upper_accuracy: Annotated[float, Means("relative", open=True)]
    deeper: Annotated[
        bool,
        Means("whether the longest-lasting stick-slip is released at a force above that at the stick speed"),
    ]
    speed_max: float | None
    laps: int
    sensitivity: Annotated[
        Mapping[str, float], Means("relative change of upper per relative change of each", open=True)
    ] = field(default_factory=dict)
    lower_sensitivity: Annotated[
        Mapping[str, float], Means("relative change of lower per relative change of each", open=True)
    ] = field(default_factory=dict)
    interval: Annotated[tuple[float, float] | None, Means("of upper, 95 %", open=True)] = None
    lower_interval: Annotated[tuple[float, float] | None, Means("of lower, 95 %", open=True)] = None
    share_bistable: Annotated[
        float | None, Means("share of the samples that have a band; null without samples")
    ] = None

    @property
    def bistable(self) -> bool:
        """Whether there is a band: drive speeds with both steady sliding and stick-slip."""
        return self.upper > self.transition * (1.0 + self.upper_accuracy)

    def derivative(self, parameter: str, value: float) -> float:
        """Return the derivative of ``upper`` to a parameter, at the value of that parameter."""
        return self.sensitivity[parameter] * self.upper / value

    def verdict(self) -> str:
        """Return what the band means, in a sentence or two."""
        stalled = "The grip does not suffice to start from rest, at any drive speed. " if self.stalls else ""
        return stalled + self._in_motion()

    def _in_motion(self) -> str:
        """What the band means where it is not stalled."""
        if self.upper == 0:
            return (
                "No stick-slip: what sticks also stalls. From the transition speed "
                f"{self.transition:.6g} up, sliding goes on while the grip exceeds the drag."
            )
        if not self.bistable:
            return (
                f"No band: stick-slip ends at {self.upper:.6g}, which is not above the transition speed "
                f"{self.transition:.6g}, so the start does not matter."
            )
        certain = f"Below {self.lower:.6g}, stick-slip is certain. From {self.transition:.6g} "
        if np.isinf(self.upper):
            return certain + "up, it slides if slowed from above, but not if started from rest."
        return (
            f"{certain}to {self.upper:.6g}, it slides if slowed from above and sticks if started from below. "
            "Above, it slides."
        )

    def headline(self) -> str:
        """Return the three speeds."""
        return f"lower edge {self.lower:.6g}, transition speed {self.transition:.6g}, V* {self.upper:.6g}"

    def summary(self, values: Mapping[str, float] | None = None) -> str:
        """Return the edges and the verdict as text, in the units of the arguments.

        ``values`` of the parameters by name adds a table of sensitivities.
        """
        lines = [
            f"lower edge        {self.lower:.9g}  (to {self.lower_accuracy:.0e})",
            f"transition speed  {self.transition:.9g}",
            f"upper fold V*     {self.upper:.9g}  (to {self.upper_accuracy:.0e}, by {self.method})",
        ]
        if self.deeper:
            lines.append("at the upper fold, a deeper stick-slip cycle ends, released above the stick speed")
        if self.sensitivity and values is not None:
            lines += self._sensitivity_lines(values)
        return "\n".join([*lines, self.verdict()])

    def _sensitivity_lines(self, values: Mapping[str, float]) -> list[str]:
        head = (
            f"{'parameter':18s} {'value':>12s} {'dV*/dparameter':>15s}"
            f" {'V* for +1 %':>13s} {'lower, +1 %':>13s}"
        )
        rows = [
            f"{name:18s} {values[name]:12.6g} {self.derivative(name, values[name]):15.6g} {share:+10.3f} % "
            f"{self.lower_sensitivity[name]:+10.3f} %"
            for name, share in self.sensitivity.items()
        ]
        return [head, *rows]

    def to_frame(self) -> pl.DataFrame:
        """Return the edges and their accuracies; the SI units in the names stand for the units given."""
        edges = ("lower", "transition", "upper")
        intervals = {"upper": self.interval, "lower": self.lower_interval}
        ends = [
            (f"{name} 95 % {end}", value, "m/s")
            for name, interval in intervals.items()
            for end, value in zip(("low", "high"), interval or (), strict=False)
        ]
        return table_of(
            [
                *((name, getattr(self, name), "m/s") for name in edges),
                ("lower_accuracy", self.lower_accuracy, ""),
                ("upper_accuracy", self.upper_accuracy, ""),
                ("speed_max", self.speed_max, "m/s"),
                *ends,
                ("share_bistable", self.share_bistable, ""),
            ]
        )


@explained
@dataclass(frozen=True)
class CyclesWithoutSticking:
    """Oscillations around steady sliding that never stick; arrays of one shape, speeds in the units given.

    The belt speed varies between ``slowest`` and ``fastest`` at ``drive_speed``. An unstable cycle is the
    boundary between steady sliding and stick-slip: from inside it the belt ends sliding, from outside
    sticking. Values are NaN where there is no cycle.
    """

    slowest: FloatArray
    fastest: FloatArray
    drive_speed: FloatArray
    stable: NDArray[np.bool_]


@takes_si(temperature="temperature")
def hysteresis(
    train: Train,
    drag: BeltDrag,
    *,
    temperature: float | None = None,
    samples: Mapping[str, ArrayLike] | None = None,
    sensitivity: bool | None = None,
    tolerance: float = TOLERANCE,
    most_steps: float = MOST_STEPS,
) -> HysteresisBand:
    """Return the band of drive speeds in which sticking depends on the start.

    If the spring force would exceed the roll's grip, the roll slips for part of each cycle and stick-slip
    dies out at a lower drive speed. ``upper`` is then the speed above which no oscillation with roll slip
    survives, even without sticking. ``stalls`` says whether the roll cannot start the belt at all.

    Parameters
    ----------
    train, drag
        A drivetrain and its drag; or a machine (`hersey.read_machine`) and the surface fitted to its log,
        which take radius, stick speed and grip from the machine file.
    temperature
        Temperature of the band, K; needed if the drag depends on it.
    samples
        Draws of uncertain parameters (any of ``stiffness``, ``mass``, ``transition_force``,
        ``transition_speed``, ``ehl_exponent``, ``mixed_exponent``, ``stick_speed``), arrays of equal length,
        e.g. from `DampingSurface.drag_samples`, in SI or with units. The intervals follow from them.
    sensitivity
        Whether to compute the change of the band with each parameter. Default: only if that takes
        milliseconds, i.e. for a `Drag` with ``retained`` or ``stiction``.
    most_steps
        Limit of work per motion, as for `simulate`, if edges are found by simulation. All together may use as
        much, or six times as much with a smooth closure.

    Raises
    ------
    ParameterError
        If a value is out of range, with its name; also ``mixed_exponent`` if it is not less than
        ``ehl_exponent``, because then there is no transition.
    UnfinishedError
        If the allowed work is exceeded, or a motion cannot be continued.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> band = hysteresis(Drivetrain(1000, 1), drag)
    >>> round(band.lower, 6), band.transition, round(band.upper, 8)
    (0.981793, 1.0, 2.17349348)
    >>> round(band.sensitivity["stick_speed"], 3)  # one per cent on v_s moves V* by a quarter of a per cent
    -0.233
    """
    train, drag, temperature = belt_of(train, drag, temperature)
    steps = whole("most_steps", most_steps)
    band = _core.band(train._arguments, drag.law_at(temperature), True, float(tolerance), steps)
    plain = drag.at(temperature) if isinstance(drag, Drag) else None
    closure = str(getattr(drag, "closure", "retained"))
    if sensitivity is None:
        sensitivity = plain is not None and band.half_laps and band.upper > 0
    changes = _sensitivities(train, plain, tolerance, steps) if sensitivity else ({}, {})
    drawn: dict[str, Any] = {}
    if samples is not None:
        given = {name: _drawn(name, values) for name, values in samples.items()}
        edges = _sampled(train, plain, given, tolerance, steps)
        drawn = {"interval": _middle(edges.upper), "lower_interval": _middle(edges.lower)}
        drawn["share_bistable"] = float(np.mean(edges.upper > edges.transition))
    return HysteresisBand(
        **{name: getattr(band, name) for name in _SHARED},
        closure=closure,
        method="half laps" if band.half_laps else "simulation",
        speed_max=None if np.isnan(band.speed_max) else band.speed_max,
        sensitivity=changes[0],
        lower_sensitivity=changes[1],
        **drawn,
    )


def fold(
    train: Drivetrain, drag: AnyDrag, *, tolerance: float = TOLERANCE, most_steps: int = MOST_STEPS
) -> tuple[float, float]:
    """Return transition speed and V* (m/s) of a drag at one temperature, without the slow lower edge.

    Raises
    ------
    ParameterError, UnfinishedError
        As `hysteresis` does.
    """
    found = _core.band(train._arguments, drag.law_at(None), False, tolerance, most_steps)
    return float(found.transition), float(found.upper)


def _drawn(name: str, values: Any) -> Any:
    """Draws of a parameter in SI; a name that is not known is refused later."""
    return (
        argument(f"samples of {name}", PARAMETER_KINDS[name], values) if name in PARAMETER_KINDS else values
    )


@takes_si(slowest="belt speed", temperature="temperature")
def cycles_without_sticking(
    train: Drivetrain,
    drag: Drag,
    *,
    slowest: ArrayLike | None = None,
    temperature: float | None = None,
    tolerance: float = TOLERANCE,
) -> CyclesWithoutSticking:
    """Return the cycle for each lowest belt speed, and the drive speed at which it occurs.

    At the stick speed, that drive speed is the fold V* of cycles released there (``retained``). From there it
    falls to the lower edge of the band and rises again to the transition speed, where the oscillation
    vanishes. Such an oscillation does not depend on the closure (except ``lugre``, whose bristles have
    memory), and the roll is assumed not to slip.

    Parameters
    ----------
    slowest
        Lowest belt speeds of the cycles, from the stick speed to below the transition speed, in the units of
        the drag. Default: 201 values between these, evenly spaced in logarithms, the last 0.1 % below the
        transition.
    temperature
        K; needed if the drag varies with it.

    Raises
    ------
    ParameterError
        If a value is out of range, or the drag is no `Drag` with a falling and a rising branch.

    Examples
    --------
    >>> drag = Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)
    >>> cycles = cycles_without_sticking(Drivetrain(1000, 1), drag, slowest=[0.01, 0.5, 0.9])
    >>> cycles.drive_speed.round(6).tolist(), cycles.stable.tolist()
    ([2.173493, 1.008534, 0.988886], [False, False, True])
    """
    if not isinstance(drag, Drag) or drag.closure == "lugre":
        raise ParameterError("cycles without sticking need a Drag, and its closure must not be 'lugre'")
    law = drag.warned(temperature, stacklevel=3).at(temperature)
    low, high = law.stick_speed, law.transition_speed
    speeds = np.geomspace(low, 0.999 * high, 201) if slowest is None else numbers_of("slowest", slowest)
    if not bool(np.all((speeds >= low) & (speeds < high))):
        raise ParameterError(f"slowest must be from the stick speed {low:g} to below {high:g}")
    flat = np.ascontiguousarray(speeds.ravel())
    swings = _core.swings(train._arguments, law.law(), flat, float(tolerance))
    if swings is None:
        raise ParameterError(
            "there are no cycles: the drag must fall below the transition speed and rise above it"
        )
    return CyclesWithoutSticking(
        slowest=speeds,
        fastest=swings.fastest.reshape(speeds.shape),
        drive_speed=swings.drive_speed.reshape(speeds.shape),
        stable=swings.stable.reshape(speeds.shape),
    )


def _sensitivities(
    train: Drivetrain, drag: Drag | None, tolerance: float, most_steps: int
) -> tuple[dict[str, float], dict[str, float]]:
    """Relative change of the edges per relative change of each parameter, by central differences."""
    if drag is None:
        raise ParameterError("sensitivity needs a Drag, because a table has no parameters")
    parameters = {**vars(train), **vars(drag)}
    base = np.array([float(parameters[name]) for name in OF_THE_BELT])
    factors = np.vstack([1 + _STEP * np.eye(len(OF_THE_BELT)), 1 - _STEP * np.eye(len(OF_THE_BELT))])
    columns = dict(zip(OF_THE_BELT, (base * factors).T, strict=True))
    edges = BandRules(train, drag, float(tolerance), most_steps).follow(columns)
    if edges.failures:
        raise edges.failures[0].error

    def change(edge: FloatArray) -> dict[str, float]:
        up, down = np.log(edge).reshape(2, -1)
        return dict(zip(OF_THE_BELT, ((up - down) / (2 * _STEP)).tolist(), strict=True))

    return change(edges.upper), change(edges.lower)


def _sampled(
    train: Drivetrain, drag: Drag | None, samples: Mapping[str, ArrayLike], tolerance: float, most_steps: int
) -> _core.Bands:
    if drag is None:
        raise ParameterError("samples need a Drag, because a table has no parameters")
    unknown = sorted(set(samples) - set(OF_THE_BELT))
    if unknown:
        raise ParameterError(f"samples: unknown parameter {unknown[0]}. Known: {', '.join(OF_THE_BELT)}")
    parameters = {**vars(train), **vars(drag)}
    given = {name: numbers_of(name, samples.get(name, parameters[name])) for name in OF_THE_BELT}
    _, columns = together(given)
    rules = BandRules(train, drag, float(tolerance), most_steps)
    bands = rules.follow({name: column.ravel() for name, column in columns.items()})
    for failure in bands.failures:
        raise failure.error.within(f"samples: draw {failure.index}")
    return bands


def _middle(values: FloatArray) -> tuple[float, float]:
    """The interval that leaves 2.5 % of the draws on either side."""
    low, high = np.quantile(values, [0.025, 0.975], method="inverted_cdf")
    return float(low), float(high)
