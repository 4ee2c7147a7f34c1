"""Model-predictive control: LQG while no limit is in sight, else the optimum within the limits, found by other means."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from scipy.optimize import lsq_linear

import beamenv
from baselines import PersistentLoad, evaluate, lqg, mpc
from baselines.lqg import sampled_design
from baselines.mpc import doubling_blocks

LOADS = {"no load estimate": None, "load estimate": PersistentLoad()}
BLOCKS = {"every interval": [1] * 6, "blocks": [1, 1, 2, 3], "one move held": [4]}


@pytest.fixture(params=LOADS, name="load")
def _load(request):
    return LOADS[request.param]


@pytest.fixture(params=BLOCKS, name="blocks")
def _blocks(request):
    return BLOCKS[request.param]


def states(count, order, size=0.5):
    """(count, order), √J, that ask for some ten times the drive limit; the load's two (N/m) among them, if there."""
    return size * np.random.default_rng(1).normal(size=(count, order))


def decide(law, state):
    """Voltage (N, m) when the filter's estimate is ``state`` (N, s): the reading is what the filter expects."""
    expected = np.clip(state @ law.output.T, -law.sensor_full_scale, law.sensor_full_scale)
    return law.predict(expected / law.measurement_scale, state)[0] * law.voltage_scale


def least_squares(held, P, state, blocks):
    """Matrix and offset whose |matrix u + offset|² is the cost of the moves u, instant by instant from the sampled cost itself."""
    n, m = held.B.shape
    stage = np.linalg.cholesky(held.cost[: n + m, : n + m] + 1e-16 * np.eye(n + m)).T
    free, forced, matrix, offset = state, np.zeros((n, m * len(blocks))), [], []
    for move, length in enumerate(blocks):
        voltage = np.zeros((m, m * len(blocks)))
        voltage[:, m * move : m * (move + 1)] = np.eye(m)
        for _ in range(length):
            matrix.append(stage @ np.vstack([forced, voltage]))
            offset.append(stage @ np.concatenate([free, np.zeros(m)]))
            free, forced = held.A @ free, held.A @ forced + held.B @ voltage
    root = np.linalg.cholesky(P).T
    return np.vstack([*matrix, root @ forced]), np.concatenate([*offset, root @ free])


def test_without_a_limit_in_sight_it_is_lqg(small_plant, load):
    plant = small_plant(voltage_limits=np.array([[-1e6, -1e6], [1e6, 1e6]]))
    law, reference = mpc(plant, load), lqg(plant, persistent_load=load)
    memory = reference_memory = None
    for observation in 0.05 * np.random.default_rng(0).normal(size=(200, 3, 2)):
        action, memory = law.predict(observation, memory)
        expected, reference_memory = reference.predict(observation, reference_memory)
        np.testing.assert_allclose(action, expected, rtol=1e-9, atol=1e-9 * np.abs(expected).max())
