"""Kept sweeps of which files were damaged: told, done again, and never read as numbers."""

from __future__ import annotations

import json
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
import zarr

import hersey
from hersey.errors import OutputError
from hersey.motion.checkpoint import opened_dataset
from tests.scale.test_sweeps import DRAG, GRID, TRAIN, assert_same

#: Chunk 3 of ten of seven sets, and chunk 4.
THIRD, FOURTH = "c/1/1/0", "c/2/0/0"
Damage = Callable[[Path], object]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sweep that is kept, in ten chunks of seven."""
    out = tmp_path_factory.mktemp("damage") / "a.zarr"
    hersey.sweep(TRAIN, DRAG, **GRID, out=out, work=hersey.Work(chunk=7))
    return out


@pytest.fixture
def out(whole: Path, tmp_path: Path) -> Path:
    return Path(shutil.copytree(whole, tmp_path / "a.zarr"))


def flip(path: Path, at: int) -> None:
    data = bytearray(path.read_bytes())
    data[at // 8 % len(data)] ^= 1 << at % 8
    path.write_bytes(data)


def swap(one: Path, other: Path) -> None:
    first, second = one.read_bytes(), other.read_bytes()
    one.write_bytes(second)
    other.write_bytes(first)


def cut(path: Path, size: int) -> None:
    path.write_bytes(path.read_bytes()[:size])


def edit(path: Path, change: Callable[[dict[str, Any]], object]) -> None:
    told = json.loads(path.read_text())
    change(told)
    path.write_text(json.dumps(told))


#: What is done to the files of chunks, and which chunks that is.
CHUNKS: dict[str, tuple[Damage, list[int]]] = {
    "cut off": (lambda out: cut(out / "frequency" / THIRD, 20), [3]),
    "one byte short": (lambda out: cut(out / "speed_max" / THIRD, -1), [3]),
    "empty": (lambda out: cut(out / "kind" / THIRD, 0), [3]),
    "longer": (
        lambda out: (out / "laps" / THIRD).write_bytes((out / "laps" / THIRD).read_bytes() + b"\0"),
        [3],
    ),
    "deleted": (lambda out: (out / "frequency" / THIRD).unlink(), [3]),
    "kind deleted": (lambda out: (out / "kind" / THIRD).unlink(), [3]),
    "other bytes": (lambda out: (out / "frequency" / THIRD).write_bytes(b"torn"), [3]),
    "zeros": (lambda out: (out / "frequency" / THIRD).write_bytes(bytes(60)), [3]),
    "two swapped": (lambda out: swap(out / "frequency" / THIRD, out / "frequency" / FOURTH), [3, 4]),
    "two arrays swapped": (lambda out: swap(out / "speed_min" / THIRD, out / "speed_max" / THIRD), [3]),
    "note cut off": (lambda out: cut(out / "status" / "notes" / "3.json", 20), [3]),
    "note deleted": (lambda out: (out / "status" / "notes" / "3.json").unlink(), [3]),
    "note of another": (
        lambda out: shutil.copy(out / "status" / "notes" / "4.json", out / "status" / "notes" / "3.json"),
        [3],
    ),
    "note of old": (lambda out: (out / "status" / "notes" / "3.json").write_text('{"kinds": {}}'), [3]),
    "note nested deep": (lambda out: (out / "status" / "notes" / "3.json").write_text("[" * 99_999), [3]),
    "status of another byte": (lambda out: (out / "status" / "c" / "3").write_bytes(b"\2"), [3]),
    "an array deleted": (lambda out: shutil.rmtree(out / "frequency" / "c"), list(range(10))),
}


@pytest.mark.parametrize("name", CHUNKS)
def test_a_damaged_chunk_is_done_again_and_told(name: str, out: Path, whole: Path) -> None:
    damage, numbers = CHUNKS[name]
    damage(out)
    found = hersey.sweep(TRAIN, DRAG, **GRID, out=out)
    many = f"{len(numbers)} chunk{'s were' if len(numbers) > 1 else ' was'} damaged and computed again"
    said = f"a.zarr: {many}: {', '.join(map(str, numbers))}"
    assert said in found.attrs["warnings"]
    assert_same(found, hersey.sweep(TRAIN, DRAG, **GRID))
    for file in whole.rglob("*"):
        if file.is_file():
            assert (out / file.relative_to(whole)).read_bytes() == file.read_bytes(), file


@pytest.mark.parametrize("seed", range(20))
def test_a_flipped_bit_is_no_number(seed: int, out: Path) -> None:
    """In any file of a chunk: it is an error where it is read, and done again where the sweep goes on."""
    dice = random.Random(seed)
    names = ["kind", "frequency", "speed_min", "speed_max", "stretch_max", "drag_work", "laps"]
    name, place = dice.choice(names), f"c/{dice.randrange(5)}/{dice.randrange(2)}/0"
    number = 2 * int(place[2]) + int(place[4])
    flip(out / name / place, dice.randrange(100_000))
    with pytest.raises(OutputError, match=rf"a\.zarr: chunk {number} of '{name}' is damaged"):
        opened_dataset(out)[name].load()
    with pytest.raises(ValueError, match="checksum"):  # xarray by itself
        xr.open_zarr(out, chunks=None)[name].load()
    found = hersey.sweep(TRAIN, DRAG, **GRID, out=out)
    assert f"a.zarr: 1 chunk was damaged and computed again: {number}" in found.attrs["warnings"]
    assert_same(found, hersey.sweep(TRAIN, DRAG, **GRID))


@pytest.mark.parametrize(
    "name", ["cut off", "empty", "deleted", "kind deleted", "other bytes", "two swapped", "note deleted"]
)
def test_a_damaged_chunk_is_an_error_where_it_is_read(name: str, out: Path) -> None:
    opened = opened_dataset(out)
    damage, numbers = CHUNKS[name]
    damage(out)
    one_of = "|".join(map(str, numbers))  # several are read at a time
    with pytest.raises(OutputError, match=rf"a\.zarr: chunk ({one_of}) of '[a-z_]+' is damaged or missing"):
        opened.load()


def test_what_is_not_finished_reads_as_missing(out: Path) -> None:
    (out / "status" / "c" / "3").unlink()
    for file in out.glob(f"*/{THIRD}"):
        file.unlink()
    values = opened_dataset(out).frequency.values
    assert np.isnan(values[1, 1]).all()


#: What is done to the rest: it is written again.
REST: dict[str, Damage] = {
    "metadata of an array broken": lambda out: (out / "frequency" / "zarr.json").write_text("{"),
    "metadata of an array deleted": lambda out: (out / "frequency" / "zarr.json").unlink(),
    "attributes missing": lambda out: edit(
        out / "frequency" / "zarr.json", lambda told: told.pop("attributes")
    ),
    "another shape": lambda out: edit(
        out / "frequency" / "zarr.json", lambda told: told.update(shape=[5, 2, 8])
    ),
    "another type": lambda out: edit(out / "kind" / "zarr.json", lambda told: told.update(data_type="int8")),
    "another codec": lambda out: edit(out / "laps" / "zarr.json", lambda told: told["codecs"].pop()),
    "all metadata in one": lambda out: edit(
        out / "zarr.json",
        lambda told: told["consolidated_metadata"]["metadata"]["frequency"].update(shape=[9, 9, 9]),
    ),
    "a coordinate": lambda out: flip(out / "drive_speed" / "c" / "0", 99),
    "a coordinate deleted": lambda out: shutil.rmtree(out / "stiffness"),
    "status without metadata": lambda out: (out / "status" / "zarr.json").unlink(),
}


@pytest.mark.parametrize("name", REST)
def test_damaged_metadata_are_written_again(name: str, out: Path) -> None:
    REST[name](out)
    found = hersey.sweep(TRAIN, DRAG, **GRID, out=out)
    assert any("was damaged or missing and was written again" in each for each in found.attrs["warnings"])
    assert_same(found, hersey.sweep(TRAIN, DRAG, **GRID))


@pytest.mark.parametrize(
    "text", ["", "{", "[]", "{}", '{"attributes": {}}', '{"attributes": {"hersey": 3}}', "[" * 99_999]
)
def test_a_store_that_does_not_say_whose_it_is(text: str, out: Path) -> None:
    (out / "zarr.json").write_text(text)
    with pytest.raises(OutputError, match=r"a\.zarr exists and was not made by a hersey sweep"):
        hersey.sweep(TRAIN, DRAG, **GRID, out=out)


def test_a_store_of_an_older_hersey_is_read_and_does_not_go_on(out: Path) -> None:
    """Its chunks cannot be checked."""
    edit(out / "zarr.json", lambda told: told["attributes"]["hersey"].update(format=1))
    with pytest.raises(
        OutputError, match=r"a\.zarr was written by an older.*resume=False and overwrite=True"
    ):
        hersey.sweep(TRAIN, DRAG, **GRID, out=out)
    assert xr.open_zarr(out, chunks=None).frequency.shape == (5, 2, 7)


def test_checksums_are_those_of_the_format(out: Path) -> None:
    """The library that is not ours reads and checks them."""
    group = zarr.open_group(out, mode="r")
    names = [codec["name"] for codec in json.loads((out / "frequency" / "zarr.json").read_text())["codecs"]]
    assert names == ["bytes", "blosc", "crc32c"]
    assert np.array_equal(group["frequency"][:], opened_dataset(out).frequency.values, equal_nan=True)
