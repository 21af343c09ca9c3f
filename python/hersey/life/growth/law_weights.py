"""How the laws of growth are weighed by their evidence."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy import special

from hersey.arrays import FloatArray
from hersey.life.growth.laws import Law
from hersey.life.growth.posterior import Posterior

#: Weight from which a law is named.
NAMED = 0.9
#: Power of the evidence of laws that grow, over each other.
COARSE = 0.5


def evidence_of(found: Sequence[Posterior], laws: Sequence[Law]) -> FloatArray:
    """Return the log evidence of laws that were fitted, some of those compared, with what holds beforehand.

    Growth and no growth are equally probable, and so are the laws that grow.
    """
    growing = sum(law.grows for law in laws)
    before = [-math.log(growing) if each.law.grows else 0.0 for each in found]
    return np.array([each.log_evidence for each in found]) + before


def weights_by(evidence: FloatArray, found: Sequence[Posterior]) -> FloatArray:
    """Weights of laws by their evidence; of those that grow, none of which is quite true, by its power.

    Evidence of a law that is not true is too sure of itself (coarsened posterior; Miller, Dunson, J. Am.
    Stat. Assoc. 114 (2019) 1113).
    """
    grows = np.array([each.law.grows for each in found])
    weights = np.exp(evidence - special.logsumexp(evidence))
    total = weights[grows].sum()
    coarse = COARSE * evidence[grows]
    weights[grows] = total * np.exp(coarse - special.logsumexp(coarse)) if total > 0.0 else 0.0
    return np.asarray(weights)


def selected(evidence: FloatArray, found: Sequence[Posterior]) -> str | None:
    """Return the law whose evidence leaves no other; None if several fit."""
    best = int(np.argmax(evidence))
    share = float(np.exp(evidence[best] - special.logsumexp(evidence)))
    return found[best].law.name if share >= NAMED else None
