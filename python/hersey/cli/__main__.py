"""``python -m hersey.cli``."""

from hersey.cli import main

main()
