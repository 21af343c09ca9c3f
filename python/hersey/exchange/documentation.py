"""The page that a unit carries about itself, and the licence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape

from hersey.exchange.description import Model
from hersey.exchange.unit_definitions import as_shown, shown
from hersey.exchange.variables import Variable

#: That of hersey, which the library in a unit is under.
LICENSE_TEXT = """\
MIT License

Copyright (c) 2026 The hersey authors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
"""
_STYLE = """\
body { max-width: 60rem; margin: 0 auto; padding: 1rem 1.25rem 3rem; color: #1a1a1a; background: #fff;
  font: 15px/1.5 "Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", sans-serif; }
p, li { overflow-wrap: anywhere; }
h1 { font-size: 1.4rem; margin: .5rem 0 .25rem; } h2 { font-size: 1.05rem; margin: 1.75rem 0 .4rem; }
table { display: block; overflow-x: auto; border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: top; padding: .25rem .75rem .25rem 0;
  border-bottom: 1px solid #ddd; }
td.n { text-align: right; white-space: nowrap; } th.n { text-align: right; }
code { font-family: ui-monospace, Consolas, "DejaVu Sans Mono", monospace; font-size: .9em; }
.facts { color: #555; } li { margin: .2rem 0; }
"""
#: What each group of variables is, in the order of the page.
_GROUPS = {
    "input": ("Inputs", "Inputs may jump at any communication point."),
    "output": ("Outputs", ""),
    "parameter": (
        "Parameters",
        "Parameters may be changed until initialization ends, and are fixed after it.",
    ),
}
_EVENTS = {
    "3.0": (
        "With event mode a step returns early at every change of mode (stick, release, start of mixed "
        "lubrication or full film, start and end of slip of the grip). Outputs can be read at that moment. "
        "Without it, steps continue through changes of mode. The motion is the same, because each "
        "change is located to rounding inside the step."
    ),
    "2.0": (
        "Inputs may have a slope between two points. Steps continue through changes of mode (stick, "
        "release, start of mixed lubrication or full film), each located to rounding inside the step."
    ),
}
_USE = {
    "Simulink": "add the FMU block and name the file. Ports are inputs and outputs, the mask has parameters.",
    "OpenModelica": "OMEdit: File, Import FMU (version 2.0). OMSimulator: add it as a component of a system.",
    "Amesim": "FMI import assistant, co-simulation; the FMU is a component of the sketch.",
    "Python": "<code>fmpy.simulate_fmu('drive.fmu', stop_time=2, output_interval=1e-3)</code>.",
}


def page(model: Model, variables: Sequence[Variable], facts: Mapping[str, str], fmi: str) -> str:
    """Return the page: what the unit is, its variables, where its law holds, how it is used.

    ``facts`` are what else is to be said of it, by what they are about.
    """
    listed = "".join(f"<li>{escape(name)}: {escape(fact)}</li>" for name, fact in facts.items())
    tables = "".join(_group(name, model, variables) for name in _GROUPS)
    uses = "".join(f"<li>{tool}: {how}</li>" for tool, how in _USE.items())
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width">\n'
        f"<title>{escape(model.name)}</title>\n<style>\n{_STYLE}</style>\n</head>\n<body>\n"
        f"<h1>{escape(model.name)}</h1>\n<p>A drive that may stick and slip, as an FMU for "
        f"co-simulation (FMI {fmi}). It contains the hersey core.</p>\n"
        f'<ul class="facts">{listed}</ul>\n{tables}'
        f"<h2>Steps and events</h2>\n<p>{_EVENTS[fmi]} The communication step size affects nothing else, "
        "because the library chooses its own steps. State can be saved, restored and serialized exactly. "
        "Any number of instances may run in one process.</p>\n"
        f"<h2>Use</h2>\n<ul>{uses}</ul>\n"
        "<h2>Licence</h2>\n<p>MIT: see licenses/license.txt.</p>\n</body>\n</html>\n"
    )


def _group(causality: str, model: Model, variables: Sequence[Variable]) -> str:
    title, remark = _GROUPS[causality]
    has_start = causality != "output"
    rows = "".join(
        f"<tr><td><code>{escape(v.name)}</code></td><td>{escape(v.unit if v.unit != '1' else '')}</td>"
        + (f'<td class="n">{escape(_start(v, model))}</td>' if has_start else "")
        + f"<td>{escape(v.description)}</td></tr>\n"
        for v in variables
        if v.causality == causality
    )
    head = '<th class="n">start</th>' if has_start else ""
    return (
        f"<h2>{title}</h2>\n" + (f"<p>{remark}</p>\n" if remark else "") + "<table><thead><tr><th>name</th>"
        f"<th>unit</th>{head}<th>what</th></tr></thead>\n<tbody>\n{rows}</tbody></table>\n"
    )


def _start(variable: Variable, model: Model) -> str:
    value = model.starts.get(variable.name)
    value = float(variable.start) if value is None else value
    plain = f"{value:.6g}"
    return f"{plain} ({as_shown(variable.unit, value)})" if variable.unit and shown(variable.unit) else plain
