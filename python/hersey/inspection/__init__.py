"""What a log holds, shown before anything is fitted.

===========  ================================================================
module       what it holds
===========  ================================================================
raw          every channel of a log as written
faults       step, noise and faults of a channel
file_report  one file: clocks, channels with their roles, warnings
support      what the dwells can tell, in words
inspecting   all of it: `inspect`
===========  ================================================================
"""

from hersey.inspection.inspecting import Inspection, inspect

__all__ = ["Inspection", "inspect"]
