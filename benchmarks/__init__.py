"""Ratios against peers and floors, each in one run."""
