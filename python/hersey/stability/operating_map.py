"""The operating map: what the belt does at each temperature and drive speed.

Four speeds divide each temperature: ``lower``, the transition speed, ``upper`` (the fold V*) and the speed
from which the drag stalls the drive. All come from the fitted surface and the core; nothing is drawn here.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey.arrays import FloatArray, numbers_of
from hersey.damping.surface import DampingSurface
from hersey.errors import InsufficientDataError, ParameterError
from hersey.machine.machine import Limits, OperatingPoint
from hersey.machine.uncertainty import Uncertainty
from hersey.motion.drag import Drag
from hersey.motion.simulation import Drivetrain
from hersey.result import Result, json_record
from hersey.stability.hysteresis import hysteresis_sweep
from hersey.units import convert, takes_si

if TYPE_CHECKING:
    import polars as pl
    import xarray as xr

#: States, from the slow side up. ``swing``: a small swing without sticking survives, a stuck belt sticks on.
STATES = ("stick_slip", "swing", "bistable", "smooth", "stall")
#: Temperatures and speeds of a map that are not given.
TEMPERATURES, SPEEDS = 61, 81
#: Share of the measured span of temperature shown beyond it on either side, and the least of it in K.
MARGIN, LEAST_MARGIN = 0.15, 5.0
#: Draws for the interval of the transition speed, and for that of V*, which costs a fold each.
DRAWS, FOLD_DRAWS = 1000, 200
#: Temperatures at which the interval of V* is computed; between them it is interpolated.
FOLD_TEMPERATURES = 13
#: Greatest speed shown, as a multiple of the fastest dwell, where V* lies higher.
_REACH = 10.0
#: Transition speeds at which the search for V* ends.
_FARTHEST = 1e4
#: Tolerance for draws: where the band opens, looser laps do not meet, and simulation takes 100 times as long.
_TIGHT = 1e-13
#: Temperatures of the summary.
_ROWS = 5
#: Drawn stick speeds stay below this share of the transition speed drawn with them.
_BELOW = 0.999


@dataclass(frozen=True)
class MapState:
    """What the belt does at one temperature and drive speed; speeds in m/s, torque in N m.

    ``state`` is one of `STATES`. ``torque`` is that of steady sliding, with which the drive must cope.
    ``extrapolated`` says that no dwell of the fit lies that far out.
    """

    state: str
    torque: float
    lower: float
    transition: float
    upper: float
    extrapolated: bool

    def verdict(self) -> str:
        """Return what the state means, in one sentence."""
        return _VERDICTS[self.state]


_VERDICTS = {
    "stick_slip": "Stick-slip is certain.",
    "swing": "The belt swings; it sticks once it has stuck.",
    "bistable": "Smooth only if it comes from above; from rest it sticks and slips.",
    "smooth": "Smooth.",
    "stall": "The drag is more than the drive can bear.",
}


@dataclass(frozen=True)
class PlacedPoint:
    """An operating point of the user's and what the map says there: speed in m/s, temperature in K."""

    name: str
    speed: float
    temperature: float
    at: MapState


