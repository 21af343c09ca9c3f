"""The command starts in a blink: what each verb loads. No clock: `benchmarks/start.py` has the times."""

from __future__ import annotations

import gc
import json
import sys
from functools import cache
from pathlib import Path

import pytest

import hersey
from hersey.cli.application import VERBS, load
from hersey.cli.loading import loading
from tests.cli.command import run, run_apart
from tests.conftest import ROOT

#: What takes long to load.
HEAVY = {"altair", "numpy", "odrpack", "pint", "polars", "pydantic", "scipy", "vl_convert", "xarray"}
#: Runs the command, then says on stderr what it loaded.
WATCHED = """
import json, sys
from hersey.cli import main
try:
    main()
finally:
    json.dump(sorted(sys.modules), sys.stderr)
"""


def loaded(*typed: str, cwd: Path) -> set[str]:
    """Modules in memory when a command has run in a process of its own."""
    done = run_apart(*typed, cwd=cwd, command=[sys.executable, "-c", WATCHED])
    assert done.stdout, done.stderr
    return set(json.loads(done.stderr[done.stderr.index("[") :]))


#: What typer loads for Markdown, tracebacks and the conversion of options, none of which a help has.
VAIN = {"attr", "markdown_it", "pydantic", "pygments", "rich.markdown", "rich.traceback"}
#: Most modules of ours behind the help of a command.
OURS = 36


def rooms(modules: set[str]) -> set[str]:
    """Rooms of the package of which something is loaded, but for the command line's own and light ones."""
    light = {"hersey.charts", "hersey.cache", "hersey.cache.switch"}  # two headers, and a switch
    opened = {name for name in modules if name.startswith("hersey.")} - light
    return {name.split(".")[1] for name in opened} - {"cli", "errors", "files", "_core"}


def test_the_version_loads_no_program() -> None:
    modules = loaded("--version", cwd=ROOT)
    assert not modules & (HEAVY | {"typer", "rich", "hersey.cli.application"})
    assert not rooms(modules)


def test_the_list_of_verbs_loads_no_verb() -> None:
    modules = loaded("--help", cwd=ROOT)
    assert not modules & (HEAVY | VAIN)
    assert not rooms(modules)
    assert not {f"hersey.cli.{name}" for name in VERBS} & modules


def test_runs_are_listed_without_tables_and_arrays(tmp_path: Path) -> None:
    from hersey.life.age import Age
    from hersey.life.campaign import Campaign
    from hersey.life.campaign.conversion import entry_of

    table = {"speed [rpm]": [10, 20, 40, 80], "torque [mN*m]": [5.0, 5.6, 6.3, 7.2]}
    kept = entry_of(hersey.SteadyPoints.from_table(table, isothermal=True), "sample.csv")
    with Campaign.create(tmp_path / "life.hersey") as campaign:
        campaign.add_entries([(kept, "F12", Age(1000.0, "pages"))])
    modules = loaded("campaign", "list", "life.hersey", cwd=tmp_path)
    assert not modules & (HEAVY - {"pydantic"})  # which typer loads to convert options


def test_importing_the_package_loads_nothing() -> None:
    done = run_apart("-c", "import hersey, sys; print(*sys.modules)", cwd=ROOT, command=[sys.executable])
    assert not set(done.stdout.split()) & (HEAVY | {"hersey._core"})


def test_a_warning_is_had_without_numpy_and_pydantic() -> None:
    asked = "import hersey.schema.warning, sys; print(*sys.modules)"
    done = run_apart("-c", asked, cwd=ROOT, command=[sys.executable])
    assert "hersey.schema.record" in done.stdout.split()
    assert not set(done.stdout.split()) & HEAVY


#: Asks one verb after the other for its help, and says on stderr what is loaded then.
HELPED = """
import json, sys
from hersey.cli import main
loaded = {}
for verb in sys.argv[1:]:
    sys.argv = ["hersey", verb, "--help"]
    try:
        main()
    except SystemExit as end:
        assert not end.code, verb
    loaded[verb] = sorted(sys.modules)
json.dump(loaded, sys.stderr)
"""


@cache
def loaded_by_help() -> dict[str, list[str]]:
    """Modules in memory after the help of each verb, which those before it in the list have added to."""
    done = run_apart(*VERBS, cwd=ROOT, command=[sys.executable, "-c", HELPED])
    assert done.stdout.count("Usage") == len(VERBS), done.stderr
    found: dict[str, list[str]] = json.loads(done.stderr[done.stderr.index("{") :])
    return found


@pytest.mark.parametrize("verb", VERBS)
def test_the_help_of_a_verb_loads_no_room(verb: str) -> None:
    modules = set(loaded_by_help()[verb])
    assert not modules & (HEAVY | VAIN)
    assert not rooms(modules)
    assert f"hersey.cli.{verb}" in modules


@pytest.mark.parametrize("typed", ["fit", "sweep", "campaign add", "export fmu"])
def test_the_help_of_a_verb_loads_little(typed: str) -> None:
    modules = loaded(*typed.split(), "--help", cwd=ROOT)
    assert not modules & (HEAVY | VAIN)
    assert sum(name.startswith("hersey.") for name in modules) <= OURS


