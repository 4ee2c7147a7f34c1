"""python-control simulates the plant, the laws and the loop that it closes as this package does."""

import control
import numpy as np
import pytest

from baselines import closed_loop_poles, full_order_lqg, h_infinity, lqg, velocity_feedback
from baselines.analysis.response import linear_response
from beamenv import blade_config, build_plant, sample

LAWS = [lqg, full_order_lqg, velocity_feedback, h_infinity]


@pytest.fixture(scope="module")
def plant():
    return build_plant(blade_config("thesis", {"modes": 3}))


@pytest.fixture(scope="module", params=LAWS, ids=lambda law: law.__name__)
def closed(request, plant):
    law, held = request.param(plant), sample(plant)
    system = held.to_control()
    behind = control.ss(held.A, system.B, held.C, system.D, dt=held.interval, inputs=6, outputs=4)
    own = law.to_control()
    padded = control.ss(own.A, own.B, np.vstack([own.C, np.zeros((2, own.nstates))]), np.vstack([own.D, np.zeros((2, 4))]), own.dt)
    return law, held, control.feedback(behind, padded, sign=1)


def test_the_loop_that_it_closes_answers_loads_as_ours(closed):
    law, held, system = closed
    loads = np.random.default_rng(3).uniform(-1.0, 1.0, (400, 2))
    states, voltages = linear_response(held, law, loads)
    assert np.abs(voltages / law.instruments.voltage_limits[1]).max() < 1.0  # no limit acts
    found = control.forced_response(system, None, np.hstack([np.zeros((400, 4)), loads]).T).outputs
    expected = held.C @ states[:-1].T
    assert np.abs(found - expected).max() < 1e-11 * np.abs(expected).max()


def test_the_loop_that_it_closes_has_our_poles(closed, plant):
    law, held, system = closed
    ours = np.exp(held.interval * closed_loop_poles(plant, law))
    theirs = system.poles().astype(complex)
    apart = np.abs(ours[:, None] - theirs)
    assert ours.shape == theirs.shape
    assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < 1e-11


def test_a_law_that_it_simulates_drives_as_predict_does(closed):
    law = closed[0]
    readings = 1e-7 * np.random.default_rng(5).normal(size=(100, 4))
    found = control.forced_response(law.to_control(), None, readings.T).outputs.T
    memory, expected = None, []
    for reading in readings:
        action, memory = law.in_physical_units().predict(reading, memory)
        expected.append(action)
    assert np.abs(found - expected).max() < 1e-11 * np.abs(expected).max()
