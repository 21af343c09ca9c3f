"""Check the judge's integrator against exact reference values (physics.md, sections 4, 5 and 7).

Usage: python -m benchmarks.decisions.check
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator

from benchmarks.decisions.belt import Belt, Closure, Drive
from benchmarks.decisions.curves import corner, p_norm
from benchmarks.decisions.fold import fold
from benchmarks.decisions.motion import Motion, from_above, moved

#: Relative error that a value may have.
_ALLOWED = 1e-4
#: Steady cycles: closure, drive speed, stiffness, drag at the transition, frequency, greatest speed and stuck
#: share (None for `stiction`, where the reference counts the first 0.03 ms of each slip as stuck).
_CYCLES: tuple[tuple[Closure, float, float, float, float, float, float | None], ...] = (
    ("retained", 0.4, 1000, 50, 2.2407986626071312, 2.487271218534647, 0.7428575582065352),
    ("retained", 1.0, 1000, 50, 3.940313951318513, 3.152923049536937, 0.4743190105858886),
    ("retained", 1.6, 1000, 50, 4.606334576126767, 3.9235580052305354, 0.2957048392910338),
    ("retained", 1.9, 1000, 50, 4.751532963167902, 4.343123230499888, 0.21962142170394058),
    ("retained", 1.0, 500, 50, 2.4606987980739277, 3.7017468721158884, 0.5561100828037013),
    ("retained", 1.0, 2000, 50, 6.117362471247326, 2.758211719212175, 0.3906496062448489),
    ("retained", 1.0, 1000, 25, 4.607447951360904, 2.4882489450933172, 0.3125597),
    ("retained", 1.0, 1000, 100, 2.9918626212919532, 4.429914759760552, 0.6296672494669258),
    ("stiction", 1.0, 1000, 50, 1.6374306717916922, 9.007891812728303, None),
    ("stiction", 1.9, 1000, 50, 2.6637145202916463, 9.949081103768767, None),
)
#: V* of the corner, `retained`: stiffness, drag at the transition, stick speed, V*.
_FOLDS = (
    (1000, 50, 0.01, 2.173493),
    (500, 50, 0.01, 2.228999),
    (2000, 50, 0.01, 2.109731),
    (1000, 25, 0.01, 2.056026),
    (1000, 100, 0.01, 2.241447),
    (1000, 50, 0.001, 4.0968),
    (1000, 50, 0.05, 1.5586),
)
#: Rounded curves: p, drag at the stick speed, V*.
_ROUNDED = (
    (1, 80.380366, 3.56116),
    (2, 97.608688, 3.28219),
    (4, 110.538879, 2.82374),
    (8, 117.825397, 2.47685),
)
#: First events from rest at the baseline: kind, time, spring force, belt speed.
_EVENTS = (
    ("release", 0.3414007621, 341.4007621, 0.0),
    ("stick", 0.4493127723, -161.4001791, 0.0074917018),
    ("release", 0.7745497086, 161.4001791, 0.0074917018),
    ("stick", 0.8968924825, -18.2920454, 0.01),
    ("release", 1.0422322470, 125.5943216, 0.01),
)

Checked = tuple[str, float, float]  #: what, value, reference


def main() -> int:
    """Print each value beside its reference; return 1 if one is off."""
    began, worst, faults = time.perf_counter(), 0.0, 0
    for what, value, reference in (*_events(), *_cycles(), *_folds(), *_rounded(), *_descents()):
        error = abs(value - reference) / max(abs(reference), 1e-3)
        worst = max(worst, error)
        faults += error > _ALLOWED
        print(f"{what:45s} {value:14.8g} {reference:14.8g} {error:9.1e}{'  OFF' * (error > _ALLOWED)}")
    print(f"worst error {worst:.1e}, {faults} values off, {time.perf_counter() - began:.1f} s")
    return int(faults > 0)


def _baseline(
    stiffness: float = 1000,
    force: float = 50,
    stick: float = 0.01,
    p: float = 0,
    closure: Closure = "retained",
) -> Belt:
    shape = p_norm(p, 0.3, -0.2) if p else corner(0.3, -0.2)
    return Belt(lambda v: force * shape(v, v), 1.0, stick, stiffness, 1.0, closure)


def _events() -> Iterator[Checked]:
    motion = Motion(_baseline(), Drive((0.0, 1.0)), (0.0, 0.0), 1)
    motion.run(1.1)
    for number, (kind, *reference) in enumerate(_EVENTS):
        event = motion.events[number]
        if event.kind != kind:
            raise ValueError(f"event {number} is {event.kind}, not {kind}")
        for name, value in zip(("time", "pull", "speed"), reference, strict=True):
            yield f"event {number}, {kind}: {name}", getattr(event, name), value


def _cycles() -> Iterator[Checked]:
    for closure, speed, stiffness, force, frequency, greatest, stuck in _CYCLES:
        belt = _baseline(stiffness, force, closure=closure)
        motion = Motion(belt, Drive((0.0, speed)), (0.0, 0.0), 1)
        motion.run(10.0)
        first, release, last = (
            motion.events[-3:] if motion.events[-1].kind == "stick" else motion.events[-4:-1]
        )
        motion.greatest_speed = 0.0
        motion.run(12.0)
        name = f"{closure}, v2 {speed:g}, k {stiffness:g}, B0 {force:g}"
        yield f"{name}: frequency", 1.0 / (last.time - first.time), frequency
        yield f"{name}: v_max", motion.greatest_speed, greatest
        if stuck is not None:
            yield f"{name}: stuck share", (release.time - first.time) / (last.time - first.time), stuck


def _folds() -> Iterator[Checked]:
    for stiffness, force, stick, reference in _FOLDS:
        name = f"V*, k {stiffness:g}, B0 {force:g}, v_s {stick:g}"
        yield name, fold(_baseline(stiffness, force, stick), 1e-6), reference


def _rounded() -> Iterator[Checked]:
    for p, force, reference in _ROUNDED:
        belt = _baseline(p=p)
        yield f"p = {p}: F(v_s)", belt.film(0.01), force
        yield f"p = {p}: V*", fold(belt, 1e-6), reference


def _descents() -> Iterator[Checked]:
    """From steady 2.5 (section 5): a step to 1.2 sticks, one to 1.3 does not, gentle ramps to 1.0 do not."""
    belt = _baseline()
    yield "step from 2.5 to 1.2 slides", from_above(belt, 1.2, 2.5 / 1.2).outcome == "slides", False
    yield "step from 2.5 to 1.3 slides", from_above(belt, 1.3, 2.5 / 1.3).outcome == "slides", True
    for deceleration in (10.0, 5.0):
        drive = Drive((0.0, 2.5), (1.5 / deceleration, 1.0))
        stuck = moved(belt, drive, (2.5, belt.drag(2.5))).stuck
        yield f"ramp of -{deceleration:g} to 1.0 sticks", len(stuck), False


if __name__ == "__main__":
    sys.exit(main())
