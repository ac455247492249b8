"""Readers of maps, floor plans, scenes and settings of robots."""
