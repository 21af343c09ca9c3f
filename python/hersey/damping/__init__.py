"""From a log to the law of its damping.

==============  =========================================================
once            logs that are read and reduced once for all commands
recipe          how logs become dwells: files, channels, corrections, the search for dwells
dwells          dwells, reduced to steady points with honest errors
distributions   Student's t and the like, from scipy.special
estimate        a number with its uncertainty
inertia         a moment of inertia as it is stated, with its error
no_load_torque  what the drive takes besides the film
soundness       whether numbers read from a file can be what they are called
smoothing       a smooth curve through dwells, and where it is least
scaled          dwells of all temperatures on one curve
gradual         a gradual bend: its minimum, and what motion is given of it
branches        two branches of the law: whether, and where torque is least
trend           whether torque rises or falls with speed, by the dwells themselves
driving_torque  torque that falls as that of a motor or a brake, and is no friction
order           the same of a few dwells, all of them together
shown           whether the dwells show a transition, in each direction
fitted_law      a fitted law: its numbers, the torque it gives, its limits
surface         the same with its transition, and the drag on a belt
surface_words   what a surface says of itself: summary, record, table
fit             fitting it: the paper's candidate among all
candidates      every law fitted to the same dwells, one chosen
friction_curve  friction of joints and gear motors: Coulomb, viscous, Stribeck
moving          logs that move all the time: friction, inertia, gravity and offset
held_or_moving  whether a log is reduced to dwells or moves all the time
curves          drag curves that the dwells allow: laws by weight, and how they go on beyond
no_load         the no-load torque from a log without the film
rising          the rising branch by itself: whether one exponent holds
systematic      what errors of the sensors do to a fit
coast_down      friction from speed against time alone, by the moment of inertia
compare         two logs against each other
design          which dwells to record next
==============  =========================================================
"""
