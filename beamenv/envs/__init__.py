"""Gymnasium environments: a single blade, a batch, and wrappers for history and placement."""
