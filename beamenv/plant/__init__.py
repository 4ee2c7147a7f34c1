"""The reduced plant: its matrices, its sampling, its reduction from a blade, its fingerprint."""

from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.plant import Plant, SampledPlant, sample
from beamenv.plant.signals import Signal

__all__ = ["Plant", "SampledPlant", "Signal", "fingerprint", "sample"]
