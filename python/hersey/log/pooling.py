"""Runs that are fitted together: one domain for all, and no torque of different radii or loads among them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.errors import ParameterError, Setting
from hersey.log.channels import Stated
from hersey.log.friction import Chosen, computed, domain_of, measured
from hersey.log.rolling import of_rolling
from hersey.log.stating import LIFTED
from hersey.log.text.column import Column
from hersey.log.torque_log import LogFile, Run
from hersey.schema.domain import TORQUE, Domain
from hersey.schema.warning import Warning
from hersey.units import Conversion

#: Ratio of loads up to which they count as the same.
SAME_LOAD = 1.03
_SPEED_WORDS = {"speed": "speed of rotation"}


def of_each_run(runs: list[tuple[Run, LogFile]], stated: Stated) -> list[tuple[Run, LogFile]]:
    """Return runs in their one domain, read with a load or a radius of 1 where one is stated for each.

    Raises
    ------
    ParameterError
        If there are not as many of them as runs, or runs have no domain in common.
    """
    domains = [_recorded(log, stated) for _, log in runs]
    for role in ("load", "radius"):
        values = getattr(stated, role)
        if not isinstance(values, tuple):
            continue
        if len(values) != len(runs):
            raise ParameterError(
                f"{role} has {len(values)} values for {len(runs)} runs. Give one value for each run"
            )
        runs = [
            (_scaled(run, of.powers(to)[role], role, value), log)
            for (run, log), (of, to), value in zip(runs, domains, values, strict=True)
        ]
    refuse_mixed([(log.name, to) for (_, log), (_, to) in zip(runs, domains, strict=True)])
    done = [
        (run, log) if to.is_torque else _in_contact(replace(run, domain=to), log, of)
        for (run, log), (of, to) in zip(runs, domains, strict=True)
    ]
    return _torque_asked(done, stated)


def _torque_asked(runs: list[tuple[Run, LogFile]], stated: Stated) -> list[tuple[Run, LogFile]]:
    """Runs as torques, if one radius is stated and their column of loads holds one load throughout."""
    if not isinstance(stated.radius, float | int) or any(run.domain.is_torque for run, _ in runs):
        return runs
    ends = [(float(run.load.min()), float(run.load.max())) for run, _ in runs if run.load is not None]
    if len(ends) < len(runs) or max(high for _, high in ends) > SAME_LOAD * min(low for low, _ in ends):
        return runs
    out = []
    for run, log in runs:
        of = run.domain
        assert run.load is not None
        torque, speed = of.converted(TORQUE, run.torque, run.speed, load=run.load, radius=stated.radius)
        kept = tuple(w for w in log.warnings if w.kind not in ("torque computed", "speed computed"))
        made = [w for w in computed(_chosen(log), stated, TORQUE) if w.kind != "load known"]
        out.append(
            (replace(run, torque=torque, speed=speed, domain=TORQUE), replace(log, warnings=(*made, *kept)))
        )
    return out


def _in_contact(run: Run, log: LogFile, of: Domain) -> tuple[Run, LogFile]:
    """A run without the rows whose load is no contact, where its column makes the coefficient."""
    if run.load is None or of.powers(run.domain)["load"][0] >= 0:
        return run, log
    pressed = run.load > LIFTED * float(np.quantile(run.load, 0.95))
    lost = int(pressed.size - np.count_nonzero(pressed))
    if not lost:
        return run, log
    if pressed.size - lost < 2:
        raise ParameterError(
            f"{log.name}: the normal load is not greater than zero in {lost} of {pressed.size} rows",
            remedy=f"if it has the wrong sign, use {Setting('load', 'unit').to('-1 N')}",
        )
    channels = ("time", "torque", "speed", "temperature", "load", "position")
    kept = {name: values[pressed] for name in channels if (values := getattr(run, name)) is not None}
    lifted = Warning(
        "rows without contact",
        "{rows} {rows:row was|rows were} excluded because the normal load is below {share:.0f %} of its "
        "usual value",
        rows=lost,
        share=LIFTED,
    )
    file = replace(log, rows=int(kept["time"].size), warnings=(*log.warnings, lifted))
    return replace(run, **kept), file


def _recorded(log: LogFile, stated: Stated) -> tuple[Domain, Domain]:
    """What a file was measured in, and the domain that it has, from the record of its channels."""
    chosen = _chosen(log)
    return measured(chosen), of_rolling(domain_of(chosen, stated), log.warnings)


def _chosen(log: LogFile) -> Chosen:
    """The columns that a file was read from."""
    return {c.role: (Column(0, c.name, c.unit), Conversion(c.unit, 1.0, 0.0)) for c in log.channels}


def _scaled(run: Run, powers: tuple[int, int], role: str, value: float) -> Run:
    """A run that was read with a load or a radius of 1."""
    done = replace(run, load=np.full(run.torque.shape, value)) if role == "load" else run
    of_quantity, of_speed = powers
    return replace(
        done,
        torque=run.torque * value**of_quantity if of_quantity else run.torque,
        speed=run.speed * value**of_speed if of_speed else run.speed,
    )


def refuse_mixed(domains: list[tuple[str, Domain]]) -> None:
    """Raise `ParameterError` unless all runs or tables are about the same quantity and speed."""
    (first, of), *others = domains
    for name, other in others:
        if other.quantity != of.quantity:
            need = Setting("load").to("50 N"), Setting("radius").to("25 mm")
            raise ParameterError(
                f"{first} holds a {of.quantity} and {name} a {other.quantity}",
                remedy=f"fit them separately, or state what makes them alike, e.g. {' and '.join(need)}",
            )
        if other.speed != of.speed:
            raise ParameterError(
                f"{first} holds a {_SPEED_WORDS.get(of.speed, of.speed)} and {name} a "
                f"{_SPEED_WORDS.get(other.speed, other.speed)}",
                remedy=f"state the radius, e.g. {Setting('radius').to('25 mm')}"
                if "speed" in (of.speed, other.speed)
                else "fit them separately",
            )
