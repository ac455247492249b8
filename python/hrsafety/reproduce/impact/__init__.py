"""Impacts on the covered manipulator."""
