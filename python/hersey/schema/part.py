"""What every part of the document is: frozen, refusing unknown fields and numbers that are none."""

from __future__ import annotations

from typing import Literal

from pydantic import BaseModel, ConfigDict

SCHEMA_VERSION: Literal["2"] = "2"

#: Numbers of shape (n,), and such of which one may be infinite or missing.
Numbers = list[float]
Holed = list[float | None]


class Part(BaseModel):
    """A frozen part of the document that refuses unknown fields and numbers that are none."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class Interval(Part):
    """A number with error, 95 % interval (null: unknown), degrees of freedom, and what sensors may add."""

    value: float
    error: float
    low: float | None
    high: float | None
    freedom: float | None = None
    systematic: float = 0.0
