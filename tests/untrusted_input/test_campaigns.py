"""Untrusted campaign files: each is read, or refused with one error that names file and fault."""

from __future__ import annotations

import json
import random
import shutil
import sqlite3
import struct
import tracemalloc
from collections.abc import Callable
from contextlib import closing
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest

from hersey.errors import HerseyError
from hersey.life.campaign import Campaign, content, guarded, store
from hersey.life.campaign.entry import COLUMNS
from tests.cli.command import Done, run
from tests.conftest import ROOT, mostly_nightly
from tests.life.shipped import write
from tests.life.test_campaign import means

Spoil = Callable[[sqlite3.Connection], object]
ENDLESS = "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x FROM c)"
RUN_COLUMNS = [row.split()[0] for row in store._SCHEMA.partition("runs (")[2].partition(");")[0].split(",")]
#: Most memory that Python may take to refuse a file, bytes.
MOST_MEMORY = 60e6
_FOLDER = TemporaryDirectory()


@cache
def sound() -> Path:
    """A campaign as hersey writes it."""
    return write(Path(_FOLDER.name) / "sound.hersey", 2)


def spoiled(folder: Path, spoil: Spoil) -> Path:
    path = folder / "life.hersey"
    shutil.copy(sound(), path)
    with closing(sqlite3.connect(path, isolation_level=None)) as database:
        spoil(database)
        database.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    return path


def typed(folder: Path) -> dict[str, Done]:
    """Every verb that reads a campaign."""
    means(folder / "run.csv")
    machine = str(ROOT / "tests" / "stand" / "machine.toml")  # which names no log that is read first
    verbs = {
        "list": ("campaign", "list", "life.hersey"),
        "show": ("campaign", "show", "life.hersey", "U1"),
        "check": ("campaign", "check", "life.hersey"),
        "export": ("campaign", "export", "life.hersey", "--out", "out.csv", "--force"),
        "life": ("life", "life.hersey", "--machine", machine, "--json"),
        "add": ("campaign", "add", "life.hersey", "run.csv", "--unit", "U1", "--age", "9 pages"),
    }
    return {verb: run(*arguments, cwd=folder) for verb, arguments in verbs.items()}


def refused(done: Done, words: str) -> None:
    """It ended with one clear error that names the file."""
    assert done.returncode != 0, done.stdout[-300:]
    assert "Traceback" not in done.stderr
    assert "life.hersey" in done.stderr, done.stderr[-500:]
    assert words in " ".join(done.stderr.split()), done.stderr[-500:]
    assert len(done.stderr) < 1000


def execute(*statements: str) -> Spoil:
    return lambda database: [database.execute(each) for each in statements]


def as_schema(*edits: tuple[str, str], and_then: str) -> Spoil:
    """Let values in that the schema forbids, then say that it is as it was."""

    def spoil(database: sqlite3.Connection) -> None:
        before = database.execute("SELECT name, sql FROM sqlite_master").fetchall()
        database.execute("PRAGMA writable_schema = ON")
        for old, new in edits:
            database.execute("UPDATE sqlite_master SET sql = replace(sql, ?, ?)", (old, new))
        database.execute("PRAGMA writable_schema = RESET")
        database.execute(and_then)
        database.execute("PRAGMA writable_schema = ON")
        for name, sql in before:
            database.execute("UPDATE sqlite_master SET sql = ? WHERE name = ?", (sql, name))
        database.execute("PRAGMA writable_schema = RESET")

    return spoil


