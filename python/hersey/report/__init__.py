"""Pages: each one self-contained HTML file.

=========  ========================================
page       document and charts of a log in the page
life_page  those of a life test
static     HTML, CSS and scripts
=========  ========================================
"""

import sys
from types import ModuleType
from typing import Any


class _Room(ModuleType):
    """Make ``hersey.report(study, "out.html")`` work once the room of that name is imported."""

    def __call__(self, *given: Any, **named: Any) -> None:
        from hersey.report.page import report

        report(*given, **named)


sys.modules[__name__].__class__ = _Room
