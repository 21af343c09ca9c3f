"""What every law of torque has: parameters with names."""

from __future__ import annotations


class Named:
    """A law whose parameters have names, and no corner if it does not say so."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the parameters, in order."""
        raise NotImplementedError

    @property
    def broken(self) -> bool:
        """Whether there are two branches that meet in a corner."""
        return False

    def index(self, name: str) -> int:
        """Return where a parameter stands."""
        return self.names.index(name)
