"""Scenarios × controllers on the same held-out episodes: ``beamenv benchmark``."""

from train.benchmark.campaign import benchmark
from train.benchmark.table import BenchmarkTable, Row

__all__ = ["BenchmarkTable", "Row", "benchmark"]
