"""`modelDescription.xml` of a unit, for FMI 3.0 and for 2.0."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as Xml

from hersey import _core
from hersey.exchange.platforms import LIBRARY
from hersey.exchange.unit_definitions import shown, unit_definitions
from hersey.exchange.variables import Variable

#: What tools simulate by default: seconds.
STOP, STEP = 2.0, 0.001
COPYRIGHT, LICENSE = "Copyright (c) 2026 The hersey authors", "MIT"
#: Type of a variable in FMI 2.0.
_TYPES_2 = {"Float64": "Real", "Enumeration": "Enumeration", "Boolean": "Boolean"}
#: How a variable begins, where FMI lets one say so.
_INITIAL = {"parameter": "exact", "output": "calculated"}
_CATEGORIES = {
    "logStatusWarning": "Unusual values; the simulation continues",
    "logStatusError": "Calls that are refused, with the reason",
}


@dataclass(frozen=True)
class Model:
    """What a description says beside its variables: name, what it is of, how it starts, tolerance, starts."""

    name: str
    description: str
    start: str
    tolerance: float
    starts: Mapping[str, float]


def description(model: Model, variables: Sequence[Variable], fmi: str, token: str) -> bytes:
    """Return the description: the same input gives the same bytes.

    Parameters
    ----------
    model, variables
        What is described; inputs and parameters have a start, in the model or in themselves.
    fmi
        ``3.0`` or ``2.0``.
    token
        By which the library knows that the description is its own.
    """
    head = {
        "fmiVersion": fmi,
        "modelName": model.name,
        "guid" if fmi == "2.0" else "instantiationToken": token,
        "description": model.description,
        "version": _core.VERSION,
        "copyright": COPYRIGHT,
        "license": LICENSE,
        "generationTool": f"hersey {_core.VERSION}",
        "variableNamingConvention": "flat",
    }
    root = Xml.Element("fmiModelDescription", head)
    root.append(_co_simulation(fmi))
    root.append(unit_definitions({v.unit for v in variables if v.unit}))
    root.append(_types(variables, fmi))
    categories = Xml.SubElement(root, "LogCategories")
    for name, meaning in _CATEGORIES.items():
        Xml.SubElement(categories, "Category", name=name, description=meaning)
    experiment = {"startTime": 0.0, "stopTime": STOP, "tolerance": model.tolerance, "stepSize": STEP}
    Xml.SubElement(root, "DefaultExperiment", {name: repr(value) for name, value in experiment.items()})
    listed = Xml.SubElement(root, "ModelVariables")
    listed.extend((_variable_2 if fmi == "2.0" else _variable_3)(v, model.starts) for v in variables)
    root.append((_structure_2 if fmi == "2.0" else _structure_3)(variables, model.start))
    Xml.indent(root)
    text = Xml.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'.encode()


def _type_name(variable: Variable) -> str:
    """Name of the enumeration that a variable is of; FMI wants one that is no variable's."""
    return variable.name.capitalize()


def _types(variables: Sequence[Variable], fmi: str) -> Xml.Element:
    """The enumerations, their items numbered as the library numbers them."""
    top = Xml.Element("TypeDefinitions")
    for variable in (v for v in variables if v.items):
        about = {"name": _type_name(variable), "description": variable.description}
        if fmi == "2.0":
            listed = Xml.SubElement(Xml.SubElement(top, "SimpleType", about), "Enumeration")
        else:
            listed = Xml.SubElement(top, "EnumerationType", about)
        for number, name in enumerate(variable.items):
            Xml.SubElement(listed, "Item", name=name, value=str(number))
    return top


def _declared(variable: Variable) -> dict[str, str]:
    return {"declaredType": _type_name(variable)} if variable.items else {}


def _co_simulation(fmi: str) -> Xml.Element:
    """What the library can do; its own tests hold it to that."""
    able = {"modelIdentifier": LIBRARY, "canHandleVariableCommunicationStepSize": "true"}
    if fmi == "2.0":
        able |= {
            "canInterpolateInputs": "true",
            "canGetAndSetFMUstate": "true",
            "canSerializeFMUstate": "true",
        }
    else:
        able |= {"canGetAndSetFMUState": "true", "canSerializeFMUState": "true"}
        able |= {"hasEventMode": "true", "mightReturnEarlyFromDoStep": "true"}
    return Xml.Element("CoSimulation", able)


