"""The closed table of what can go wrong for a user, each error also the matching built-in."""

from __future__ import annotations


class HerseyError(Exception):
    """A mistake that the user can mend; the message says what is wrong and the way out."""

    def __str__(self) -> str:
        """Return the message on one line."""
        return " ".join(str(part) for part in self.args)


class MissingFileError(HerseyError, FileNotFoundError):
    """A file that is not there, or is not a file."""


class UnreadableLogError(HerseyError, ValueError):
    """A log whose text cannot be read as a table of numbers."""


class ChannelError(HerseyError, LookupError):
    """A channel that cannot be found, or could be several."""


class UnitError(HerseyError, ValueError):
    """A unit that is missing, unknown or of the wrong dimension."""


class WrongKindError(UnitError):
    """A known unit, of another kind of quantity."""


class InsufficientDataError(HerseyError, ValueError):
    """Data that cannot answer the question asked of it."""


class ParameterError(HerseyError, ValueError):
    """A parameter outside what the physics allows."""


class OutputError(HerseyError, OSError):
    """A result that cannot be written, or would overwrite something."""


class ExtrapolationWarning(UserWarning):
    """A fitted law is used outside the range of its data."""
