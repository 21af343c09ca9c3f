"""The drive of examples/machine.toml in numbers: what ages where no other machine is given."""

from __future__ import annotations

from hersey.damping.no_load_torque import NoLoadTorque
from hersey.lubrication.asperities import Asperities, BoundaryFriction
from hersey.lubrication.contact import Contact
from hersey.lubrication.lubricant import Lubricant
from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine
from hersey.schema.noun import BELT
from hersey.units import ZERO_CELSIUS


def example_drive() -> tuple[Machine, NoLoadTorque]:
    """Return machine and no-load torque of the shipped example, so far as the stand needs them."""
    cold, hot, density = 40.0 + ZERO_CELSIUS, 200.0 + ZERO_CELSIUS, 1900.0
    machine = Machine(
        stiffness=11e3,
        mass=11.0,
        roll_radius=15e-3,
        stick_speed=3e-3,
        part=BELT,
        limits=Limits(motor_torque=1.0, roll_friction=0.6, nip_load=300.0, acceleration=0.5, speed=0.4),
        points=(
            OperatingPoint("full speed", 0.2, 180.0 + ZERO_CELSIUS),
            OperatingPoint("thick paper", 0.045, 180.0 + ZERO_CELSIUS),
        ),
        contact=Contact(
            roll_radius=15e-3,
            rubber_thickness=3.5e-3,
            modulus=0.65e6,
            poisson_ratio=0.48,
            length=0.22,
            load=300.0,
            roughness=0.5e-6,
            nip_uncertainty=0.1,
        ),
        lubricant=Lubricant(
            "walther",
            ((cold, 500e-6 * density), (hot, 7.2e-6 * density)),
            density=density,
            pressure_viscosity=((25.0 + ZERO_CELSIUS, 20e-9),),
            conductivity=0.1,
            uncertainty=0.2,
            name="invented grease oil",
        ),
        asperities=Asperities(modulus=2e9, sigma_beta_density=0.04, sigma_over_beta=0.001),
        boundary=BoundaryFriction(0.05),
    )
    return machine, NoLoadTorque.stated(constant=0.18, per_speed=1e-3)