@dataclass(frozen=True, repr=False)
class OperatingMap(Result):
    """Speeds (m/s) that divide the behaviour at each temperature (K), shape (n,).

    ``temperature`` is None for an isothermal fit, whose map has one column. ``upper`` is infinite beyond
    10,000 transition speeds. Intervals, shape (2, n), hold 95 % of the draws; ``upper_interval`` counts the
    fit and the parameters in ``uncertain``. Drag exceeds ``torque_limit`` (N m, set by ``limited_by``) from
    ``stall_above`` up (infinite if never) and, on the falling branch, up to ``stall_below`` (0 if never).
    ``torque`` in N m, shape (n, m), is that of steady sliding at ``speed``, shape (m,). The measured ranges
    bound the dwells.
    """

    temperature: FloatArray | None
    speed: FloatArray
    lower: FloatArray
    transition: FloatArray
    upper: FloatArray
    transition_interval: FloatArray
    upper_interval: FloatArray
    stall_below: FloatArray
    stall_above: FloatArray
    torque: FloatArray
    torque_limit: float | None
    limited_by: str
    speed_limit: float | None
    measured_temperature: tuple[float, float] | None
    measured_speed: tuple[float, float]
    points: tuple[PlacedPoint, ...]
    uncertain: tuple[str, ...]
    warnings: tuple[str, ...]
    roll_radius: float
    train: Drivetrain
    drag: Drag

    @takes_si(temperature="temperature", speed="belt speed")
    def state_at(self, temperature: float | None, speed: float) -> MapState:
        """Return the state at a temperature (K; None for an isothermal fit) and a drive speed (m/s).

        The bands are computed there, not interpolated.

        Raises
        ------
        ParameterError
            If the speed or the temperature is not one that the law allows.
        """
        return self.look_up(temperature, speed)[0]

    @takes_si(temperature="temperature", speed="belt speed")
    def states(self, temperature: ArrayLike | None, speed: ArrayLike) -> NDArray[np.str_]:
        """Return the name of the state for arrays of temperature (K) and speed (m/s), broadcast together."""
        shape = np.broadcast_shapes(
            np.shape(temperature if temperature is not None else 0.0), np.shape(speed)
        )
        names = [state.state for state in self.look_up(temperature, speed)]
        return np.array(names).reshape(shape)

    @takes_si(torque="torque")
    def contour(self, torque: float) -> tuple[FloatArray, FloatArray]:
        """Return the speeds (m/s) of a torque (N m) at each temperature: falling branch, rising branch.

        0 on the falling branch where torque stays below it down to the stick speed; both the transition
        speed where torque is never so small.
        """
        return _contour(_laws(self.drag, self.temperature), torque / self.roll_radius)

    def to_dict(self) -> dict[str, Any]:
        """Return the whole map in SI; None stands for a speed beyond all that was searched."""
        return json_record(vars(self))

    def to_frame(self) -> pl.DataFrame:
        """Return the dividing speeds at each temperature (one row if isothermal)."""
        import polars as pl

        speeds = {
            "lower": self.lower,
            "transition": self.transition,
            "transition 95 % low": self.transition_interval[0],
            "transition 95 % high": self.transition_interval[1],
            "upper": self.upper,
            "upper 95 % low": self.upper_interval[0],
            "upper 95 % high": self.upper_interval[1],
            "stall below": self.stall_below,
            "stall above": self.stall_above,
        }
        columns = {} if self.temperature is None else {"temperature (K)": self.temperature}
        return pl.DataFrame({**columns, **{f"{name} (m/s)": values for name, values in speeds.items()}})

    def headline(self) -> str:
        """Return the ranges of temperature and speed."""
        low, high = _mm(float(self.speed[0])), _mm(float(self.speed[-1]))
        hot = (
            ""
            if self.temperature is None
            else f", {_celsius(self.temperature[0])} to {_celsius(self.temperature[-1])}"
        )
        return f"{low} to {high} mm/s{hot}, {len(self.points)} points"

    def summary(self) -> str:
        """Return the dividing speeds at a few temperatures, and the points, as text."""
        return _summary(self)

    @takes_si(temperature="temperature", speed="belt speed")
    def look_up(self, temperature: ArrayLike | None, speed: ArrayLike) -> list[MapState]:
        """Return the states of arrays, broadcast together and flattened, as `state_at` does for one."""
        if (temperature is None) == self.drag.varies_with_temperature:
            reason = "the map is one of temperatures: give one, in K"
            other = "temperature is given, but the fit is isothermal"
            raise ParameterError(reason if self.drag.varies_with_temperature else other)
        speeds = numbers_of("speed", speed)
        kelvin = numbers_of("temperature", 0.0 if temperature is None else temperature)
        try:
            speeds, kelvin = (a.ravel() for a in np.broadcast_arrays(speeds, kelvin))
        except ValueError:
            raise ParameterError("speed and temperature do not fit together") from None
        if not np.all((speeds > 0) & np.isfinite(speeds)):
            raise ParameterError(f"speed is {float(speeds.min()):g}: it must be greater than 0")
        levels, place = np.unique(kelvin, return_inverse=True)
        if temperature is not None:
            _check_temperatures(levels, self.drag)
        found = _edges(self.train, self.drag, None if temperature is None else levels)
        laws = _laws(self.drag, None if temperature is None else levels)
        rows = zip(speeds.tolist(), kelvin.tolist(), place.ravel().tolist(), strict=True)
        return [self._state(laws[i], {k: float(v[i]) for k, v in found.items()}, t, v) for v, t, i in rows]

    def _state(self, law: Drag, edges: Mapping[str, float], kelvin: float, speed: float) -> MapState:
        torque = float(law.force(speed)) * self.roll_radius
        if self.torque_limit is not None and torque > self.torque_limit:
            state = "stall"
        elif speed < edges["lower"]:
            state = "stick_slip"
        elif speed < edges["transition"]:
            state = "swing"
        else:
            state = "bistable" if speed < edges["upper"] else "smooth"
        low, high = self.measured_speed
        cold, hot = self.measured_temperature or (-np.inf, np.inf)
        outside = not (low <= speed <= high and cold <= kelvin <= hot)
        return MapState(state, torque, **edges, extrapolated=outside)


