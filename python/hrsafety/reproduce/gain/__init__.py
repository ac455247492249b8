"""Gains of the force field."""
