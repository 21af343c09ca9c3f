"""Whether what the first screen of a report says of a machine holds on the machine.

Machines and their motion are written from physics alone and import nothing of hersey; hersey sees a log and a
machine file, and is asked as a user asks it: ``hersey report --json``.

=========  ==================================================================
belt       a belt on a spring and two branches of drag, moved; its fold V*
machines   machines drawn at random, their logs and their files
judged     one report against its machine: what is said, and whether it holds
=========  ==================================================================

SI throughout; temperatures in degC.
"""
