"""Blades in motion: the stepping kernel, the plants that move, the signals that act on them."""
