"""Units run by FMPy, call for call: what the tests of a motion need, the same for FMI 3.0 and 2.0."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import fmpy
import numpy as np
from fmpy import fmi2, fmi3
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave

#: Status, category and text of what an instance says.
Said = tuple[int, str, str]


def _callbacks(said: list[Said]) -> fmi2.fmi2CallbackFunctions:
    """What an instance of FMI 2.0 is called back by: all that it says is kept."""
    found = fmi2.fmi2CallbackFunctions()
    found.logger = fmi2.fmi2CallbackLoggerTYPE(
        lambda _environment, _name, status, category, text: said.append(
            (status, category.decode(), text.decode())
        )
    )
    found.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
    found.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
    return found


class Instance:
    """One instance of a unit, initialized; values by name."""

    def __init__(
        self,
        folder: str,
        *,
        events: bool = False,
        start: dict[str, float] | None = None,
        initialize: bool = True,
        silent: bool = False,
    ) -> None:
        about = fmpy.read_model_description(folder)
        self.references = {v.name: v.valueReference for v in about.modelVariables}
        self.types = {v.name: v.type for v in about.modelVariables}
        self.is_2 = about.fmiVersion == "2.0"
        settings = {
            "guid": about.guid,
            "unzipDirectory": folder,
            "modelIdentifier": about.coSimulation.modelIdentifier,
            "instanceName": "drive",
        }
        self.events, self.time = events, 0.0
        self.said: list[Said] = []
        if self.is_2:
            self.fmu: Any = FMU2Slave(**settings)
            self.callbacks = _callbacks(self.said)
            if silent:
                self.callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(0)
            self.fmu.instantiate(callbacks=self.callbacks)
            self.fmu.setupExperiment(startTime=0.0)
        else:
            self.fmu = FMU3Slave(**settings)
            if silent:
                make = self.fmu.fmi3InstantiateCoSimulation
                none = fmi3.fmi3LogMessageCallback(0)
                self.fmu.fmi3InstantiateCoSimulation = lambda *given: make(*given[:-2], none, given[-1])
            self.fmu.instantiate(
                eventModeUsed=events,
                earlyReturnAllowed=events,
                logMessage=self._said,
            )
        self.set(**(start or {}))
        self.fmu.enterInitializationMode()
        if initialize:
            self.initialize()

    def _said(self, _environment: object, status: int, category: bytes, text: bytes) -> None:
        self.said.append((status, category.decode(), text.decode()))

    def initialize(self) -> None:
        self.fmu.exitInitializationMode()
        if self.events:
            self.handle()

    def handle(self) -> None:
        """Go through event mode, where the instance is in it."""
        while self.fmu.updateDiscreteStates()[0]:
            pass
        self.fmu.enterStepMode()

    def set(self, **values: float) -> None:
        put = self.fmu.setReal if self.is_2 else self.fmu.setFloat64
        if values:
            put([self.references[name] for name in values], list(values.values()))

    def get(self, *names: str) -> list[Any]:
        return [self._reader(name)([self.references[name]])[0] for name in names]

    def _reader(self, name: str) -> Any:
        kinds = {"Real": "getReal", "Enumeration": "getInteger" if self.is_2 else "getInt64"}
        return getattr(self.fmu, kinds.get(self.types[name], f"get{self.types[name]}"))

    def step(self, to: float) -> bool:
        """Step as far as the unit goes, at the most to a time; whether it returned early."""
        if self.is_2:
            self.fmu.doStep(currentCommunicationPoint=self.time, communicationStepSize=to - self.time)
            self.time = to
            return False
        event, ends, early, reached = self.fmu.doStep(
            currentCommunicationPoint=self.time, communicationStepSize=to - self.time
        )
        assert not ends
        assert event == early
        self.time = reached if early else to
        return bool(early)

    def to(self, until: float) -> list[float]:
        """Go to a time through all events; the times of these."""
        times = []
        while self.time < until:
            if self.step(until):
                times.append(self.time)
                self.fmu.enterEventMode()
                self.handle()
        return times

    def states(self) -> Any:
        return self.fmu.getFMUstate() if self.is_2 else self.fmu.getFMUState()

    def restore(self, state: Any) -> None:
        (self.fmu.setFMUstate if self.is_2 else self.fmu.setFMUState)(state)

    def serialized(self, state: Any) -> bytes:
        return bytes((self.fmu.serializeFMUstate if self.is_2 else self.fmu.serializeFMUState)(state))

    def deserialized(self, content: bytes) -> Any:
        name = "deSerializeFMUstate" if self.is_2 else "deserializeFMUState"
        return getattr(self.fmu, name)(content)


@contextmanager
def instance(unit: Path, **settings: Any) -> Iterator[Instance]:
    """An instance of a unit in a file, freed at the end."""
    with TemporaryDirectory() as folder:
        fmpy.extract(str(unit), folder)
        opened = Instance(folder, **settings)
        try:
            yield opened
        finally:
            opened.fmu.freeInstance()


def course(opened: Instance, times: np.ndarray, *names: str) -> np.ndarray:
    """Values at times, a column a name, stepping from each to the next."""
    rows = [opened.get(*names)]
    for time in times[1:]:
        opened.to(float(time))
        rows.append(opened.get(*names))
    return np.array(rows, dtype=float)
