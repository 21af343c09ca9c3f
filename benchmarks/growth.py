"""How often the interval of the age at a limit holds the truth, over virtual campaigns.

The generator stands in this file and shares no code with the fitter: it steps the growth of each unit in time
and looks up when the indicator crosses the limit. Every campaign has units that differ by 10 to 40 % (growth)
and 5 to 15 % (level), runs that scatter by 1 to 3 %, and one of five truths: linear, side flow, exponential,
saturating above the limit, or a film that side flow and evaporation thin while the no-load torque stays.

Usage: python -m benchmarks.growth [--campaigns 200] [--first 1001]
[--units 8] [--logs 10] [--laws linear,...] [--workers 2] [--scheduler ADDRESS]
"""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from functools import partial

import numpy as np

from benchmarks.working import takes_workers, worked

#: Truths, drawn equally often.
TRUTHS = ("linear", "side flow", "exponential", "saturating", "film")
#: Steps of the clock in which units age.
_CLOCK = np.linspace(0.0, 30.0, 15_001)
_STATED = 0.005


@dataclass(frozen=True)
class Outcome:
    """What one campaign tells: shares held, whether early, width over truth, weights and seconds."""

    truth: str
    held: tuple[bool, ...]
    below: tuple[bool, ...]  #: truth below the interval
    width: tuple[float, ...]  #: of the interval over the true age
    passed: int
    b10: bool
    b50: bool
    law: str | None
    seconds: float
    effective: float


def _paths(truth: str, pace: np.ndarray, level: np.ndarray, own: dict[str, float]) -> np.ndarray:
    """The indicator of each unit along the clock, (units, steps)."""
    step = _CLOCK[1] - _CLOCK[0]
    z = pace[:, None] * _CLOCK
    if truth == "linear":
        grown = 1.0 + z
    elif truth == "exponential":
        grown = np.exp(np.minimum(z, 60.0))
    elif truth == "side flow":
        grown = (1.0 + z) ** 0.5
    elif truth == "saturating":
        # All units saturate with one time constant; the size differs.
        grown = 1.0 + own["final"] * pace[:, None] * (1.0 - np.exp(-_CLOCK / own["tau"]))
    else:
        film = np.empty((pace.size, _CLOCK.size))
        h = np.ones(pace.size)
        for i in range(_CLOCK.size):
            film[:, i] = h
            h = np.maximum(h - pace * step * (own["flow"] * h**3 + own["evaporation"]), 1e-3)
        grown = own["rest"] + (1.0 - own["rest"]) / film
    return level[:, None] * grown


def _crossing(path: np.ndarray, limit: float) -> float:
    """Age at which a path first reaches the limit; infinite if it does not."""
    over = np.flatnonzero(path >= limit)
    if over.size == 0:
        return np.inf
    i = int(over[0])
    if i == 0:
        return 0.0
    share = (limit - path[i - 1]) / (path[i] - path[i - 1])
    return float(_CLOCK[i - 1] + share * (_CLOCK[1] - _CLOCK[0]))


def campaign(
    seed: int,
    units: int = 8,
    logs: int = 10,
    laws: tuple[str, ...] | None = None,
    only: str | None = None,
) -> Outcome:
    """Draw a campaign, fit it, and say what its intervals hold."""
    from hersey.life.growth.fit import fit_growth

    random = np.random.default_rng([seed, 14])
    truth = str(random.choice(TRUTHS))
    truth = only or truth
    spread, between, noise = random.uniform(0.1, 0.4), random.uniform(0.05, 0.15), random.uniform(0.01, 0.03)
    limit = random.uniform(1.6, 2.5)
    own = {
        "final": (limit - 1.0) * random.uniform(1.5, 3.0),
        "tau": random.uniform(0.7, 2.0),
        "rest": random.uniform(0.1, 0.4),
        "flow": random.uniform(0.3, 1.0),
        "evaporation": random.uniform(0.0, 0.3),
    }
    population = 400
    pace = np.exp(random.normal(0.0, spread, population + units))
    level = np.exp(random.normal(0.0, between, population + units))
    own_paths = _paths(truth, pace[:units], level[:units], own)
    ages = np.array([_crossing(path, limit) for path in own_paths])
    coarse = _population_ages(truth, pace, level, own, limit)
    # The campaign stops for all at 60 % of the median life of its units, whoever has passed the limit.
    stop = 0.6 * float(np.median(ages))
    rows = []
    for i in range(units):
        at = np.sort(random.uniform(0.0, 1.0, logs)) * stop
        value = np.interp(at, _CLOCK, own_paths[i])
        measured = value * np.exp(random.normal(0.0, np.hypot(noise, _STATED), logs))
        rows += [(f"unit {i + 1}", a, v) for a, v in zip(at, measured, strict=True)]
    names, at, value = zip(*rows, strict=True)
    scale = 10 ** random.uniform(0, 5)
    begin = time.perf_counter()
    growth = fit_growth(list(names), np.array(at) * scale, np.array(value), _STATED, laws=laws)
    told = growth.reaches(limit)
    seconds = time.perf_counter() - begin
    intervals = [(each.age.low / scale, each.age.high / scale) for each in told.units]
    held = tuple(bool(low <= age <= high) for age, (low, high) in zip(ages, intervals, strict=True))
    b10, b50 = np.quantile(coarse, [0.1, 0.5], method="inverted_cdf")
    return Outcome(
        truth,
        held,
        tuple(bool(age < low) for age, (low, _) in zip(ages, intervals, strict=True)),
        tuple(_width(age, *ends) for age, ends in zip(ages, intervals, strict=True)),
        int((ages < stop).sum()),
        bool(told.b10.age.low <= b10 * scale <= told.b10.age.high),
        bool(told.b50.age.low <= b50 * scale <= told.b50.age.high),
        growth.law,
        seconds,
        growth.effective,
    )


