"""The analyses of one start: changes by the page, and the processes that read and compute.

An analysis has a folder with a random name. It holds the machine file and the mapping, with links to the
logs that these name, a folder ``results``, and a folder for each dropped file. In the last the file lies
alone in ``dropped``, so that nothing of ours can have its name.
"""

from __future__ import annotations

import asyncio
import os
import shutil
import time
from collections.abc import AsyncIterator, Coroutine
from contextlib import suppress
from pathlib import Path
from typing import Any

from hersey.app.analysis import Analysis, Dropped, number
from hersey.app.channels import of_problem
from hersey.app.checking import check
from hersey.app.course import Courses
from hersey.app.kept import Kept, kept_reports
from hersey.app.machine import MACHINE_FILE, MAPPING_FILE
from hersey.app.uploads import Bounds, TooMuchError, clean_name, megabytes, receive
from hersey.app.workers import EndedError, Refused, ask
from hersey.errors import ExistingFileError, HerseyError, OutputError
from hersey.files.writing import write_atomically

#: Analyses that run at the same time.
_AT_ONCE = max(1, (os.cpu_count() or 1) // 2)


#: Folders of what is computed, and of one dropped file.
_RESULTS, _DROPPED = "results", "dropped"


class UnknownError(Exception):
    """Nothing has this number."""


class NotNowError(Exception):
    """The request cannot be fulfilled now; the message is for the user."""


class Session:
    """All analyses of one start, below one private folder.

    Parameters
    ----------
    folder
        Private folder of this start.
    reports
        Where finished reports are kept; made when the first is finished.
    bounds
        What is taken at the most.
    """

    def __init__(self, folder: Path, reports: Path, bounds: Bounds | None = None) -> None:
        """Start with one analysis, which is empty."""
        self.folder, self.reports, self.bounds = folder, reports, bounds or Bounds()
        self.analyses: dict[str, Analysis] = {}
        self.shown: dict[str, Path] = {}  #: reports by the number in their address
        self._earlier: list[Kept] | None = None
        self._courses = Courses()
        self._tasks: dict[str, asyncio.Task[None]] = {}
        self._running = asyncio.Semaphore(_AT_ONCE)
        self._looking = asyncio.Semaphore(2)
        self.new()

    def new(self) -> Analysis:
        """Return a new analysis.

        Raises
        ------
        NotNowError
            If there are too many.
        """
        if len(self.analyses) >= self.bounds.analyses:
            raise NotNowError(f"{self.bounds.analyses} analyses are open. Remove one first")
        one = Analysis(Path())
        one.folder = self.folder / one.id
        one.folder.mkdir(mode=0o700)
        (one.folder / _RESULTS).mkdir(mode=0o700)
        self.analyses[one.id] = one
        return one

    async def earlier(self) -> list[Kept]:
        """Return the reports that earlier starts have kept, looked for once."""
        if self._earlier is None:
            own = {each.saved for each in self.analyses.values()}
            found = await asyncio.to_thread(kept_reports, self.reports)
            if self._earlier is None:  # nobody was quicker
                self._earlier = [each for each in found if each.saved not in own]
                self.shown |= {each.report: each.path for each in self._earlier}
        return self._earlier

    def get(self, one: str) -> Analysis:
        """Return an analysis.

        Raises
        ------
        UnknownError
            If there is none of that number.
        """
        if one not in self.analyses:
            raise UnknownError
        return self.analyses[one]

    def remove(self, one: Analysis) -> None:
        """End what it runs and forget it with its files; a finished report stays where it was kept."""
        self.cancel(one)
        for file in one.files.values():
            self._end(file.id)
        del self.analyses[one.id]
        shutil.rmtree(one.folder, ignore_errors=True)
        self.shown.pop(one.report, None)

    async def drop(self, one: Analysis, name: str, length: int | None, chunks: AsyncIterator[bytes]) -> None:
        """Take a file as it comes, and look at it.

        Raises
        ------
        TooMuchError, NotNowError
            In words for the user; what is too long stands in the list with its fault.
        """
        self._refuse_while_busy(one)
        files = [file for each in self.analyses.values() for file in each.files.values()]
        if len(files) >= self.bounds.files:
            raise NotNowError(f"{len(files)} files have been added. Remove some first")
        most = min(
            self.bounds.file, self.bounds.all_files - sum(file.size or file.received for file in files)
        )
        file = Dropped(clean_name(name), Path())
        folder = one.folder / file.id / _DROPPED
        folder.parent.mkdir(mode=0o700)
        folder.mkdir(mode=0o700)
        file.path = folder / file.name
        one.files[file.id] = file
        one.revision += 1
        try:
            await _received(file, length, most, chunks)
        except TooMuchError as error:
            file.state, file.fault, file.received = "fault", str(error), 0
            async with one.lock:
                await self._check(one)
            raise
        except BaseException:  # the page went away in the midst
            one.files.pop(file.id, None)
            one.revision += 1
            raise
        if file.name.lower().endswith(".toml"):
            await self._take_toml(one, file)
            return
        file.state = "looking"
        one.revision += 1
        self._start(file.id, self._look(one, file))

    async def _take_toml(self, one: Analysis, file: Dropped) -> None:
        async with one.lock:
            wrong = (
                "not a machine file (table [drivetrain]), a mapping (tables such as [torque]) or a recipe "
                "(keys such as logs and tare)"
            )
            try:
                taken = one.take_file(file)
            except (HerseyError, ValueError) as error:
                taken, wrong = False, str(error).removeprefix(f"{file.name}: ")
            if not taken:
                file.state, file.fault = "fault", wrong
            await self._check(one)

    async def _look(self, one: Analysis, file: Dropped) -> None:
        try:
            async with self._looking:
                look = await ask(
                    {"task": "look", "path": str(file.path)}, one.folder / file.id, lambda *_: None
                )
            async with one.lock:
                if any(_same(other.look, look) for other in one.files.values()):
                    file.state, file.fault = "fault", "this log was already added"
                else:
                    file.look, file.state = look, "ready"
                    one.propose(file)
        except Refused as error:
            said = str(error).removeprefix(f"{file.name}: ").removeprefix(f"{file.name} ")
            file.state, file.fault = "fault", f"not a log: {said}"
        except EndedError:
            file.state = "fault"
            file.fault = "not a log: reading it failed. Is the file damaged or too large?"
        async with one.lock:
            await self._check(one)

    async def change(self, one: Analysis, given: dict[str, Any]) -> None:
        """Take choices of the page; see `Analysis.choose`."""
        async with one.lock:
            self._refuse_while_busy(one)
            one.choose(given)
            await self._check(one)

    async def keep(self, one: Analysis, key: str) -> None:
        """Keep a value that is only doubtful."""
        async with one.lock:
            one.kept.add(key)
            await self._check(one)

    async def mend(self, one: Analysis, key: str) -> None:
        """Apply the fix of a fault's button."""
        async with one.lock:
            self._refuse_while_busy(one)
            fault = next((fault for fault in one.faults if fault.key == key), None)
            if fault is None:
                raise UnknownError
            if "remove" in fault.mend:
                self._end(str(fault.mend["remove"]))
            one.choose(fault.mend)
            await self._check(one)

    async def take_machine(self, one: Analysis, given: dict[str, Any]) -> str:
        """Take the machine as the page has it; return why a form cannot be shown, or nothing."""
        async with one.lock:
            self._refuse_while_busy(one)
            refused = ""
            if "mode" in given:
                refused = one.turn("toml" if given["mode"] == "toml" else "form")
            else:
                one.take_machine(given)
            await self._check(one)
        return refused

    async def remove_file(self, one: Analysis, file: str) -> None:
        """Remove a file."""
        async with one.lock:
            self._refuse_while_busy(one)
            if file not in one.files:
                raise UnknownError
            self._end(file)
            one.remove(file)
            await self._check(one)

    async def run(self, one: Analysis) -> None:
        """Start the analysis.

        Raises
        ------
        NotNowError
            If something stands before it.
        """
        async with one.lock:
            self._refuse_while_busy(one)
            await self._check(one)
            if not one.logs or one.waiting:
                raise NotNowError("drop a log first" if not one.files else "a file is still being read")
            if one.faults:
                raise NotNowError("fix first: " + ", ".join(fault.link for fault in one.faults))
            one.state, one.step, one.share, one.reason = "preparing", "queued", None, ""
            one.result, one.finished = {}, ""
            one.revision += 1
            self._start(one.id, self._run(one))

    async def _run(self, one: Analysis) -> None:
        page = one.folder / _RESULTS / f"{number()}.html"
        try:
            async with self._running:
                await self._computed(one, page)
            one.saved = await asyncio.to_thread(self._kept, one, page)
            self.shown.pop(one.report, None)
            one.report = number()
            self.shown[one.report] = page
            one.state = "done"
        except Refused as error:
            one.state, one.reason = "stopped", str(error)
            if logs := one.logs:
                one.faults = [of_problem(error.problem, logs[0].look, one.choices)]
        except OutputError as error:
            one.state, one.reason = "stopped", str(error)
        except EndedError:
            one.state, one.reason = "stopped", "the calculation stopped unexpectedly. Is there enough memory?"
        except asyncio.CancelledError:
            one.state, one.step = "editing", ""
            raise
        finally:
            one.share = one.course = None
            one.finished = time.strftime("%H:%M")
            one.revision += 1

    async def _computed(self, one: Analysis, page: Path) -> None:
        """Let a process compute an analysis and write its page."""
        machine, earlier = one.folder / MACHINE_FILE, one.earlier
        request = {
            "task": "run",
            "logs": [str(file.path) for file in one.told_of],
            "against": None if earlier is None else str(earlier.path),
            "mapping": str(one.folder / MAPPING_FILE),
            "machine": str(machine) if machine.exists() else None,
            "command": one.command(),
            "report": str(page),
            **{key: one.options[key] for key in ("isothermal", "drop_missing", "tare")},
        }
        points = one.machine_file().count("[[points]]")
        alike = (len(one.logs), bool(request["against"]), bool(request["machine"]), points)
        one.state, one.step = "running", "starting"
        one.course = course = self._courses.begin(alike)

        def said(step: str, share: float | None) -> None:
            course.step(step)
            one.step, one.share = step, share

        one.result = await ask(request, page.parent, said)
        self._courses.keep(alike, course)

    def _kept(self, one: Analysis, page: Path) -> str:
        """Keep a finished report beyond this start, under a name that is free; return what the page says."""
        self.reports.mkdir(parents=True, exist_ok=True)
        stem = clean_name(Path(one.told_of[0].name).stem)
        text = page.read_bytes()
        for count in range(1, 1000):
            path = self.reports / (f"{stem}.html" if count == 1 else f"{stem}-{count}.html")
            if os.path.lexists(path):
                continue
            with suppress(ExistingFileError):  # somebody was quicker
                write_atomically(path, text, overwrite=False)
                return f"{self.reports.name}/{path.name}"
        raise OutputError(f"{self.reports.name} holds a thousand reports of this name. Move some away")

    def cancel(self, one: Analysis) -> None:
        """Cancel a run; nothing of it is kept."""
        self._end(one.id)
        if one.busy:
            one.state, one.step = "editing", ""
            one.revision += 1

    async def close(self) -> None:
        """End everything."""
        tasks = list(self._tasks.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _check(self, one: Analysis) -> None:
        await asyncio.to_thread(check, one)
        if one.state == "stopped":
            one.state = "editing"

    def _refuse_while_busy(self, one: Analysis) -> None:
        if one.busy:
            raise NotNowError("the analysis is running: cancel it first")

    def _start(self, name: str, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.create_task(work)
        self._tasks[name] = task
        task.add_done_callback(lambda _: self._tasks.pop(name, None))

    def _end(self, name: str) -> None:
        if (task := self._tasks.get(name)) is not None:
            task.cancel()


async def _received(file: Dropped, length: int | None, most: int, chunks: AsyncIterator[bytes]) -> None:
    """Write a file as it comes."""
    if length is not None and length > most:
        raise TooMuchError(
            f"the file has {megabytes(length)}, more than the {megabytes(max(most, 0))} that the app takes: "
            "thin it, or run hersey report in a terminal"
        )

    file.total = length or 0

    def received(size: int) -> None:
        file.received = size

    file.size = await receive(chunks, file.path, most, received)


def _same(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether two files hold the same channels, whatever they are called."""
    return bool(one) and one["channels"] == other["channels"]
