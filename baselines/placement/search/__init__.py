"""Searching for the layout of least cost."""
