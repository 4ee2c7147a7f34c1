"""Sensors of a blade: what kinds there are, what of its motion each feels, and what a plant shows of that."""
