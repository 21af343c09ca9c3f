"""Joints that move all the time: a generator of its own, and what hersey finds in its logs."""
