"""The core in a page: the same numbers as in Python, in a real headless Chromium."""

from __future__ import annotations

import base64
import json
import re
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import Browser, Page

from hersey import Drag
from hersey.arrays import FloatArray
from hersey.damping.surface import FIXED, WITH_TRANSITION
from hersey.motion.belt import Drivetrain
from hersey.stability.operating_map.edges import edges_at
from tests.browser.belts import Setting, settings

STATIC = resources.files("hersey.report") / "static"
ASKING = Path(__file__).with_name("asking.js").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(browser: Browser) -> Page:
    return browser.new_page()


def code() -> list[str]:
    """The script, and the module as text."""
    module = base64.b64encode((STATIC / "physics.wasm").read_bytes()).decode()
    return [(STATIC / "physics.js").read_text(encoding="utf-8"), module]


def asked(page: Page, belts: list[Setting]) -> list[list[list[float]] | str]:
    answers = page.evaluate(ASKING, [*code(), json.dumps([belt.asked() for belt in belts])])
    found: list[list[list[float]] | str] = json.loads(answers)
    return found


def apart(one: list[FloatArray], other: list[list[float]]) -> float:
    """Greatest difference of two answers, of each quantity relative to its greatest value."""
    if [len(mine) for mine in one] != [len(theirs) for theirs in other]:
        return np.inf
    worst = 0.0
    for mine, theirs in zip(one, (np.asarray(each, dtype=float) for each in other), strict=True):
        different = mine != theirs
        if different.any():
            most = np.max(np.abs(mine))
            worst = max(worst, float(np.max(np.abs(mine - theirs)[different]) / most) if most else np.inf)
    return worst


def without_time(words: str) -> str:
    """The words of an error without the time that a motion had reached."""
    return re.sub(r"reached time \S+", "", words)


def test_a_thousand_belts_have_the_numbers_of_python(page: Page) -> None:
    """To 1e-12 of the greatest value of each quantity; edges, which are searched for, to 1e-11."""
    belts = settings(1000, seed=15)
    refused, at_the_limit = 0, 0
    for belt, theirs in zip(belts, asked(page, belts), strict=True):
        mine = belt.answered()
        if isinstance(mine, str) and isinstance(theirs, str):
            assert without_time(mine) == without_time(theirs), belt
            refused += 1
        elif isinstance(mine, str) or isinstance(theirs, str):
            # the search for an edge just ends within the work allowed, or just does not
            assert "allow more by most_steps" in f"{mine} {theirs}", belt
            at_the_limit += 1
        else:
            off = apart(mine, theirs)
            assert off <= belt.tolerance, f"{off:.1e}: {belt}"
    assert refused < 100
    assert at_the_limit < 5


#: A belt as the document has it.
TRAIN = {"stiffness": 1000.0, "mass": 1.0, "grip": None}
DRAG = Drag(
    50,
    1,
    ehl_exponent=-0.7,
    mixed_exponent=-1.2,
    stick_speed=0.01,
    reference_temperature=453.15,
    force_temperature_exponent=-0.4,
    speed_temperature_exponent=1.5,
    temperature_zero=273.15,
)
#: Begins a script that asks the core: it holds the belt above.
BEGIN = """async ([source, bytes, train, drag]) => {
  const physics = new Function(`${source}; return physics;`)();
  const core = await physics(Uint8Array.from(atob(bytes), (letter) => letter.charCodeAt(0)));
"""


def told(page: Page, script: str) -> Any:
    """What a script that asks the core about the belt returns."""
    return page.evaluate(BEGIN + script + "}", [*code(), TRAIN, asdict(DRAG)])


def test_the_map_has_its_edges_by_either_rule(page: Page) -> None:
    kelvin = np.linspace(400.0, 480.0, 9)
    script = """
      const temperatures = Array.from({ length: 9 }, (_, i) => 400 + 10 * i);
      return ["with transition", "fixed"].map((rule) => {
        const edges = core.edges({ train, drag, temperatures, rule, lower: true });
        const laws = temperatures.map((t) => core.drag(drag, t, { rule }));
        const single = laws.map((law) => core.band({ train, law }).upper);
        const same = laws.every((law, i) => core.holding(law) === edges.holding[i]);
        if (!same) throw new Error("another holding force");
        return [...["lower", "transition", "upper"].map((name) => [...edges[name]]), single];
      });"""
    for rule, found in zip((WITH_TRANSITION, FIXED), told(page, script), strict=True):
        edges = edges_at(Drivetrain(1000, 1), DRAG, kelvin, rule)
        for name, theirs in zip(("lower", "transition", "upper", "upper"), found, strict=True):
            np.testing.assert_allclose(theirs, edges[name], rtol=1e-11, err_msg=f"{rule}: {name}")


