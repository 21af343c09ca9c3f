"""The operating map, what can be asked of it, and its words."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import ArrayLike, NDArray

from hersey.arrays import FloatArray, numbers_of
from hersey.errors import ParameterError
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import DragTable, PowerDrag
from hersey.result import OPEN, Means, Result
from hersey.schema.warning import Warning
from hersey.stability.operating_map.edges import check_temperatures, contour, edges_at, shown_laws
from hersey.stability.operating_map.state import MapState, PlacedPoint
from hersey.units import convert, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Temperatures of the summary.
_ROWS = 5


@dataclass(frozen=True, repr=False)
class OperatingMap(Result):
    """Speeds (m/s) that separate sliding and stick-slip at each temperature (K), shape (n,).

    ``temperature`` is None for an isothermal fit, whose map has one column. ``upper`` is infinite beyond
    10,000 transition speeds; its interval includes the fit and the parameters in ``uncertain``, as does that
    of ``holding``. Drag exceeds ``torque_limit`` (set by ``limited_by``) from ``stall_above`` up (infinite if
    never) and, on the falling branch, up to ``stall_below`` (0 if never). The measured ranges bound the
    dwells. If ``holding``, including the no-load torque, exceeds ``torque_limit``, the drive cannot start the
    belt. The bands include the grip of the roll (``train``); ``lower`` is zero where there is no stick-slip
    because a belt that sticks is never released. ``stick_speed_rule`` says how the stick speed depends on
    temperature. If edges are ``given``, transition and V* come from a posterior of drives and are
    interpolated between temperatures; ``drag`` is that of its typical draw.
    """

    also_stated = ("given",)

    temperature: FloatArray | None
    speed: Annotated[FloatArray, Means(unit="m/s", shape="(m,)")]
    lower: Annotated[FloatArray, OPEN]
    transition: Annotated[FloatArray, OPEN]
    upper: Annotated[FloatArray, OPEN]
    transition_interval: Annotated[FloatArray, Means("95 %", shape="(2, n)", open=True)]
    upper_interval: Annotated[FloatArray, Means("95 %", shape="(2, n)", open=True)]
    stall_below: Annotated[FloatArray, OPEN]
    stall_above: Annotated[FloatArray, OPEN]
    torque: Annotated[FloatArray, Means("of steady sliding", "N m", shape="(n, m)")]
    holding: Annotated[FloatArray, Means("torque to start from rest", "N m")]
    holding_interval: Annotated[FloatArray, Means("95 %", "N m", shape="(2, n)", open=True)]
    torque_limit: Annotated[float | None, Means(unit="N m")]
    limited_by: str
    speed_limit: Annotated[float | None, Means(unit="m/s")]
    measured_temperature: Annotated[tuple[float, float] | None, Means(unit="K")]
    measured_speed: Annotated[tuple[float, float], Means(unit="m/s")]
    points: tuple[PlacedPoint, ...]
    uncertain: tuple[str, ...]
    warnings: tuple[Warning, ...]
    roll_radius: Annotated[float, Means(unit="m")]
    train: Drivetrain
    drag: PowerDrag
    stick_speed_rule: str

    @property
    def given(self) -> bool:
        """Whether the edges come from a posterior of drives."""
        return isinstance(self.drag, DragTable)

    @property
    def stick_speed(self) -> FloatArray:
        """Stick speed (m/s) at each temperature."""
        return np.array([law.stick_speed for law in self._laws(self.temperature)])

    @property
    def starts(self) -> NDArray[np.bool_]:
        """Whether the drive starts a belt at rest, at each temperature."""
        return self.holding <= self._limit

    @property
    def _limit(self) -> float:
        """The torque (N m) that the drive cannot exceed."""
        return np.inf if self.torque_limit is None else self.torque_limit

    def _may_start(self, low: ArrayLike, holding: ArrayLike, high: ArrayLike) -> NDArray[np.bool_] | np.bool_:
        """Whether the limit lies within the interval of what a belt at rest withstands."""
        return (np.minimum(low, holding) <= self._limit) & (self._limit < np.maximum(high, holding))

    @property
    def doubtful(self) -> NDArray[np.bool_]:
        """Whether it starts some draws of the belt and not others, at each temperature."""
        low, high = self.holding_interval
        return np.asarray(self._may_start(low, self.holding, high))

    def at(self, values: FloatArray, kelvin: float | None) -> float:
        """Return one of the rows of the map at a temperature (K; None if isothermal), interpolated."""
        if self.temperature is None or kelvin is None:
            return float(values[0])
        right = int(np.searchsorted(self.temperature, kelvin).clip(1, self.temperature.size - 1))
        ends = values[right - 1 : right + 1]
        if not np.all(np.isfinite(ends)):
            return float(ends[0] if kelvin <= self.temperature[right - 1] else ends[1])
        return float(np.interp(kelvin, self.temperature, values))

    @takes_si(temperature="temperature", speed="belt speed")
    def state_at(self, *, temperature: float | None, speed: float) -> MapState:
        """Return the state at a temperature (K; None for an isothermal fit) and a drive speed (m/s).

        The bands are computed there, not interpolated.

        Raises
        ------
        ParameterError
            If the law does not apply at the speed or temperature.
        """
        return self.look_up(temperature=temperature, speed=speed)[0]

    @takes_si(temperature="temperature", speed="belt speed")
    def states(self, *, temperature: ArrayLike | None, speed: ArrayLike) -> NDArray[np.str_]:
        """Return the name of the state for arrays of temperature (K) and speed (m/s), broadcast together."""
        shape = np.broadcast_shapes(
            np.shape(temperature if temperature is not None else 0.0), np.shape(speed)
        )
        names = [state.state for state in self.look_up(temperature=temperature, speed=speed)]
        return np.array(names).reshape(shape)

    @takes_si(torque="torque")
    def contour(self, torque: float) -> tuple[FloatArray, FloatArray]:
        """Return the speeds (m/s) of a torque (N m) at each temperature: falling branch, rising branch.

        0 on the falling branch if torque stays below it down to the stick speed; both equal the transition
        speed if torque is always larger.
        """
        return contour(self._laws(self.temperature), torque / self.roll_radius)

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
    def look_up(self, *, temperature: ArrayLike | None, speed: ArrayLike) -> list[MapState]:
        """Return the states of arrays, broadcast together and flattened, as `state_at` does for one."""
        if (temperature is None) == self.drag.varies_with_temperature:
            reason = "the map depends on temperature. Give one, in K"
            other = "the fit is isothermal. Do not give a temperature"
            raise ParameterError(reason if self.drag.varies_with_temperature else other)
        speeds = numbers_of("speed", speed)
        kelvin = numbers_of("temperature", 0.0 if temperature is None else temperature)
        try:
            speeds, kelvin = (a.ravel() for a in np.broadcast_arrays(speeds, kelvin))
        except ValueError:
            raise ParameterError("the shapes of speed and temperature do not match") from None
        if not np.all((speeds > 0) & np.isfinite(speeds)):
            raise ParameterError(f"speed is {float(speeds.min()):g}: it must be greater than 0")
        levels, place = np.unique(kelvin, return_inverse=True)
        if temperature is not None:
            check_temperatures(levels, self.drag)
        at = None if temperature is None else levels
        if isinstance(self.drag, DragTable):
            edges = self._given_at(at)
        else:
            edges = edges_at(self.train, self.drag, at, self.stick_speed_rule)
        laws = self._laws(at)
        rows = zip(speeds.tolist(), kelvin.tolist(), place.ravel().tolist(), strict=True)
        return [self._state(laws[i], {k: float(v[i]) for k, v in edges.items()}, t, v) for v, t, i in rows]

    def _given_at(self, kelvin: FloatArray | None) -> dict[str, FloatArray]:
        """Edges at temperatures (K), between those of the map."""
        levels = [None] if kelvin is None else kelvin.tolist()
        names = ("lower", "transition", "upper")
        return {name: np.array([self.at(getattr(self, name), t) for t in levels]) for name in names}

    @property
    def beyond(self) -> str:
        """State beyond ``torque_limit``: the roll slips, or the motor stops."""
        return "motor" if self.limited_by == "motor torque" else "stall"

    def _laws(self, kelvin: FloatArray | None) -> Sequence[PowerDrag]:
        return shown_laws(self.drag, kelvin, self.stick_speed_rule)

    def _state(self, law: PowerDrag, edges: Mapping[str, float], kelvin: float, speed: float) -> MapState:
        torque, holding = (force * self.roll_radius for force in (float(law.force(speed)), law.holding_force))
        if self.given:
            holding = self.at(self.holding, kelvin)
        starts = bool(holding <= self._limit)
        bears = [self.at(edge, kelvin) for edge in self.holding_interval]
        doubtful = bool(self._may_start(bears[0], holding, bears[1]))
        held = edges["lower"] == 0 and speed < edges["transition"]
        if torque > self._limit or (held and not starts):
            moving = self.beyond
        elif speed < law.stick_speed and not self.given:
            moving = "creep"
        elif speed < edges["lower"]:
            moving = "stick_slip"
        elif speed < edges["transition"]:
            moving = "swing"
        else:
            moving = "bistable" if speed < edges["upper"] else "smooth"
        state = moving if starts else self.beyond
        low, high = self.measured_speed
        cold, hot = self.measured_temperature or (-np.inf, np.inf)
        outside = not (low <= speed <= high and cold <= kelvin <= hot)
        return MapState(
            state,
            moving,
            torque,
            holding,
            starts,
            doubtful,
            **edges,
            stick_speed=law.stick_speed,
            extrapolated=outside,
            slipping=self.train.grip is not None,
        )


def _summary(map_: OperatingMap) -> str:
    columns = range(map_.lower.size)
    if map_.temperature is not None and map_.measured_temperature is not None:
        asked = np.linspace(*map_.measured_temperature, _ROWS)
        columns = np.unique(np.searchsorted(map_.temperature, asked).clip(0, map_.lower.size - 1)).tolist()
    head = ("temperature", "stick-slip below", "transition [95 %]", "smooth above V* [95 %]", "stall from")
    lines = ["".join(f"{text:<26s}" for text in head) + "(speeds in mm/s)"]
    starts, doubtful = map_.starts, map_.doubtful
    for i in columns:
        edges = (map_.transition, map_.transition_interval), (map_.upper, map_.upper_interval)
        speeds = [f"{_mm(e[i])} [{_mm(low[i])}, {_mm(high[i])}]" for e, (low, high) in edges]
        where = "as in the log" if map_.temperature is None else _celsius(map_.temperature[i])
        stall = "never" if np.isinf(map_.stall_above[i]) else _mm(map_.stall_above[i])
        sure = stall if starts[i] else "not started"
        stall = f"{stall}, may not start" if doubtful[i] else sure
        cells = (where, _mm(map_.lower[i]), *speeds, stall if map_.torque_limit else "unknown")
        lines.append("".join(f"{text:<26s}" for text in cells).rstrip())
    for point in map_.points:
        where = f"{_mm(point.speed)} mm/s" + (
            "" if map_.temperature is None else f", {_celsius(point.temperature)}"
        )
        lines.append(f"{point.name} ({where}, {point.at.torque:.3g} N m): {point.verdict()}")
    return "\n".join(lines)


def _mm(speed: float) -> str:
    return f"{1e3 * speed:.3g}" if speed < 0.1 else f"{1e3 * speed:.0f}"


def _celsius(kelvin: float) -> str:
    return f"{convert(kelvin, 'K', 'degC'):.0f} degC"