def _width(age: float, low: float, high: float) -> float:
    return (high - low) / age if np.isfinite(age) and np.isfinite(high) else np.inf


def _population_ages(
    truth: str, pace: np.ndarray, level: np.ndarray, own: dict[str, float], limit: float
) -> np.ndarray:
    """True ages of many units: the growth that each needs, looked up on the path of a unit of pace 1."""
    if truth == "saturating":
        need = (limit / level - 1.0) / (own["final"] * pace)
        age = -own["tau"] * np.log(np.maximum(1.0 - need, 1e-300))
        return np.where(need >= 1.0, np.inf, np.maximum(age, 0.0))
    one = _paths(truth, np.ones(1), np.ones(1), own)[0]
    return np.interp(limit / level, one, _CLOCK) / pace


def table(outcomes: list[Outcome]) -> list[str]:
    """Return the lines of a table, one for each truth and one for all."""
    lines = [
        "| truth | campaigns | units | hold the truth | truth below | truth above | width over age: median "
        "| 90 % | passed | B10 held | B50 held | true law named | another named |",
        "|" + "---|" * 13,
    ]
    for name in (*TRUTHS, "all"):
        chosen = [each for each in outcomes if name in (each.truth, "all")]
        if not chosen:
            continue
        held = np.concatenate([each.held for each in chosen])
        below = np.concatenate([each.below for each in chosen])
        width = np.sort(np.concatenate([each.width for each in chosen]))
        right = np.mean([each.law == each.truth for each in chosen])
        wrong = np.mean([each.law not in (None, each.truth) for each in chosen])
        cells = [
            name,
            len(chosen),
            held.size,
            f"{held.mean():.1%}",
            f"{below.mean():.1%}",
            f"{(~held & ~below).mean():.1%}",
            f"{width[width.size // 2]:.2f}",
            f"{width[int(0.9 * width.size)]:.2f}",
            f"{sum(each.passed for each in chosen) / held.size:.0%}",
            f"{np.mean([each.b10 for each in chosen]):.0%}",
            f"{np.mean([each.b50 for each in chosen]):.0%}",
            f"{right:.0%}",
            f"{wrong:.0%}",
        ]
        lines.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    return lines


def main() -> None:
    """Run the campaigns and print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--campaigns", type=int, default=200)
    parser.add_argument("--first", type=int, default=1001, help="first seed")
    parser.add_argument("--units", type=int, default=8)
    parser.add_argument("--logs", type=int, default=10)
    parser.add_argument("--laws", help="names, separated by commas")
    parser.add_argument("--only", choices=TRUTHS, help="this truth alone")
    takes_workers(parser)
    given = parser.parse_args()
    laws = tuple(given.laws.split(",")) if given.laws else None
    one = partial(campaign, units=given.units, logs=given.logs, laws=laws, only=given.only)
    seeds = range(given.first, given.first + given.campaigns)
    outcomes = list(worked(one, seeds, given))
    print("\n".join(table(outcomes)))
    seconds = np.array([each.seconds for each in outcomes])
    least = np.array([each.effective for each in outcomes])
    print(
        f"\nfit and ages: {np.median(seconds):.2f} s in the median, {seconds.max():.2f} s at the most; ",
        end="",
    )
    print(f"draws worth {np.median(least):.0f} in the median, {least.min():.0f} at the least")


if __name__ == "__main__":
    main()
