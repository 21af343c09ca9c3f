"""Places of texts in a chart, in pixels from the lower left, so that none covers another."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from hersey.arrays import FloatArray

#: Left, bottom, right and top, pixels.
Box = tuple[float, float, float, float]
#: Width of a letter of a bold name, height of a line of text, pixels.
_LETTER, _LINE = 7.0, 15.0
#: Where a point's name may stand above or below it, the nearest first.
_ROWS = (17.0, -17.0, 33.0, -33.0, 49.0, -49.0)
#: Half the width of a point's mark, and the room between a mark and its name.
_MARK, _BESIDE = 8.0, 12.0
#: Half the width of a small mark without a name.
_DOT = 3.0
#: Room that a name gives up to stand where it is preferred, and the most that counts.
_PREFERENCE, _ROOMY = 40.0, 80.0
#: Steps of the search for a place, across and up.
_ACROSS, _UP = 8.0, 6.0


@dataclass(frozen=True)
class Text:
    """A text and the middle of the place it got, pixels."""

    text: str
    across: float
    up: float
    style: str
    half: float  #: half its width

    @property
    def box(self) -> Box:
        """What it covers."""
        left, right = self.across - self.half, self.across + self.half
        return left, self.up - _LINE / 2, right, self.up + _LINE / 2


class Labels:
    """Texts of a chart of ``width`` by ``height`` pixels; the first placed have their choice.

    A ``letter`` is so many pixels wide on average.
    """

    def __init__(self, width: float, height: float, letter: float = _LETTER) -> None:
        self.width, self.height, self._letter = width, height, letter
        self.texts: list[Text] = []
        self._taken: list[Box] = []

    def avoid(self, across: float, up: float) -> None:
        """Keep texts off a mark."""
        self._taken.append((across - _DOT, up - _DOT, across + _DOT, up + _DOT))

    def beside(self, text: str, across: float, up: float, style: str) -> None:
        """Name a point, on the first side where there is room, or above it where there is none."""
        self._taken.append((across - _MARK, up - _MARK, across + _MARK, up + _MARK))
        away = self._half(text) + _BESIDE
        sides = [(away, 0.0), (-away, 0.0), *((dx, dy) for dy in _ROWS for dx in (0.0, away, -away))]
        for dx, dy in sides:
            if self._put(text, across + dx, up + dy, style):
                return
        self._put(text, across, up + _ROWS[0], style, force=True)

    def along(self, text: str, line: Sequence[tuple[float, float]], style: str) -> None:
        """Name a line, above its far end or as near to it as there is room, or else below, or not at all."""
        for away in (8.0, -9.0):
            for across, up in reversed(line):
                if self._put(text, across - self._half(text) - 4.0, up + away, style):
                    return

    def inside(
        self,
        text: str,
        parts: Iterable[tuple[FloatArray, FloatArray, FloatArray]],
        style: str,
        preferred: Box = (0.0, 0.0, 0.0, 0.0),
    ) -> None:
        """Name a region where it has the most room, preferably in the ``preferred`` box.

        Each of its ``parts`` lies between two lines: where they are measured across, the lower, the upper.
        """
        places = [place for part in parts for place in self._rooms(text, *part, preferred)]
        if places:
            _, across, up = max(places, key=lambda place: place[0])
            self._put(text, across, up, style)

    def _rooms(
        self, text: str, across: FloatArray, low: FloatArray, high: FloatArray, preferred: Box
    ) -> Iterable[tuple[float, float, float]]:
        """Room around each place where the text fits, and that place."""
        half = self._half(text) + 4.0
        for middle in np.arange(half, self.width - half, _ACROSS).tolist():
            left, right = middle - half, middle + half
            columns = np.append(across[(across > left) & (across < right)], [left, right])
            floor = float(np.interp(columns, across, low).max())
            ceiling = float(np.interp(columns, across, high).min())
            for up in np.arange(floor + _LINE / 2, ceiling - _LINE / 2, _UP).tolist():
                if self._is_free(Text(text, middle, up, "", half - 4.0).box):
                    liked = _contains(preferred, (left, up - _LINE, right, up + _LINE))
                    room = min(up - floor, ceiling - up, _ROOMY) + _PREFERENCE * liked
                    yield room - 0.05 * abs(middle - self.width / 2), middle, up

    def _put(self, text: str, across: float, up: float, style: str, *, force: bool = False) -> bool:
        placed = Text(text, across, up, style, self._half(text))
        if not (force or self._is_free(placed.box)):
            return False
        self._taken.append(placed.box)
        self.texts.append(placed)
        return True

    def _half(self, text: str) -> float:
        return 0.5 * self._letter * len(text)

    def _is_free(self, box: Box) -> bool:
        return _contains((0.0, 0.0, self.width, self.height), box, edges=True) and not any(
            _overlap(box, other) for other in self._taken
        )


def apart(ups: Sequence[float], gap: float = _LINE) -> list[float]:
    """Return heights near those given, pixels, each at least a ``gap`` from the next: names of levels."""
    order = np.argsort(ups, kind="stable")
    clusters: list[list[float]] = []
    for up in np.asarray(ups, dtype=float)[order].tolist():
        clusters.append([up])
        while len(clusters) > 1 and _bottom(clusters[-1], gap) < _bottom(clusters[-2], gap) + gap * len(
            clusters[-2]
        ):
            clusters[-2:] = [clusters[-2] + clusters[-1]]
    placed = np.empty(len(ups))
    placed[order] = [
        _bottom(cluster, gap) + gap * (i + 0.5) for cluster in clusters for i in range(len(cluster))
    ]
    return [float(up) for up in placed]


def _bottom(cluster: list[float], gap: float) -> float:
    """Lower end of names stacked about their mean height."""
    return sum(cluster) / len(cluster) - 0.5 * gap * len(cluster)


def _contains(outer: Box, inner: Box, *, edges: bool = False) -> bool:
    inside = outer[0] < inner[0] and outer[1] < inner[1] and inner[2] < outer[2] and inner[3] < outer[3]
    if edges:
        return outer[0] <= inner[0] and outer[1] <= inner[1] and inner[2] <= outer[2] and inner[3] <= outer[3]
    return inside


def _overlap(a: Box, b: Box) -> bool:
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]
