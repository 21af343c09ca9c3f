"""The machine file: what the log cannot tell, each value with its unit.

===================  ==============================================================
machine              `Machine` and the file as a whole
finding              machine files in a folder, and what to do where one is missing
limits               what the machine can bear; operating points
motor                what a motion asks of the motor
nip                  the tables of contact and lubricant
heat                 the table of what warms the nip, and what the rest takes away
duty                 the tables of how the machine is used, and of a gear that fatigues
no_load              the table of what the drive takes without the film
sharing              the tables of what shares the load with the film
at_belt              quantities where the part slides, and what to write for one of another kind
rotational           rotational quantities in the place of those at the surface
doubts               values that are possible, but unusual
uncertainty          how far a parameter is known
temperature_profile  temperature against time, from a file
lubricant_file       a file of a lubricant alone
questions            what is asked about a machine and the channels of its log
writing              a machine file and hersey.toml from answers
===================  ==============================================================
"""

from hersey.machine.limits import Limits, OperatingPoint
from hersey.machine.machine import Machine, read_machine
from hersey.machine.motor import MotorUse, motor_use
from hersey.machine.temperature_profile import read_temperature_profile
from hersey.machine.uncertainty import Uncertainty, read_uncertainty

__all__ = [
    "Limits",
    "Machine",
    "MotorUse",
    "OperatingPoint",
    "Uncertainty",
    "motor_use",
    "read_machine",
    "read_temperature_profile",
    "read_uncertainty",
]
