"""Beams whose sections turn and move by any amount: the steady state under spin, and vibration about it."""
