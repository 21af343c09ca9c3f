"""Which candidates there are, what each is called, and which a set of dwells cannot carry."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.damping.candidates.branched import (
    CONSTANT_PLUS,
    COULOMB_VISCOUS,
    FREE,
    HELD,
    NO_SPEED,
    ONE,
    REST_PLUS,
    SHARED,
    Law,
)
from hersey.damping.candidates.constant_plus import ConstantPlusLaw
from hersey.damping.candidates.observations import Observations
from hersey.damping.candidates.shared_load import SharedLoad, SharedLoadLaw
from hersey.damping.candidates.stribeck import StribeckLaw
from hersey.damping.candidates.thermal import ARRHENIUS, CELSIUS, KELVIN, VFT, Thermal
from hersey.damping.dwells import distinct_speeds
from hersey.errors import ParameterError
from hersey.units import convert

#: Degrees of freedom that a fit must leave.
LEAST_FREEDOM = 3
#: Distinct speeds that one branch needs.
SPEEDS_OF_ONE = 3
#: Those that a constant beside a film needs.
SPEEDS_OF_CURVE = 4
#: Those that two branches need.
SPEEDS_OF_TWO = 5
_WORDS = {CELSIUS: "power-degC", KELVIN: "power-K", ARRHENIUS: "arrhenius", VFT: "vft", None: "isothermal"}
_BRANCH_WORDS = {
    NO_SPEED: "viscosity",
    ONE: "one",
    HELD: "two-hersey",
    FREE: "two-free",
    CONSTANT_PLUS: "constant-plus-power",
    COULOMB_VISCOUS: "coulomb-viscous",
    REST_PLUS: "rest-plus-power",
}
_BESIDE_WORDS = {
    CONSTANT_PLUS: "constant {quantity} plus power of speed",
    COULOMB_VISCOUS: "Coulomb plus viscous",
    REST_PLUS: "constant and viscous {quantity} plus power of speed",
}
_BESIDE = tuple(_BESIDE_WORDS)


@dataclass(frozen=True)
class Candidate:
    """One law, before it is fitted; that of a ``contact`` may take its viscosity as known."""

    thermal: str | None
    branches: str
    per_temperature: bool = False
    stribeck: bool = False
    contact: SharedLoad | None = None
    viscosity_known: bool = False
    quantity: str = "torque"  #: what the law is of, for its name

    @property
    def key(self) -> str:
        """A short name, as ``arrhenius/two-hersey``."""
        if self.contact is not None:
            return "mixed/viscosity-known" if self.viscosity_known else "mixed"
        if self.stribeck:
            return "stribeck" if self.thermal else "isothermal/stribeck"
        each = "/each" if self.per_temperature else ""
        return f"{_WORDS[self.thermal]}/{_BRANCH_WORDS[self.branches]}{each}"

    @property
    def name(self) -> str:
        """The law in words."""
        if self.contact is not None:
            return f"{self.branches}, viscosity {'as stated' if self.viscosity_known else 'free'}"
        temperature = self.thermal or "no temperature"
        if self.stribeck:
            return (
                f"Stribeck curve, {temperature} viscosity"
                if self.thermal
                else "Stribeck curve, no temperature"
            )
        if self.branches == NO_SPEED:
            return temperature
        if self.branches in _BESIDE:
            parts = _BESIDE_WORDS[self.branches].format(quantity=self.quantity)
            return f"{parts}, film by {temperature}" if self.thermal else f"{parts}, {temperature}"
        each = ", exponents per temperature" if self.per_temperature else ""
        return f"{temperature} x power of speed, {self.branches}{each}"

    def law(self, data: Observations) -> Law | StribeckLaw | ConstantPlusLaw | SharedLoadLaw:
        """Return the law about the reference values of the data."""
        if self.contact is not None:
            torque = float(np.exp(np.mean(data.log_torque)))
            return SharedLoadLaw(self.contact, data.reference_speed, torque, self.viscosity_known)
        thermal = None
        if self.thermal is not None and data.reference_kelvin is not None:
            thermal = Thermal(self.thermal, data.reference_kelvin)
        if self.stribeck:
            return StribeckLaw(thermal)
        if self.branches in _BESIDE:
            exponent = 0.0 if self.branches == COULOMB_VISCOUS else None
            return ConstantPlusLaw(thermal, exponent, viscous=self.branches == REST_PLUS)
        return Law(thermal, self.branches, data.temperatures.size if self.per_temperature else 1)

    def refused(self, data: Observations) -> str:
        """Return why the data cannot carry this candidate; empty if they can."""
        levels = data.temperatures.size
        if self.contact is not None:
            if data.inputs.kelvin is None:
                return "the log has no temperature"
            try:
                self.contact.product(data.speed, data.inputs.kelvin)
                self.contact.numbers(data.inputs.kelvin)
            except ParameterError as error:
                return str(error)
        if self.thermal is not None:
            needed = 3 if self.thermal == VFT else 2
            if data.inputs.kelvin is None:
                return "the log has no temperature"
            if levels < needed:
                return f"needs {needed} temperatures; the log has {_listed(data)}"
            if self.thermal == CELSIUS and np.min(data.inputs.kelvin) <= convert(0.0, "degC", "K"):
                return "T^b is not defined at or below 0 degC"
        if self.per_temperature:
            for group in range(levels):
                speeds = distinct_speeds(data.speed[data.inputs.group == group])
                if speeds < SPEEDS_OF_ONE:
                    at = convert(float(data.temperatures[group]), "K", "degC")
                    return f"needs {SPEEDS_OF_ONE} speeds at each temperature; {at:.0f} degC has {speeds}"
        needed = SPEEDS_OF_TWO if self.branches in (HELD, FREE) or self.stribeck else 0
        needed = SPEEDS_OF_CURVE if self.branches in (CONSTANT_PLUS, COULOMB_VISCOUS) else needed
        needed = SPEEDS_OF_TWO if self.branches in (REST_PLUS, SHARED) else needed
        speeds = distinct_speeds(data.speed) if needed else 0
        if speeds < needed:
            return f"needs {needed} speeds; the log has {speeds}"
        parameters = len(self.law(data).names)
        if len(data) < parameters + LEAST_FREEDOM:
            return (
                f"its {parameters} parameters need {parameters + LEAST_FREEDOM} dwells; the log has "
                f"{len(data)}"
            )
        return ""


def all_candidates() -> tuple[Candidate, ...]:
    """Return the candidates, the simplest first."""
    laws_of_temperature = (None, CELSIUS, KELVIN, ARRHENIUS, VFT)
    one = [Candidate(law, ONE) for law in laws_of_temperature]
    held = [Candidate(law, HELD) for law in laws_of_temperature[1:]]
    free = [Candidate(law, FREE) for law in laws_of_temperature]
    each = [
        Candidate(law, kind, per_temperature=True) for law in laws_of_temperature[1:] for kind in (ONE, FREE)
    ]
    curves = [Candidate(None, ONE, stribeck=True), Candidate(ARRHENIUS, ONE, stribeck=True)]
    constant = [
        Candidate(law, kind) for law in laws_of_temperature for kind in (COULOMB_VISCOUS, CONSTANT_PLUS)
    ]
    rest = [Candidate(law, REST_PLUS) for law in (None, ARRHENIUS)]  # the others take time and tell no more
    flat = (*constant[:2], *rest[:1], *free[:1], *curves[:1])
    return (*one, *flat, *constant[2:], *rest[1:], *held, *free[1:], *each, *curves[1:])


def contact_candidates(contact: SharedLoad) -> tuple[Candidate, ...]:
    """Return the laws of a known contact, the simplest first."""
    return tuple(Candidate(None, SHARED, contact=contact, viscosity_known=known) for known in (True, False))


def viscosity_candidates() -> tuple[Candidate, ...]:
    """Return the laws of temperature alone, for a table of viscosities."""
    return tuple(Candidate(law, NO_SPEED) for law in (CELSIUS, KELVIN, ARRHENIUS, VFT))


def _listed(data: Observations) -> str:
    degrees = ", ".join(f"{convert(float(t), 'K', 'degC'):.0f}" for t in data.temperatures)
    return f"{data.temperatures.size} ({degrees} degC)"