def test_what_stands_in_for_markdown_loads_it_where_it_is_used() -> None:
    asked = """
import sys
from hersey.cli.light_help import LightHelp
class Helped: format_help = lambda self, context, formatter: None
type("Command", (LightHelp, Helped), {})().format_help(None, None)
import typer.rich_utils
assert "rich.markdown" not in sys.modules
shown = typer.rich_utils.Markdown("*a*")
import rich.markdown, rich.traceback
assert isinstance(shown, rich.markdown.Markdown)
assert typer.rich_utils.Traceback.from_exception == rich.traceback.Traceback.from_exception
"""
    done = run_apart("-c", asked, cwd=ROOT, command=[sys.executable])
    assert done.returncode == 0, done.stderr


LOG = "examples/bench.csv --tare standing"
MACHINE = "examples/machine.toml"
#: What each verb loads of what is heavy, beside pydantic, which every command loads.
LOADS = {
    "explain dwell": "",
    "simulate": "numpy",
    "simulate --json": "numpy",
    "simulate --check": "numpy",
    "hysteresis": "numpy",
    "hysteresis --from-speed 2.5 --to-speed 1.2 --drive-speed 1.2 --json": "numpy",
    "simulate --csv motion.csv": "numpy polars",
    "inspect examples/bench.csv": "numpy odrpack polars scipy",
    f"fit {LOG}": "numpy odrpack polars scipy",
    f"compare {LOG} examples/bench.csv": "numpy odrpack polars scipy",
    f"film {MACHINE}": "numpy odrpack polars scipy",
    "cycles examples/stick-slip.csv": "numpy polars scipy",
    "testbench": "numpy polars scipy",
}


@pytest.mark.parametrize("typed", LOADS)
def test_what_a_verb_loads(typed: str, examples_here: Path) -> None:
    modules = loaded(*typed.split(), cwd=examples_here)
    assert modules & HEAVY - {"pydantic"} == set(LOADS[typed].split())


@pytest.mark.parametrize("verb", ["fit", "models"])
def test_a_conclusion_loads_no_document(verb: str, examples_here: Path) -> None:
    modules = loaded(verb, *LOG.split(), cwd=examples_here)
    assert not rooms(modules) & {"decision", "document", "posterior", "stability", "study"}
    assert "hersey.damping.curves" not in modules


def test_cycles_of_a_log_load_little_of_scipy(examples_here: Path) -> None:
    asked = f"posterior {LOG} --machine {MACHINE} --draws 40"
    modules = loaded(*asked.split(), cwd=examples_here)
    assert "hersey.identification.cycle_record" in modules
    assert not {"scipy.integrate", "scipy.signal", "scipy.stats"} & modules


def test_what_a_report_loads() -> None:
    """Of SciPy only what its fits need, and nothing of what reads other files or draws other pictures."""
    code = "import sys, hersey.document.assembly, hersey.report.page; print(*sys.modules)"
    modules = set(run_apart("-c", code, cwd=ROOT, command=[sys.executable]).stdout.split())
    assert modules & HEAVY == {"altair", "numpy", "odrpack", "polars", "pydantic", "scipy"}
    rarer = ("integrate", "interpolate", "io", "ndimage", "signal", "stats")
    assert not {f"scipy.{name}" for name in rarer} & modules
    assert not {"h5py", "openpyxl", "pandas", "matplotlib", "uvicorn", "starlette"} & modules


def test_the_collector_rests_while_much_is_loaded(examples_here: Path) -> None:
    with loading():
        assert not gc.isenabled()
    assert gc.isenabled()
    counted = WATCHED.replace("sorted(sys.modules)", "__import__('gc').get_freeze_count()")
    done = run_apart("fit", *LOG.split(), cwd=examples_here, command=[sys.executable, "-c", counted])
    assert int(done.stderr.split()[-1]) > 50_000  # what was loaded is not looked through again


@pytest.mark.parametrize(
    "typed",
    [
        "report bench.csv --out report.csv/page.html",
        "map machine.toml bench.csv --out map.bmp",
        "plan machine.toml bench.csv --figure plan.bmp",
        "film machine.toml --figure film.bmp",
        "inspect bench.csv --figure channels.bmp",
        "cycles trace.csv --figure cycles.bmp",
        "sweep scenario.toml --out sweep.bmp",
    ],
)
def test_a_refused_output_costs_nothing(typed: str, tmp_path: Path) -> None:
    done = run_apart(*typed.split(), cwd=tmp_path, command=[sys.executable, "-c", WATCHED])
    assert done.stderr.startswith("hersey: ")
    modules = set(json.loads(done.stderr.splitlines()[1]))
    assert not modules & HEAVY - {"pydantic"}
    assert not rooms(modules)


@pytest.mark.parametrize("verb", VERBS)
def test_the_list_says_what_the_verb_says(verb: str) -> None:
    """The sentence in the list of verbs is the first of the verb's own help."""
    assert load(verb).help.split("\n\n")[0] == VERBS[verb]


def test_the_list_of_verbs_has_them_in_order() -> None:
    text = run("--help", cwd=ROOT).stdout
    assert [name for name in text.split() if name in VERBS and f"\u2502 {name}  " in text] != []
    lines = [line.split()[1] for line in text.splitlines() if line.startswith("\u2502 ") and line[2] != " "]
    assert [word for word in lines if not word.startswith("--")] == list(VERBS)


def test_a_verb_nearly_right_is_guessed() -> None:
    done = run("simulat", cwd=ROOT)
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr == "hersey: There is no command 'simulat'. Did you mean: hersey simulate\n"
