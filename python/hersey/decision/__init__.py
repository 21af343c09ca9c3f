"""What to do, from the posterior of the drive.

===========  ======================================================================
behaviour    what the machine of a log does: posterior, map, band, points, worked out in threads
edges        transition and V* at one temperature, with their intervals
judge        the verdict on an operating point: one function for list, map, plan and text
mapping      the operating map of a posterior
measurement  the one measurement that would narrow V* most, and by how much
plausibility numbers that cannot be what they are called
start_up     a start-up profile that works on nearly all draws, whatever the closure
warming      the same while temperature changes
===========  ======================================================================
"""

from hersey.decision.judge import Verdict, judge
from hersey.decision.measurement import Measurement, next_measurement

__all__ = ["Measurement", "Verdict", "judge", "next_measurement"]
