"""Warnings beside results: of runs, scenarios and shields."""
