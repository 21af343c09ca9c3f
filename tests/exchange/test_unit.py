"""What a unit holds: valid by the standard, the same bits from the same input, and its own account."""

from __future__ import annotations

import json
import re
import zipfile
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml

import fmpy
import pytest
from fmpy.validation import validate_fmu

import hersey
from hersey.errors import MissingFileError, OutputError, ParameterError
from hersey.exchange import unit as exporting
from hersey.exchange.documentation import LICENSE_TEXT
from hersey.exchange.platforms import own_library
from hersey.exchange.unit_definitions import _UNITS
from hersey.exchange.variables import variables_of
from tests.conftest import ROOT
from tests.exchange.test_against_core import CLOSURES, DRAG, TABLE, TRAIN, VERSIONS, WARM, mixed_drag


def contents(path: Path) -> dict[str, bytes]:
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def described(path: Path) -> Xml.Element:
    return Xml.fromstring(contents(path)["modelDescription.xml"])


def kinds() -> dict[str, tuple[hersey.Drivetrain, Any, dict[str, Any]]]:
    """One of each kind of unit."""
    warm = {"temperature": 420.0}
    of_closures = {
        name: (TRAIN, replace(WARM, closure=name, **more), warm) for name, more in CLOSURES.items()
    }
    return of_closures | {
        "table": (TRAIN, TABLE, {}),
        "mixed": (TRAIN, mixed_drag(), {"temperature": "150 degC"}),
        "grip": (replace(TRAIN, grip=40.0), DRAG, {"start": "steady", "drive_speed": "30 mm/s"}),
        "given": (TRAIN, replace(DRAG, static_force=50.0), {"start": (0.01, 1e-4)}),
        "torque": (TRAIN, WARM, warm | {"drive": "torque", "drive_torque": "1 N*m", "roll_radius": "15 mm"}),
        "free": (hersey.Drivetrain(0.0, 2.0), DRAG, {"drive": "torque", "roll_radius": 0.015}),
    }


@pytest.mark.parametrize("fmi", VERSIONS)
@pytest.mark.parametrize("kind", [*CLOSURES, "table", "mixed", "grip", "given", "torque", "free"])
def test_every_kind_is_valid_and_runs(kind: str, fmi: str, tmp_path: Path) -> None:
    train, drag, settings = kinds()[kind]
    unit = hersey.export_fmu(tmp_path / "drive.fmu", train, drag, fmi=fmi, **settings)
    assert validate_fmu(str(unit.path)) == []
    assert fmpy.simulate_fmu(str(unit.path), stop_time=0.01, output_interval=0.005).size == 3