@takes_si(roll_radius="length", stick_speed="belt speed", temperatures="temperature", speeds="belt speed")
def operating_map(
    surface: DampingSurface,
    train: Drivetrain,
    *,
    roll_radius: float,
    stick_speed: float,
    limits: Limits | None = None,
    points: Sequence[OperatingPoint] = (),
    uncertainty: Mapping[str, Uncertainty] | None = None,
    temperatures: ArrayLike | None = None,
    speeds: ArrayLike | None = None,
    seed: int = 0,
    draws: int = FOLD_DRAWS,
    threads: int = 1,
) -> OperatingMap:
    """Return what the belt does at each temperature and drive speed.

    Parameters
    ----------
    surface
        The fitted surface; it must have a transition.
    train
        Stiffness (N/m) and mass (kg) at the belt.
    roll_radius, stick_speed
        m and m/s, as in `DampingSurface.drag`; the stick speed is that at the fit's reference temperature
        and moves with temperature as the transition speed does.
    limits
        What the drive can bear: ``motor_torque``, or ``roll_friction`` with ``nip_load``, gives the stall.
    points
        Operating points to judge.
    uncertainty
        How far ``stiffness``, ``mass`` and ``stick_speed`` are known, for the interval of V*; what it says of
        other parameters is left alone, since the fit knows them better.
    temperatures
        K, ascending; by default the measured range and the points, and a little beyond.
    speeds
        m/s, ascending; by default all that the bands, the dwells and the points need.
    seed
        Of the draws for the intervals.
    draws, threads
        For the interval of V*, which takes most of the time.

    Raises
    ------
    InsufficientDataError
        If the data show no falling branch: then there is no stick-slip to map.
    ParameterError
        If a value is out of range, with its name.

    Examples
    --------
    >>> from hersey import fit, read
    >>> surface = fit(read("examples/bench.csv").steady(tare="standing"))
    >>> map_ = operating_map(surface, Drivetrain(11e3, 11.0), roll_radius=0.015, stick_speed=3e-4)
    >>> [map_.state_at(180 + 273.15, v).state for v in (0.02, 0.045, 0.12)]
    ['stick_slip', 'bistable', 'smooth']
    """
    limits = limits or Limits()
    if draws < 1:
        raise ParameterError(f"draws is {draws}: at least 1 is needed")
    if surface.transition is None:
        raise InsufficientDataError(
            f"no operating map: the data show no falling branch ({surface.rejected_transition}); "
            "record slower dwells, until torque rises as the drive slows"
        )
    drag = surface.drag(roll_radius=roll_radius, stick_speed=stick_speed)
    reach = surface.speed_range[0] * roll_radius, surface.speed_range[1] * roll_radius
    kelvin = _temperatures(surface, drag, points, temperatures)
    edges = _edges(train, drag, kelvin)
    shown = _speeds(edges, reach, points, limits.speed, speeds)
    laws = _laws(drag, kelvin)
    limit, limited_by = _torque_limit(limits, roll_radius)
    below, above = _contour(laws, np.inf if limit is None else limit / roll_radius)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        transition_interval, upper_interval, uncertain = _intervals(
            surface, train, drag, kelvin, uncertainty or {}, roll_radius, seed, draws, threads
        )
    drawn = OperatingMap(
        temperature=kelvin,
        speed=shown,
        **edges,
        transition_interval=transition_interval,
        upper_interval=upper_interval,
        stall_below=below,
        stall_above=above,
        torque=np.array([law.force(shown) for law in laws]) * roll_radius,
        torque_limit=limit,
        limited_by=limited_by,
        speed_limit=limits.speed,
        measured_temperature=surface.temperature_range if drag.varies_with_temperature else None,
        measured_speed=reach,
        points=(),
        uncertain=uncertain,
        warnings=(),
        roll_radius=float(roll_radius),
        train=train,
        drag=drag,
    )
    placed = tuple(_placed(drawn, point) for point in points)
    said = list(dict.fromkeys(str(w.message) for w in caught))
    said += _remarks(drawn, placed, stick_speed)
    return replace(drawn, points=placed, warnings=tuple(said))


