"""Questions in a terminal, or answers from a pipe: one a line, each checked at once."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import TypeVar

from hersey.cli.terminal import say
from hersey.errors import HerseyError, ParameterError, printable

Answer = TypeVar("Answer")
#: What leaves out that for which there is a proposal.
NONE = "-"


class Asking:
    """Asks on stderr and reads from stdin, so that results alone stand on stdout."""

    def __init__(self, order: Sequence[str]) -> None:
        """Take what is asked, in order, for those who pipe their answers."""
        self._order, self._count = order, 0
        self._terminal = sys.stdin.isatty()

    @property
    def by_hand(self) -> bool:
        """Whether a person answers, who can be asked more than is listed for a pipe."""
        return self._terminal

    def ask(
        self,
        what: str,
        read: Callable[[str], Answer],
        *,
        words: str = "",
        proposed: str = "",
        needed: bool = False,
    ) -> Answer | None:
        """Return what ``read`` makes of an answer, or None where it is left out.

        ``words`` say more of it, to be shown with it alone. An empty answer takes the proposal, if there is
        one, and else leaves out. What ``read`` refuses is asked again, in its words; from a pipe it ends the
        command.

        Raises
        ------
        ParameterError
            If the answers end before what is needed, or one from a pipe cannot be read.
        """
        while True:
            text = self._line(what, words, proposed, needed)
            if text == NONE or (not text and not proposed):
                if not needed:
                    return None
                self._refuse(what, ParameterError("this is needed"))
                continue
            try:
                return read(text or proposed)
            except HerseyError as error:
                self._refuse(what, error)

    def _line(self, what: str, words: str, proposed: str, needed: bool) -> str:
        default = f" [{proposed}]" if proposed else "" if needed else " [left out]"
        try:
            sys.stderr.write(printable(f"{what}{f' ({words})' if words else ''}{default}: "))
            sys.stderr.flush()
            line = sys.stdin.readline()
        except KeyboardInterrupt:
            sys.stderr.write("\n")  # what is said of it begins a line of its own
            raise
        if not self._terminal:
            sys.stderr.write("\n")
        self._count += 1
        if line or (self._count > 1 and not needed and not self._terminal):
            return line.strip()
        if self._count > 1 or self._terminal:
            raise ParameterError(f"the answers end before '{what}', which is needed: nothing is written")
        raise ParameterError(
            "hersey new asks questions: type it in a terminal, or pipe the answers, one a line, an empty one "
            f"for what is proposed or left out: {', '.join(self._order)}"
        )

    def _refuse(self, what: str, error: HerseyError) -> None:
        if not self._terminal:
            raise ParameterError(f"answer {self._count}, {what}: {error}: nothing is written")
        say(f"  {error}", file=sys.stderr)