@pytest.mark.parametrize("fmi", VERSIONS)
def test_the_same_input_gives_the_same_bits(fmi: str, tmp_path: Path) -> None:
    one, other, third = (tmp_path / f"{i}.fmu" for i in range(3))
    for path in (one, other):
        hersey.export_fmu(path, TRAIN, WARM, temperature=420.0, fmi=fmi)
    sticky = replace(WARM, closure="stribeck")  # of which the description says nothing
    tokens = {hersey.export_fmu(third, TRAIN, sticky, temperature=420.0, fmi=fmi).token}
    assert one.read_bytes() == other.read_bytes()
    tokens |= {
        described(path).get("guid" if fmi == "2.0" else "instantiationToken") or "" for path in (one, third)
    }
    assert len(tokens) == 2
    with zipfile.ZipFile(one) as archive:
        assert {entry.date_time for entry in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
        assert archive.namelist()[0] == "modelDescription.xml"


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_unit_whose_description_was_changed_is_refused(fmi: str, tmp_path: Path) -> None:
    """The token of another unit is not this one's."""
    one = hersey.export_fmu(tmp_path / "one.fmu", TRAIN, DRAG, fmi=fmi)
    other = hersey.export_fmu(tmp_path / "other.fmu", TRAIN, DRAG, drive_speed=0.1, fmi=fmi)
    parts = contents(one.path) | {"modelDescription.xml": contents(other.path)["modelDescription.xml"]}
    with zipfile.ZipFile(tmp_path / "crossed.fmu", "w") as archive:
        for name, content in parts.items():
            archive.writestr(name, content)
    with pytest.raises(Exception, match="instantiate"):
        fmpy.simulate_fmu(str(tmp_path / "crossed.fmu"), stop_time=0.01)


@pytest.mark.parametrize("fmi", VERSIONS)
def test_variables_are_those_of_the_drive(fmi: str, tmp_path: Path) -> None:
    """An input that the drive has not, or a parameter that it does not read, is not there."""
    names = {}
    for kind in ("table", "retained", "torque", "lugre"):
        train, drag, settings = kinds()[kind]
        unit = hersey.export_fmu(tmp_path / f"{kind}.fmu", train, drag, fmi=fmi, **settings)
        names[kind] = {v.name for v in unit.variables}
        about = fmpy.read_model_description(str(unit.path))
        assert {v.name for v in about.modelVariables} == names[kind]
        starts = {
            v.name: float(v.start) for v in about.modelVariables if v.causality in ("input", "parameter")
        }
        assert starts == {name: unit.starts[name] for name in starts}
    assert not {"temperature", "drive_torque", "transition_force", "grip"} & names["table"]
    assert {"drive_speed", "temperature", "transition_force", "rest_temperature_slope"} <= names["retained"]
    assert {"drive_torque", "roll_radius"} <= names["torque"]
    assert "drive_speed" not in names["torque"]
    assert {"bristle_stiffness", "bristle_damping"} <= names["lugre"]


def test_it_says_what_the_library_can(tmp_path: Path) -> None:
    able = {"canHandleVariableCommunicationStepSize"}
    expected = {
        "3.0": able
        | {"canGetAndSetFMUState", "canSerializeFMUState", "hasEventMode", "mightReturnEarlyFromDoStep"},
        "2.0": able | {"canGetAndSetFMUstate", "canSerializeFMUstate", "canInterpolateInputs"},
    }
    for fmi, flags in expected.items():
        unit = hersey.export_fmu(tmp_path / f"{fmi[0]}.fmu", TRAIN, DRAG, fmi=fmi)
        found = described(unit.path).find("CoSimulation")
        assert found is not None
        assert {name for name, value in found.attrib.items() if value == "true"} == flags
        assert found.attrib["modelIdentifier"] == "hersey"


def test_numbers_of_the_drive_are_whole(tmp_path: Path) -> None:
    """Every number of the file comes back to the last digit."""
    unit = hersey.export_fmu(
        tmp_path / "drive.fmu", TRAIN, replace(WARM, mixed_exponent=-4 / 3), temperature=420.0
    )
    lines = contents(unit.path)["resources/drive.txt"].decode().splitlines()
    values = dict(line.split(" = ", 1) for line in lines if not line.startswith("#"))
    assert float(values["mixed_exponent"]) == -4 / 3
    assert values["format"] == "1"
    assert values["token"] == unit.token
    assert {float(values[name]) == value for name, value in unit.starts.items()} == {True}


@pytest.mark.parametrize("fmi", VERSIONS)
def test_units_are_defined_in_base_units_and_shown_as_people_read_them(fmi: str, tmp_path: Path) -> None:
    unit = hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, WARM, temperature="180 degC", fmi=fmi)
    root = described(unit.path)
    by_name = {element.get("name"): element for element in root.iter("Unit")}
    stiffness, kelvin = by_name["N/m"], by_name["K"].find("DisplayUnit")
    assert stiffness.find("BaseUnit").attrib == {"kg": "1", "s": "-2"}  # type: ignore[union-attr]
    assert kelvin is not None
    assert float(kelvin.attrib["factor"]) * unit.starts["temperature"] + float(
        kelvin.attrib["offset"]
    ) == pytest.approx(180)
    used = {element.get("unit") for element in root.iter() if element.get("unit")}
    assert used == set(by_name)
    about = fmpy.read_model_description(str(unit.path))
    displays = {v.name: v.displayUnit for v in about.modelVariables}
    assert (displays["drive_speed"], displays["temperature"], displays["stiffness"]) == (
        "mm/s",
        "degC",
        "N/mm",
    )