def _temperatures(
    surface: DampingSurface, drag: Drag, points: Sequence[OperatingPoint], given: ArrayLike | None
) -> FloatArray | None:
    if surface.temperature_range is None or not drag.varies_with_temperature:
        if given is not None:
            raise ParameterError("temperatures are given, but the fit is isothermal: leave them out")
        return None
    if given is not None:
        kelvin = np.atleast_1d(numbers_of("temperatures", given))
        if kelvin.ndim > 1 or kelvin.size < 2 or not np.all(np.diff(kelvin) > 0):
            raise ParameterError("temperatures must ascend, two or more of them")
        _check_temperatures(kelvin, drag)
        return kelvin
    _check_temperatures(np.array([p.temperature for p in points]), drag)
    cold, hot = surface.temperature_range
    margin = max(MARGIN * (hot - cold), LEAST_MARGIN)
    cold, hot = (f([end, *(p.temperature for p in points)]) for f, end in ((min, cold), (max, hot)))
    # A law in degC has no meaning at 0 degC, and all speeds go to nought there.
    least = cold - 0.5 * (cold - drag.temperature_zero)
    return np.linspace(max(cold - margin, least), hot + margin, TEMPERATURES)


def _check_temperatures(kelvin: FloatArray, drag: Drag) -> None:
    scale = "degC" if drag.temperature_zero else "K"
    wrong = kelvin[~(np.isfinite(kelvin) & (kelvin > drag.temperature_zero))]
    if wrong.size:
        raise ParameterError(
            f"temperature is {float(wrong[0]):g} K: a law in {scale} holds above 0 {scale} only"
        )


def _speeds(
    edges: Mapping[str, FloatArray],
    measured: tuple[float, float],
    points: Sequence[OperatingPoint],
    greatest: float | None,
    given: ArrayLike | None,
) -> FloatArray:
    if given is not None:
        speeds = np.atleast_1d(numbers_of("speeds", given))
        if speeds.ndim > 1 or speeds.size < 2 or not (speeds[0] > 0 and np.all(np.diff(speeds) > 0)):
            raise ParameterError("speeds must ascend from above 0, two or more of them")
        return speeds
    wanted = [point.speed for point in points]
    low = max(float(edges["lower"].min()), measured[0] / _REACH)
    high = min(float(edges["upper"].max()), measured[1] * _REACH)
    if greatest is not None and greatest < 3.0 * measured[1]:
        wanted.append(greatest)
    return np.geomspace(0.7 * min(low, measured[0], *wanted), 1.25 * max(high, measured[1], *wanted), SPEEDS)


def _edges(train: Drivetrain, drag: Drag, kelvin: FloatArray | None) -> dict[str, FloatArray]:
    """The bands at each temperature; an isothermal drag has one."""
    band = hysteresis_sweep(train, drag, temperature=kelvin)
    _require_all(band)
    edges = {name: np.atleast_1d(band[name].values) for name in ("lower", "transition", "upper")}
    # Without a band the three speeds are one, up to the last digit.
    edges["lower"] = np.minimum(edges["lower"], edges["transition"])
    edges["upper"] = np.maximum(edges["upper"], edges["transition"])
    return edges


