"""What voltages a drive may be limited to."""

from beamenv.configuration import Range

STRONGEST_DRIVE = 1e9
"""V."""

VOLTAGES = Range(-STRONGEST_DRIVE, STRONGEST_DRIVE, encloses=0.0, apart=1e-3, unit="V")
