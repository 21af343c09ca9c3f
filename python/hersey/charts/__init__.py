"""One chart per result.

===============  ==========================================================================
style            sizes, colours, the smallest pieces
labels           where texts stand, so that none covers another
vega             drawing and bundling, in a process of their own (`vega_script` runs there)
runtime          the Vega runtime, inlined in every page
page             what every page is made of, and what it may do
render           from a chart to the content of a file
analysis         the charts of the analysis document
over_time        lines, shades and moments over time, of which those of log, motion, plan and warm_up are made
log              speed, torque and temperature over time
inspection       the channels of a log, and their faults
against_speed    dwells and curves against speed, of which most of what follows is made
damping          dwells, surface, candidates, two logs, the next dwells
coast_down       speeds of a coast-down, and its torque against speed
moving           friction against speed of a log that moves all the time
regime           exponents against what each regime predicts
film             the regime chart, over the Stribeck curve
friction_curve   torque of a joint against speed, both directions
friction         the Stribeck curve: dwells, model, regimes, stall
mixed            torque of film and asperities against speed
transition       transition speed against temperature
stick_speed      V* against the stick speed
torque_budget    what film, contact and no-load torque take, stacked
motion           a trajectory, and the lap to which it settles
cycles           trace, cycles and fitted motion
hysteresis       what the belt does at which drive speed
operating_map    the operating map
plan             a drive profile and the motion
warm_up          speed, drag and temperatures of a warm-up
weibull          axes that make a Weibull law a straight line
life_failures    specimens of a life test as intervals, on the axes of a Weibull plot
failures         share failed against age, of failures typed in; remaining life, fleet, test plan
ageing_maps      the operating map of a unit when new, now and at its end
life             the charts of a life test, in the order of its page
trend            friction against age at one speed
drift            what moved with age, a panel per quantity
film_life        the film of units that age, and the layer of oil that feeds it
growth           growth with age, and the ages at a limit
replacement      cost against the age of a planned replacement
time_to_failure  failure modes against age
other_uses       the ages in other uses of the machine
===============  ==========================================================================
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from hersey.errors import ParameterError

if TYPE_CHECKING:
    from hersey.charts.style import Chart

#: Kinds of file of a figure, and of a picture that may also be a page: it has tooltips and needs no network.
FIGURES = (".png", ".svg", ".pdf")
PICTURES = (".html", *FIGURES)
#: Module and function that draw each kind of result, by the name of its type.
CHARTS = {
    "TorqueLog": ("log", "log_chart"),
    "Inspection": ("inspection", "channels_chart"),
    "SteadyPoints": ("damping", "steady_chart"),
    "DampingSurface": ("damping", "surface_chart"),
    "FrictionCurve": ("friction_curve", "friction_curve_chart"),
    "NoLoadTorque": ("damping", "rest_chart"),
    "ModelComparison": ("damping", "models_chart"),
    "LogComparison": ("damping", "logs_chart"),
    "CoastDown": ("coast_down", "coast_down_chart"),
    "TestDesign": ("damping", "design_chart"),
    "MovingFit": ("moving", "moving_chart"),
    "Regime": ("regime", "regime_chart"),
    "Film": ("film", "film_chart"),
    "MeasuredFilm": ("film", "measured_chart"),
    "MixedFilm": ("mixed", "mixed_chart"),
    "Trajectory": ("motion", "trajectory_chart"),
    "StickSlipCycle": ("motion", "cycle_chart"),
    "CycleRecord": ("cycles", "trace_chart"),
    "IdentifiedDrive": ("cycles", "drive_chart"),
    "HysteresisBand": ("hysteresis", "band_chart"),
    "OperatingMap": ("operating_map", "map_chart"),
    "Plan": ("plan", "plan_chart"),
    "WarmUp": ("warm_up", "warm_up_chart"),
    "FailureLaw": ("failures", "law_chart"),
    "RemainingLife": ("failures", "remaining_chart"),
    "FleetForecast": ("failures", "fleet_chart"),
    "Replacement": ("replacement", "replacement_chart"),
    "LifeTestPlan": ("failures", "plan_chart"),
    "OtherUses": ("other_uses", "other_uses_chart"),
    "AgeingMaps": ("ageing_maps", "ageing_maps_chart"),
    "LifeTest": ("life", "life_chart"),
    "FrictionTrend": ("trend", "trend_chart"),
    "Drift": ("drift", "drift_chart"),
    "FilmLife": ("film_life", "film_life_chart"),
    "Growth": ("growth", "growth_chart"),
    "AgesAtLimit": ("growth", "ages_chart"),
    "TimeToFailure": ("time_to_failure", "time_to_failure_chart"),
}


def has_chart(kind: type) -> bool:
    """Return whether `chart_of` draws results of a type."""
    return _place(kind) is not None


def _place(kind: type) -> tuple[str, str] | None:
    """Module and function that draw results of a type."""
    names = [each.__name__ for each in kind.__mro__]
    return next((CHARTS[name] for name in names if name in CHARTS), None)


def chart_of(result: object, **choices: Any) -> Chart:
    """Return the chart of a result; its module is loaded when it is first drawn.

    Parameters
    ----------
    result
        Of a type in `CHARTS`.
    choices
        What its function takes beside the result, as ``tooltips=False`` of an operating map.

    Raises
    ------
    ParameterError
        If such a thing has no chart.
    """
    place = _place(type(result))
    if place is None:
        raise ParameterError(
            f"there is no chart of an object of type {type(result).__name__}: {', '.join(CHARTS)} have one"
        )
    from hersey.charts.style import unchecked

    module, function = place
    draw = getattr(importlib.import_module(f"hersey.charts.{module}"), function)
    with unchecked():
        chart: Chart = draw(result, **choices)
    return chart