@pytest.mark.parametrize("fmi", VERSIONS)
def test_mode_is_an_enumeration_of_its_names(fmi: str, tmp_path: Path) -> None:
    """Held at the start, whatever the version; tools show the name."""
    unit = hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG, fmi=fmi).path
    about = fmpy.read_model_description(str(unit))
    (mode,) = (v for v in about.modelVariables if v.name == "mode")
    assert mode.type == "Enumeration"
    assert mode.declaredType.name == "Mode"
    items = {item.name: int(item.value) for item in mode.declaredType.items}
    assert items == {"ehl": 0, "mixed": 1, "microslip": 2, "stuck": 3}
    ran = fmpy.simulate_fmu(
        str(unit), stop_time=1.0, output_interval=0.005, start_values={"drive_speed": 0.03}, output=["mode"]
    )
    assert ran["mode"][1] == 3
    assert set(ran["mode"]) >= {0, 1, 3}


@pytest.mark.parametrize("name", list(_UNITS))
def test_definitions_of_units_agree_with_the_one_door(name: str) -> None:
    """Exponents and factors of each unit are those of the registry that reads units."""
    from hersey.units import registry

    unit = _UNITS[name]
    base = registry.Quantity(1.0, name.replace("N.m", "N*m").replace(".s", "*s")).to_base_units()
    dimensions = {"[length]": "m", "[mass]": "kg", "[time]": "s", "[temperature]": "K"}
    found = {dimensions[d]: int(power) for d, power in base.dimensionality.items()}
    assert found == {key: power for key, power in unit.exponents.items() if key != "rad"}
    assert base.magnitude == pytest.approx(1.0)
    if unit.shown and unit.shown not in ("%/K", "degC"):
        text = unit.shown.replace("mN.m", "mN*m").replace("mPa.s", "mPa*s")
        assert registry.Quantity(1.0, text).to(base.units).magnitude * unit.factor == pytest.approx(1.0)


def test_the_library_tells_units_that_are_defined() -> None:
    variables = variables_of(own_library())
    assert {v.unit for v in variables if v.unit} <= set(_UNITS)
    assert {v.causality for v in variables} == {"independent", "input", "output", "parameter"}
    assert all(v.description for v in variables)


def test_it_says_what_it_is_made_of(surface: hersey.DampingSurface, tmp_path: Path) -> None:
    machine = hersey.read_machine(ROOT / "tests" / "stand" / "machine.toml")
    drag = surface.drag(**machine.belt)
    unit = hersey.export_fmu(
        tmp_path / "drive.fmu",
        machine.train,
        drag,
        temperature="150 degC",
        fitted=surface,
        roll_radius="15 mm",
    )
    parts = contents(unit.path)
    page, told = (parts[name].decode() for name in ("documentation/index.html", "resources/drive.txt"))
    sums = surface.data_sha256[0]
    for text in (page, told, described(unit.path).get("description") or "", unit.summary()):
        assert sums in text
        assert hersey.__version__ in text
        assert "extrapolated outside" in text
    high = surface.speed_range[1] * 30 / 3.141592653589793
    assert f" to {high:.4g} rpm" in unit.facts["Measured at"]
    for variable in unit.variables:
        if variable.causality == "independent":
            continue
        assert f"<code>{variable.name}</code>" in page
    assert (
        parts["documentation/licenses/license.txt"].decode() == LICENSE_TEXT == (ROOT / "LICENSE").read_text()
    )
    assert "http" not in page
    assert json.loads(json.dumps(unit.to_dict())) == unit.to_dict()


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        ({"fmi": "1.0"}, "fmi is '1.0': it must be 3.0 or 2.0"),
        ({"drive": "current"}, "drive is 'current': it must be speed or torque"),
        ({"drive": "torque"}, "needs the roll_radius"),
        ({"drive": "torque", "roll_radius": 0.0}, "roll_radius is 0.0: it must be greater than 0"),
        ({"temperature": 400.0}, "temperature is given, but"),
        ({"start": "running"}, "start is 'running': it must be rest, steady"),
        (
            {"drive": "torque", "roll_radius": 0.02, "start": "steady"},
            "start 'steady' needs drive 'speed'",
        ),
        ({"drive_speed": float("nan")}, "is NaN"),
        ({"drive_speed": "30 rpm"}, "rpm"),
        ({"tolerance": 2.0}, "tolerance"),
        ({"name": " "}, "name is ' ': it must be one line of visible characters"),
        ({"name": "a\nb"}, "it must be one line of visible characters"),
        (
            {"libraries": {"sparc-solaris": "hersey.so"}},
            "platform 'sparc-solaris' is not known: x86_64-linux",
        ),
        (
            {"libraries": {"aarch64-linux": "hersey.so"}, "fmi": "2.0"},
            "FMI 2.0 has no folder for aarch64-linux",
        ),
    ],
)
def test_what_is_wrong_is_said_in_a_line(settings: dict[str, Any], said: str, tmp_path: Path) -> None:
    with pytest.raises(hersey.HerseyError) as caught:
        hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, DRAG, **settings)
    assert re.search(re.escape(said), str(caught.value))
    assert "\n" not in str(caught.value)
    assert list(tmp_path.iterdir()) == []


