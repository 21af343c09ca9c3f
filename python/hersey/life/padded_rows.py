"""Lists of runs, or of dwells, as rows of equal length, for what is computed over all of them at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from hersey.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True)
class PaddedRows:
    """Where each entry of a list stands in rows, one row for each label; ``given`` marks what is an entry."""

    first: IntArray  #: place in the list of the first entry of each row
    row: IntArray
    column: IntArray
    given: BoolArray

    @classmethod
    def of(cls, label: IntArray) -> PaddedRows:
        """Return the rows of a list whose entries have labels; rows go by label, entries as in the list."""
        _, first, row, count = np.unique(label, return_index=True, return_inverse=True, return_counts=True)
        ordered = np.argsort(row, kind="stable")
        column = np.empty_like(row)
        column[ordered] = np.arange(row.size) - np.repeat(np.cumsum(count) - count, count)
        given = np.zeros((count.size, count.max()), dtype=bool)
        given[row, column] = True
        return cls(first, row, column, given)

    def filled(self, values: FloatArray) -> FloatArray:
        """Return values of the list as rows, each filled up with its first."""
        rows = np.repeat(values[self.first][:, None], self.given.shape[1], axis=1)
        rows[self.row, self.column] = values
        return rows
