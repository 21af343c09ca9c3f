"""Parts of the document that are laid out otherwise than the results that they tell of.

===============  ===============================================
log              logs and dwells
fit              the damping surface and the regime
motion           trajectories, cycles, sweeps
stability        bands
models           candidates, comparisons of logs, designs
campaign         runs of many units at many ages
cycles           cycles of a trace
exchange         a unit for other tools
glossary         terms with their meanings
posterior        what dwells, starts and stick-slip say together
study            what a log and its machine tell together
drift            what moved with age
life_test        a life test followed: all of these
===============  ===============================================
"""