COLUMNS_OF_RUNS = ", ".join(f"x AS {name}" for name in RUN_COLUMNS)
#: What a stranger may have put into the schema, and what the error says.
TABLES: dict[str, tuple[Spoil, str]] = {
    "endless view for runs": (
        execute("DROP TABLE runs", f"CREATE VIEW runs AS {ENDLESS} SELECT {COLUMNS_OF_RUNS} FROM c"),
        "view 'runs'",
    ),
    "endless view for dwells": (
        execute("DROP TABLE dwells", f"CREATE VIEW dwells AS {ENDLESS} SELECT x AS run_id FROM c"),
        "view 'dwells'",
    ),
    "endless view for campaign": (
        execute("DROP TABLE campaign", f"CREATE VIEW campaign AS {ENDLESS} SELECT x AS value FROM c"),
        "view 'campaign'",
    ),
    "a view more": (execute("CREATE VIEW mine AS SELECT 1"), "view 'mine'"),
    "trigger": (
        execute(
            f"CREATE TRIGGER t AFTER INSERT ON runs BEGIN INSERT INTO campaign {ENDLESS} "
            "SELECT x, x FROM c; END"
        ),
        "trigger 't'",
    ),
    "trigger that removes": (
        execute("CREATE TRIGGER t AFTER INSERT ON runs BEGIN DELETE FROM runs; END"),
        "trigger 't'",
    ),
    "index with expression": (execute("CREATE INDEX i ON runs (abs(age))"), "index 'i'"),
    "partial index": (execute("CREATE INDEX i ON runs (age) WHERE age > 1"), "index 'i'"),
    "index of another kind": (
        execute("DROP INDEX runs_of_a_unit", "CREATE INDEX runs_of_a_unit ON runs (unit, abs(age))"),
        "index 'runs_of_a_unit'",
    ),
    "generated column": (
        execute("ALTER TABLE runs ADD COLUMN g AS (zeroblob(1000000000))"),
        "table 'runs' is not the one that hersey creates",
    ),
    "full-text search": (execute("CREATE VIRTUAL TABLE f USING fts5(x)"), "'f'"),
    "virtual table of trees": (execute("CREATE VIRTUAL TABLE r USING rtree(id, a, b)"), "'r'"),
    "a table more": (execute("CREATE TABLE mine (x)"), "table 'mine'"),
    "a table of terminal codes": (execute("CREATE TABLE '\x1b[2J' (x)"), "which does not belong there"),
    "cyclic references": (
        execute(
            "CREATE TABLE a (x PRIMARY KEY REFERENCES b (x))",
            "CREATE TABLE b (x PRIMARY KEY REFERENCES a (x))",
        ),
        "which does not belong there",
    ),
    "a table less": (execute("DROP TABLE dwells"), "no table 'dwells'"),
    "an index less": (execute("DROP INDEX runs_of_a_file"), "no index 'runs_of_a_file'"),
    "another default": (
        execute(
            "PRAGMA writable_schema = ON",
            "UPDATE sqlite_master SET sql = replace(sql, 'exponent REAL', 'exponent REAL DEFAULT (hex(1))')",
        ),
        "table 'runs' is not the one that hersey creates",
    ),
    "statistics of a planner": (execute("ANALYZE"), "table 'sqlite_stat1'"),
    "another program's": (execute("PRAGMA application_id = 7"), "is not a campaign file"),
    "no program's": (execute("PRAGMA application_id = 0"), "is not a campaign file"),
    "a newer version": (execute(f"PRAGMA user_version = {store.VERSION + 1}"), "a newer version"),
    "version 0": (execute("PRAGMA user_version = 0"), "version 0"),
    "version -1": (execute("PRAGMA user_version = -1"), "version -1"),
    "twenty thousand tables": (
        execute(
            "PRAGMA writable_schema = ON",
            "WITH RECURSIVE c(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM c WHERE x < 20000) INSERT INTO "
            "sqlite_master SELECT 'view', 'v' || x, 'v' || x, 0, 'CREATE VIEW v' || x || ' AS SELECT 1' "
            "FROM c",
        ),
        "more work than",
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_other_tables_are_refused(name: str, tmp_path: Path) -> None:
    spoil, words = TABLES[name]
    path = spoiled(tmp_path, spoil)
    for verb, done in typed(tmp_path).items():
        if verb == "add" and name in ("version 0", "version -1"):
            words = "cannot update"
        refused(done, words)
        assert "\x1b" not in done.stderr
    with pytest.raises(HerseyError):
        Campaign.open(path)


TEXT, BLOB, HUGE = "'no'", "x'ff00'", "printf('%.*c', 30000000, 'x')"
SOME = {
    "INTEGER": (TEXT, BLOB, "1.5", "-1", "9e999", "NULL"),
    "REAL": (HUGE, TEXT, BLOB, "9e999", "-9e999", "1e308"),
    "TEXT": (HUGE, BLOB, "NULL"),
}
VALUES = {
    **{("dwells", name): SOME[kind] for name, kind in COLUMNS.items()},
    ("dwells", "run_id"): ("77",),
    ("dwells", "number"): (TEXT, "-1"),
    ("runs", "unit"): (BLOB, "''", "NULL", HUGE, "printf('%.*c', 61, 'x')"),
    ("runs", "age"): (TEXT, BLOB, "-1", "9e999", "1e300", "NULL"),
    ("runs", "path"): ("7", "''", "NULL", HUGE, "'a' || char(0)"),
    ("runs", "sha256"): (BLOB, "NULL", HUGE),
    ("runs", "written"): (TEXT, BLOB, "9e999"),
    ("runs", "added"): (BLOB, "NULL", HUGE),
    ("runs", "version"): (BLOB, "NULL", HUGE),
    ("runs", "settings"): (BLOB, "NULL", HUGE),
    ("runs", "reduction"): (BLOB, "NULL", HUGE),
    ("runs", "fit"): (BLOB, HUGE),
    ("runs", "no_fit"): (BLOB, "NULL", HUGE, "'a reason'"),
    ("runs", "dwells"): (TEXT, BLOB, "-1", "1.5", "NULL", "77", "9223372036854775807"),
    ("runs", "exponent"): (TEXT, BLOB, "9e999"),
    ("runs", "transition_speed"): (TEXT, "-1", "9e999"),
    ("campaign", "name"): ("'mine'", BLOB),
    ("campaign", "value"): (BLOB, "7", "''", "'two words'", HUGE),
    ("sqlite_sequence", "seq"): (TEXT, "NULL", "-1", "9223372036854775807"),
}
LOOSE = (("NOT NULL", ""), ("CHECK (age >= 0)", ""), ("REFERENCES runs (id) ON DELETE CASCADE", ""))


#: Columns with rules of their own, and one of each kind: all others go through the same check of the schema.
OWN_RULES = (
    *(("runs", name) for name in ("unit", "age", "path", "fit", "dwells", "exponent", "transition_speed")),
    *(("dwells", name) for name in ("run_id", "number", *list(COLUMNS)[:2])),
    *(key for key in VALUES if key[0] in ("campaign", "sqlite_sequence")),
)


@pytest.mark.parametrize(("table", "column"), mostly_nightly(VALUES, *OWN_RULES))
def test_a_value_that_no_campaign_has(table: str, column: str, tmp_path: Path) -> None:
    """Of a run it is refused by every verb, of a dwell by those that read dwells."""
    for value in VALUES[table, column]:
        where = {"runs": "WHERE id = 2", "dwells": "WHERE run_id = 2 AND number = 1"}.get(table, "")
        change = f'UPDATE {table} SET "{column}" = {value} {where}'
        path = spoiled(tmp_path, as_schema(*LOOSE, and_then=change))
        tracemalloc.start()
        try:
            with pytest.raises(HerseyError) as raised, Campaign.open(path, write=False) as opened:
                opened.dwells()
            assert tracemalloc.get_traced_memory()[1] < MOST_MEMORY, value
        finally:
            tracemalloc.stop()
        assert str(raised.value).startswith("life.hersey "), value
        assert len(str(raised.value)) < 500
    for verb, done in typed(tmp_path).items():
        if table != "dwells" or verb in ("check", "export", "life"):
            refused(done, "is damaged" if (table, column) != ("runs", "dwells") else "life.hersey")
        else:
            assert done.returncode == 0, done.stderr


def of_reduction(change: Callable[[dict[str, object]], object]) -> Spoil:
    def spoil(database: sqlite3.Connection) -> None:
        held = json.loads(database.execute("SELECT reduction FROM runs WHERE id = 2").fetchone()[0])
        changed = change(held)
        text = changed if isinstance(changed, str) else json.dumps(held)
        database.execute("UPDATE runs SET reduction = ? WHERE id = 2", (text,))

    return spoil


def rest(**changes: object) -> dict[str, object]:
    estimate = {
        "kind": "Estimate",
        "value": 0.0,
        "error": 0.0,
        "low": 0.0,
        "high": 0.0,
        "freedom": 1e9,
        "systematic": 0.0,
    }
    whole = {
        "kind": "NoLoadTorque",
        "constant": {**estimate, "value": 1e-4, "low": 1e-4, "high": 1e-4},
        "per_speed": estimate,
        "temperature_slope": estimate,
        "reference_temperature": None,
        "covariance": {"array": [[0.0] * 3] * 3, "shape": [3, 3]},
        "freedom": 1e9,
        "source": "stated",
    }
    return whole | changes


BIG = {"array": [[-1.0, 0, 0], [0, 0, 0], [0, 0, 0]], "shape": [3, 3]}
WRONG_REST = {
    "no record": {"rest": 7},
    "another record": {"rest": {"kind": "Sensors"}},
    "unknown record": {"rest": {"kind": "Path", "x": 1}},
    "kind is a list": {"rest": {"kind": []}},
    "text for a number": {"rest": rest(constant="no")},
    "missing key": {"rest": {"kind": "NoLoadTorque"}},
    "unknown key": {"rest": rest(mine=1)},
    "NaN": {"rest": rest(reference_temperature=float("nan"))},
    "below 0 K": {"rest": rest(reference_temperature=-1.0)},
    "negative variance": {"rest": rest(covariance=BIG)},
    "shape of another size": {"rest": rest(covariance={"array": [1.0], "shape": [3, 3]})},
    "shape beyond memory": {"rest": rest(covariance={"array": [1.0], "shape": [10**9, 10**9]})},
    "ragged": {"rest": rest(covariance={"array": [[1.0], [1.0, 2.0]], "shape": [3]})},
    "no freedom": {"rest": rest(freedom=-1.0)},
    "range turned round": {"rest": rest(speed_range=[2.0, 1.0])},
}
WRONG_JSON: dict[str, Callable[[dict[str, object]], object]] = {
    "no JSON": lambda _: "{",
    "nested deep": lambda _: "[" * 100_000,
    "nested deep, closed": lambda _: '{"a":' * 50_000 + "1" + "}" * 50_000,
    "digits without end": lambda _: "1" * 100_000,
    "a list": lambda _: "[]",
    "null": lambda _: "null",
    "empty": lambda _: "{}",
    "a log that is a number": lambda held: held.update(log=7),
    "sensors that are text": lambda held: held.update(log={"sensors": "no"}),
    "a sensor below nothing": lambda held: held.update(
        log={"sensors": {"kind": "Sensors", "temperature_zero": -5.0}}
    ),
    "a sensor without end": lambda held: held.update(
        log={"sensors": {"kind": "Sensors", "torque_gain": float("inf")}}
    ),
    **{name: lambda held, change=change: held.update(change) for name, change in WRONG_REST.items()},  # type: ignore[misc]
}


#: Of each kind of fault: of the text, of what it holds, of a record, and of an array.
FAULTS = ("nested deep", "a list", "a log that is a number", "a sensor without end", "unknown record")
ARRAYS = ("text for a number", "missing key", "NaN", "negative variance", "shape beyond memory", "ragged")


@pytest.mark.parametrize("name", mostly_nightly(WRONG_JSON, *FAULTS, *ARRAYS))
def test_json_inside_that_no_campaign_has(name: str, tmp_path: Path) -> None:
    path = spoiled(tmp_path, of_reduction(WRONG_JSON[name]))
    done = typed(tmp_path)
    for verb in ("export", "life"):
        refused(done[verb], "'reduction' of run 2")
    with Campaign.open(path, write=False) as opened:
        with pytest.raises(HerseyError, match="'reduction' of run 2"):
            opened.points(2)
        assert opened.runs().height == 13  # with the one added


@pytest.mark.parametrize("column", ["fit", "settings"])
def test_a_fit_or_settings_that_are_no_json(column: str, tmp_path: Path) -> None:
    for text in ("{", "[" * 100_000, "[]", "7"):
        path = spoiled(
            tmp_path, lambda db, text=text: db.execute(f"UPDATE runs SET {column} = ? WHERE id = 2", (text,))
        )  # type: ignore[misc]
        with (
            Campaign.open(path, write=False) as opened,
            pytest.raises(HerseyError, match=f"'{column}' of run 2"),
        ):
            getattr(opened, column)(2)


def test_what_is_no_whole_file(tmp_path: Path) -> None:
    path, whole = tmp_path / "life.hersey", sound().read_bytes()
    contents = {
        "no SQLite": b"speed,torque\n1,2\n" * 100,
        "the head alone": whole[:16],
        "a header alone": whole[:100],
        "a page": whole[:4096],
        "half": whole[: len(whole) // 2],
        "one byte short": whole[:-1],
        "one page short": whole[:-4096],
        "a page of zeros": whole[:4096] + bytes(4096) + whole[8192:],
        "pages swapped": whole[:4096] + whole[8192:12288] + whole[4096:8192] + whole[12288:],
        "a size of page that is none": whole[:16] + b"\x00\x03" + whole[18:],
    }
    for name, data in contents.items():
        path.write_bytes(data)
        for verb, done in typed(tmp_path).items():
            assert done.returncode != 0, (name, verb)
            refused(done, "life.hersey")
    path.write_bytes(b"")  # as a writer that was killed leaves it: the next makes it
    done = typed(tmp_path)
    assert done.pop("add").returncode == 0
    for each in done.values():
        refused(each, "is not a campaign file")


def test_flipped_bits_end_in_one_error_or_are_read(tmp_path: Path) -> None:
    path, whole = tmp_path / "life.hersey", sound().read_bytes()
    dice, errors = random.Random(5), list[str]()
    for _ in range(300):
        data = bytearray(whole)
        for _ in range(dice.choice((1, 1, 20))):
            data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)
        path.write_bytes(data)
        try:
            with Campaign.open(path, write=False) as opened:
                opened.summary()
                opened.dwells()
        except HerseyError as error:
            errors.append(str(error))
        for side in ("-wal", "-shm"):
            path.with_name(f"life.hersey{side}").unlink(missing_ok=True)
    assert len(errors) > 50
    assert all(error.startswith("life.hersey ") for error in errors)


def test_a_tree_that_leads_back_to_itself(tmp_path: Path) -> None:
    """Counting its rows would never end."""
    path = spoiled(tmp_path, execute())
    data = bytearray(path.read_bytes())
    with closing(sqlite3.connect(path)) as database:
        size = database.execute("PRAGMA page_size").fetchone()[0]
        root = database.execute("SELECT rootpage FROM sqlite_master WHERE name = 'dwells'").fetchone()[0]
    start = (root - 1) * size
    struct.pack_into(">I", data, start + 8, root)  # the last child is the page itself
    path.write_bytes(data)
    for done in typed(tmp_path).values():
        refused(done, "is damaged")


def test_side_files_of_others(tmp_path: Path) -> None:
    """A log of SQLite that is not of this file is left alone."""
    path = spoiled(tmp_path, execute())
    for content_ in (b"", b"no log", random.Random(1).randbytes(10_000)):
        for side in ("-wal", "-shm", "-journal"):
            path.with_name(path.name + side).write_bytes(content_)
            if side != "-journal":  # which only a writer can remove
                with Campaign.open(path, write=False) as opened:
                    assert opened.runs()["unit"].n_unique() == 2
            with Campaign.open(path) as opened:
                assert opened.runs()["unit"].n_unique() == 2
            path.with_name(path.name + side).unlink(missing_ok=True)


def test_what_a_log_of_sqlite_brings_is_checked_too(tmp_path: Path) -> None:
    path = spoiled(tmp_path, execute())
    with closing(sqlite3.connect(path, isolation_level=None)) as database:
        database.execute("PRAGMA wal_autocheckpoint = 0")
        database.execute("CREATE VIEW mine AS SELECT 1")
        wal = path.with_name("life.hersey-wal").read_bytes()
    other = tmp_path / "other"
    other.mkdir()
    shutil.copy(sound(), other / "life.hersey")
    (other / "life.hersey-wal").write_bytes(wal)
    with pytest.raises(HerseyError, match="view 'mine'"):
        Campaign.open(other / "life.hersey")


def test_a_journal_deletes_no_other_file(tmp_path: Path) -> None:
    """SQLite removes the file that a rollback journal names as the one of several databases."""
    path, victim = spoiled(tmp_path, execute()), tmp_path / "victim.txt"
    victim.write_text("mine")
    name = str(victim).encode()
    sector = 512
    head = bytes.fromhex("d9d505f920a163d7") + struct.pack(
        ">5I", 0, 0, len(path.read_bytes()) // 4096, sector, 4096
    )
    tail = struct.pack(">I", 4096 * 0 + (0x40000000 // 4096) + 1) + name
    tail += struct.pack(">2I", len(name), sum(name)) + bytes.fromhex("d9d505f920a163d7")
    path.with_name("life.hersey-journal").write_bytes(head.ljust(sector, b"\0") + tail)
    for done in typed(tmp_path).values():
        assert "Traceback" not in done.stderr
    assert victim.read_text() == "mine"


def test_rows_beyond_number(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoiled(tmp_path, execute())
    monkeypatch.setattr(content, "MOST_RUNS", 3)
    for done in typed(tmp_path).values():
        refused(done, "at most 3 are allowed")
    monkeypatch.undo()
    monkeypatch.setattr(content, "MOST_DWELLS", 9)
    for done in typed(tmp_path).values():
        refused(done, "at most 9 are allowed")


def test_work_is_counted_and_ended() -> None:
    """Each statement by itself: what one took is not held against the next."""
    with closing(guarded.connect(Path(_FOLDER.name) / "work", mode="mode=memory")) as database:
        for _ in range(3):
            with pytest.raises(sqlite3.OperationalError, match="interrupted"):
                database.execute(f"{ENDLESS} SELECT count(*) FROM c")
            assert database.work == database.allowed + guarded._COUNTED
        with pytest.raises(sqlite3.DataError, match="too big"):
            database.execute("SELECT zeroblob(8000001)").fetchone()


def test_a_sound_campaign_takes_a_tenth_of_the_work_it_may(tmp_path: Path) -> None:
    path = spoiled(tmp_path, execute())
    most = 0
    with Campaign.open(path, write=False) as opened:
        database = opened._database
        assert isinstance(database, guarded.GuardedConnection)
        assert database.allowed > guarded._LEAST
        database.set_trace_callback(None)
        for read in (opened.summary, opened.dwells, opened.check):
            read()
            most = max(most, database.work)
    assert 10 * most < database.allowed
