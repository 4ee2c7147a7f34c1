"""Episodes of a controller as a Minari data set, for offline learning: ``record``."""

from train.datasets.recording import record

__all__ = ["record"]