def test_what_cannot_be_is_refused_in_the_words_of_the_core(page: Page) -> None:
    script = """
      const law = core.drag(drag, 453.15);
      const motion = { train, law, schedule: 1, start: "rest", duration: 20, samples: 100 };
      const wrong = [
        () => core.drag({ ...drag, stick_speed: 2 }, 453.15),
        () => core.drag(drag, null),
        () => core.drag(drag, 453.15, { closure: "glue" }),
        () => core.drag({ ...drag, rest_force: "much" }, 453.15),
        () => core.motion({ ...motion, duration: -1 }),
        () => core.motion({ ...motion, schedule: [[1, 1], [0, 1]] }),
        () => core.motion({ ...motion, most_steps: 30 }),
        () => core.band({ train, law: core.drag(drag, 453.15, { closure: "stribeck" }), most_steps: 300 }),
        () => core.edges({ train, drag, temperatures: [200, 210], rule: "fixed" }),
      ];
      return wrong.map((ask) => {
        try { return ask(); } catch (error) { return { ...error, words: error.message, name: error.name }; }
      });"""
    found = told(page, script)
    names = [each["name"] for each in found]
    assert names == ["ParameterError"] * 6 + ["UnfinishedError"] * 2 + ["ParameterError"]
    words = [each["words"] for each in found]
    assert words[0] == "stick_speed is 2: it must be less than 1"
    assert (found[0]["quantity"], found[0]["value"], found[0]["limit"]) == ("stick_speed", 2, 1)
    assert words[1] == "the drag varies with temperature: give temperature"
    assert words[2] == "closure 'glue' is not known: retained, stiction, stribeck, lugre"
    assert words[3] == "rest_force is much: a finite number is needed"
    assert "duration is -1" in words[4]
    assert "drive_speed runs backwards" in words[5]
    assert words[6].startswith("after 30 steps, all that are allowed, the motion has reached time")
    assert words[7].startswith("after 1800 steps")  # six motions of 300
    assert words[8].startswith("temperature is -73.1")


def test_the_unstable_lap_parts_sliding_from_sticking(page: Page) -> None:
    """Starts a little within it come to slide, those a little outside stick; above V* there is none."""
    script = """
      return ["retained", "stiction", "stribeck"].map((closure) => {
        const law = core.drag(drag, 453.15, { closure });
        const lap = core.unstable({ train, law, drive_speed: 1.5 });
        const [steady] = core.forces(law, [1.5]);
        const kinds = [0.99, 1.01].flatMap((size) => [0, 60, 200, 300].map((i) => {
          const [speed, force] = [1.5 + size * (lap.speed[i] - 1.5), steady + size * (lap.force[i] - steady)];
          return core.cycle({ train, law, drive_speed: 1.5, start: [speed, force / train.stiffness] }).kind;
        }));
        const gap = Math.abs(lap.force[360] - lap.force[0]) + Math.abs(lap.force[359] / lap.force[0] - 1);
        return [lap.closed, gap, kinds, core.unstable({ train, law, drive_speed: 12 })];
      });"""
    for closed, gap, kinds, above in told(page, script):
        assert closed
        assert gap < 0.05
        assert kinds == ["steady_sliding"] * 4 + ["stick_slip"] * 4
        assert above is None


def test_a_worker_has_the_same_core_where_no_text_may_become_code(browser: Browser) -> None:
    source, module = code()
    policy = "default-src 'none'; script-src 'unsafe-inline' 'wasm-unsafe-eval' blob:; worker-src blob:"
    ask = """
      const law = core.drag(drag, 453.15);
      const run = core.motion({ train, law, schedule: 1.2, start: "rest", duration: 5, samples: 50 });
      const own = [...run.belt_speed, ...run.spring_force];"""
    script = f"""
      {source}
      const [train, drag] = {json.dumps([TRAIN, asdict(DRAG)])};
      window.found = (async () => {{
        const core = await physics(Uint8Array.from(atob("{module}"), (letter) => letter.charCodeAt(0)));
        {ask}
        const text = `${{physics}}
          onmessage = async ({{ data: [module, train, drag] }}) => {{
            const core = await physics(module);
            {ask}
            postMessage(own);
          }};`;
        const worker = new Worker(URL.createObjectURL(new Blob([text], {{ type: "text/javascript" }})));
        const theirs = new Promise((resolve) => {{ worker.onmessage = (event) => resolve(event.data); }});
        worker.postMessage([core.module, train, drag]);
        return [own, await theirs];
      }})();"""
    page = browser.new_page()
    page.set_content(
        f'<meta http-equiv="Content-Security-Policy" content="{policy}"><script>{script}</script>'
    )
    own, theirs = page.evaluate("window.found")
    assert len(own) == 100
    assert own == theirs
