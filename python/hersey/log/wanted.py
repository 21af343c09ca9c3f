"""What the user wants of a log, in one piece from `hersey.read` to the readers."""

from __future__ import annotations

from dataclasses import dataclass

from hersey.errors import ISOTHERMAL, ChannelError, ParameterError
from hersey.log.channels import ChannelChoice, Stated
from hersey.log.derived.given import Derived
from hersey.log.roles import EVERY, ROLES


@dataclass(frozen=True)
class Wanted:
    """What the user says of a log: a choice for each role, what a file need not hold, what is left out.

    A log of a wheel that coasts down is read ``without_torque``. ``names`` are those of all files that are
    read together.

    Raises
    ------
    ParameterError
        If both a column of the time and the time between rows are given.
    ChannelError
        If temperature is excluded and its column named.
    """

    choices: dict[str, ChannelChoice]
    stated: Stated
    isothermal: bool = False
    drop_missing: bool = False
    without_torque: bool = False
    derived: Derived = Derived()  # noqa: RUF009 # frozen
    names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Refuse what contradicts itself."""
        if self.stated.every is not None and self.choices["time"] != ChannelChoice():
            raise ParameterError(
                f"{EVERY.to()} sets the time between rows. Do not name a time column as well"
            )
        if self.isothermal and self.choices["temperature"] != ChannelChoice():
            said = f"{ISOTHERMAL.to()} excludes temperature"
            raise ChannelError(said, remedy="do not name a temperature column")

    @property
    def needs_parts(self) -> bool:
        """Whether a channel is to be made of something else than a column of its own."""
        named = any(self.choices[role].name for role in ("position", "direction") if role in self.choices)
        return named or bool(self.derived.channels)

    @property
    def roles(self) -> tuple[str, ...]:
        """Roles that a channel must play."""
        without = {
            "temperature": self.isothermal,
            "time": self.stated.every is not None,
            "torque": self.without_torque,
        }
        return tuple(role for role in ROLES if not without.get(role))
