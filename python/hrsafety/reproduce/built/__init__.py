"""Robots as built."""
