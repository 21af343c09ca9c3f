"""What a base installation lacks: the answer names the package and what to type."""

from __future__ import annotations

import sys

import pytest

import hersey
from hersey.charts import vega
from hersey.errors import MissingFileError

TRAIN = hersey.Drivetrain(1000, 1)
DRAG = hersey.Drag(50, 1, ehl_exponent=-0.7, mixed_exponent=-1.2, stick_speed=0.01)


@pytest.fixture
def no_xarray(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xarray", None)


@pytest.fixture
def no_renderer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(vega, "find_spec", lambda _: None)


@pytest.mark.usefixtures("no_xarray")
def test_a_sweep_needs_xarray() -> None:
    with pytest.raises(MissingFileError, match=r"pip install 'hersey\[sweep\]'"):
        hersey.sweep(TRAIN, DRAG, drive_speed=[0.4, 1.0])
    with pytest.raises(MissingFileError, match=r"pip install 'hersey\[sweep\]'"):
        hersey.hysteresis_sweep(TRAIN, DRAG, stiffness=[500, 2000])


@pytest.mark.usefixtures("no_renderer")
def test_a_notebook_without_a_renderer_shows_the_words() -> None:
    found = hersey.stick_slip(TRAIN, DRAG, drive_speed=1.0)
    shown = found._repr_html_()
    assert found.summary().split("\n")[0] in shown
    assert "pip install &#x27;hersey[figures]&#x27;" in shown
    assert "<svg" not in shown