def _require_all(band: xr.Dataset) -> None:
    if band.attrs["failures"]:
        raise ParameterError(f"the bands cannot be computed: {band.attrs['failures'][0]}")


def _laws(drag: Drag, kelvin: FloatArray | None) -> list[Drag]:
    return [drag] if kelvin is None else [drag.at(t) for t in kelvin.tolist()]


def _contour(laws: Sequence[Drag], force: float) -> tuple[FloatArray, FloatArray]:
    """Speeds of a force on the falling and the rising branch of each law."""
    below, above = np.array([law.speeds_of(force) for law in laws]).T
    return below, above


def _torque_limit(limits: Limits, roll_radius: float) -> tuple[float | None, str]:
    """The torque on the roll (N m) at which the belt slips on it or the motor gives up, and which."""
    known = []
    if limits.grip is not None:
        known.append((limits.grip * roll_radius, "roll friction"))
    if limits.motor_torque is not None:
        known.append((limits.motor_torque, "motor torque"))
    return min(known) if known else (None, "")


def _intervals(
    surface: DampingSurface,
    train: Drivetrain,
    drag: Drag,
    kelvin: FloatArray | None,
    uncertainty: Mapping[str, Uncertainty],
    roll_radius: float,
    seed: int,
    draws: int,
    threads: int,
) -> tuple[FloatArray, FloatArray, tuple[str, ...]]:
    """Intervals of the transition speed and of V*, shape (2, n) each, and the parameters that were varied."""

    def samples(t: float | None, count: int) -> dict[str, FloatArray]:
        return surface.drag_samples(
            count, seed, roll_radius=roll_radius, stick_speed=drag.at(t).stick_speed, temperature=t
        )

    levels: list[float | None] = [None] if kelvin is None else kelvin.tolist()
    transition = np.array([_middle(samples(t, DRAWS)["transition_speed"]) for t in levels]).T
    known = {**asdict(train), "stick_speed": drag.stick_speed}
    rng = np.random.default_rng(seed)
    uncertainties = {
        name: spread.draw(rng, known[name], draws) for name, spread in uncertainty.items() if name in known
    }
    few = levels
    if kelvin is not None and kelvin.size > FOLD_TEMPERATURES:
        few = np.linspace(kelvin[0], kelvin[-1], FOLD_TEMPERATURES).tolist()
    ratios = []
    for t in few:
        law, drawn = drag.at(t), samples(t, draws)
        stick = (
            uncertainties.get("stick_speed", np.array(drag.stick_speed)) * law.stick_speed / drag.stick_speed
        )
        band = hysteresis_sweep(
            train,
            law,
            stiffness=uncertainties.get("stiffness"),
            mass=uncertainties.get("mass"),
            stick_speed=np.minimum(stick, _BELOW * drawn["transition_speed"]),
            transition_force=drawn["transition_force"],
            transition_speed=drawn["transition_speed"],
            ehl_exponent=drawn["ehl_exponent"],
            mixed_exponent=drawn["mixed_exponent"],
            zip=True,
            lower=False,
            tolerance=_TIGHT,
            threads=threads,
        )
        _require_all(band)
        low, high = _middle(band["upper"].values / law.transition_speed)
        ratios.append((min(low, _FARTHEST), min(high, _FARTHEST)))
    upper = np.array(ratios).T
    if kelvin is not None:
        upper = np.array(
            [np.exp(np.interp(kelvin, np.array(few, dtype=float), np.log(edge))) for edge in upper]
        )
    bend = np.array([law.transition_speed for law in _laws(drag, kelvin)])
    return transition, upper * bend, tuple(uncertainties)


def _middle(values: FloatArray) -> tuple[float, float]:
    """The interval that leaves 2.5 % of the draws on either side."""
    low, high = np.quantile(values, [0.025, 0.975], method="inverted_cdf")
    return float(low), float(high)


def _placed(drawn: OperatingMap, point: OperatingPoint) -> PlacedPoint:
    temperature = point.temperature if drawn.drag.varies_with_temperature else None
    return PlacedPoint(point.name, point.speed, point.temperature, drawn.state_at(temperature, point.speed))


