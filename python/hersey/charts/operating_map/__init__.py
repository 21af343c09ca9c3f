"""The operating map as a chart: temperature across, drive speed up, everything named on it.

=======  =====================================================
frame    the window of the map, its pixels and axes
regions  what the belt does where, and where that is known
lines    transition speed, V*, stall, torque, the drive's limit
points   the machine's points, and what the pointer shows
chart    all of it together, with names that do not overlap
=======  =====================================================

Regions differ in lightness and carry their names, lines differ in dash, and what is extrapolated is hatched,
so that the picture survives greyscale.
"""

from hersey.charts.operating_map.chart import map_chart

__all__ = ["map_chart"]
