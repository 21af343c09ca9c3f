"""What every page is made of: a policy that names its scripts by their digests, data that is no markup."""

from __future__ import annotations

import base64
import hashlib
import re

import pytest

import hersey
from hersey.charts import page as module
from hersey.charts.page import embedded, page
from hersey.charts.render import picture
from hersey.document.analysis import Analysis
from hersey.report.page import render


def test_embedded_text_is_no_markup() -> None:
    text = embedded({"title": "</script><!-- & -->"})
    assert not set("<>&") & set(text)


def directives(text: str) -> dict[str, list[str]]:
    (policy,) = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', text)
    return {name: sources for name, *sources in (part.split() for part in policy.split(";"))}


def test_the_policy_names_the_scripts_by_their_digests(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "runtime", lambda: "window.a = 1;\r\n")
    text = page(title="t", style="", body="", data={"d": 1}, script="é\r")
    digests = [
        f"'sha256-{base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()}'"
        for script in ("window.a = 1;\n", "é\n")
    ]
    assert directives(text)["script-src"] == digests
    assert text.count("<script") == 3


def test_a_title_is_no_markup_and_can_be_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "runtime", lambda: "")
    text = page(title="</title><b>\ud83d", style="", body="", data={}, script="")
    assert "<b>" not in text
    assert text.encode().count(b"</title>") == 1


def test_a_report_may_compute_and_else_no_more_than_a_figure(
    document: Analysis, points: hersey.SteadyPoints
) -> None:
    report, figure = directives(render(document)), directives(picture(points.chart(), ".html").decode())
    assert report["script-src"][0] == figure["script-src"][0]
    assert figure.pop("script-src")[2:] == []
    assert report.pop("script-src")[2:] == ["'wasm-unsafe-eval'"]  # compiles the core in it, and no text
    assert report.pop("worker-src") == ["blob:"]
    assert report == figure
    assert figure["default-src"] == figure["base-uri"] == figure["form-action"] == ["'none'"]