def _remarks(drawn: OperatingMap, points: Sequence[PlacedPoint], stick_speed: float) -> list[str]:
    """What a reader of the map must know, one sentence each."""
    hot = drawn.drag.reference_temperature
    where = "" if hot is None else f" at {convert(hot, 'K', 'degC'):.0f} degC"
    counted = " and ".join(["the fit", *(name.replace("_", " ") for name in drawn.uncertain)])
    said = [
        f"V* depends on the stick speed, {1e3 * stick_speed:.3g} mm/s{where} here, which nobody measures; "
        f"its interval counts {counted}"
        + ("" if "stick_speed" in drawn.uncertain else ": state how far stick_speed is known")
    ]
    if drawn.temperature is None:
        said.append("the fit is isothermal: the map holds at the temperature of the log, for the points too")
    if drawn.torque_limit is None:
        said.append("no stall is shown: state motor_torque, or roll_friction and nip_load, among the limits")
    else:
        rest = max(law.breakaway_force for law in _laws(drawn.drag, drawn.temperature)) * drawn.roll_radius
        said.append(
            f"stall counts steady sliding beyond {drawn.torque_limit:.3g} N m ({drawn.limited_by}); "
            f"a belt at rest can bear {rest:.3g} N m before it starts"
        )
    for p in points:
        within = _within(drawn, p)
        if within:
            said.append(f"{p.name}: within the 95 % interval of {within}, so the verdict is not certain")
        if p.at.extrapolated:
            said.append(f"{p.name}: extrapolated, no dwell lies that far out")
    if drawn.speed_limit is not None:
        fast = [p for p in points if p.speed > drawn.speed_limit]
        said += [f"{p.name}: faster than the drive, {1e3 * drawn.speed_limit:.3g} mm/s" for p in fast]
    return said


def _summary(drawn: OperatingMap) -> str:
    columns = range(drawn.lower.size)
    if drawn.temperature is not None and drawn.measured_temperature is not None:
        asked = np.linspace(*drawn.measured_temperature, _ROWS)
        columns = np.unique(np.searchsorted(drawn.temperature, asked).clip(0, drawn.lower.size - 1)).tolist()
    head = ("temperature", "stick-slip below", "transition [95 %]", "smooth above V* [95 %]", "stall from")
    lines = ["".join(f"{text:<26s}" for text in head) + "(speeds in mm/s)"]
    for i in columns:
        edges = (drawn.transition, drawn.transition_interval), (drawn.upper, drawn.upper_interval)
        shown = [f"{_mm(e[i])} [{_mm(low[i])}, {_mm(high[i])}]" for e, (low, high) in edges]
        where = "as in the log" if drawn.temperature is None else _celsius(drawn.temperature[i])
        stall = "never" if np.isinf(drawn.stall_above[i]) else _mm(drawn.stall_above[i])
        cells = (where, _mm(drawn.lower[i]), *shown, stall if drawn.torque_limit else "not known")
        lines.append("".join(f"{text:<26s}" for text in cells).rstrip())
    for point in drawn.points:
        where = f"{_mm(point.speed)} mm/s" + (
            "" if drawn.temperature is None else f", {_celsius(point.temperature)}"
        )
        lines.append(f"{point.name} ({where}, {point.at.torque:.3g} N m): {point.at.verdict()}")
    return "\n".join(lines)


def _mm(speed: float) -> str:
    return f"{1e3 * speed:.3g}" if speed < 0.1 else f"{1e3 * speed:.0f}"


def _celsius(kelvin: float) -> str:
    return f"{convert(kelvin, 'K', 'degC'):.0f} degC"


def _within(drawn: OperatingMap, point: PlacedPoint) -> str:
    """The edge whose interval holds the point, if any."""
    named = {"the transition speed": drawn.transition_interval, "V*": drawn.upper_interval}
    for name, interval in named.items():
        low, high = (
            edge[0] if drawn.temperature is None else np.interp(point.temperature, drawn.temperature, edge)
            for edge in interval
        )
        if low <= point.speed <= high:
            return f"{name} ({1e3 * low:.3g} to {1e3 * high:.3g} mm/s)"
    return ""
