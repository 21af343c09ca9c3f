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

import sys
from types import ModuleType
from typing import Any

from hersey.study.log_and_machine import Study, study

__all__ = ["Study", "study"]


class _Room(ModuleType):
    """Make ``hersey.study(points, machine)`` work once the room of that name is imported."""

    def __call__(self, *given: Any, **named: Any) -> Study:
        return study(*given, **named)


sys.modules[__name__].__class__ = _Room
