"""Walls: materials, laminates, the contour they follow, and how they deform."""
