"""Questions in a terminal, or answers from a pipe: one per line, each checked at once."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import TypeVar

from hersey.cli.terminal import say
from hersey.errors import HerseyError, ParameterError, capital, printable

Answer = TypeVar("Answer")
#: The answer that rejects a proposal.
NONE = "-"
#: Answers that ask for help, and those of a person who does not know.
_HELP = ("?", "h", "help")
_UNKNOWN = ("don't know", "dont know", "do not know", "not known", "no idea", "unknown", "n/a", "na", "none")


class Asking:
    """Asks on stderr and reads from stdin, so that stdout holds only results."""

    def __init__(self, order: Sequence[str]) -> None:
        """Take the names of the questions in order, for those who pipe their answers."""
        self._order, self._count = order, 0
        self._terminal = sys.stdin.isatty()

    @property
    def by_hand(self) -> bool:
        """Whether a person answers, who can be asked more questions than a pipe."""
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
        """Return the answer as ``read`` returns it, or None if the question is skipped.

        ``words`` explain the question. An empty answer accepts the proposal, or skips the question if there
        is none. If ``read`` refuses an answer, its error is shown and the question is repeated; an answer
        from a pipe ends the command.

        Raises
        ------
        ParameterError
            If the answers end before a required one, or one from a pipe cannot be read.
        """
        while True:
            text = self._line(what, words, proposed, needed)
            if self._terminal and text.lower() in _HELP:
                say(f"  {_help(words, proposed, needed)}", file=sys.stderr)
                continue
            if text != NONE and (text or proposed):
                try:
                    return read(text or proposed)
                except HerseyError as error:
                    if text.lower() not in _UNKNOWN:
                        self._refuse(what, error)
                        continue
                if proposed:
                    return read(proposed)
            if not needed:
                return None
            self._refuse(what, ParameterError(_required(proposed)))

    def _line(self, what: str, words: str, proposed: str, needed: bool) -> str:
        default = f" [{proposed}]" if proposed else "" if needed else " [skip]"
        try:
            sys.stderr.write(printable(f"{what}{f' ({words})' if words else ''}{default}: "))
            sys.stderr.flush()
            line = sys.stdin.readline()
        except KeyboardInterrupt:
            sys.stderr.write("\n")  # the message begins on a new line
            raise
        if not self._terminal:
            sys.stderr.write("\n")
        self._count += 1
        if line or (self._count > 1 and (proposed or not needed) and not self._terminal):
            return line.strip()
        if self._count > 1 or self._terminal:
            raise ParameterError(f"the answers end before '{what}', which is required; nothing is written")
        raise ParameterError(
            "hersey new asks questions: type it in a terminal, or pipe the answers, one per line, with an "
            f"empty line to accept a proposal or skip a question: {', '.join(self._order)}"
        )

    def _refuse(self, what: str, error: HerseyError) -> None:
        if not self._terminal:
            raise ParameterError(f"answer {self._count}, {what}: {error}; nothing is written")
        say(f"  {error}", file=sys.stderr)


def _required(proposed: str) -> str:
    """What to do about a question that cannot be skipped."""
    if proposed:
        return f"this answer is required. Press Enter for {proposed}"
    return (
        "this answer is required. Estimate it (a mass may be a range, e.g. 5 kg to 20 kg), or press Ctrl-C "
        "to end without writing a file"
    )


def _help(words: str, proposed: str, needed: bool) -> str:
    """What a question is about, and what can be answered."""
    enter = f"accepts {proposed}" if proposed else "" if needed else "skips the question"
    said = [capital(words), f"Enter {enter}" if enter else "An answer is required"]
    return f"{'. '.join(part for part in said if part)}. Ctrl-C ends, and nothing is written."
