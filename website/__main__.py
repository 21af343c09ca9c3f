"""Renew the pages that are made from the code: ``python -m website``."""

from __future__ import annotations

import sys

from website.navigation import ROOT
from website.pages import renew

for page in renew():
    sys.stdout.write(f"{page.relative_to(ROOT)}\n")
