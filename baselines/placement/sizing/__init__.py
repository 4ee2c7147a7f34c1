"""Patches sized and placed together: how much damping a blade gets for its piezo mass, voltages and power."""
