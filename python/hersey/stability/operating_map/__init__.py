"""The operating map: what the belt does at each temperature and drive speed.

Four speeds divide each temperature: ``lower``, the transition speed, ``upper`` (the fold V*) and the speed
from which the drag stalls the drive. All come from the fitted surface and the core; nothing is drawn here.

============  ===================================================================
edges         the speeds that divide the behaviour at each temperature
window        the temperatures and speeds shown where none are asked for
intervals     how far the transition speed and V* are known
state         what the belt does at one temperature and drive speed
result        `OperatingMap`, what can be asked of it, and its words
map_warnings  what must be known of a map and its points
mapping       `operating_map`, of a fitted surface; `given_map`, of edges found elsewhere
============  ===================================================================
"""

from hersey.stability.operating_map.mapping import given_map, operating_map
from hersey.stability.operating_map.result import OperatingMap
from hersey.stability.operating_map.state import STATES, MapState, PlacedPoint

__all__ = ["STATES", "MapState", "OperatingMap", "PlacedPoint", "given_map", "operating_map"]
