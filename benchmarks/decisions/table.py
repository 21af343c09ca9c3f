"""The results as Markdown: one row for all machines, and for each shape, closure and kind of evidence."""

from __future__ import annotations

import statistics
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence

from benchmarks.decisions.judged import Judged

#: Claims that have a column.
_COLUMNS = {
    "X smooth": "X smooth",
    "plan works": "plans work",
    "smooth": "`smooth` true",
    "sticks": "`sticks` true",
}
#: Letters of an instruction that tell it from others.
_FIRST = 28


def lines(results: Sequence[Judged]) -> Iterator[str]:
    """Yield the table, and what else was said or went wrong."""
    yield "counts are `held/claimed`; ranges are median (least to greatest)"
    yield ""
    heads = ["", "machines", "no report", "V* in interval", "width", "X given", "X/V*", *_COLUMNS.values()]
    yield f"| {' | '.join(heads)} |"
    yield "|---" * len(heads) + "|"
    yield _row("all", results)
    for attribute in ("shape", "closure", "evidence"):
        for value in sorted({getattr(result, attribute) for result in results}):
            yield _row(value, [r for r in results if getattr(r, attribute) == value])
    yield ""
    yield from _other_claims(results)
    yield from _instructions(results)
    yield from (f"- no report: machine {r.number}: {r.fault}" for r in results if r.fault)
    yield from (f"- false: {words}" for result in results for words in result.wrong)


def _row(name: str, results: Sequence[Judged]) -> str:
    held = [r.fold_held for r in results if r.fold_held is not None]
    over = [r.over for r in results if r.over is not None]
    cells = [
        name,
        str(len(results)),
        str(sum(bool(r.fault) for r in results)),
        _share(held),
        _range(r.width for r in results if r.width is not None),
        str(len(over)),
        _range(over),
        *(_share(_claims(results, kind)) for kind in _COLUMNS),
    ]
    return f"| {' | '.join(cells)} |"


def _claims(results: Iterable[Judged], kind: str) -> list[bool]:
    return [held for result in results for held in result.claims.get(kind, [])]


def _share(held: Sequence[bool]) -> str:
    return f"{sum(held)}/{len(held)}" if held else "-"


def _range(values: Iterable[float]) -> str:
    known = sorted(values)
    return f"{statistics.median(known):.2f} ({known[0]:.2f} to {known[-1]:.2f})" if known else "-"


def _other_claims(results: Sequence[Judged]) -> Iterator[str]:
    """Yield claims without a column, the verdicts given, and the measurements asked for."""
    kinds = sorted({kind for r in results for kind in r.claims} - set(_COLUMNS))
    yield from (f"- {kind}: {_share(_claims(results, kind))}" for kind in kinds)
    if verdicts := Counter(verdict for r in results for verdict in r.verdicts):
        yield f"- verdicts: {_counted(verdicts)}"
    if asked := Counter(r.measurement for r in results if r.measurement):
        yield f"- measurements asked for: {_counted(asked)}"


def _counted(counter: Counter[str]) -> str:
    return ", ".join(f"{name} {count}" for name, count in counter.most_common())


def _instructions(results: Sequence[Judged]) -> Iterator[str]:
    """Yield the first words of instructions that give no safe speed."""
    other = Counter(_first_words(r.said) for r in results if r.over is None and not r.fault)
    yield from (f"- no safe speed, {count} times: {words} ..." for words, count in other.most_common())


def _first_words(text: str) -> str:
    """Return the beginning of an instruction, without its temperature."""
    cut = text.split(" °C ", 1)[-1]
    return cut[:_FIRST].rsplit(" ", 1)[0]
