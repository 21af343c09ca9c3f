"""Options that belong together stand in the place of their group, and reach the command as one value."""

from __future__ import annotations

import inspect
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

from hersey.cli.groups import argument, grouped, option

SEEN = []


@dataclass(frozen=True)
class Channel:
    """Two options, one of which must be given."""

    name: Annotated[str, option("Its name.")]
    unit: Annotated[str, option("Its unit.")] = "rpm"


@grouped
def look(
    logs: Annotated[list[Path], argument("LOG...", "Logs.")], *, channel: Channel, quiet: bool = False
) -> None:
    """Look at a channel of logs."""
    SEEN.append((logs, channel, quiet))


def test_options_stand_in_the_place_of_their_group() -> None:
    parameters = inspect.signature(look).parameters
    assert list(parameters) == ["logs", "name", "unit", "quiet"]
    assert parameters["name"].default is inspect.Parameter.empty
    assert (parameters["unit"].default, look.__doc__) == ("rpm", "Look at a channel of logs.")


def test_a_command_receives_a_group_as_one_value(tmp_path: Path) -> None:
    """And patterns among logs as the files that they stand for."""
    files = [tmp_path / name for name in ("a.csv", "b.csv")]
    for file in files:
        file.touch()
    look(logs=[tmp_path / "*.csv"], name="speed", unit="rad/s", quiet=True)
    assert [(files, Channel("speed", "rad/s"), True)] == SEEN
