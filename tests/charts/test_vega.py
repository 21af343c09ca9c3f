"""Drawing in a process of its own: out of memory it ends in one line, Ctrl-C stops it at once."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from hersey.charts import vega
from hersey.charts.vega import drawn
from hersey.errors import OutputError
from hersey.processes.child import Child
from tests.conftest import ROOT, mostly_nightly

linux = pytest.mark.skipif(sys.platform != "linux", reason="limits and signals as Linux has them")
#: Few threads, each of which reserves memory of its own.
FEW = dict.fromkeys(("POLARS_MAX_THREADS", "RAYON_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "2")
COMMAND = "import sys; from hersey.cli import main; main()"
#: The command, with a renderer that never ends, and neither hears a signal nor lets another thread run.
ENDLESS = """
import sys
from pathlib import Path
from hersey.charts import vega
from hersey.cli import main
from hersey.processes.child import Child
vega._process = Child(Path(sys.argv.pop(1)))
main()
"""
SCRIPT = """
import ctypes, os
def answer(request, content):
    with open(os.environ["SIGN"] + ".part", "w") as file:
        file.write(str(os.getpid()))
    os.replace(os.environ["SIGN"] + ".part", os.environ["SIGN"])
    ctypes.PyDLL(None).sleep(600)
"""
BROKEN = """
import os, signal
def answer(request, content):
    if request["kinds"] == ["png"]:
        raise ValueError("no such mark\\nand a stack")
    os.kill(os.getpid(), signal.SIGKILL if request["kinds"] == ["svg"] else signal.SIGTRAP)
"""
MARK = {
    "data": {"values": [{"a": 1}]},
    "mark": "point",
    "encoding": {"x": {"field": "a", "type": "quantitative"}},
}
TRACE = ["cycles", str(ROOT / "examples" / "stick-slip.csv"), "--figure", "x.png"]
REPORT = ["report", str(ROOT / "examples" / "bench.csv"), "--out", "r.html", "--figures", "figures"]


@linux
@pytest.mark.parametrize("limit", mostly_nightly([1.5e9, 6e9], 6e9))
def test_out_of_memory_it_ends_in_one_line(tmp_path: Path, limit: float) -> None:
    import resource

    done = subprocess.run(
        [sys.executable, "-c", COMMAND, *TRACE],
        cwd=tmp_path,
        env=os.environ | FEW,
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (int(limit), int(limit))),
    )
    assert done.returncode == 2, done.stderr
    assert done.stderr == (
        "hersey: the figures cannot be drawn: the renderer ran out of memory (the limit of virtual memory is "
        f"{limit / 1e9:.3g} GB: see ulimit -v)\n"
    )
    assert list(tmp_path.iterdir()) == []


@linux
@pytest.mark.parametrize("arguments", [TRACE, REPORT])
def test_an_interrupt_ends_command_and_renderer(tmp_path: Path, arguments: list[str]) -> None:
    script, sign, place = tmp_path / "endless.py", tmp_path / "sign", tmp_path / "place"
    script.write_text(SCRIPT)
    place.mkdir()
    process = subprocess.Popen(
        [sys.executable, "-c", ENDLESS, str(script), *arguments],
        cwd=place,
        env=os.environ | {"SIGN": str(sign)},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        while not sign.exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, told = process.communicate(timeout=60.0)
    finally:
        process.kill()
    assert (process.returncode, told) == (130, "hersey: interrupted\n")
    assert not Path(f"/proc/{sign.read_text()}").exists()
    written = [path.name for path in place.iterdir()]
    assert written == (["r.html"] if arguments is REPORT else [])
    for name in written:
        assert (place / name).read_text().endswith("</html>\n")


@linux
@pytest.mark.parametrize(
    ("kind", "told"),
    [
        ("png", "the figures cannot be drawn: no such mark$"),
        ("svg", "the renderer was killed, as it is where memory runs out"),
        ("pdf", r"the renderer broke down \(exit code -5\)"),
    ],
)
def test_what_became_of_the_renderer(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str, told: str
) -> None:
    script = tmp_path / "broken.py"
    script.write_text(BROKEN)
    monkeypatch.setattr(vega, "_process", Child(script))
    with pytest.raises(OutputError, match=told):
        drawn({}, [kind])


def test_a_picture_that_is_unknown_is_told() -> None:
    with pytest.raises(OutputError, match="no such picture: gif"):
        drawn(MARK, ["gif"])


def test_all_kinds_come_of_one_drawing() -> None:
    kinds = ["png", "svg", "pdf"]
    together = drawn(MARK, kinds)
    assert [content[:4] for content in together] == [b"\x89PNG", b"<svg", b"%PDF"]
    assert together[:2] == [drawn(MARK, [kind])[0] for kind in kinds[:2]]
