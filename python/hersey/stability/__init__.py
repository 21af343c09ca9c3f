"""Where the belt runs smoothly, where it sticks, and how to get past.

================  =====================================================================
hysteresis        the band of drive speeds where the past decides
hysteresis_sweep  the band of each of many combinations of parameters
disturbance       steps, ramps and kicks that sliding bears
operating_map     what the belt does at each temperature and drive speed
plan              the quickest drive profile that ends smooth
warm_up_result    the course of a warm-up, its words and its table
warm_up           slow until warm: the quickest drive speed whose drag keeps below a limit
================  =====================================================================
"""
