"""What must be fixed before a run: files, channels, mapping and machine that cannot be used as they are."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from hersey.app.analysis import Analysis, Dropped
from hersey.app.channels import Fault, channel_faults
from hersey.app.machine import answer_faults, doubtful, file_faults, mapping_faults
from hersey.log.roles import ROLES


def check(one: Analysis) -> None:
    """Look for problems again; it may take a moment where the machine file names a log."""
    faults = [
        _of_file(file, "", file.fault, file.fault.split(":")[0][:60])
        for file in one.files.values()
        if file.state == "fault"
    ]
    faults += [*_channel_faults(one, one.logs), *_machine_faults(one)]
    one.faults = [fault for fault in faults if not (fault.keep and fault.key in one.kept)]
    one.revision += 1  # last: a page that asks meanwhile asks again


def _of_file(file: Dropped, title: str, text: str, short: str) -> Fault:
    return Fault(f"file:{file.id}", title, text, f"{file.name}: {short}", "Remove", {"remove": file.id})


def _channel_faults(one: Analysis, logs: list[Dropped]) -> list[Fault]:
    if not logs:
        return []
    asked = {"every": "time.every", "radius": "radius.value", "motor_constant": "torque.motor_constant"}
    said = {name: one.corrections.get(key, "") for name, key in asked.items()}
    faults = channel_faults(logs[0].look, one.choices, one.options | said)
    used = {name for name, choice in one.choices.items() if choice["role"] in ROLES}
    for other in logs[1:]:
        if absent := sorted((used & logs[0].names) - other.names):
            text = f"It has no channel “{absent[0]}”. All logs of one analysis need the same channels."
            faults.append(_of_file(other, "", text, "other channels"))
    for role, stated in one.mapped.items():
        if not logs[0].channel(stated) and (role != "temperature" or not one.options["isothermal"]):
            faults = [fault for fault in faults if fault.at != f"lacking:{role}"]
            faults.append(_not_there(role, stated, one.choices))
    return faults or mapping_faults(one.mapping_answers(), one.mapping_tables(), one.folder, _dropped(one))


def _dropped(one: Analysis) -> dict[str, Path]:
    return {file.name: file.path for file in one.files.values() if file.state == "ready"}


def _machine_faults(one: Analysis) -> list[Fault]:
    if one.mode == "form" and (faults := answer_faults(one.answers, one.points)):
        return faults
    faults = file_faults(one.machine_file(), one.folder, _dropped(one))
    return faults + (doubtful(one.answers) if one.mode == "form" else [])


def _not_there(role: str, stated: str, choices: Mapping[str, Mapping[str, str]]) -> Fault:
    """The fault of a channel that the mapping names and the log does not have."""
    now = next((name for name, choice in choices.items() if choice["role"] == role), "")
    title = f"The mapping names the {role} channel “{stated}”, which this log does not have."
    link = f"choose the {role} channel"
    text = "Choose one in the column Role."
    if not now:
        return Fault(f"lacking:{role}", title, text, link)
    return Fault(f"lacking:{role}", title, "", link, f"Use “{now}”", {"roles": {now: role}})
