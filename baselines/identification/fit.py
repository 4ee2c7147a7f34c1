"""How well a model does on rows that it was not learned from."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_lyapunov

from baselines.identification.innovation_model import InnovationModel
from baselines.identification.measurement import Measurement
from beamenv.configuration.read_only import ReadOnly

Array = NDArray[np.float64]

LAGS = 50
"""Rows over which errors are compared with those after them."""
BAND = 1.96
"""Standard deviations: 95 of 100 correlations of what is white lie within."""


@dataclass(frozen=True, slots=True, eq=False)
class Fit(ReadOnly):
    """On the rows held back. A fit is 1 − ‖y − ŷ‖/‖y − mean y‖: 1 is perfect, 0 as good as the mean."""

    rows: int
    one_step: Array
    """(p,), predicted from all rows before."""
    free_run: Array
    """(p,), from the voltages alone."""
    attainable: Array
    """(p,): the free run's, if the model were exact: loads and sensor noise are no matter of voltages."""
    autocorrelation: Array
    """(LAGS + 1, p) of one-step errors."""
    band: float
    """95 % of the correlations of white errors lie within ± this."""

    @property
    def outside(self) -> Array:
        """(p,): share of the correlations outside the band; 0.05 of white errors."""
        return np.asarray((np.abs(self.autocorrelation[1:]) > self.band).mean(axis=0))


def fit_of(model: InnovationModel, everything: Measurement, learned: int) -> Fit:
    """Of a model learned from the first rows, on all after them; readings without their mean."""
    readings = everything.readings[learned:]
    errors = model.one_step_errors(everything.voltages, everything.readings)[learned:]
    free = readings - model.simulated(everything.voltages)[learned:]
    spread = readings.std(axis=0)
    return Fit(
        rows=len(readings),
        one_step=1.0 - errors.std(axis=0) / spread,
        free_run=1.0 - free.std(axis=0) / spread,
        attainable=1.0 - _noise(model) / spread,
        autocorrelation=np.stack([_autocorrelation(column) for column in errors.T], axis=1),
        band=BAND / np.sqrt(len(readings)),
    )


def _noise(model: InnovationModel) -> Array:
    """(p,): standard deviation of readings of the blade left alone."""
    driven = model.K @ model.covariance @ model.K.T
    states = solve_discrete_lyapunov(model.A, driven)
    return np.asarray(np.sqrt(np.diag(model.C @ states @ model.C.T + model.covariance)))


def _autocorrelation(column: Array) -> Array:
    column = column - column.mean()
    power = np.abs(np.fft.rfft(column, 2 * len(column))) ** 2
    moments = np.fft.irfft(power)[: LAGS + 1]
    return np.asarray(moments / moments[0])
