"""What an identification found: the model, how well it does, how well it is known, and the plant for controllers."""

from __future__ import annotations

import io
import os
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_discrete_lyapunov

from baselines.design.linear import LinearController
from baselines.design.loop import closed_loop, sampled, spectral_radius
from baselines.identification.fit import Fit
from baselines.identification.innovation_model import InnovationModel
from baselines.identification.measurement import Measurement
from baselines.identification.modes import Modes, drawn, modes_of
from baselines.identification.order import Choice
from baselines.identification.realisation import Stabilisation
from baselines.identification.state_space import StateSpace, continuous
from baselines.identification.white_noise import WhiteNoise
from beamenv.configuration import Count, checked
from beamenv.configuration.files import checked_path
from beamenv.configuration.writing import write_whole
from beamenv.plant.plant import Plant

Array = NDArray[np.float64]

ENDING = ".npz"
QUIET = 0.1
"""Of the noise of a sensor, standard deviations: what loads make of its readings where next to nothing moved the structure."""
MODE = ("frequency", "frequency_spread", "damping_ratio", "damping_spread", "certainty")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Identified:
    """The model of a measurement, with everything that is to be said of it."""

    measurement: Measurement
    """What was measured, all of it."""
    learned: int
    """Rows that the model was learned from, the first; the others were held back."""
    choice: Choice
    """The model, and which orders were tried."""
    noise: WhiteNoise
    """Of ``scaled``."""
    balanced: dict[int, float]
    """Loss on the rows held back, as ``Tried`` has it, of the balanced model of each order, among which the search began."""
    stabilisation: Stabilisation
    fit: Fit
    collocated: float | None = None
    """|charge per strain of a sensor| over |moment per volt| of the actuator at its place."""

    def __repr__(self) -> str:
        modes = self.modes
        fits = ", ".join(f"{each:.3f}" for each in self.fit.free_run)
        return f"Identified({self.model.order} states, {len(modes)} modes, free-run fit {fits})"

    @property
    def scaled(self) -> InnovationModel:
        """For voltages and readings of unit standard deviation."""
        return self.choice.refined.model

    @property
    def parameters(self) -> Array:
        """Covariance (k, k) of its parameters, as ``prediction_error.moved`` takes steps."""
        return self.choice.refined.parameters

    @property
    def model(self) -> InnovationModel:
        """In V and the sensors' units."""
        return self._in_units(self.scaled)

    def _in_units(self, model: InnovationModel) -> InnovationModel:
        return model.scaled(self.measurement.voltages.std(axis=0), self.measurement.readings.std(axis=0))

    @property
    def modes(self) -> Modes:
        """Frequencies and dampings with their spread."""
        return modes_of(self.choice.refined)

    @property
    def sensor_noise(self) -> Array:
        """(p,): standard deviation of one reading's own noise, in its unit."""
        return np.asarray(np.sqrt(self.noise.sensor_variance) * self.measurement.readings.std(axis=0))

    @property
    def quiet(self) -> bool:
        """Whether voltages alone moved the structure, so that what was measured says nothing of the loads that it will meet."""
        E, C = self.noise.load_input, self.scaled.C
        moved = np.einsum("pi,ij,pj->p", C, solve_discrete_lyapunov(self.scaled.A, E @ E.T), C)
        return bool(np.all(moved < QUIET**2 * self.noise.sensor_variance))

    @property
    def state_space(self) -> StateSpace:
        """In continuous time."""
        return continuous(self.model, self.noise.load_input, self.collocated)

    def arrays(self, model: StateSpace | None = None, **about: Any) -> dict[str, Any]:
        """The arguments of ``Plant.from_state_space`` for the model, or one of the ``ensemble``; ``about`` says more, or otherwise.

        Loads are the disturbances, of unit variance in each interval; of a ``quiet`` measurement they are left to the rules, for an
        estimator that expects none follows none. Voltages may go as far as they did in the measurement.
        """
        model = self.state_space if model is None else model
        measurement, loads = self.measurement, self.noise.load_input.shape[1]
        known = {
            "A": model.A,
            "B": model.B,
            "C": model.C,
            "interval": measurement.interval,
            "energy": model.energy,
            "disturbance_input": None if self.quiet else model.load_input,
            "disturbance_names": None if self.quiet else [f"load {k}" for k in range(1, loads + 1)],
            "process_noise": None if self.quiet else np.ones(loads),
            "sensor_noise": self.sensor_noise,
            "sensor_names": list(measurement.reading_names),
            "sensor_units": list(measurement.reading_units),
            "actuator_limits": np.abs(measurement.voltages).max(axis=0) * np.array([[-1.0], [1.0]]),
        }
        return {name: value for name, value in {**known, **about}.items() if value is not None}

    def plant(self, **about: Any) -> Plant:
        """The plant that controllers are built from and environments run (``Plant.from_state_space`` of ``arrays``)."""
        return Plant.from_state_space(**self.arrays(**about))

    def save(self, path: str | os.PathLike[str], model: StateSpace | None = None, **about: Any) -> None:
        """Write ``arrays`` for ``Plant.from_file``, whole or not at all; ``ValueError`` for another ending than .npz."""
        place, file = checked_path("path", path, (ENDING,)), io.BytesIO()
        np.savez(file, **self.arrays(model, **about))
        try:
            write_whole(place, file.getvalue())
        except OSError as error:
            raise ValueError(f"file {str(place)!r} cannot be written: {error.strerror or error}.") from None

    def ensemble(self, count: int, seed: int = 0) -> list[StateSpace]:
        """So many models drawn from the spread of the parameters, each with the loads of the model itself."""
        count, seed = checked("count", count, Count()), checked("seed", seed, Count(0))
        models = drawn(self.scaled, self.parameters, count, seed)
        return [continuous(self._in_units(each), self.noise.load_input, self.collocated) for each in models]

    def unstable_on(self, law: LinearController, count: int = 32, seed: int = 0, **about: Any) -> int:
        """On how many of ``count`` plants within the spread the sampled loop of a controller for ``plant(**about)`` is unstable.

        None of them should be: where some are, the voltages hardly moved what the controller is to damp. Measure longer then, with
        larger voltages, or with voltages that are held for longer, which have more power at low frequencies.
        """
        plants = (Plant.from_state_space(**self.arrays(each, **about)) for each in self.ensemble(count, seed))
        return sum(not spectral_radius(closed_loop(sampled(plant, law), law)[0]) < 1.0 for plant in plants)

    def to_dict(self) -> dict[str, Any]:
        """What JSON can hold of it."""
        measurement, fit, modes = self.measurement, self.fit, self.modes
        return {
            "seconds": measurement.seconds,
            "interval": measurement.interval,
            "rows_learned_from": self.learned,
            "rows_held_back": fit.rows,
            "order": self.model.order,
            "order_reason": self.choice.reason,
            "orders_tried": [
                {"order": each.order, "loss": _finite(each.loss), "missed": _finite(each.missed), "kept": each.kept}
                for each in self.choice.tried
            ],
            "modes": [
                dict(zip(MODE, map(float, row), strict=True)) for row in zip(*(getattr(modes, name) for name in MODE), strict=True)
            ],
            "spread": "one standard deviation, from the curvature of the likelihood (Cramér and Rao)",
            "readings": [
                {
                    "name": name,
                    "unit": unit,
                    "one_step_fit": float(fit.one_step[k]),
                    "free_run_fit": float(fit.free_run[k]),
                    "attainable_free_run_fit": float(fit.attainable[k]),
                    "noise": float(self.sensor_noise[k]),
                    "share_of_correlations_outside": float(fit.outside[k]),
                }
                for k, (name, unit) in enumerate(zip(measurement.reading_names, measurement.reading_units, strict=True))
            ],
            "loads": self.noise.load_input.shape[1],
        }


def _finite(value: float) -> float | None:
    return value if np.isfinite(value) else None
