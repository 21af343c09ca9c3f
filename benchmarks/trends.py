"""Friction over time at one speed: intervals, claims and jumps of `hersey.trend` on logs of a known truth.

The generator stands in `benchmarks/trends.py` and shares no code with the fitter. A log is an hour at 1 Hz:
friction that does not change, falls or rises to a steady value (exponentially, or by a power of age), grows
steadily, or jumps; with noise of neighbouring rows that lasts 3 to 60 s (1 to 4 %), independent noise (0.5 to
3 %) and a resolution of 0.1 %. Temperature rises by up to 3 K with a time constant of its own and swings by
up to 0.3 K; friction changes by -1.5 to 0.5 % per K.

`python -m benchmarks.trends` writes `docs/validation/trends.md`, with the files of the pin-on-disc rig if the
collection of public measurements is there. ``--only KIND --first SEED`` runs one kind; nothing is written.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

import hersey
from benchmarks.working import takes_workers, worked

ROOT = Path(__file__).parents[1]
PAGE = ROOT / "docs" / "validation" / "trends.md"
#: Truths, and what each is called on the page.
KINDS = {
    "flat": "no trend",
    "run-in": "falls exponentially",
    "power": "falls by a power of time",
    "saturating": "rises exponentially",
    "step": "one jump",
    "linear": "grows steadily",
}
_DURATION, _SHARE = 3600.0, 0.05
#: Reading of the pin-on-disc files.
_FILES = "friction/te67_pin_on_disc/*.tsv"
_CHANNELS = {
    "time": "Time",
    "torque": "Friction Force#1",
    "speed": "Speed",
    "temperature": "Specimen Temp",
    "radius": "Radius",
    "load": "Load",
}
_UNITS = {"torque": "N", "speed": "rpm", "temperature": "degC", "radius": "mm", "load": "N"}


@dataclass(frozen=True)
class Truth:
    """What one log is made of, at the temperature of its last tenth."""

    steady: float | None
    steady_age: float | None
    tau: float | None
    jump: float | None  #: age


@dataclass(frozen=True)
class Judged:
    """What is said of one log, beside the truth."""

    kind: str
    said: str
    steady: str  #: held, low, high, none, or wrong where there is no steady value
    steady_age: str
    tau: str
    jumps: int
    found: bool  #: the jump that there is
    width: float
    seconds: float
    seed: int = field(default=0)


def log_of(kind: str, seed: int) -> tuple[dict[str, np.ndarray], Truth]:
    """Return the columns of a log and its truth."""
    random = np.random.default_rng([seed, list(KINDS).index(kind)])
    t = np.arange(0.0, _DURATION, 1.0)
    level = np.exp(random.uniform(np.log(0.05), np.log(2.0)))
    course, truth = _course(kind, t, level, random)
    warming = random.uniform(0.0, 3.0) * (1.0 - np.exp(-t / random.uniform(200.0, 3000.0)))
    swing = random.uniform(0.0, 0.3) * np.sin(
        2 * np.pi * (t / random.uniform(300.0, 2000.0) + random.random())
    )
    kelvin = warming + swing
    last = kelvin[t >= 0.9 * _DURATION].mean()
    friction = course + level * random.uniform(-0.015, 0.005) * (kelvin - last)
    lasts, own = random.uniform(3.0, 60.0), level * random.uniform(0.005, 0.03)
    friction = friction + level * random.uniform(0.01, 0.04) * _wandering(t.size, lasts, random)
    friction = friction + own * random.standard_normal(t.size)
    step = 1e-3 * level
    read = 25.0 + kelvin + 0.05 * random.standard_normal(t.size)
    return {"time": t, "friction": np.round(friction / step) * step, "temperature": read}, truth


def _course(kind: str, t: np.ndarray, level: float, random: np.random.Generator) -> tuple[np.ndarray, Truth]:
    """Friction without noise and temperature."""
    if kind == "flat":
        return np.full(t.size, level), Truth(level, 0.0, None, None)
    if kind in ("run-in", "saturating"):
        height = random.uniform(0.2, 1.0) if kind == "run-in" else -random.uniform(0.1, 0.5)
        tau = np.exp(random.uniform(np.log(60.0), np.log(900.0)))
        steady_age = max(tau * np.log(abs(height) / _SHARE), 0.0)
        return level * (1.0 + height * np.exp(-t / tau)), Truth(level, steady_age, tau, None)
    if kind == "power":
        height, tau, power = random.uniform(0.2, 1.0), random.uniform(20.0, 200.0), random.uniform(0.7, 1.5)
        steady_age = tau * ((height / _SHARE) ** (1.0 / power) - 1.0)
        tau63 = tau * (np.exp(1.0 / power) - 1.0)
        return level * (1.0 + height * (1.0 + t / tau) ** -power), Truth(level, steady_age, tau63, None)
    if kind == "step":
        at = random.uniform(0.2, 0.8) * _DURATION
        height = random.choice([-1.0, 1.0]) * random.uniform(0.1, 0.4)
        after = level * (1.0 + height)
        steady_age = at if abs(height) / (1.0 + height) > _SHARE else 0.0
        return np.where(t < at, level, after), Truth(after, steady_age, None, at)
    grown = random.uniform(0.1, 0.5)
    return level * (1.0 + grown * t / _DURATION), Truth(None, None, None, None)


def _wandering(count: int, lasts: float, random: np.random.Generator) -> np.ndarray:
    """Noise of unit variance whose neighbours correlate, from its stationary state on."""
    kept = np.exp(-1.0 / lasts)
    noise = random.standard_normal(count)
    for i in range(1, count):
        noise[i] = kept * noise[i - 1] + np.sqrt(1.0 - kept * kept) * noise[i]
    return noise


def judged(kind: str, seed: int) -> Judged:
    """Write one log, follow it, and hold what is said against the truth."""
    columns, truth = log_of(kind, seed)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "log.csv"
        table = np.column_stack(
            [
                columns["time"],
                np.full(columns["time"].size, 60.0),
                columns["friction"],
                columns["temperature"],
            ]
        )
        head = "time (s),speed (rpm),torque (N*m),temperature (degC)"
        np.savetxt(file, table, delimiter=",", header=head, comments="", fmt="%.7g")
        log = hersey.read(file)
    begun = time.process_time()
    found = hersey.trend(log)
    seconds = time.process_time() - begun
    return Judged(
        kind,
        found.kind,
        _held(found.steady, truth.steady),
        _held(found.steady_age, truth.steady_age),
        _held(found.time_constant, truth.tau),
        len(found.jumps),
        truth.jump is not None and any(abs(each.age - truth.jump) < 60.0 for each in found.jumps),
        (found.steady.high - found.steady.low) / truth.steady if found.steady and truth.steady else np.nan,
        seconds,
        seed,
    )


def _held(found: hersey.Estimate | None, truth: float | None) -> str:
    if found is None:
        return "none"
    if truth is None:
        return "wrong"
    return "held" if found.low <= truth <= found.high else "low" if truth < found.low else "high"


def table(every: list[Judged]) -> list[str]:
    """Return the lines of the table, one for each kind."""
    head = (
        "truth",
        "logs",
        "claim right",
        "steady: given",
        "held",
        "below",
        "above",
        "width",
        "age held",
        "time constant held",
        "jumps claimed",
        "s",
    )
    lines = [f"| {' | '.join(head)} |", "|" + " --- |" * len(head)]
    for kind in dict.fromkeys(each.kind for each in every):
        some = [each for each in every if each.kind == kind]
        lines.append(f"| {' | '.join(_cells(kind, some))} |")
    return lines


#: What may be said of each truth.
_RIGHT = {
    "flat": ("constant",),
    "run-in": ("falls and settles",),
    "power": ("falls and settles",),
    "saturating": ("rises and settles",),
    "step": ("constant",),
    "linear": ("rises",),
}


def _cells(kind: str, some: list[Judged]) -> list[str]:
    right = sum(each.said in _RIGHT[kind] for each in some)
    given = [each for each in some if each.steady != "none"]
    low, high = (sum(each.steady == side for each in given) for side in ("low", "high"))
    width = np.nanmedian([each.width for each in given]) if given and kind != "linear" else np.nan
    jumps = (
        sum(each.found and each.jumps == 1 for each in some)
        if kind == "step"
        else sum(each.jumps > 0 for each in some)
    )
    return [
        KINDS[kind],
        str(len(some)),
        f"{right}",
        f"{len(given)}",
        "" if kind == "linear" else f"{sum(each.steady == 'held' for each in given)}",
        f"{low}",
        f"{high}",
        "" if np.isnan(width) else f"{100 * width:.1f} %",
        _share([each.steady_age for each in some]),
        _share([each.tau for each in some]) if kind in ("run-in", "power", "saturating") else "",
        f"{jumps}",
        f"{np.median([each.seconds for each in some]):.2f}",
    ]


def _share(held: list[str]) -> str:
    known = [each for each in held if each != "none"]
    return f"{sum(each == 'held' for each in known)} of {len(known)}" if known else ""


def files(folder: Path) -> list[str]:
    """Return the lines of what is said of the pin-on-disc files, or that they are not there."""
    paths = sorted(folder.glob(_FILES))
    if not paths:
        return ["The collection of public measurements was not there."]
    lines = []
    for path in paths:
        found = hersey.trend(hersey.read(path, channels=_CHANNELS, units=_UNITS))
        law = found.law or ", ".join(
            f"{each.name} {each.weight:.2f}" for each in found.laws if each.weight >= 0.1
        )
        kept = [each.sentence for each in found.warnings if each.severity != "note"]
        lines.append(f"| {path.stem} | {found.headline()}. | {law} | {' '.join(kept)} |")
    return ["| file | headline | law, or weights | warnings |", "| --- | --- | --- | --- |", *lines]


def page(every: list[Judged], folder: Path, first: int) -> str:
    """Return the page."""
    said = " ".join(line.strip() for line in (__doc__ or "").splitlines()[2:7])
    shown = [each for each in every if each.steady in ("held", "low", "high")]
    held = sum(each.steady == "held" for each in shown)
    ages = [
        each.steady_age
        for each in every
        if each.kind != "flat" and each.steady_age in ("held", "low", "high")
    ]
    alarms = sum(each.said != "constant" for each in every if each.kind == "flat")
    flat = sum(each.kind == "flat" for each in every)
    return "\n".join(
        [
            "# Friction over time",
            "",
            "`python -m benchmarks.trends` writes this page.",
            "",
            "## Logs of a known truth",
            "",
            said,
            "",
            f"Seeds {first} to {first + flat - 1}. Thresholds were chosen on seeds 1 to 30; these ran twice, "
            "the second time after jumps were placed at rows, not blocks.",
            "",
            *table(every),
            "",
            f"- 95 % intervals of the steady value hold the truth in {held} of {len(shown)} logs where one "
            f"is given ({100 * held / len(shown):.1f} %; asked: 92 to 98 %).",
            f"- A trend is claimed in {alarms} of {flat} logs without one (asked: at most 5 %).",
            "- The age from which friction is steady lies in its interval in "
            f"{ages.count('held')} of {len(ages)} logs ({100 * ages.count('held') / len(ages):.1f} %).",
            '- "below" and "above" count true steady values outside the interval. "jumps claimed": of one '
            "jump, logs in which it alone is found; of the others, logs in which any is claimed. s: "
            "processor time.",
            "",
            "## Wear tests by others",
            "",
            "Polyphenylene sulphide, plain and with 15 to 45 % of PTFE, on a disc at constant speed (TE67, "
            "kyembot/pin-on-disk-data-analysis). Nobody knows the truth here.",
            "",
            *files(folder),
            "",
        ]
    )


def main() -> None:
    """Judge the logs, print what is found and write the page."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--logs", type=int, default=100, help="of each kind")
    parser.add_argument("--first", type=int, default=1001, help="first seed")
    parser.add_argument("--only", choices=list(KINDS))
    parser.add_argument("--folder", type=Path, default=ROOT.parent / "shared" / "data")
    takes_workers(parser)
    given = parser.parse_args()
    every: list[Judged] = []
    seeds = list(range(given.first, given.first + given.logs))
    for kind in [given.only] if given.only else KINDS:
        some = list(worked(partial(judged, kind), seeds, given))
        every += some
        print(*table(some)[2:], *(some if given.only else ()), sep="\n", flush=True)
    if not given.only:
        PAGE.write_text(page(every, given.folder, given.first))


if __name__ == "__main__":  # workers know the functions by the name of the module
    from benchmarks.trends import main as run

    run()
