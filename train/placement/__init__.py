"""Layouts compared and drawn."""
