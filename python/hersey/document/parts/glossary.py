"""Terms of the glossary in the document."""

from __future__ import annotations

from pydantic import Field

from hersey.schema.part import Part


class TermPart(Part):
    """A term of the glossary."""

    term: str = Field(description="the term")
    also: list[str] = Field(description="other spellings and symbols")
    text: str = Field(description="meaning, with symbol and unit")
    see: list[str] = Field(description="terms to read next")


class GlossaryPart(Part):
    """Terms of the glossary: the one asked for, or all of them in alphabetical order."""

    terms: list[TermPart] = Field(description="terms with their meanings")
