"""Hersey asked for the ages of a campaign, by its public names; the answer beside the truth as one row."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

#: Indicator values that are kept of each mode.
Row = dict[str, Any]


def campaign_file(folder: Path) -> Path:
    """Return the campaign file of a folder of tables; it is made if it is not there.

    Logs that hersey refuses are left out, as `hersey campaign add --table` does; ``refused.json`` says why.
    """
    import hersey
    from hersey.life.campaign import read_runs

    file = folder / "life.hersey"
    if file.exists():
        return file
    machine = hersey.read_machine(folder / "machine.toml")
    half, refused = folder / "half.hersey", {}
    half.unlink(missing_ok=True)
    fit = None  # ages do not depend on it, and most of the time would go into it
    with hersey.Campaign.create(half) as campaign:
        for run in read_runs(folder / "runs.csv").runs:
            try:
                points = hersey.SteadyPoints.from_table(run.log).without(machine.rest)
                fit = fit or hersey.fit(points)
                campaign.add(points, log=run.log, unit=run.unit, age=run.age, fit=fit)
            except hersey.HerseyError as error:
                refused[run.log.name] = str(error)
        for unit, age in _maintenance(folder):
            campaign.add_event(unit, age, "re-greased")
    (folder / "refused.json").write_text(json.dumps(refused, indent=1) + "\n")
    half.rename(file)
    return file


def _maintenance(folder: Path) -> list[tuple[str, str]]:
    """Return specimens and ages at which grease was renewed."""
    file = folder / "maintenance.csv"
    rows = file.read_text().splitlines()[1:] if file.exists() else []
    return [(unit, age) for unit, age in (row.split(",") for row in rows)]


def refused(folder: Path) -> dict[str, str]:
    """Return the logs that hersey refused, with its reasons."""
    found: dict[str, str] = json.loads((folder / "refused.json").read_text())
    return found


def ask(folder: Path) -> Row:
    """Return what hersey says of the campaign in a folder."""
    import hersey

    machine = hersey.read_machine(folder / "machine.toml")
    started, seconds = time.process_time(), {}
    file = campaign_file(folder)
    seconds["add"], started = time.process_time() - started, time.process_time()
    with hersey.Campaign.open(file, write=False) as campaign:
        indicators = hersey.indicators_of(campaign, machine, signs=False)
        film = None
        try:
            film = hersey.film_life(campaign, machine)
            indicators = film.with_starvation(indicators)
        except hersey.HerseyError as error:
            reason = str(error)
        answer = hersey.time_to_failure(indicators)
    seconds["ask"] = time.process_time() - started
    return {
        "answer": _short(answer.to_dict()),
        "film": "computed" if film is not None else reason,
        "refused": refused(folder),
        "seconds": seconds,
    }


def row(folder: Path) -> Row:
    """Return the answer with the truth of the folder."""
    truth = json.loads((folder / "truth.json").read_text())
    try:
        asked = ask(folder)
    except Exception as error:  # every failure is a row, to be counted
        asked = {"error": f"{type(error).__name__}: {error}"}
    return {"seed": truth["seed"], "truth": truth, **asked}


def _short(answer: Row) -> Row:
    """Return the parts of an answer that are counted."""
    modes = [
        {
            "name": mode["name"],
            "limit": mode["limit"],
            "law": mode["growth"]["law"],
            "weights": mode["growth"]["weights"],
            "units": mode["ages"]["units"],
            "b10": mode["ages"]["b10"],
            "b50": mode["ages"]["b50"],
        }
        for mode in answer["modes"]
        if not mode["sign"]
    ]
    kept = {name: answer[name] for name in ("units", "b10", "b50", "shares")}
    return {**kept, "modes": modes, "warnings": answer["warnings"]}
