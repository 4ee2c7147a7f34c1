"""What agents may be shown in place of readings: the belief of a Kalman filter that knows the design, mode by mode.

The filter has all modes of the design blade, and agents are shown the slow ones. As long as the filter is right, what is not
fed back cannot be made unstable, whatever an agent in the making does with the rest: the estimate of one mode does not hold
the motion of another. States are shown in energy coordinates, whose squares are energy, in one common unit.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from gymnasium.spaces import Box
from gymnasium.vector import VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import ArrayLike, NDArray
from scipy.linalg import block_diag, solve_discrete_lyapunov

from baselines import PersistentLoad
from baselines.laws.lqg import optimal_filter, optimal_regulator, sampled_with_loads
from beamenv import VectorSensorHistory
from beamenv.blade.design import Design
from beamenv.configuration import Refused
from beamenv.plant.hold import hold
from beamenv.plant.plant import Plant, drive_limit
from train.controllers.belief_policy import FILTER, corrected
from train.learning.sb3.typical import shown_states

Array = NDArray[Any]


class Belief(NamedTuple):
    """A filter in normalised units, as ``train.controllers.belief_policy.BeliefPolicy`` has it; n states, f of them shown."""

    transition: Array
    """(n, n)"""
    input: Array
    """(m, n)"""
    correction: Array
    """(p, n)"""
    readout: Array
    """(n, p)"""
    shown: Array
    """(n, f): energy coordinates of the blade over their common size, and the lasting load over its size."""


def design_belief(design: Design, modes: int) -> Belief:
    """Of the design blade's full plant under white loads and ``PersistentLoad()``, the slowest ``modes`` of it shown.

    Of a model in coordinates of its own all states are shown. ``ValueError`` where the plant has no such filter, and for more modes
    than it has.
    """
    plant, load = design.full_plant, PersistentLoad()
    held = sampled_with_loads(plant, load)
    full_scale, modal, n = plant.sensor_full_scale, plant.blade_states, len(held.A)
    if plant.in_energy_coordinates and modes > modal // 2:
        raise Refused("modes", modes, f"at most the {modal // 2} of the design")
    noise = held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    size = np.sqrt(np.diag(solve_discrete_lyapunov(held.A, noise))[:modal].mean())
    kept = [*shown_states(plant, modes), *range(n - plant.loads, n)]
    shown = np.diag(np.repeat([1.0 / size, 1.0 / load.magnitude], [modal, n - modal]))[:, kept]
    gain = optimal_filter(plant, held).gain * full_scale
    parts = held.A.T, (held.B * drive_limit(plant)).T, gain.T, held.C.T / full_scale, shown
    return Belief(*(np.ascontiguousarray(part, dtype=np.float32) for part in parts))


OSCILLATORS = (15.0, 25.0, 40.0, 65.0)
"""Hz: two to an octave or so, from below the slowest mode to where the fast ones begin."""

OSCILLATOR_DAMPING = 0.4

USUAL_READING = 0.1
"""Of full scale, about, root mean square."""


def oscillator_bank(plant: Plant) -> Belief:
    """Readings alone, through oscillators: each shows what a reading has about its frequency, in phase and a quarter period later.

    Nothing of the blade is in it. ẋ₁ = 2ζω (y − x₁) − ω x₂, ẋ₂ = ω x₁; the newest reading is held over the interval that it ends.
    """
    p, m = len(plant.C), plant.B.shape[1]
    omega = 2.0 * np.pi * np.array(OSCILLATORS) / plant.time_scale
    blocks = [np.array([[-2.0 * OSCILLATOR_DAMPING * w, -w], [w, 0.0]]) for w in omega]
    held, driven = hold(
        block_diag(*blocks), np.ravel([(2.0 * OSCILLATOR_DAMPING * w, 0.0) for w in omega])[:, None], plant.control_interval
    )
    transition, n = np.kron(np.eye(p), held), p * len(held)
    parts = transition.T, np.zeros((m, n)), np.kron(np.eye(p), driven.T), np.zeros((n, p)), np.eye(n) / USUAL_READING
    return Belief(*(np.ascontiguousarray(part, dtype=np.float32) for part in parts))


def regulator_on(belief: Belief, design: Design, approach: float = 1.0) -> Array:
    """(m, f + m): the sampled regulator's gain as a linear actor on what a ``design_belief`` shows has it.

    What is not shown has no part in it. ``approach`` of the way to its actions lie the regulator's voltages.
    """
    plant = design.full_plant
    gain = -optimal_regulator(plant, sampled_with_loads(plant, PersistentLoad())).gain / drive_limit(plant)[:, None]
    held = (1.0 - approach) * np.eye(len(gain))
    return np.asarray(np.hstack([gain @ np.linalg.pinv(belief.shown.astype(np.float64)).T, -held]) / approach)


class RollingBelief:
    """The beliefs of a batch of blades, kept up as ``beamenv.envs.history.RollingHistory`` keeps windows."""

    def __init__(self, count: int, belief: Belief) -> None:
        self.belief = belief
        self._filter: Mapping[str, Array] = dict(zip(FILTER, belief, strict=True))
        self._before, self._estimate = (np.zeros((count, len(belief.transition)), np.float32) for _ in range(2))
        self._voltages = np.zeros((count, len(belief.input)), np.float32)

    def begin(self, readings: ArrayLike, rows: Any = slice(None)) -> None:
        """Forget the past of ``rows``; ``readings`` (len(rows), p) are all there is."""
        self._before[rows] = 0.0
        self._voltages[rows] = 0.0
        self._read(rows, readings)

    def append(self, readings: ArrayLike, voltages: ArrayLike) -> None:
        """One more instant: ``readings`` (N, p) after ``voltages`` (N, m), both normalised."""
        self._voltages[...] = voltages
        self._before[...] = self._estimate @ self.belief.transition + self._voltages @ self.belief.input
        self._read(slice(None), readings)

    def replace_last(self, rows: Any, readings: ArrayLike, voltages: ArrayLike) -> None:
        """Put another last instant in the place of that of ``rows``."""
        self._before[rows] += (np.asarray(voltages, np.float32) - self._voltages[rows]) @ self.belief.input
        self._voltages[rows] = voltages
        self._read(rows, readings)

    def _read(self, rows: Any, readings: ArrayLike) -> None:
        self._estimate[rows] = corrected(self._filter, self._before[rows], np.asarray(readings))

    @property
    def estimate(self) -> Array:
        """(N, n) what the filters hold."""
        return self._estimate

    def window(self, rows: Any = slice(None)) -> Array:
        """What is shown (len(rows), f + m): the beliefs, and the voltages held before."""
        return np.hstack([self._estimate[rows] @ self.belief.shown, self._voltages[rows]])

    def state_dict(self) -> dict[str, Array]:
        """Copies of what moves."""
        return {name: getattr(self, f"_{name}").copy() for name in ("before", "estimate", "voltages")}

    def load_state_dict(self, state: Mapping[str, ArrayLike]) -> None:
        """Go back to a ``state_dict`` of an equally made batch."""
        for name, array in state.items():
            if name != "over":
                getattr(self, f"_{name}")[...] = np.asarray(array)


class VectorBelief(VectorSensorHistory):
    """Observes the beliefs of ``belief`` in place of readings: (N, f + m).

    - `env`: a `RotatingBeamVectorEnv` with normalised units.
    """

    def __init__(self, env: VectorEnv[Any, Any, NDArray[Any]], belief: Belief) -> None:
        super().__init__(env, length=1)
        self._history: Any = RollingBelief(env.num_envs, belief)
        width = belief.shown.shape[1] + len(belief.input)
        self.single_observation_space = Box(-np.inf, np.inf, (width,), np.float32)
        self.observation_space = batch_space(self.single_observation_space, env.num_envs)

    @property
    def estimate(self) -> Array:
        """(N, n) the filters' states."""
        return np.asarray(self._history.estimate)

    def show(self, belief: Belief) -> None:
        """Another view of the same filters."""
        self._history.belief = belief
