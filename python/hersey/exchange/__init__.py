"""The fitted drive inside other people's tools.

================  ==================================================================================
module            responsibility
================  ==================================================================================
platforms         where a unit keeps the library of each platform, and of which one a library is
variables         the variables of a unit, as the library tells them
unit_definitions  their units as the Functional Mock-up Interface defines them
drive_file        the drive as the library reads it
description       the unit as tools read it, for FMI 3.0 and 2.0
documentation     the page that a unit carries
unit              a drive as a unit: all of these in one file
trial             a unit validated and run by FMPy, beside the core
library           the library of this platform, made by ``make build``
================  ==================================================================================
"""
