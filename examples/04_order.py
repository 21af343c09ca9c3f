"""Error of the stick-slip frequency against tolerance, on the paper's baseline (docs/theory/order.svg)."""

import sys
from pathlib import Path

import altair as alt

import hersey

EXACT = 3.940313951318513  # independent solution at 1e-12 (physics.md, section 4)

train = hersey.Drivetrain(1000, 1)
drag = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)

KINDS = ["single motion (order 14)", "lanes (order 12)", "error = tolerance"]
rows = []
for power in range(3, 13):
    tolerance = 10.0**-power
    cycle = hersey.stick_slip(train, drag, drive_speed=1.0, tolerance=tolerance)
    run = hersey.simulate(train, drag, drive_speed=1.0, duration=5.0, samples=2, tolerance=tolerance)
    error = max(abs(cycle.frequency / EXACT - 1), 1e-14)
    rows.append({"tolerance": tolerance, "error": error, "what": "single motion (order 14)"})
    lanes = hersey.sweep(train, drag, drive_speed=1.0, work=hersey.Work(tolerance=tolerance))
    error = max(abs(float(lanes.frequency) / EXACT - 1), 1e-14)
    rows.append({"tolerance": tolerance, "error": error, "what": "lanes (order 12)"})
    print(f"tolerance {tolerance:.0e}: error {rows[-2]['error']:.1e}, lanes {error:.1e}, steps {run.steps}")
    rows.append({"tolerance": tolerance, "error": tolerance, "what": "error = tolerance"})

chart = (
    alt.Chart(alt.Data(values=rows))
    .mark_line(point=True)
    .encode(
        x=alt.X("tolerance:Q", title="tolerance", scale=alt.Scale(type="log"), axis=alt.Axis(format="~e")),
        y=alt.Y(
            "error:Q",
            title="relative error of the frequency",
            scale=alt.Scale(type="log"),
            axis=alt.Axis(format="~e"),
        ),
        color=alt.Color(
            "what:N", title=None, scale=alt.Scale(domain=KINDS, range=["#0b5394", "#e69138", "#999999"])
        ),
        strokeDash=alt.StrokeDash(
            "what:N", title=None, scale=alt.Scale(domain=KINDS, range=[[1, 0], [6, 2], [2, 3]])
        ),
    )
    .properties(width=460, height=300, title="Baseline of the paper: k = 1000, B0 = 50, drive speed 1")
)
folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent.parent / "docs" / "theory"
chart.save(folder / "order.svg")
chart.save(folder / "order.png") if len(sys.argv) > 1 else None
