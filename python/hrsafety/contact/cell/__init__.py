"""Cells: a robot, its coverings and the contacts with people that are planned, read from files and judged."""
