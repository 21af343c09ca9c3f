"""The ages of a life test in other uses, in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.document.parts.time_to_failure import SpanPart
from hersey.schema.part import Numbers, Part


class UseEndPart(Part):
    """The first end in a use, of a unit or a share of new units."""

    name: str
    age: SpanPart
    ways: str = Field(description="which way comes first, in words; empty for a share of new units")


class UsePart(Part):
    """One use of the machine, and the first ends in it."""

    torque_limit: float | None = Field(description="N m")
    coldest: float | None = Field(description="coldest start, K")
    duty: str
    stated: bool = Field(description="the use that the machine's file states")
    ends: list[UseEndPart] = Field(description="units, then a tenth and half of new units; empty if not told")


class OtherUsesPart(Part):
    """Every combination of limits, coldest starts and duties, in this order of the lists."""

    age_unit: str
    torque_limits: Numbers = Field(description="N m")
    coldest: Numbers = Field(description="K")
    duties: list[str]
    uses: list[UsePart]
