"""Warnings in a campaign's file: every digit is kept, and sentences of earlier versions are read."""

from __future__ import annotations

import json
import sqlite3
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hersey.errors import ROTATION, ParameterError
from hersey.life.campaign import Campaign, store
from hersey.life.campaign.kept_warnings import SENTENCE
from hersey.life.campaign.records import plain, read_json, restored
from hersey.schema.warning import Warning

KINDS = {"warnings": tuple[Warning, ...]}


def kept(*warnings: Any) -> str:
    return json.dumps(plain({"warnings": warnings}))


def test_a_warning_comes_back_with_kind_numbers_and_words() -> None:
    warning = Warning(
        "late",
        "{count:row|rows} of '{column}' at {speed:.3g rpm}",
        severity="act",
        title="{count} late",
        where="bench.csv",
        remedy="set {how}",
        count=np.int64(3),
        column="{speed.real}",
        speed=0.1 + 0.2,
        how=ROTATION,
        shape=None,
    )
    (again,) = restored(read_json(kept(warning)), KINDS)["warnings"]
    assert again.to_dict() == warning.to_dict()
    assert again.values["speed"] == 0.1 + 0.2
    assert type(again.values["count"]) is int
    assert str(again) == "bench.csv: 3 late: Rows of '{speed.real}' at 2.86 rpm. Set rotation."
    assert kept(again) == kept(warning)


def test_sentences_of_an_earlier_version_are_warnings() -> None:
    notes = {"notes": ("the clocks were {aligned}", "a line was cut off")}
    found = restored(read_json(json.dumps(plain(notes))), KINDS)["warnings"]
    assert [each.kind for each in found] == [SENTENCE, SENTENCE]
    assert tuple(map(str, found)) == notes["notes"]
    for said, kinds in (("the shaft {slips}", [SENTENCE]), ("", [])):
        found = restored({"note": said}, KINDS)["warnings"]
        assert [each.kind for each in found] == kinds
        assert "".join(map(str, found)) == said
    with pytest.raises(ParameterError, match="'notes' has a value of the wrong type"):
        restored({"notes": [1]}, KINDS)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"severity": "grave"}, "'Warning.severity' has a value of the wrong type"),
        ({"values": [["count", []]]}, "'Warning.values' has a value of the wrong type"),
        ({"values": [["severity", 1]]}, "'Warning.values' has a value of the wrong type"),
        ({"values": [[1, 1]]}, "'Warning.values' has a value of the wrong type"),
        ({"values": 3}, "'Warning.values' has a value of the wrong type"),
        ({"text": None}, "'Warning.text' has a value of the wrong type"),
        ({"more": 1}, "'Warning.more' is unknown"),
    ],
)
def test_what_is_no_warning_is_refused(change: dict[str, Any], said: str) -> None:
    whole = json.loads(kept(Warning("late", "late")))
    whole["warnings"][0] |= change
    with pytest.raises(ParameterError, match=said):
        restored(whole, KINDS)
    del whole["warnings"][0]["where"]
    with pytest.raises(ParameterError, match="Warning"):
        restored(whole, KINDS)


def test_a_file_of_version_1_is_read_as_it_is_and_brought_up_to_date_when_written(tmp_path: Path) -> None:
    path = tmp_path / "life.hersey"
    Campaign.create(path).close()

    def version(to: int | None = None) -> int:
        with sqlite3.connect(path) as database:
            if to is not None:
                database.execute(f"PRAGMA user_version = {to}")
            return int(database.execute("PRAGMA user_version").fetchone()[0])

    assert version() == store.VERSION == 3
    with sqlite3.connect(path) as database:  # which kept no events then
        database.execute("DROP TABLE events")
    version(1)
    with Campaign.open(path, write=False) as opened:
        assert len(opened) == 0
    assert version() == 1
    Campaign.open(path).close()
    assert version() == 3
