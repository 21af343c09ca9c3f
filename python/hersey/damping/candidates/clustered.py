"""The covariance of a fit whatever the points of a cluster have in common."""

from __future__ import annotations

import numpy as np

from hersey.arrays import FloatArray, IntArray
from hersey.damping.candidates.likelihood import HUBER


def clustered_with_prior(
    jacobian: FloatArray, u: FloatArray, bread: FloatArray, cluster: IntArray
) -> FloatArray:
    """Return the covariance of the values and the effects, whose priors are the last rows."""
    prior = jacobian[u.size :]
    return _cr3(jacobian[: u.size], u, bread, cluster, prior.T @ prior)


def clustered_covariance(jacobian: FloatArray, u: FloatArray, cluster: IntArray) -> FloatArray:
    """Return a covariance that holds whatever points of a cluster have in common (Bell and McCaffrey's CR3).

    Parameters
    ----------
    jacobian
        Of the residuals in standard errors, shape (points, parameters).
    u
        These residuals, shape (points,).
    cluster
        Label of each point, shape (points,).
    """
    bread = np.asarray(np.linalg.pinv(jacobian.T @ jacobian), dtype=np.float64)
    return _cr3(jacobian, u, bread, cluster, np.zeros_like(bread))


def _cr3(
    rows: FloatArray, u: FloatArray, bread: FloatArray, cluster: IntArray, prior: FloatArray
) -> FloatArray:
    out = np.zeros_like(bread)
    # the rows carry the root of Huber's weight already, so the residual carries the other root
    weighted = np.sign(u) * np.sqrt(np.minimum(np.abs(u), HUBER) * np.abs(u))
    labels = np.unique(cluster)
    for label in labels:
        members = np.flatnonzero(cluster == label)
        part = rows[members]
        leverage = np.eye(members.size) - part @ bread @ part.T
        push = part.T @ np.linalg.pinv(leverage) @ weighted[members]
        out += np.outer(push, push)
    shrink = (labels.size - 1) / labels.size
    return np.asarray(bread @ (shrink * out + prior) @ bread)
