"""What every part of the document is: frozen, refusing unknown fields and numbers that are none."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict

from hersey.errors import sentence

SCHEMA_VERSION: Literal["2"] = "2"

#: Numbers of shape (n,), and such of which one may be infinite or missing.
Numbers = list[float]
Holed = list[float | None]
#: Text that pages and terminal show as it is: whole sentences, or empty.
Sentences = Annotated[str, AfterValidator(sentence)]


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
