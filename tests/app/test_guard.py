"""Who is not the page of this start is refused, and nothing of the disk can be asked for."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from pathlib import Path

import pytest

from hersey.app.checking import check
from hersey.app.guard import POLICY, SANDBOX
from hersey.app.machine import file_faults
from hersey.app.uploads import Bounds, clean_name
from tests.app.asking import OWN, PORT, TOKEN, Asked, run
from tests.app.test_mistakes import log


@pytest.fixture
def asked(tmp_path: Path) -> Asked:
    return Asked(tmp_path)


def test_the_page_of_this_start_is_answered(asked: Asked) -> None:
    page = asked.ask("GET", "/", x_hersey_token=None, origin=None)
    assert page.status == 200
    assert page.headers["content-security-policy"] == POLICY
    assert page.headers["x-content-type-options"] == "nosniff"
    assert page.headers["referrer-policy"] == "no-referrer"
    assert "access-control-allow-origin" not in page.headers
    for name in (
        "app.js",
        "building.js",
        "channels.js",
        "machine.js",
        "analyses.js",
        "app.css",
        "tokens.css",
    ):
        assert asked.ask("GET", f"/{name}", x_hersey_token=None, origin=None).status == 200
    assert asked.ask("GET", "/api/state", origin=None).status == 200
    assert asked.ask("POST", "/api/analyses").status == 200
    assert asked.ask("GET", "/api/state", host=f"localhost:{PORT}", origin=None).status == 200


@pytest.mark.parametrize(
    "wrong",
    [
        {"host": f"evil.example:{PORT}"},
        {"host": "127.0.0.1"},
        {"host": f"127.0.0.1:{PORT + 1}"},
        {"host": f"127.0.0.1.evil.example:{PORT}"},
        {"host": None},
        {"origin": "https://evil.example"},
        {"origin": "null"},
        {"origin": f"http://127.0.0.1:{PORT + 1}"},
        {"origin": f"https://127.0.0.1:{PORT}"},
        {"origin": f"http://localhost:{PORT}"},
        {"origin": None},
        {"sec_fetch_site": "cross-site"},
        {"sec_fetch_site": "same-site"},
        {"x_hersey_token": None},
        {"x_hersey_token": ""},
        {"x_hersey_token": TOKEN + "x"},
        {"x_hersey_token": TOKEN[:-1]},
        {"x_hersey_token": "\u00e9"},
    ],
)
def test_hostile_requests_are_refused(asked: Asked, wrong: dict[str, str | None]) -> None:
    before = len(asked.session.analyses)
    for method, path in (
        ("POST", "/api/analyses"),
        ("POST", f"/api/analyses/{asked.first}/files"),
        ("DELETE", f"/api/analyses/{asked.first}"),
    ):
        answer = asked.ask(method, path, **wrong)
        assert answer.status == 403
        assert answer.headers["x-content-type-options"] == "nosniff"
        assert TOKEN.encode() not in answer.body
    assert len(asked.session.analyses) == before
    if wrong.keys() & {"host", "x_hersey_token"}:
        assert asked.ask("GET", "/api/state", **{"origin": None, **wrong}).status == 403


def test_two_hosts_are_none(asked: Asked) -> None:
    async def twice() -> int:
        scope = {
            "type": "http",
            "method": "GET",
            "path": "/",
            "headers": [(b"host", OWN["host"].encode())] * 2,
        }
        sent: list[int] = []

        async def send(message: dict[str, int]) -> None:
            sent.append(message.get("status", 0))

        await asked.app(scope, None, send)  # type: ignore[arg-type]
        return sent[0]

    assert run(twice()) == 403


def test_a_token_in_the_address_is_none(asked: Asked) -> None:
    assert asked.ask("GET", f"/api/state?token={TOKEN}", x_hersey_token=None).status == 403


@pytest.mark.parametrize(
    "path",
    [
        "/../../etc/passwd",
        "/static/../app.py",
        "/..%2f..%2fetc/passwd",
        "/report/../../etc/passwd",
        "/report/..%2f..%2fetc%2fpasswd",
        "/report//etc/passwd",
        "/app.html/../../guard.py",
        "/guard.py",
        "/static/app.js",
        "//etc/passwd",
        "/report/" + "x" * 5000,
    ],
)
def test_no_path_of_the_disk_can_be_asked_for(asked: Asked, path: str) -> None:
    answer = asked.ask("GET", path)
    assert answer.status == 404
    assert b"root:" not in answer.body
    of_api = asked.ask("GET", f"/api/analyses/{asked.first}/..{path}")
    assert of_api.status == 404


@pytest.mark.parametrize(
    ("method", "path"),
    [
        ("GET", "/api/analyses"),
        ("PUT", "/api/state"),
        ("POST", "/"),
        ("DELETE", "/report/x"),
        ("OPTIONS", "/api/state"),
    ],
)
def test_another_method_is_refused(asked: Asked, method: str, path: str) -> None:
    answer = asked.ask(method, path)
    assert answer.status == 405
    assert "access-control-allow-origin" not in answer.headers


@pytest.mark.parametrize(
    ("name", "clean"),
    [
        ("../../etc/passwd", "passwd"),
        ("..\\..\\boot.ini", "boot.ini"),
        ("..", "log"),
        ("", "log"),
        ("/etc/cron.d/x", "x"),
        (".bashrc", "bashrc"),
        ("a\x00b.csv", "a_x00b.csv"),
        ("nul:stream.csv", "nul_stream.csv"),
        ("x" * 300 + ".csv", "x" * 116 + ".csv"),
        ("\u202egpj.exe", "_u202egpj.exe"),
        ("Maß 3.csv", "Maß 3.csv"),
    ],
)
def test_names_lead_nowhere(name: str, clean: str, tmp_path: Path) -> None:
    cleaned = clean_name(name)
    assert cleaned.replace("\\", "_") == clean
    assert (tmp_path / cleaned).resolve().parent == tmp_path.resolve()


def test_a_file_lies_in_the_private_folder_whatever_it_is_called(asked: Asked) -> None:
    async def dropped() -> Path:
        path = f"/api/analyses/{asked.first}/files"
        await asked.asked("POST", path, [b"no log"], x_name="..%2f..%2f..%2fescape.csv")
        (file,) = asked.session.get(asked.first).files.values()
        await asked.session.close()
        return file.path

    path = run(dropped())
    assert path.is_relative_to(asked.session.folder)
    assert path.name == "escape.csv"
    view = asked.ask("GET", f"/api/analyses/{asked.first}").body.decode()
    assert str(asked.session.folder) not in view


@pytest.mark.parametrize("length", ["20", None, "5"])
def test_what_is_too_large_is_refused_as_it_comes(tmp_path: Path, length: str | None) -> None:
    asked = Asked(tmp_path, Bounds(file=10))
    path = f"/api/analyses/{asked.first}/files"

    async def dropped() -> int:
        answer = await asked.asked("POST", path, [b"12345"] * 4, x_name="long.csv", content_length=length)
        await asked.session.close()  # what is taken would be looked at
        return answer.status

    assert run(dropped()) == 413
    (file,) = asked.ask("GET", f"/api/analyses/{asked.first}").json["files"]
    assert (file["state"], file["name"]) == ("fault", "long.csv")
    assert not [
        each for each in asked.session.folder.rglob("*") if each.is_file() and each.stat().st_size > 0
    ]


def test_no_more_files_and_analyses_than_bounds_allow(tmp_path: Path) -> None:
    asked = Asked(tmp_path, Bounds(files=0, analyses=2, request=100))
    path = f"/api/analyses/{asked.first}"
    assert asked.ask("POST", f"{path}/files", b"x", x_name="a.csv").status == 409
    assert asked.ask("POST", "/api/analyses").status == 200
    assert asked.ask("POST", "/api/analyses").status == 409
    assert asked.ask("POST", f"{path}/choices", b"x" * 200).status == 413


@pytest.mark.parametrize(
    ("what", "body"),
    [
        ("choices", b"[]"),
        ("choices", b"{"),
        ("choices", b'{"roles": {"none": "torque"}}'),
        ("choices", b'{"options": {"tare": "rm -rf"}}'),
        ("choices", b'{"corrections": {"x.y": "1"}}'),
        ("choices", b'{"roles": 3}'),
        ("machine", b'{"answers": {"__class__": "x"}}'),
        ("machine", b'{"remove": 99}'),
        ("machine", b'{"remove": -1}'),
        ("machine", b'{"answers": {"drivetrain.mass": 3}}'),
        ("mend", b"{}"),
        ("mend", b'{"fault": "none"}'),
        ("run", b""),
        ("machine", b"\xff\xfe"),
    ],
)
def test_what_no_page_of_ours_sends_is_refused_in_words(asked: Asked, what: str, body: bytes) -> None:
    answer = asked.ask("POST", f"/api/analyses/{asked.first}/{what}", body)
    assert answer.status in (400, 404, 409), answer.body
    assert answer.json["error"]


def test_a_report_is_nobody_s(asked: Asked, tmp_path: Path) -> None:
    page = tmp_path / "private" / "page.html"
    page.write_text("<!doctype html><p>report</p>")
    asked.session.shown["capability"] = page
    answer = asked.ask("GET", "/report/capability", x_hersey_token=None, origin=None)
    assert answer.status == 200
    assert answer.headers["content-security-policy"] == SANDBOX
    assert "allow-same-origin" not in SANDBOX
    assert asked.ask("GET", "/report/other", x_hersey_token=None, origin=None).status == 404


def test_a_recipe_is_that_of_the_report_that_is_shown(asked: Asked, tmp_path: Path) -> None:
    path = f"/api/analyses/{asked.first}/recipe.toml"
    assert asked.ask("GET", path).status == 404
    (tmp_path / "r.html").write_text("report")
    (tmp_path / "r.toml").write_text('logs = ["drive.csv"]\n')
    asked.session.shown["number"] = tmp_path / "r.html"
    asked.session.analyses[asked.first].report = "number"
    assert asked.ask("GET", path).body == b'logs = ["drive.csv"]\n'
    assert asked.ask("GET", path, x_hersey_token=None).status in (401, 403)


def test_a_machine_s_file_names_only_what_was_dropped(asked: Asked) -> None:
    machine = (
        '[drivetrain]\nstiffness = "11 N/mm"\nmass = "11 kg"\nroll_radius = "15 mm"\nstick_speed = "3 mm/s"\n'
    )
    for named in ("/etc/passwd", "../../../etc/passwd", "other.csv"):
        text = f'{machine}[rest]\nlog = "{named}"\n'
        one = asked.session.get(asked.first)
        one.take_machine({"text": text})
        check(one)
        (fault,) = one.faults
        assert fault.at == "toml"
        assert "drop that file here too" in fault.text
        alone = named.rpartition("/")[2]
        assert (f"name it {alone} without its folder" in fault.text) == (alone != named)


@pytest.mark.parametrize(
    ("body", "said"),
    [
        (b"[" * 100_000, "the JSON of the request is nested too deeply"),
        (b'{"a":' * 100_000, "the JSON of the request is nested too deeply"),
        (
            b'{"roles": ' + b"[" * 20_000 + b"]" * 20_000 + b"}",
            "the JSON of the request is nested too deeply",
        ),
        (b"[1]", "the request is no JSON object"),
        (b"{", "the request is no JSON: "),
        (b"\xff", "the request is no JSON: "),
        (b'{"text": "\\ud800"}', "the request is no JSON: "),
    ],
)
@pytest.mark.parametrize("what", ["choices", "machine", "mend"])
def test_a_body_that_is_no_json_object_is_refused_in_words(
    asked: Asked, what: str, body: bytes, said: str
) -> None:
    answer = asked.ask("POST", f"/api/analyses/{asked.first}/{what}", body)
    assert answer.status == 400
    assert answer.json["error"].startswith(said)
    assert asked.ask("GET", f"/api/analyses/{asked.first}", origin=None).status == 200


def test_a_dropped_file_is_never_replaced_by_one_of_ours(asked: Asked) -> None:
    """Each has the name of a file that is made while it is looked at."""
    mapping = b'[torque]\nunit = "N*m"\n'
    dropped = {"look.json": log(), "read.toml": mapping}
    one = asked.session.analyses[asked.first]

    async def course() -> None:
        for name, content in dropped.items():
            await asked.session.drop(one, name, None, at_once(content))
        while one.waiting:
            await asyncio.sleep(0.01)

    run(course())
    assert [file.state for file in one.files.values()] == ["ready", "mapping"]
    for file in one.files.values():
        assert file.path.name == file.name
        assert [each.name for each in file.path.parent.iterdir()] == [file.name]
        assert file.path.read_bytes() == dropped[file.name]


async def at_once(content: bytes) -> AsyncIterator[bytes]:
    yield content


@pytest.mark.parametrize("name", ["machine.toml", "hersey.toml", "results"])
def test_a_log_beside_the_machine_replaces_nothing_of_ours(name: str, tmp_path: Path) -> None:
    machine = '[drivetrain]\nstiffness = "11 N/mm"\nmass = "1 kg"\n[rest]\nlog = "NAME"\n'
    (tmp_path / "results").mkdir()
    dropped = tmp_path / "of-the-user"
    dropped.write_bytes(log())
    (fault,) = file_faults(machine.replace("NAME", name), tmp_path, {name: dropped})
    assert fault.text == f"[rest] names the log {name}, a name that is taken here: give the log another"
    assert dropped.read_bytes() == log()
    assert {each.name for each in tmp_path.iterdir()} == {"results", "of-the-user"}


def test_a_log_that_is_dropped_anew_is_the_one_that_counts(tmp_path: Path) -> None:
    machine = '[rest]\nlog = "idle.csv"\n'
    for name in ("first", "second"):
        file_faults(machine, tmp_path, {"idle.csv": tmp_path / name})
        assert (tmp_path / "idle.csv").readlink() == tmp_path / name


def test_all_files_together_are_no_longer_than_the_bound(tmp_path: Path) -> None:
    """Two of 20 bytes, each allowed alone, where 30 are in all."""
    asked = Asked(tmp_path, Bounds(file=25, all_files=30))
    path = f"/api/analyses/{asked.first}/files"

    async def dropped() -> list[int]:
        answers = [await asked.asked("POST", path, [b"x" * 20], x_name=f"{name}.csv") for name in "ab"]
        await asked.session.close()  # what is taken would be looked at
        return [answer.status for answer in answers]

    assert run(dropped()) == [200, 413]
