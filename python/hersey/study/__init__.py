"""Everything for one log and one machine, computed once.

===============  ====================================================================
log_and_machine  the study: fit, regime, nip, torque budget, behaviour, decision
nip              the film of the machine's nip, beside what the log says of it
nip_film         what the document holds of both
torque_budget    what film, contact and the no-load torque take of the torque
simulation       the typical belt of the machine below its transition speed
first_screen     what to do: the decision in words
findings         what was found of both, before anything is decided
thinning         fewer samples to show, the extremes among them
===============  ====================================================================
"""

from hersey.schema.callable_room import make_callable
from hersey.study.log_and_machine import Study, study

__all__ = ["Study", "study"]

make_callable(__name__, "hersey.study.log_and_machine", "study")
