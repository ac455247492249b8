"""Obstacles: discs and rectangles that stand or move, walking and recorded people."""
