"""The first screen of the report: what to do, why, how sure, and what would tell more.

=========== ==================================================================
module      what it holds
=========== ==================================================================
result      what the first screen holds
words       numbers as the first screen writes them
reasons     why something cannot be computed
instruction the sentence, its interval, and what happens otherwise
friction    the sentence for a log of friction, without a machine
points      what is said of each operating point
advice      the next measurement, in words
questions   a question in the place of a conclusion
temperature operating points far from the one temperature of a dead sensor
flags       what stands against it, and the section that holds the evidence
missing     lines to add to a file, ready to copy
decision    all of it together
=========== ==================================================================
"""

from hersey.study.first_screen.decision import decision

__all__ = ["decision"]
