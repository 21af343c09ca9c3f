"""The one door for units: they are read and written here, everything inside is SI.

==========  ==========================================================================
kinds       kinds of quantities, their SI units, and what a wrong unit should be
table       units in which logs and machine files of drives are written
pint_units  every other unit, by pint
spelling    factors, spellings of the field, counts of an encoder
into_si     from a unit to SI and back
quantity    a number with its unit, as text
arguments   what functions and records are called with, in SI
==========  ==========================================================================
"""

from hersey.units.arguments import Kind, argument, si, takes_si
from hersey.units.into_si import Conversion, Number, celsius, conversion, convert, rpm
from hersey.units.kinds import KINDS, named, nearest_unit
from hersey.units.pint_units import registry
from hersey.units.quantity import parse
from hersey.units.spelling import COUNTS, of_encoder, without_factor
from hersey.units.table import ZERO_CELSIUS

__all__ = [
    "COUNTS",
    "KINDS",
    "ZERO_CELSIUS",
    "Conversion",
    "Kind",
    "Number",
    "argument",
    "celsius",
    "conversion",
    "convert",
    "named",
    "nearest_unit",
    "of_encoder",
    "parse",
    "registry",
    "rpm",
    "si",
    "takes_si",
    "without_factor",
]
