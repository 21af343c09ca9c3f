"""The drive behind a stick-slip record: parameters that make the exact model run through the mean cycle."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.estimate import Estimate, quantile
from hersey.errors import InsufficientDataError, ParameterError, Setting
from hersey.identification.cycle_record import CycleRecord
from hersey.identification.cycle_warnings import FALLS_OF_FEW_SAMPLES
from hersey.identification.detection import FEWEST_SLIPS
from hersey.identification.drive_fit import EXPONENTS, NORMAL_REACH, DriveFit
from hersey.identification.drive_warnings import doubted, forced, warnings_of
from hersey.identification.independence import ESTIMABLE
from hersey.identification.motion_kind import NO_FREE_PERIOD
from hersey.identification.waveform import FEWEST_LAPS, Waveform, mean_waveform
from hersey.motion.belt import Drivetrain
from hersey.motion.drag import Drag
from hersey.motion.parameters import KINDS, OF_THE_BELT
from hersey.result import OPEN, Means, Record, Result
from hersey.schema.warning import Warning
from hersey.units import argument, takes_si

if TYPE_CHECKING:
    import polars as pl

#: Closures that a record can be compared with, and those that are by default: `stribeck` takes minutes.
CLOSURES = ("retained", "stiction", "stribeck")
COMPARED = ("retained", "stiction")
#: Closures whose chi-square differs by less (over the misfit of the best) cannot be distinguished.
UNDECIDED = 10.0
#: What needs no single parameter: the free period 2 pi sqrt(m/k), s, the force at which a held belt is
#: released, and the drag at the drive speed.
DERIVED = ("free_period", "release_force", "drag_at_drive_speed")
#: Force averaged over a cycle, as a share of the drop, below which its zero is lost. A drive breaks away at
#: 50 times the friction of sliding if it is more than zero by so little.
_LEAST_MEAN = 0.01
#: The drive speed is estimated only if what is known halves the interval that was stated.
_HALVED = 0.5


@dataclass(frozen=True)
class ClosureFit(Record):
    """The best drive with one closure: chi-square of its mean cycle, and misfit as a share of the drop."""

    closure: str
    chi_square: Annotated[float, OPEN]
    misfit: Annotated[float, OPEN]


@dataclass(frozen=True, repr=False)
class IdentifiedDrive(Result):
    """A drive identified from a record.

    ``estimates`` holds every parameter that the record determines, with its 95 % interval; ``values`` all of
    the best fit, estimable or not (those in ``known`` as given). ``derived`` are quantities that can be
    determined without a single parameter; they include the drive speed if the known parameters determine it
    better than stated. ``systematic`` is the half width, in the unit of each quantity, that the uncertainty
    of the stated drive speed adds to its interval. ``closure`` is the best one; ``decided`` says whether the
    others are worse by more than chance. Warnings of the kind "not estimable" name what the record cannot
    determine.
    """

    also_stated = ("closure_decided", "best_fit")
    not_stated = ("decided", "values", "waveform", "fitted")

    closure: str
    decided: bool
    estimates: Annotated[Mapping[str, Estimate], Means("what the record determines")]
    values: Mapping[str, float]
    known: Annotated[Mapping[str, float], Means("parameters that were given")]
    derived: Annotated[
        Mapping[str, Estimate],
        Means("free period, release force, drag at the drive speed; the drive speed if better than stated"),
    ]
    systematic: Annotated[
        Mapping[str, float], Means("half width added to an interval by the uncertainty of the drive speed")
    ]
    closures: tuple[ClosureFit, ...]
    misfit: float
    drive_speed: Annotated[float, Means(unit="m/s")]
    drive_speed_uncertainty: Annotated[float, Means("relative, half of the 95 % interval", open=True)]
    waveform: Waveform
    fitted: FloatArray
    warnings: tuple[Warning, ...]

    @property
    def closure_decided(self) -> bool:
        """Whether the other closures are worse by more than chance."""
        return self.decided

    @property
    def best_fit(self) -> Annotated[Mapping[str, float], OPEN]:
        """Every parameter of the best fit, estimable or not."""
        return self.values

    @property
    def train(self) -> Drivetrain:
        """Drivetrain of the best fit."""
        return Drivetrain(self.values["stiffness"], self.values["mass"])

    @property
    def drag(self) -> Drag:
        """Drag of the best fit."""
        return Drag(*(self.values[name] for name in OF_THE_BELT[2:]), closure=self.closure)

    def to_frame(self) -> pl.DataFrame:
        """Return the estimates with their 95 % intervals; the units apply to a trace in newtons."""
        import polars as pl

        rows = [
            (name, e.value, e.error, e.low, e.high, _UNITS["N"].get(name, "").strip())
            for name, e in {**self.estimates, **self.derived}.items()
        ]
        columns = ("value", "error", "low", "high")
        schema = {"name": pl.String, **dict.fromkeys(columns, pl.Float64), "unit": pl.String}
        return pl.DataFrame(rows, schema=schema, orient="row")

    def headline(self) -> str:
        """Return the closure and the parameters that can be estimated."""
        return f"closure {self.closure}, estimated: {', '.join(self.estimates) or 'nothing'}"

    def summary(self, unit: str = "") -> str:
        """Return the result as text; with units if the trace is in N or N m."""
        units = _UNITS.get(unit, {})
        decided = "" if self.decided else " (not decided)"
        ranked = ", ".join(f"{fit.closure} {fit.chi_square:.4g}" for fit in self.closures)
        lines = [f"closure: {self.closure}{decided}; chi-square: {ranked}"]
        for name in OF_THE_BELT:
            if name in self.known:
                lines.append(f"{name:18s} {self.known[name]:.5g}{units.get(name, '')} (given)")
            else:
                known = self.estimates.get(name)
                entry = "not estimable from this record" if known is None else f"{known}{units.get(name, '')}"
                lines.append(f"{name:18s} {entry}")
        lines += [f"{name:18s} {estimate}{units.get(name, '')}" for name, estimate in self.derived.items()]
        lines.append(
            f"intervals assume a drive speed of {self.drive_speed:.5g}{units.get('drive_speed', '')} "
            f"within {100 * self.drive_speed_uncertainty:.2g} %"
        )
        lines.append(f"the model matches the mean cycle within {self.misfit:.2%} of the drop")
        return "\n".join([*lines, *(f"- {each}" for each in self.warnings)])


#: Units of what is identified from a force, and from a torque.
_UNITS = {
    force: {
        "stiffness": f" {stiffness}",
        "mass": f" {mass}",
        "transition_force": f" {force}",
        "transition_speed": f" {speed}",
        "stick_speed": f" {speed}",
        "free_period": " s",
        "release_force": f" {force}",
        "drag_at_drive_speed": f" {force}",
        "drive_speed": f" {speed}",
    }
    for force, stiffness, mass, speed in (("N", "N/m", "kg", "m/s"), ("N m", "N m/rad", "kg m^2", "rad/s"))
}


@takes_si()
def identify(
    record: CycleRecord,
    *,
    known: Mapping[str, float] | None = None,
    closures: tuple[str, ...] = COMPARED,
    unit: str = "",
) -> IdentifiedDrive:
    """Identify the drive from the cycles of a trace of force at known drive speed.

    Weighted least squares of the mean cycle and the period, with the exact motion of the model. Errors follow
    from the scatter of the cycles (sandwich estimator) and are widened where the model does not match the
    mean cycle.

    Parameters
    ----------
    known
        Parameters that are known, e.g. ``{"mass": 0.03}``; names as in `OF_THE_BELT`.
    closures
        Closures to compare.
    unit
        Unit of the trace, ``N``, ``N m`` or ``1``, in which warnings show numbers.

    If the known parameters do not fit the trace, the drive is also identified without them, for a warning.

    Raises
    ------
    InsufficientDataError
        If the belt does not stick and slip, or there are too few cycles.
    ParameterError
        If the drive speed or a name is missing or unknown.
    """
    given = {name: _in_si(name, value) for name, value in (known or {}).items()}
    _check(record, given, closures)
    assert record.drive_speed is not None
    wave = mean_waveform(record)
    fits = _fits(wave, record, given, closures)
    best = fits[0]
    freedom = max(wave.offset.size + 2 - len(best.names), 1)
    scale = max(1.0, best.chi_square / freedom)
    near = [fit for fit in fits if (fit.chi_square - best.chi_square) / scale <= UNDECIDED]
    covariances = [fit.covariance(scale) for fit in near]
    intervals, systematic = _intervals(near, covariances, scale, wave.number)
    warnings = warnings_of(record, near, covariances[0], intervals, unit)
    warnings = (*_forced(record, best, closures, warnings, unit), *warnings)
    if any(each.kind == NO_FREE_PERIOD for each in warnings):
        del intervals["free_period"]
    return IdentifiedDrive(
        closure=best.closure,
        decided=len(near) == 1,
        estimates={name: each for name, each in intervals.items() if name in OF_THE_BELT},
        values=best.parameters(best.values),
        known=given,
        derived={name: each for name, each in intervals.items() if name not in OF_THE_BELT},
        systematic={name: systematic[name] for name in intervals},
        closures=tuple(ClosureFit(f.closure, f.chi_square, f.misfit) for f in fits),
        misfit=best.misfit,
        drive_speed=record.drive_speed,
        drive_speed_uncertainty=record.drive_speed_uncertainty,
        waveform=wave,
        fitted=best.curve(best.values),
        warnings=warnings,
    )


def _forced(
    record: CycleRecord, best: DriveFit, closures: tuple[str, ...], warnings: tuple[Warning, ...], unit: str
) -> tuple[Warning, ...]:
    """What is to be known of known parameters that keep the fit from the trace: without them it is better."""
    if not (names := doubted(best, warnings)):
        return ()
    try:
        free = identify(record, closures=closures)
    except InsufficientDataError:
        return ()
    return forced(best, names, free.misfit, free.estimates, unit)


def _fits(
    wave: Waveform, record: CycleRecord, given: Mapping[str, float], closures: tuple[str, ...]
) -> list[DriveFit]:
    """A fit with each closure, the best first."""
    fits: list[DriveFit] = []
    for closure in closures:
        start = fits[-1].values if closure == "stribeck" and fits else None
        fits.append(DriveFit(wave, record, given, closure, start))
    fits.sort(key=lambda fit: fit.chi_square)
    if fits[0].lap is None:
        raise InsufficientDataError(
            "no drive of the model makes such a cycle",
            remedy=f"check {', '.join(given)} and the units"
            if given
            else "give known parameters, or check the units",
        )
    return fits


def _in_si(name: str, value: Any) -> Any:
    """A known parameter in SI, if it comes with a unit; a name that is not known is refused later."""
    kind = KINDS.get(name)
    return value if kind is None else argument(f"known {name}", kind, value)


def _check(record: CycleRecord, known: Mapping[str, float], closures: tuple[str, ...]) -> None:
    if record.quantity != "force":
        raise ParameterError(
            "a trace of speed has no force. To identify a drive, give a trace of the spring force"
        )
    if record.kind != "stick_slip":
        raise _no_stick_slip(record)
    if record.slips < FEWEST_LAPS <= record.falls:
        raise InsufficientDataError(
            f"{record.headline()}. To identify a drive, omit {Setting('least_drop').to()}"
        )
    _refuse_a_lost_zero(record)
    if record.drive_speed is None:
        needed = Setting("drive_speed").to("20 mm/s", python="0.02")
        raise ParameterError(f"the drive speed is needed to identify a drive. Give it, e.g. {needed}")
    for name, value in known.items():
        if name not in OF_THE_BELT:
            raise ParameterError(f"unknown parameter '{name}' in known. Use {', '.join(OF_THE_BELT)}")
        if not np.isfinite(value) or (name not in EXPONENTS and not value > 0):
            raise ParameterError(f"known {name} is {value}: it must be greater than 0")
    unknown = [closure for closure in closures if closure not in CLOSURES]
    if unknown or not closures:
        raise ParameterError(
            f"unknown closures: {', '.join(unknown) or 'none given'}. Use {', '.join(CLOSURES)}"
        )


def _refuse_a_lost_zero(record: CycleRecord) -> None:
    """Refuse a force whose mean over a cycle is not above zero, although its work is what friction takes."""
    first, last = (np.searchsorted(record.samples.time, record.slip_time[end]) for end in (0, -1))
    share = float(np.mean(record.samples.value[first:last]) / np.median(record.drop))
    if share < _LEAST_MEAN:
        raise InsufficientDataError(
            "the zero of the force is lost: over a cycle the force averages "
            f"{100 * share + 0.0:.1f} % of its drop, but sliding against friction needs a "
            "force above zero",
            remedy="identification needs the true zero: record with DC coupling, and zero the sensor "
            "without load",
        )


def _no_stick_slip(record: CycleRecord) -> InsufficientDataError:
    """What a trace shows instead of stick-slip, and what to do if it was recorded too slowly."""
    if record.kind != "steady_sliding":
        found = f"the trace shows {record.kind.replace('_', ' ')} motion"
    elif record.falls < FEWEST_SLIPS:
        found = "the trace shows steady sliding"
    else:
        found = f"the trace is irregular: {record.falls} drops exceed the noise, but no cycles were found"
    few = [each for each in record.warnings if each.kind == FALLS_OF_FEW_SAMPLES]
    needed = "a drive is identified from the cycles of stick-slip"
    return InsufficientDataError(found, remedy=str(few[0]) if few else needed)


def _intervals(
    near: list[DriveFit], covariances: list[FloatArray], scale: float, laps: int
) -> tuple[dict[str, Estimate], dict[str, float]]:
    """Every quantity that the record determines, over all closures and drives that fit alike.

    Also the half width that the stated drive speed adds to each; it is added, not in quadrature, for it is
    the same for every lap: whatever the speed is within what is stated, the interval holds.
    """
    names = (*near[0].names, *DERIVED)
    factor = quantile(laps - 1)
    lows, highs, shifts = [], [], []
    for fit, covariance in zip(near, covariances, strict=True):
        gradient = _gradient(fit)
        errors = np.sqrt(np.maximum(np.diag(gradient @ covariance @ gradient.T), 0.0))
        shifts.append(NORMAL_REACH * np.abs(gradient @ fit.by_drive_speed()))
        for values, share in ((fit.values, 0.0), *fit.alternatives(covariance, scale)):
            # What an alternative costs is gone from what is left for the other values to be off.
            half = factor * errors * np.sqrt(1.0 - share) + shifts[-1]
            quantities = _quantities(fit, values[:-1])
            lows.append(quantities - half)
            highs.append(quantities + half)
    low, high, shift = np.min(lows, axis=0), np.max(highs, axis=0), np.max(shifts, axis=0)
    middle = _quantities(near[0], near[0].values[:-1])
    bound = [near[0].at_bound(index) for index in range(len(near[0].names))] + [False] * len(DERIVED)
    rows = [
        (i, name)
        for i, name in enumerate(names)
        if high[i] - low[i] < 2.0 * factor * ESTIMABLE
        and not bound[i]
        and (name != "drive_speed" or _better(near, i))
    ]
    intervals = {name: _estimate(name, middle[i], low[i], high[i], factor) for i, name in rows}
    scales = {name: 1.0 if name in EXPONENTS else abs(each.value) for name, each in intervals.items()}
    return intervals, {name: float(shift[i]) * scales[name] for i, name in rows}


def _better(near: list[DriveFit], index: int) -> bool:
    """Whether what is known determines the drive speed better than it was stated."""
    left = max(abs(fit.by_drive_speed()[index]) / fit.stated_error for fit in near)
    return bool(left < _HALVED)


def _estimate(name: str, value: float, low: float, high: float, factor: float) -> Estimate:
    error = 0.5 * (high - low) / factor
    if name in EXPONENTS:
        return Estimate(float(value), float(error), float(low), float(high))
    number = float(np.exp(value))
    return Estimate(number, number * float(error), float(np.exp(low)), float(np.exp(high)))


def _quantities(fit: DriveFit, values: FloatArray) -> FloatArray:
    """Fitted parameters (logarithms, exponents themselves) and the logarithms of `DERIVED`."""
    parameters = fit.parameters(np.append(values, 0.0))
    drag = Drag(*(parameters[name] for name in OF_THE_BELT[2:]), closure=fit.closure)
    free = 2.0 * np.pi * np.sqrt(parameters["mass"] / parameters["stiffness"])
    held = float(drag.force(parameters["stick_speed"])) if fit.closure == "retained" else drag.breakaway_force
    driven = float(drag.force(parameters["drive_speed"]))
    return np.concatenate([values, np.log([free, held, driven])])


def _gradient(fit: DriveFit) -> FloatArray:
    values, step = fit.values[:-1], 1e-4
    columns = []
    for index in range(values.size):
        change = step * (np.arange(values.size) == index)
        columns.append((_quantities(fit, values + change) - _quantities(fit, values - change)) / (2.0 * step))
    return np.stack(columns, axis=1)
