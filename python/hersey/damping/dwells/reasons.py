"""Why a stretch of a log is not used: a kind with its numbers, and the words made of them."""

from __future__ import annotations

from dataclasses import dataclass
from statistics import median
from typing import Literal

from hersey.damping.dwells.groups import MIN_SAMPLES
from hersey.errors import SIGN, InsufficientDataError, capital, turned
from hersey.schema.domain import TORQUE, Domain

Kind = Literal[
    "changing", "standing", "too slow", "other rotation", "too short", "zero torque", "speed not held",
    "stick-slip", "swing", "speed drift", "temperature drift", "torque drift", "opposite signs", "spikes",
    "ripple", "rising", "held", "stepped", "braking", "driven", "reversed", "ends", "short", "no window",
    "no film",
]  # fmt: skip
#: Stretches that nobody meant as a dwell.
NO_DWELL: tuple[Kind, ...] = ("changing", "standing", "too slow", "other rotation")
#: A ripple comes a whole number of times in a turn within this share of one; frequencies closer than this
#: share are the same.
WHOLE_TURN = 0.03
#: More often than this in a turn, any number is near a whole one.
MOST_WHOLE = 12
#: A longer dwell averages a ripple out: so many of its periods.
MANY_PERIODS = 10.0
#: Causes of what is wrong with a dwell, and what to do about them.
CAUSES: tuple[Kind, ...] = ("spikes", "ripple")
_SPIKES = "check the cable of the sensor, and remove these rows"
_OWN = "look for an oscillation of the drive, a controller or the mains"
#: What each kind is called, where the words do not depend on a number.
_LABELS: dict[Kind, str] = {
    "changing": "speed changing",
    "standing": "drive at standstill",
    "too slow": "drive near standstill, or in no window",
    "other rotation": "other direction of rotation",
    "too short": "dwell too short",
    "zero torque": "{quantity} is zero",
    "speed not held": "speed not constant",
    "stick-slip": "stick-slip",
    "swing": "{quantity} fluctuates",
    "speed drift": "speed drifts",
    "temperature drift": "temperature drifts",
    "torque drift": "{quantity} drifts",
    "opposite signs": "{quantity} and {speed} have opposite signs",
    "spikes": "{quantity} spikes",
    "ripple": "{quantity} ripple",
    "rising": "rising speed",
    "held": "constant speed",
    "stepped": "steps between held speeds",
    "braking": "braked",
    "driven": "driven",
    "reversed": "driven through standstill",
    "ends": "beginning or end of a fall of speed",
    "short": "fall of speed with too few rows",
    "no window": "in no window of speed",
    "no film": "torque is not above the no-load torque by more than twice the error",
}


def label_of(kind: Kind, of: Domain = TORQUE) -> str:
    """Return what a kind is called, where that depends on no number."""
    return _LABELS[kind].format(quantity=of.quantity, speed=of.speed)


@dataclass(frozen=True)
class Reason:
    """Why a stretch is not used; only what belongs to the ``kind`` is set."""

    kind: Kind
    #: as a share of the mean: standard deviation of a swing, drift over the dwell with its sign, median size
    #: of the spikes, amplitude of the ripple
    share: float | None = None
    kelvin: float | None = None  #: drift of the temperature over the dwell, K
    slow: float = 0.0  #: least speed, SI
    fast: float = 0.0  #: greatest speed, SI
    lasts: float = 0.0  #: how long is settled, s
    rows: int = 0  #: how many rows are settled
    needed: float = 0.0  #: duration that is needed, s
    count: int = 0  #: spikes
    frequency: float = 0.0  #: of a ripple, Hz
    per_turn: float = 0.0  #: of a ripple, times per revolution of the roll
    seen_as: Kind | None = None  #: what is wrong with the dwell because of spikes or a ripple
    asked: str = ""  #: rotation that was asked for, ``forward`` or ``reverse``
    domain: Domain = TORQUE  #: what was measured

    @property
    def drifts(self) -> bool:
        """Whether a later start of the same dwell may be steady."""
        return self.kind in ("temperature drift", "torque drift")

    @property
    def label(self) -> str:
        """Return what is wrong, without numbers."""
        if self.kind == "other rotation":
            return f"rotation is not {self.asked}"
        return label_of(self.kind, self.domain) + (self._few() if self.kind == "changing" else "")

    def _few(self) -> str:
        return f", or held for fewer than {MIN_SAMPLES} rows" if 0 < self.rows < MIN_SAMPLES else ""

    def __str__(self) -> str:
        """Return what is wrong in words, with its numbers and what to do."""
        share = 0.0 if self.share is None else self.share
        match self.kind:
            case "too short":
                how = f": {self.lasts:.1f} s and {self.rows} rows are settled, but "
                how += f"{self.needed:g} s and {MIN_SAMPLES} rows are needed"
            case "zero torque":
                how = ". Check that the sensor is connected"
            case "speed not held":
                how = f": {self.domain.between(self.slow, self.fast)}, standard deviation {100 * share:.0f} %"
            case "stick-slip":
                how = f": {self.domain.quantity} rises slowly and drops fast, "
                how += f"standard deviation {100 * share:.0f} %"
            case "swing":
                how = f": standard deviation {100 * share:.0f} %, so sliding is not steady"
            case "speed drift" | "torque drift":
                how = f" by {100 * share:+.1f} % over the dwell"
            case "temperature drift":
                how = f" by {self.kelvin or 0.0:+.1f} K over the dwell"
            case "opposite signs":
                how = f". Flip one with {turned('torque')}"
            case "spikes":
                how = f": {self.count} samples differ from their neighbours by {_times(share)} the mean; "
                how += f"without them the dwell is steady. {capital(_SPIKES)}"
            case "ripple":
                how = f" at {self.frequency:.3g} Hz, amplitude {_times(share)} the mean, {self.turns()}; "
                how += f"without it the dwell is steady. {capital(self.remedy())}"
            case _:
                how = ""
        return self.label + how

    def turns(self) -> str:
        """Return how a ripple goes with the revolution of the roll, in words; nothing if that is unknown."""
        if self.domain.speed != "speed":
            return "of unknown cause"
        times = round(self.per_turn)
        if 1 <= times <= MOST_WHOLE and abs(self.per_turn - times) <= WHOLE_TURN:
            return "once per revolution" if times == 1 else f"{times} times per revolution"
        if self.per_turn < 1.0:
            return f"once in {1.0 / self.per_turn:.3g} revolutions"
        return f"{self.per_turn:.3g} times per revolution"

    def remedy(self) -> str:
        """Return what to do about a ripple."""
        enough = MANY_PERIODS / self.frequency
        if self.seen_as != "swing" and self.lasts < enough:
            return f"hold each speed for at least {enough:.0f} s to average it out"
        return "find the part that turns at this frequency, and true it"


