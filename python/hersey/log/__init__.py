"""A `TorqueLog` from any file, or from frames in memory.

====================  =======================================================================
torque_log            `TorqueLog`: channels in SI, with where they came from
sensors               what the sensors do not know
text                  CSV and its relatives
layouts               exports that need a layout to be read
recording             what a file of any other format holds: channels with clocks of their own
formats               one reader per format, and which one opens a file
signals               currents, voltages and percentages, and how much one of them stands for
words                 words of other languages that columns are called by
roles                 roles of columns: their names, and the kinds of units that they may have
role_units            the unit of a column with a role
elsewhere             a speed or a temperature in the names of files, or in a position
pressures             pressures of a cylinder, from which a friction force can be computed
channels              which column plays which role
pulses                times of pulses instead of a speed
without_units         columns without units: named at once
lacking_roles         several roles that a file leaves open: asked for at once
friction              which of them a file holds, and what it becomes with a load and a radius
rolling               contacts that roll and slide, whose speed is that of entrainment
pooling               runs that are fitted together: one domain for all
as_torque             friction as a torque, where somebody has a radius and asks for it
stating               a radius or a load: proposed, used once a person states it
slow_channels         a temperature or a load that is slower than the rows: interpolated between its values
long_arrays           numbers of long logs: on disk, and gone over a block at a time
middle                the median of the steps of a clock
clock                 rate, gaps and unevenness of a clock
rows                  which rows can be used, and where one run ends and the next begins
replaced              units of a file that a person replaced
believed              what a channel of a drive can read at all, and codes for no reading
wrapped               negative counts that were logged without a sign
impossible            readings that cannot be right: found, named, left out
counters              the step in which a sensor counts
white_noise           the median of noise over its standard deviation
neighbours            rows that their neighbours rule out
stray_times           rows whose time lies off the clock around them
wanted                what the user wants of a log, checked
columns               columns as they stand, for readers with roles of their own
assembly              from a recording to a run on the clock of the torque
constant_temperature  a temperature that is excluded: which column, and whether its sensor may be dead
given_twice           a measurement that a log holds twice: refused
not_a_log             what is neither a file nor a table: refused
own_tables            tables that hersey wrote: refused as logs
derived               channels that no column holds: file names, run tables, schedules, positions, directions
exchanged             columns under each other's names: refused
reading               `read`: from files to a log
many                  many files, each a log of its own: in turn, in threads, or by workers
corrections           what lies between sensor and film, subtracted with a record
cell_table            a table as it stands: cells of text or numbers
mean_roles            which column of a table of means plays which role
mean_blocks           a table of means in blocks below one header
mean_refusals         what cannot be applied to a table of means: refused
mean_signs            whether a file is a table of means by its content
means                 a table of means: a row per dwell, no clock
doubtful              numbers that would be ordinary in another unit
quantities            quantities that no log holds
sensor_tables         what a file says of the errors of the sensors
role_tables           the tables of a mapping: what it says of each role
mapping               which channel plays which role, kept beside the data
proposal              a mapping proposed for a log
====================  =======================================================================

A further format is one more context manager that yields a `Recording`, entered in `formats.READERS`.
"""

from hersey.log.channels import ChannelChoice
from hersey.log.columns import OpenColumns, open_columns
from hersey.log.formats import READERS, memory_limit
from hersey.log.reading import list_channels, read
from hersey.log.torque_log import Channel, LogFile, Run, TorqueLog

__all__ = [
    "READERS",
    "Channel",
    "ChannelChoice",
    "LogFile",
    "OpenColumns",
    "Run",
    "TorqueLog",
    "list_channels",
    "memory_limit",
    "open_columns",
    "read",
]
