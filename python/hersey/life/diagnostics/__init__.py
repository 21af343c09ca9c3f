"""Which runs of a life test do not fit the others, and the likeliest slip behind each.

============  ============================================================================
measured      the runs as they are compared: specimen, age and dwells
fingerprint   each run in a few numbers: level of torque, slopes and curvatures
trends        what a specimen's own runs and the other specimens let expect of a run
compared      every run against that: distances and log densities
slips         how much better each slip explains the runs
finding       the likeliest slips, each undone before the next is looked for
same_logs     runs that hold the same torques
said          the warning of each slip
run_compared  a run with its distance and influence, as it is stated
diagnosis     what was found: warnings, and the runs that growth does without
============  ============================================================================
"""