def opposite_signs(where: str) -> InsufficientDataError:
    """Return the error of torque and speed that have opposite signs."""
    said = f"{where}: {label_of('opposite signs')}"
    return InsufficientDataError(said, remedy=f"flip one with {turned('torque')}", setting=SIGN)


def joined(reasons: list[Reason]) -> str:
    """Return each kind once, with its least and greatest share and how often it occurs."""
    kinds: dict[str, list[Reason]] = {}
    for reason in reasons:
        kinds.setdefault(reason.label, []).append(reason)
    said = []
    for label, alike in kinds.items():
        dwells = f" in {len(alike)} dwell{'' if len(alike) == 1 else 's'}" if len(kinds) > 1 else ""
        caused = alike[0].kind in CAUSES
        said.append(f"{label}{dwells}{cause(alike)}" if caused else f"{label}{_shares(alike)}{dwells}")
    return "; ".join(said)


def _shares(alike: list[Reason]) -> str:
    """The least and greatest share of reasons of one kind, or nothing."""
    digits = 1 if alike[0].kind in ("torque drift", "speed drift") else 0
    shares = [round(100.0 * abs(r.share), digits) for r in alike if r.share is not None]
    if not shares:
        return ""
    low, high = f"{min(shares):.3g}", f"{max(shares):.3g}"
    by = {"stick-slip": f" with {alike[0].domain.quantity} varying by", "speed not held": " (varies by"}.get(
        alike[0].kind, " by"
    )
    return f"{by} {low if low == high else f'{low} to {high}'} %" + (")" if "(" in by else "")


def cause(alike: list[Reason]) -> str:
    """Return numbers of spikes, or of ripples, over several dwells, and what to do."""
    return f"{sizes(alike)}: {remedies(alike)}"


def sizes(alike: list[Reason]) -> str:
    """Return numbers of spikes, or of ripples, over several dwells."""
    size = _times(float(median(r.share or 0.0 for r in alike)))
    if alike[0].kind == "spikes":
        return f" ({sum(r.count for r in alike)} samples, off by {size} the mean)"
    slow, fast = _frequencies(alike)
    low, high = f"{slow:.3g}", f"{fast:.3g}"
    at = f" at {low if low == high else f'{low} to {high}'} Hz, amplitude {size} the mean, "
    if _once_a_turn(alike) or alike[0].domain.speed != "speed":
        return f"{at}{_longest(alike).turns()}"
    if _same_frequency(alike):
        return f"{at}the same at every speed, so not from what turns"
    turns = [r.per_turn for r in alike]
    return f"{at}{min(turns):.3g} to {max(turns):.3g} times per revolution"


def remedies(alike: list[Reason]) -> str:
    """Return what to do about spikes, or ripples, over several dwells."""
    if alike[0].kind == "spikes":
        return _SPIKES
    return _OWN if _same_frequency(alike) and not _once_a_turn(alike) else _longest(alike).remedy()


def _frequencies(alike: list[Reason]) -> tuple[float, float]:
    return min(r.frequency for r in alike), max(r.frequency for r in alike)


def _once_a_turn(alike: list[Reason]) -> bool:
    """Whether ripples come equally often in a turn of the roll at all speeds."""
    turns = [r.per_turn for r in alike]
    return max(turns) - min(turns) <= 2.0 * WHOLE_TURN * max(turns)


def _same_frequency(alike: list[Reason]) -> bool:
    slow, fast = _frequencies(alike)
    return len(alike) > 1 and fast - slow <= WHOLE_TURN * fast


def _longest(alike: list[Reason]) -> Reason:
    return max(alike, key=lambda r: r.frequency * r.lasts)


def _times(share: float) -> str:
    """A share of the mean."""
    return f"{100 * share:.0f} % of" if share < 2.0 else f"{share:.3g} times"
