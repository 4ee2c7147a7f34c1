"""Small dense quadratic programs within bounds, many that differ in their linear term alone."""

from __future__ import annotations

import importlib
import threading
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class BoxQP:
    """Least ½ uᵀHu + fᵀu with lowest ≤ u ≤ highest, for one H and many f.

    Solved exactly by DAQP's dual active-set method (Arnström, Bemporad and Axehill, IEEE Trans. Automatic Control 67, 2022).
    Several threads may solve at once: each has a solver of its own, for DAQP works in its model's memory without Python's lock.
    Raises ModuleNotFoundError when DAQP is not installed, ValueError when H is not positive definite or the bounds are not
    finite and in order.
    """

    def __init__(self, hessian: Array, lowest: Array, highest: Array) -> None:
        if not (np.isfinite([lowest, highest]).all() and np.all(lowest <= highest)):
            raise ValueError(f"bounds from {lowest} to {highest} are not allowed: they must be finite, the lower ones first.")
        if not (np.isfinite(hessian).all() and np.linalg.eigvalsh(hessian)[0] > 0.0):
            raise ValueError("hessian is not positive definite, but must be: else there may be more than one least value.")
        self.hessian, self.lowest, self.highest = hessian, lowest, highest
        self.failures = 0
        """Programs that the solver gave up since this object was made."""
        # DAQP's tolerances are absolute: the variables are scaled by their bounds, the cost to a mean curvature of 1.
        self._unit = np.maximum(np.maximum(np.abs(lowest), np.abs(highest)), np.finfo(float).tiny)
        scaled = hessian * np.outer(self._unit, self._unit)
        curvature = np.trace(scaled) / len(scaled)
        self._gradient_scale = self._unit / curvature
        size = len(scaled)
        self._problem = (scaled / curvature, np.zeros(size), np.zeros((0, size)), highest / self._unit, lowest / self._unit)
        self._of_thread, self._counting = threading.local(), threading.Lock()
        self._solver()

    def _solver(self) -> tuple[Any, NDArray[np.int32]]:
        """The calling thread's solver, and the guess that says nothing: set up when it is first asked for."""
        if not hasattr(self._of_thread, "model"):
            model = _daqp().Model()
            model.setup(*(part.copy() for part in self._problem))
            self._of_thread.model, self._of_thread.no_guess = model, np.zeros(len(self.hessian), dtype=np.int32)
        return self._of_thread.model, self._of_thread.no_guess

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy sets up a solver of its own, for DAQP's workspace cannot be copied; its count of failures begins at zero."""
        return BoxQP, (self.hessian, self.lowest, self.highest)

    def minimise(self, gradients: Array) -> Array:
        """Minimisers (N, k) for linear terms f (N, k); a row that the solver gives up is NaN and counts as a failure."""
        minimisers, (model, no_guess) = np.full(gradients.shape, np.nan), self._solver()
        for row, gradient in enumerate(gradients * self._gradient_scale):
            model.update(f=gradient, sense=no_guess)  # else it starts from the last program's active bounds
            minimiser, _, exit_flag, _ = model.solve()
            if exit_flag > 0:
                minimisers[row] = minimiser
        failed = int(np.isnan(minimisers).any(axis=1).sum())
        if failed:
            with self._counting:
                self.failures += failed
        return np.clip(minimisers * self._unit, self.lowest, self.highest)  # DAQP meets bounds to its tolerance


def _daqp() -> Any:
    try:
        return importlib.import_module("daqp")
    except ModuleNotFoundError:
        raise ModuleNotFoundError("model-predictive control needs the solver DAQP: pip install daqp", name="daqp") from None