def test_a_drive_that_is_none_is_refused(tmp_path: Path) -> None:
    for train in (replace(TRAIN, stiffness=0.0), replace(TRAIN, mass=-1.0)):
        with pytest.raises(ParameterError, match=r"stiffness|mass"):
            hersey.export_fmu(tmp_path / "drive.fmu", train, DRAG)
    with pytest.raises(ParameterError, match=r"depends on temperature. Give temperature"):
        hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, WARM)
    with pytest.raises(
        ParameterError, match="temperature is -20 degC: the law needs temperatures above 0 degC"
    ):
        hersey.export_fmu(tmp_path / "drive.fmu", TRAIN, WARM, temperature="-20 degC")


@pytest.mark.parametrize("fmi", VERSIONS)
def test_a_loop_may_be_closed_over_the_motion(fmi: str, tmp_path: Path) -> None:
    """Speed and forces of the spring answer to no input at once, drag to temperature and torque alone."""
    for kind, drag in (
        ("retained", {"temperature"}),
        ("torque", {"temperature", "drive_torque"}),
        ("grip", set()),
    ):
        train, law, settings = kinds()[kind]
        unit = hersey.export_fmu(tmp_path / f"{kind}.fmu", train, law, fmi=fmi, **settings)
        about = fmpy.read_model_description(str(unit.path))
        at_once = {
            u.variable.name: None if u.dependencies is None else {v.name for v in u.dependencies}
            for u in about.outputs
        }
        assert [at_once[name] for name in ("drag", "friction_power", "contact_power")] == [drag] * 3
        assert [at_once[name] for name in ("friction_energy", "belt_position")] == [set()] * 2
        assert at_once["slip_power"] == ({"drive_speed"} if kind != "torque" else set())
        assert [at_once[name] for name in ("belt_speed", "stretch", "spring_force")] == [set()] * 3
        assert at_once["mode"] is None
        first = {u.variable.name: u.dependencies for u in about.initialUnknowns}
        if kind == "grip":  # it starts steady
            assert first["belt_speed"] is None
        else:
            assert {v.causality for v in first["belt_speed"]} == {"parameter"}


def test_nothing_is_replaced_unasked_and_a_failure_leaves_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "drive.fmu"
    path.write_text("kept")
    with pytest.raises(OutputError, match="exists"):
        hersey.export_fmu(path, TRAIN, DRAG)
    assert path.read_text() == "kept"
    hersey.export_fmu(path, TRAIN, DRAG, overwrite=True)
    assert zipfile.is_zipfile(path)
    with pytest.raises(ParameterError, match=r"ends in \.fmu"):
        hersey.export_fmu(tmp_path / "drive.zip", TRAIN, DRAG)
    with pytest.raises(OutputError, match="cannot be written"):
        hersey.export_fmu(tmp_path / "none" / "drive.fmu", TRAIN, DRAG)
    monkeypatch.setattr(exporting, "own_library", lambda: tmp_path / "hersey.so")
    with pytest.raises(
        MissingFileError, match=r"no library for FMUs \(hersey.so is missing\). Build it with make build"
    ):
        hersey.export_fmu(tmp_path / "other.fmu", TRAIN, DRAG)
    assert [file.name for file in tmp_path.iterdir()] == ["drive.fmu"]
