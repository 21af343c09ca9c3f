"""Part 0: the generator judged by itself, so that its claims on hersey hold.

The means of the dwells are taken where the generator knows that they are, the zero is predicted from the
standstills, and generalised least squares with the true covariance finds a, b, c. If the logs are what
`known` says of them, 95 % of its intervals hold the truth and chi-square per degree of freedom is 1.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.independent import intervals
from benchmarks.independent.judged import generator
from benchmarks.independent.known import slopes, true_covariance, zero_given_rest
from benchmarks.independent.laws import MIDDLE, Array, PowerLaw, TwoBranches
from benchmarks.independent.logs import SETTLING, Log, record

NAMES = intervals.NAMES
LOGS = 100
#: Settled after so many time constants.
_SETTLED = 3.0


@dataclass(frozen=True)
class Pull:
    """Of one log: how many least errors each estimate is off, and chi-square per degree of freedom."""

    z: tuple[float, ...]
    chi_square: float


def one_log(seed: int, name: str, index: int) -> Pull:
    """Return what the best estimates of one log are off by."""
    setting = intervals.SETTINGS[name.removesuffix(intervals.WITH)]
    law = TwoBranches() if name.endswith(intervals.WITH) else PowerLaw()
    log = record(law, setting.plan, setting.errors, generator(seed, name, index))
    skipped = _SETTLED * SETTLING * setting.plan.rate
    torque = _means(log, log.middle, log.samples, skipped)
    if setting.tare:
        middles, samples = np.array(log.standing).T
        torque -= zero_given_rest(log, setting.errors) @ _means(log, middles, samples, skipped)
    expected = log.dwell_read + 0.5 * setting.errors.heating * log.heated
    residual = np.log(torque / law.torque(log.dwell_speed, expected))
    design = slopes(law, log, MIDDLE)
    inverse = np.linalg.inv(true_covariance(law, log, setting.plan, setting.errors, tare=setting.tare))
    covariance = np.linalg.inv(design.T @ inverse @ design)
    off = covariance @ design.T @ inverse @ residual
    rest = residual - design @ off
    z = (off / np.sqrt(np.diag(covariance)))[:3]
    return Pull(tuple(z.tolist()), float(rest @ inverse @ rest) / (residual.size - off.size))


def _means(log: Log, middles: Array, samples: Array, skipped: float) -> Array:
    """Means of torque over stretches, their settling left out."""
    ends = np.rint((middles * log.time.size / (log.time[-1] + log.time[1])) + 0.5 * samples).astype(int)
    starts = ends - samples.astype(int) + int(skipped)
    return np.array([log.torque[i:j].mean() for i, j in zip(starts, ends, strict=True)])


def table(results: dict[str, list[Pull]]) -> list[str]:
    """Return the lines: per setting the share of intervals that hold a, b, c, and mean chi-square."""
    lines = ["| setting | logs | a | b | c | chi-square per degree of freedom |", "|---|---|---|---|---|---|"]
    for name, pulls in results.items():
        shares = np.mean(np.abs([p.z for p in pulls]) < intervals.REACH, axis=0)
        cells = " | ".join(f"{share:.0%}" for share in shares)
        lines.append(f"| {name} | {len(pulls)} | {cells} | {np.mean([p.chi_square for p in pulls]):.2f} |")
    return lines
