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
    weighted = robust_residuals(u)
    pushes = np.vstack([_pushes(rows[of], weighted[of], bread) for of in alike(cluster)])
    shrink = (len(pushes) - 1) / len(pushes)
    return np.asarray(bread @ (shrink * pushes.T @ pushes + prior) @ bread)


def robust_residuals(u: FloatArray) -> FloatArray:
    """Return residuals beside rows that carry the root of Huber's weight: they carry the other root."""
    return np.asarray(np.sign(u) * np.sqrt(np.minimum(np.abs(u), HUBER) * np.abs(u)))


def alike(cluster: IntArray) -> list[IntArray]:
    """Return the members of the clusters of each size, shape (clusters, size)."""
    _, label, sizes = np.unique(cluster, return_inverse=True, return_counts=True)
    members = np.split(np.argsort(label, kind="stable"), np.cumsum(sizes)[:-1])
    return [
        np.array([each for each in members if each.size == size], dtype=np.intp) for size in np.unique(sizes)
    ]


def _pushes(rows: FloatArray, residuals: FloatArray, bread: FloatArray) -> FloatArray:
    return pushes_of(rows, rows @ bread @ rows.swapaxes(1, 2), residuals)


def pushes_of(rows: FloatArray, hat: FloatArray, residuals: FloatArray) -> FloatArray:
    """Return by how much each cluster of one size moves the values, shape (clusters, parameters).

    ``hat`` is by how much each point of a cluster moves the fit to the others, shape (clusters, size, size).
    """
    leverage = np.eye(rows.shape[1]) - hat
    return np.asarray(np.einsum("cmp,cmn,cn->cp", rows, np.linalg.pinv(leverage), residuals))
