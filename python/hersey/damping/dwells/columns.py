"""A column of the steady points by its name."""

from __future__ import annotations

import polars as pl

from hersey.errors import ChannelError, meant, printable


def column_of(table: pl.DataFrame, name: str) -> pl.Series:
    """Return the column of a name.

    Raises
    ------
    ChannelError
        If there is none, with the nearest name.
    """
    if name in table.columns:
        return table[name]
    known = table.columns
    near = next((each for each in known if str(name).lower().startswith(each)), meant(str(name), known))
    did = f"did you mean '{near}'? " if near else ""
    raise ChannelError(
        f"steady points have no column '{printable(str(name))}'", remedy=f"{did}They have {', '.join(known)}"
    )
