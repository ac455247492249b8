"""Recorded people in the layouts that researchers publish."""
