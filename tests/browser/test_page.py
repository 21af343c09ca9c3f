"""The page of a report in a real headless Chromium, offline: three logs, screen, dark, narrow and paper."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import pytest
from playwright.sync_api import Browser, Page

from hersey.decision.edges import Edge
from hersey.document.analysis import Analysis
from hersey.document.assembly import load
from hersey.report.page import render
from hersey.study.first_screen.result import MeasurementPart
from tests.browser.accessibility import open_all, violations_by_width
from tests.browser.conftest import SCREENS
from tests.browser.opening import Opened
from tests.conftest import ROOT, mostly_nightly
from tests.files.test_tables import CELLS

Report = Callable[[str], tuple[Path, Analysis]]
DESK = (1280, 800)


@pytest.fixture(scope="module", params=["demo", "screw", "plain"])
def each(
    browser: Browser, report: Report, request: pytest.FixtureRequest
) -> Iterator[tuple[Opened, Analysis]]:
    """Each of the three pages, as it opens on a desk."""
    path, document = report(request.param)
    opened = Opened(browser, path, size=DESK)
    opened.page.wait_for_timeout(300)
    picture(opened.page, f"{request.param}-first")
    picture(opened.page, request.param, whole=True)
    yield opened, document
    opened.page.close()


@pytest.fixture(scope="module")
def demo(browser: Browser, report: Report) -> Iterator[Opened]:
    opened = Opened(browser, report("demo")[0], size=DESK)
    yield opened
    opened.page.close()


def picture(page: Page, name: str, *, whole: bool = False) -> None:
    SCREENS.mkdir(parents=True, exist_ok=True)
    page.screenshot(path=SCREENS / f"{name}.png", full_page=whole)


def boxes(page: Page, selector: str) -> list[dict[str, Any]]:
    """Places of elements that are shown, with their texts."""
    found: list[dict[str, Any]] = page.evaluate(
        """(selector) => [...document.querySelectorAll(selector)].map((e) => {
             const b = e.getBoundingClientRect();
             return { text: e.textContent, x: b.x, y: b.y, right: b.right, bottom: b.bottom };
           }).filter((b) => b.right > b.x && b.bottom > b.y)""",
        selector,
    )
    return found


def test_it_draws_without_errors_and_without_network(each: tuple[Opened, Analysis]) -> None:
    each[0].assert_quiet()


def test_what_to_do_is_seen_first(each: tuple[Opened, Analysis]) -> None:
    """Decision, points, flags and the picture, all within a screen of 1280 by 800."""
    opened, document = each
    page, decision = opened.page, document.decision
    assert decision is not None
    assert page.evaluate("scrollY") == 0
    lead = page.locator("#decision .lead").text_content() or ""
    assert lead.replace("\u00a0", " ").startswith(decision.instruction)
    assert decision.signal.capitalize() in (page.locator("#decision .sign").text_content() or "")
    assert page.locator(".points tr").count() == len(decision.points)
    assert page.locator("#flags li").count() == len(decision.flags)
    drawing = "#map svg" if document.map else "#chart-torque svg.marks"
    for selector in ("#decision", ".points", "#flags", drawing, "#panel .cap"):
        for box in boxes(page, selector)[:1]:
            assert 0 <= box["x"] < box["right"] <= DESK[0], selector
            assert 0 <= box["y"] < box["bottom"] <= DESK[1], (selector, box)
    picture_box = boxes(page, drawing)[0]
    assert picture_box["bottom"] - picture_box["y"] > 250


def test_without_a_machine_the_lines_to_add_are_ready(each: tuple[Opened, Analysis]) -> None:
    opened, document = each
    assert document.decision is not None
    if document.map is not None:
        pytest.skip("this one has a machine")
    lines = opened.page.locator("#panel pre").all_text_contents()
    assert lines == [missing.lines for missing in document.decision.missing]
    assert opened.page.locator("#panel button", has_text="Copy").count() == len(lines)


def test_each_section_states_its_finding(each: tuple[Opened, Analysis]) -> None:
    opened, document = each
    names = opened.page.locator("section").evaluate_all("all => all.map((e) => e.id)")
    for part, name in (
        ("fit", "torque"),
        ("quality", "data"),
        ("command", "reproduce"),
    ):
        assert name in names, part
    assert ("regime" in names) == (document.friction is None)
    for part, name in (("map", "band"), ("compare", "compare")):
        assert (name in names) == bool(getattr(document, part)), part
    findings = opened.page.locator("section > .finding").all_text_contents()
    assert len(findings) == len(names)
    for finding in findings:
        assert re.match(r"[A-Z0-9].{15,}\.$", finding), finding
        assert "undefined" not in finding
        assert "NaN" not in finding
    contents = opened.page.locator("#contents a").evaluate_all("all => all.map((e) => e.hash.slice(1))")
    assert contents == names
    for target in opened.page.locator("#flags a").evaluate_all("all => all.map((e) => e.hash.slice(1))"):
        assert target in names


def test_nothing_is_said_twice(each: tuple[Opened, Analysis]) -> None:
    headings = each[0].page.locator("h2, h3, .finding").all_text_contents()
    assert len(headings) == len(set(headings)), headings
    ids = each[0].page.locator("[id]").evaluate_all("all => all.map((e) => e.id)")
    assert len(ids) == len(set(ids))


def test_numbers_match_the_document(each: tuple[Opened, Analysis]) -> None:
    opened, document = each
    page = opened.page
    page.evaluate("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
    page.wait_for_selector("#summary", state="attached")
    leads: Any = document.friction
    assert page.text_content("#summary") == (document.fit.summary if leads is None else leads.summary())
    assert page.text_content("#command") == document.command
    recipes = [] if document.recipe is None else [document.recipe.toml]
    assert page.locator("#recipe").all_text_contents() == recipes
    assert page.locator("button", has_text="Copy recipe").count() == len(recipes)
    shown = " ".join(page.locator("section").all_text_contents())
    c = f"{document.fit.coefficients['c'].value:.2f}".replace("-", "\u2212")
    assert len(page.locator("#warnings li").all()) == len(document.warnings)
    if leads is None:
        assert c in shown
        assert len(page.locator("#verdict p").all()) == len(document.verdict)
    else:  # one law on the page: none of its numbers is of a power of speed
        assert c not in shown
        assert page.locator("#chart-damping, #chart-regime, #chart-surface").count() == 0


def test_the_transition_is_told_at_the_belt(demo: Opened, report: Report) -> None:
    part = report("demo")[1].map
    assert part is not None
    assert part.temperature is not None
    assert part.measured_temperature is not None
    hottest = part.measured_temperature[1] + 1
    speed = [v for t, v in zip(part.temperature, part.transition, strict=True) if v and t <= hottest][-1]
    assert f" {1e3 * (speed or 0):.2g} mm/s at 180" in (demo.page.text_content("#torque .finding") or "")


def test_plans_and_steps_are_those_of_the_document(demo: Opened, report: Report) -> None:
    """Speeds in mm/s at the belt, and whether it sticks, row by row."""
    decision = report("demo")[1].decision
    assert decision is not None
    for point in decision.points:
        if point.plan:
            cells = demo.page.locator(f"table[aria-label='Profile of {point.name}'] td:nth-child(2)")
            shown = [float(text) for text in cells.all_text_contents()]
            assert shown == pytest.approx([1e3 * row.drive_speed for row in point.plan.rows()], rel=5e-3)
    ends = demo.page.locator("table[aria-label='Steps from steady sliding'] td:last-child")
    sticks = [text.startswith("sticks") for text in ends.all_text_contents()]
    assert sticks == [step.sticks for point in decision.points for step in point.steps]
    assert sticks


def test_a_profile_is_drawn_until_its_oscillation_has_died_out(report: Report) -> None:
    decision = report("demo")[1].decision
    assert decision is not None
    moving = [(point, point.motion) for point in decision.points if point.motion]
    assert moving
    for point, motion in moving:
        off = [abs(v / point.speed - 1) for v in motion.belt_speed]
        assert max(off[: len(off) // 4]) > 0.2
        assert max(off[-10:]) < 0.035


def test_marks_and_words_lie_inside_their_charts(each: tuple[Opened, Analysis]) -> None:
    """No mark or word of a chart is cut off by its frame."""
    cut = each[0].page.evaluate(
        """() => [...document.querySelectorAll("svg.marks, #timeline svg")].flatMap((drawing) => {
             const frame = drawing.getBoundingClientRect();
             if (!frame.width) return [];
             return [...drawing.querySelectorAll("text, .mark-symbol path")].filter((e) => {
               const b = e.getBoundingClientRect();
               return b.width && (b.x < frame.x - 1 || b.right > frame.right + 1
                 || b.y < frame.y - 1 || b.bottom > frame.bottom + 1);
             }).map((e) => `${drawing.closest("figure")?.id}: ${e.textContent || "mark"}`);
           })"""
    )
    assert cut == []


#: Pairs of words in one chart that cover each other.
COVERED = """() => [...document.querySelectorAll("svg.marks, #timeline svg")].flatMap((drawing) => {
  const bare = (e) => e.textContent && getComputedStyle(e).stroke === "none" && !e.closest(".cursor");
  const words = [...drawing.querySelectorAll("text")].filter(bare)
    .map((e) => ({ text: e.textContent, b: e.getBoundingClientRect() })).filter(({ b }) => b.width);
  const out = [];
  words.forEach((one, i) => words.slice(i + 1).forEach((other) => {
    const across = Math.min(one.b.right, other.b.right) - Math.max(one.b.x, other.b.x);
    const down = Math.min(one.b.bottom, other.b.bottom) - Math.max(one.b.y, other.b.y);
    if (across > 2 && down > 4) out.push(`${drawing.closest("figure")?.id}: ${one.text} / ${other.text}`);
  }));
  return out;
})"""


def test_words_cover_no_other_words(each: tuple[Opened, Analysis]) -> None:
    assert each[0].page.evaluate(COVERED) == []


def test_drawings_say_what_they_show(each: tuple[Opened, Analysis]) -> None:
    labels = (
        each[0]
        .page.locator("figure svg[role=img]")
        .evaluate_all("all => all.map((e) => e.getAttribute('aria-label'))")
    )
    assert labels
    assert all(label and len(label) > 20 for label in labels), labels
    unnamed = each[0].page.locator("figure svg.marks:not([role=img])").count()
    assert unnamed == 0


@pytest.mark.parametrize("name", ["demo", "plain"])
def test_nothing_is_wider_than_the_page(browser: Browser, report: Report, name: str) -> None:
    """As it opens on a small phone, and as wide as it may then be made."""
    opened = Opened(browser, report(name)[0], size=(360, 800))
    opened.page.wait_for_timeout(150)
    picture(opened.page, f"{name}-360", whole=True)
    assert opened.page.evaluate(COVERED) == []
    broken = opened.page.evaluate(  # a word of a heading that stands in two lines
        """() => [...document.querySelectorAll(
             "h1, h2, h3, .finding, .lead, .points td, .btn, th")].flatMap((e) => {
             const walk = document.createTreeWalker(e, NodeFilter.SHOW_TEXT), out = [];
             while (walk.nextNode()) for (const word of walk.currentNode.data.matchAll(/[^\\s-]+/g)) {
               const range = new Range();
               range.setStart(walk.currentNode, word.index);
               range.setEnd(walk.currentNode, word.index + word[0].length);
               if (range.getClientRects().length > 1) out.push(word[0]);
             }
             return out;
           })"""
    )
    assert broken == []
    for width in (360, 390, 768, 1000):
        opened.page.set_viewport_size({"width": width, "height": 800})
        opened.page.wait_for_timeout(150)
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
    opened.assert_quiet()
    opened.page.close()


@pytest.mark.nightly  # in make test a page is made wider; here it opens at each width
@pytest.mark.parametrize("width", [390, 768, 1000])
@pytest.mark.parametrize("name", ["demo", "plain"])
def test_nothing_is_wider_than_the_page_that_opens(
    browser: Browser, report: Report, name: str, width: int
) -> None:
    opened = Opened(browser, report(name)[0], size=(width, 800))
    opened.page.wait_for_timeout(150)
    assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
    opened.assert_quiet()
    opened.page.close()


#: Each page and each scheme once: the page makes what stands on it, the scheme its colours.
SEEN = mostly_nightly(
    [(name, scheme) for name in ("demo", "plain", "against") for scheme in ("light", "dark")],
    ("demo", "light"),
    ("plain", "dark"),
)


@pytest.mark.parametrize(("name", "scheme"), SEEN)
def test_it_is_accessible(
    browser: Browser, report: Report, name: str, scheme: Literal["light", "dark"]
) -> None:
    """WCAG 2.2 AA by axe-core, with folds open and nothing left out: no violation at any width."""
    opened = Opened(browser, report(name)[0], size=DESK, scheme=scheme)
    page = opened.page
    assert page.get_attribute("html", "data-theme") == scheme
    open_all(page)
    picture(page, f"{name}-{scheme}-open", whole=True)
    assert violations_by_width(page) == {}
    page.close()


#: Words that the page of the example may show as it opens, and outside its charts with each section laid out;
#: folds are closed.
WORDS, WORDS_OUTSIDE_CHARTS = 700, 720


def test_the_page_of_the_example_is_short(browser: Browser, report: Report) -> None:
    """As a reader sees it: numbers, buttons and tables count too, and as it opens those of axes."""
    opened = Opened(browser, report("demo")[0], size=DESK)
    page = opened.page
    page.wait_for_timeout(700)  # the panel has answered
    words = "document.body.innerText.split(/\\s+/).filter(Boolean).length"
    assert 300 < page.evaluate(words) <= WORDS
    # a section out of view is not laid out, and its text is not among that of the page
    page.add_style_tag(content="#report section { content-visibility: visible !important; }")
    whole = page.evaluate(words)
    page.evaluate("document.querySelectorAll('svg').forEach((each) => each.remove())")
    assert 400 < page.evaluate(words) <= WORDS_OUTSIDE_CHARTS < whole
    page.close()


def test_the_next_measurement_has_its_reason_one_click_away(
    browser: Browser, report: Report, tmp_path: Path
) -> None:
    document = report("demo")[1]
    assert document.decision is not None
    text = "Measure next: start once from rest at 110 mm/s. V* would then be known within 5 %"
    measurement = MeasurementPart(kind="starts", text=text, temperature=453.15, speeds=[0.11], left=0.5)
    known = {
        "measurement": measurement,
        "next": measurement.text,
        "fold": Edge(0.1, 0.05, 0.2),
        "closures": {"retained": 0.7, "stiction": 0.29, "stribeck": 0.01},
    }
    decision = document.decision.model_copy(update=known)
    path = tmp_path / "page.html"
    path.write_text(render(document.model_copy(update={"decision": decision})), encoding="utf-8")
    opened = Opened(browser, path, size=DESK)
    line = opened.page.locator("#decision .next")
    assert f"{text}." in line.inner_text().replace("\u00a0", " ")
    line.locator("summary").click()
    why = line.locator("details p").inner_text().replace("\u00a0", " ")
    assert "between 50 and 200 mm/s (95 %)" in why
    assert "from 4 to 2." in why  # half of it in logarithms
    assert "comes to rest gradually (70 %) or stops abruptly (29 %)" in why
    line.locator("details a").click()
    assert opened.page.evaluate("location.hash") == "#band"
    opened.page.close()


def test_a_chart_has_a_label_and_hides_its_drawing(each: tuple[Opened, Analysis]) -> None:
    """A screen reader is given one label for each chart, not its hundred marks and ticks."""
    bare = each[0].page.evaluate(
        """() => [...document.querySelectorAll("figure")].filter((figure) => {
             const images = [...figure.querySelectorAll("svg[role=img], svg g[role=img]")];
             const named = figure.matches("[aria-label]") || figure.querySelector("[role=group]");
             return !named || !images.length
               || images.some((image) => !image.getAttribute("aria-label")
                 || [...image.children].some((part) => part.getAttribute("aria-hidden") !== "true"));
           }).map((figure) => figure.id)"""
    )
    assert bare == []


def test_a_direct_label_has_no_second_key(demo: Opened) -> None:
    """Temperatures are named at the ends of their lines; the buttons that hide them are in the fold."""
    for name in ("torque", "damping"):
        chart = demo.page.locator(f"#chart-{name}")
        assert chart.locator("svg text", has_text="90 °C").count() == 1
        assert chart.locator(".toggle:visible").count() == 0


def test_the_torque_says_what_it_is_and_what_was_subtracted(each: tuple[Opened, Analysis]) -> None:
    opened, document = each
    heading = opened.page.locator("#chart-torque h2, #chart-torque h3").first.text_content()
    drag = "Drag torque" + (", no-load torque subtracted" if document.fit.rest else "")
    assert heading == ("Friction torque" if document.friction else drag)


def test_dark_and_light(demo: Opened) -> None:
    page = demo.page
    ground = "getComputedStyle(document.body).backgroundColor"
    line = """getComputedStyle(document.querySelector("#chart-damping .mark-line path")).stroke"""
    before = page.evaluate(ground), page.evaluate(line)
    page.click("#theme")
    after = page.evaluate(ground), page.evaluate(line)
    assert after[0] == "rgb(17, 23, 29)"
    assert before[1] != after[1]
    picture(page, "demo-dark-first")
    page.click("#theme")
    assert (page.evaluate(ground), page.evaluate(line)) == before


def test_a_table_sorts_by_its_heads(demo: Opened) -> None:
    page = demo.page
    page.locator("#statistics > summary").click()
    table = page.locator("table[aria-label='All dwells']")
    column = "all => all.map((e) => Number(e.textContent.replaceAll('\u2212', '-')))"
    head = table.locator("th button", has_text="Measured / fitted")
    place = head.evaluate("e => e.closest('th').cellIndex") + 1
    head.focus()
    page.keyboard.press("Enter")
    values = table.locator(f"td:nth-child({place})").evaluate_all(column)
    assert values == sorted(values)
    assert values[0] < 0
    page.keyboard.press("Enter")
    values = table.locator(f"td:nth-child({place})").evaluate_all(column)
    assert values == sorted(values, reverse=True)
    assert table.locator("th[aria-sort]").get_attribute("aria-sort") == "descending"


def test_the_contents_lead_to_their_headings(demo: Opened) -> None:
    """From the top of the page, whatever heights stand in for what is not drawn yet."""
    page = demo.page
    page.reload()
    page.wait_for_selector("body[data-ready=true]")
    for link in reversed(page.locator("#contents a").all()):
        page.evaluate("scrollTo(0, 0)")
        link.click()
        name = link.get_attribute("href")
        page.wait_for_function(
            """(name) => {
                 const top = document.querySelector(`${name} h2`).getBoundingClientRect().top;
                 const end = scrollY + innerHeight >= document.documentElement.scrollHeight - 2;
                 return Math.abs(top - 12) < 8 || (end && top > 0 && top < innerHeight);
               }""",
            arg=name,
            timeout=5000,
        )


def saved(page: Page, button: Any) -> bytes:
    with page.expect_download() as download:
        button.click()
    return Path(download.value.path()).read_bytes()


def test_a_table_is_saved(demo: Opened, report: Report) -> None:
    document = report("demo")[1]
    fold = demo.page.locator("#statistics")
    if fold.get_attribute("open") is None:
        fold.locator("summary").first.click()
    text = saved(
        demo.page,
        fold.locator(
            "table[aria-label='All dwells'] >> xpath=ancestor::details[1]//button[text()='Save CSV']"
        ).first,
    )
    rows = list(csv.reader(text.decode().splitlines()))
    assert len(rows) == 1 + len(document.points)
    head = {name: i for i, name in enumerate(rows[0])}
    torques = sorted(float(row[head["Torque, N·m"]]) for row in rows[1:])
    assert torques == pytest.approx(sorted(p.torque for p in document.points), rel=1e-3)
    assert demo.violations == []


def test_no_cell_that_is_saved_is_a_formula(demo: Opened) -> None:
    """By the same rule as the tables that commands write."""
    source = (ROOT / "python" / "hersey" / "report" / "static" / "drawing.js").read_text()
    of_cells = source[source.index("const FORMULA") : source.index("// A table that sorts")]
    texts = [*CELLS, "\u22121.5"]
    written = demo.page.evaluate(
        f"(texts) => {{ {of_cells} return csv(['n'], texts.map((text) => [text])); }}", texts
    )
    with io.StringIO(written, newline="") as file:
        cells = [row[0] if row else "" for row in csv.reader(file)]
    assert cells == ["n", *CELLS.values(), "-1.5"]


def test_the_document_is_saved(demo: Opened, report: Report) -> None:
    text = saved(demo.page, demo.page.locator("button", has_text="Save document"))
    document = load(text.decode())
    made = report("demo")[1]
    assert made.map is not None
    assert document.points == made.points
    assert document.model_dump(mode="json")["map"] == made.map.to_dict()


@pytest.mark.parametrize(("kind", "start"), [("SVG", b"<svg"), ("PNG", b"\x89PNG")])
def test_a_chart_is_saved(demo: Opened, kind: str, start: bytes) -> None:
    behind = demo.page.locator("#chart-regime details")
    if behind.get_attribute("open") is None:
        behind.locator("summary").click()
    behind.locator("tbody tr").nth(4).wait_for(state="attached")  # rows come when the fold opens
    content = saved(demo.page, behind.locator("button", has_text=f"Save {kind}"))
    assert content.startswith(start)
    assert b"light-dark" not in content
    assert demo.violations == []


def test_a_series_can_be_hidden(demo: Opened) -> None:
    fold = demo.page.locator("#chart-torque details")
    if fold.get_attribute("open") is None:
        fold.locator("summary").click()
    press = demo.page.locator("#chart-torque .toggle").first
    marks = """[...document.querySelectorAll('#chart-torque .mark-symbol path')]
      .filter((e) => Number(e.getAttribute('opacity')) < 0.5).length"""
    assert demo.page.evaluate(marks) == 0
    press.focus()
    demo.page.keyboard.press("Space")
    assert press.get_attribute("aria-pressed") == "false"
    assert demo.page.evaluate(marks) > 5
    press.click()
    assert demo.page.evaluate(marks) == 0
    fold.locator("summary").click()


def test_a_tooltip_shows_the_numbers_of_a_dwell(demo: Opened) -> None:
    mark = demo.page.locator("#chart-torque svg .mark-symbol path").nth(5)
    mark.scroll_into_view_if_needed()
    mark.hover(force=True)
    demo.page.wait_for_selector("#vg-tooltip-element.visible")
    text = demo.page.text_content("#vg-tooltip-element") or ""
    assert "speed (rpm)" in text
    assert "torque (" in text


def test_one_cursor_reads_all_rows_of_the_log(demo: Opened) -> None:
    place = demo.page.locator("#timeline .chart")
    place.scroll_into_view_if_needed()
    place.hover(position={"x": 500, "y": 120})
    read = place.locator(".cursor text").all_text_contents()
    assert [re.sub(r"[\d.\u2212]+ ", "", text) for text in read] == ["rpm", "N·m", "°C", "s"]
    first = read[-1]
    place.focus()
    demo.page.keyboard.press("ArrowRight")
    assert place.locator(".cursor text").last.text_content() != first
    said = demo.page.locator("#timeline [aria-live]").text_content() or ""
    assert "Torque" in said


def test_keys_reach_everything_in_order(demo: Opened) -> None:
    """Tab goes down the page; nothing that takes a click is left out."""
    page = demo.page
    page.reload()
    page.wait_for_selector("body[data-ready=true]")
    page.evaluate("document.activeElement.blur(); scrollTo(0, 0)")
    want = page.evaluate(
        """() => [...document.querySelectorAll("a, button, summary, input, select, [tabindex='0']")]
             .filter((e) => !e.disabled && e.checkVisibility()).length"""
    )
    seen = []
    for _ in range(want + 5):
        page.keyboard.press("Tab")
        seen.append(
            page.evaluate(
                """() => { const e = document.activeElement; if (e === document.body) return null;
                     e.dataset.seen = "true";
                     const b = e.getBoundingClientRect();
                     return [b.x, b.y + scrollY, e.closest("#map, #panel, nav, .columns") !== null]; }"""
            )
        )
        if seen[-1] is None:
            break
    left = page.evaluate(
        """() => [...document.querySelectorAll("a, button, summary, input, select")]
             .filter((e) => e.checkVisibility() && !e.disabled && e.tabIndex >= 0 && !e.dataset.seen)
             .map((e) => e.outerHTML.slice(0, 80))"""
    )
    assert left == []
    down = [place[1] for place in seen if place is not None and not place[2]]
    assert all(after > before - 40 for before, after in pairwise(down))


def test_it_prints(browser: Browser, report: Report) -> None:
    """Five pages of A4, light, folds open, and no control."""
    opened = Opened(browser, report("demo")[0], size=DESK, scheme="dark")
    SCREENS.mkdir(parents=True, exist_ok=True)
    pdf = opened.page.pdf(prefer_css_page_size=True, path=SCREENS / "demo.pdf")
    assert len(re.findall(rb"/Type\s*/Page[^s]", pdf)) <= 5
    opened.page.emulate_media(media="print")
    opened.page.evaluate("dispatchEvent(new Event('beforeprint'))")
    assert opened.page.evaluate("getComputedStyle(document.documentElement).colorScheme") == "light"
    assert opened.page.locator("button:visible:not(.by), nav:visible").count() == 0
    assert opened.page.locator(".on-paper:visible", has_text="3 of 73 rows").count() == 1
    opened.page.evaluate("dispatchEvent(new Event('afterprint'))")
    assert opened.page.locator("details[open]").count() == 0
    opened.page.close()


def test_the_document_is_data_and_no_markup(report: Report) -> None:
    text = report("demo")[0].read_text(encoding="utf-8")
    assert len(text.encode()) < 2_500_000
    (block,) = re.findall(r'id="document">(.*?)</script>', text, re.DOTALL)
    assert json.loads(block)["title"] == "bench.csv"
