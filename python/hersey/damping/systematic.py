"""What errors of the sensors do to a fit: by how much each value moves if a sensor errs by its limit."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from hersey.arrays import FloatArray
from hersey.damping.candidates.fitting import LawFit
from hersey.damping.candidates.observations import Inputs, Observations
from hersey.damping.candidates.searching import search
from hersey.log.sensors import HYSTERESIS_OF_LARGEST, SHARE_OF_LARGEST, TEMPERATURE_LAG, Sensors


def sensor_shifts(fit: LawFit, data: Observations, sensors: Sensors) -> FloatArray:
    """Return the changes of the values of a fit, shape (errors, parameters).

    One row for each error at its limit: gain and zero of torque, gain of speed, and the temperature of the
    film off its reading, everywhere alike, and the more the faster the drive runs unless film heating has a
    bound of its own. Where the log cannot check them, there is a row for hysteresis of the torque sensor, one
    for the lag of the temperature sensor, and one for the gain of each set of runs that shares no temperature
    with the others.
    """
    torque = np.exp(data.log_torque)
    zero = sensors.torque_zero
    if zero is None:
        zero = SHARE_OF_LARGEST * float(torque.max())
    z, kelvin = data.inputs.log_speed, data.inputs.kelvin
    erring = [
        replace(data, log_torque=data.log_torque + sensors.torque_gain),
        replace(data, log_torque=data.log_torque + zero / torque),
        _with_inputs(data, z + sensors.speed_gain, kelvin),
    ]
    if kelvin is not None and fit.law.thermal is not None and sensors.temperature_zero:
        shapes = [np.ones_like(z)]
        if not sensors.film_heating:
            shapes.append((z - z.min()) / max(float(np.ptp(z)), 1e-12))
        erring += [_with_inputs(data, z, kelvin + sensors.temperature_zero * shape) for shape in shapes]
    erring += _unchecked(fit, data, sensors)
    start = np.append(fit.values, fit.effects)
    moved = [search(fit.law, each, fit.disturbances, fit.sigma, start) for each in erring]
    return np.array([minimum.values[: fit.values.size] - fit.values for minimum in moved])


def _unchecked(fit: LawFit, data: Observations, sensors: Sensors) -> list[Observations]:
    """The dwells with each error at its limit that the order of this log does not check."""
    torque, z, kelvin = np.exp(data.log_torque), data.inputs.log_speed, data.inputs.kelvin
    erring = []
    if data.direction.size:
        moved = HYSTERESIS_OF_LARGEST * float(torque.max()) * data.direction / torque
        erring.append(replace(data, log_torque=data.log_torque + moved))
    if kelvin is None or fit.law.thermal is None:
        return erring
    if data.temperature_rate.size:
        erring.append(_with_inputs(data, z, kelvin + TEMPERATURE_LAG * data.temperature_rate))
    for member in np.unique(data.unlinked):
        gain = sensors.torque_gain * (data.unlinked == member)
        erring.append(replace(data, log_torque=data.log_torque + gain))
    return erring


def _with_inputs(data: Observations, log_speed: FloatArray, kelvin: FloatArray | None) -> Observations:
    return replace(data, inputs=Inputs(log_speed, kelvin, data.inputs.group))
