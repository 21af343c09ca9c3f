"""The lowest versions that `pyproject.toml` allows, as constraints for pip: ``python tests/lowest.py``."""

from __future__ import annotations

import re
import sys
import tomllib
from pathlib import Path


def lowest(document: str) -> list[str]:
    """``name==version`` of each requirement of the package and its extras."""
    project = tomllib.loads(document)["project"]
    extras = project.get("optional-dependencies", {}).values()
    requirements = [*project["dependencies"], *(name for names in extras for name in names)]
    return [re.sub(r">=([\d.]+),<[\d.]+$", r"==\1", requirement) for requirement in requirements]


if __name__ == "__main__":
    sys.stdout.write("\n".join([*lowest(Path(sys.argv[1]).read_text()), ""]))
