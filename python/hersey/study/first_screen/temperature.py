"""Operating points far from the one temperature that a dead sensor shows, which the fit left out."""

from __future__ import annotations

from collections.abc import Iterator

from hersey.damping.dwells import SteadyPoints
from hersey.log.constant_temperature import CONSTANT_TEMPERATURE
from hersey.machine.machine import Machine
from hersey.schema.warning import Warning

#: Difference, K, beyond which the temperature of a log is not that of a point.
FAR = 30.0


def temperature_unknown(points: SteadyPoints, machine: Machine | None) -> Iterator[Warning]:
    """Yield a warning if the log has a constant temperature, and a point of the machine another."""
    found = [
        each.within(file.name)
        for file in points.log.files
        for each in file.warnings
        if each.kind == CONSTANT_TEMPERATURE
    ]
    if not found or machine is None or not machine.points:
        return
    first = found[0]
    read = first.values["temperature"]
    assert isinstance(read, float)
    far = max(machine.points, key=lambda point: abs(point.temperature - read))
    if abs(far.temperature - read) > FAR:
        yield Warning(
            "temperature of the log unknown",
            "{concerns}: '{column}' reads {temperature:.4g degC} in every row, so the sensor may be dead, "
            "and {point} is at {of_point:.4g degC}",
            severity="act",
            title="The temperature of the log is not known",
            where="data",
            remedy="check the sensor and record again",
            concerns=first.where,
            point=far.name,
            of_point=far.temperature,
            column=str(first.values["column"]),
            temperature=read,
        )