def _start(variable: Variable, starts: Mapping[str, float]) -> dict[str, str]:
    if variable.causality not in ("input", "parameter"):
        return {}
    value = starts.get(variable.name)
    return {"start": variable.start if value is None else repr(float(value))}


def _common(variable: Variable) -> dict[str, str]:
    return {
        "name": variable.name,
        "valueReference": str(variable.reference),
        "description": variable.description,
        "causality": variable.causality,
        "variability": variable.variability,
    }


def _initial(variable: Variable) -> dict[str, str]:
    how = _INITIAL.get(variable.causality)
    return {"initial": how} if how else {}


def _units(variable: Variable) -> dict[str, str]:
    if not variable.unit:
        return {}
    display = shown(variable.unit)
    return {"unit": variable.unit} | ({"displayUnit": display} if display else {})


def _variable_3(variable: Variable, starts: Mapping[str, float]) -> Xml.Element:
    kind = {**_common(variable), **_initial(variable), **_declared(variable), **_units(variable)}
    kind |= _start(variable, starts)
    return Xml.Element(variable.type, kind)


def _variable_2(variable: Variable, starts: Mapping[str, float]) -> Xml.Element:
    element = Xml.Element("ScalarVariable", {**_common(variable), **_initial(variable)})
    kind = {**_declared(variable), **_units(variable), **_start(variable, starts)}
    Xml.SubElement(element, _TYPES_2[variable.type], kind)
    return element


_WITH_DRAG = {"temperature", "drive_torque"}
#: Inputs that an output answers to at once.
_AT_ONCE = {
    "drag": _WITH_DRAG,
    "friction_power": _WITH_DRAG,
    "contact_power": _WITH_DRAG,
    "slip_power": {"drive_speed", "roll_speed"},
}


def _hangs_on(variable: Variable, variables: Sequence[Variable]) -> list[Variable] | None:
    """The inputs that an output answers to at once; None for any.

    Motion, ways and heat since the start are states, so that a tool may close a loop over them. Drag and its
    powers follow temperature and, while drag holds the belt, a torque on the roll; slip is against the drive.
    """
    if variable.type != "Float64":
        return None
    at_once = _AT_ONCE.get(variable.name, set())
    return [v for v in variables if v.causality == "input" and v.name in at_once]


def _unknowns(variables: Sequence[Variable], start: str) -> list[tuple[str, Variable, list[Variable] | None]]:
    """Outputs with what they hang on, in motion and, as initial unknowns, at the start.

    A belt that starts steady has its speed of the drive.
    """
    outputs = [v for v in variables if v.causality == "output"]
    known = [v for v in variables if v.causality == "parameter"]
    found = [("Output", v, _hangs_on(v, variables)) for v in outputs]
    for v in outputs:
        inputs = None if start == "steady" else _hangs_on(v, variables)
        found.append(("InitialUnknown", v, None if inputs is None else [*inputs, *known]))
    return found


def _structure_3(variables: Sequence[Variable], start: str) -> Xml.Element:
    structure = Xml.Element("ModelStructure")
    for name, variable, inputs in _unknowns(variables, start):
        element = Xml.SubElement(structure, name, valueReference=str(variable.reference))
        if inputs is not None:
            element.set("dependencies", " ".join(str(v.reference) for v in inputs))
    return structure


def _structure_2(variables: Sequence[Variable], start: str) -> Xml.Element:
    """The same; variables are counted from 1 in the order of the list."""
    structure = Xml.Element("ModelStructure")
    index = {v.name: str(i) for i, v in enumerate(variables, 1)}
    lists = {name: Xml.SubElement(structure, f"{name}s") for name in ("Output", "InitialUnknown")}
    for name, variable, inputs in _unknowns(variables, start):
        element = Xml.SubElement(lists[name], "Unknown", index=index[variable.name])
        if inputs is not None:
            element.set("dependencies", " ".join(index[v.name] for v in inputs))
    return structure
