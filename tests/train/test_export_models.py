"""Multiple-model laws of every make as block diagrams: run by NumPy, they ask for the voltages of the law."""

import numpy as np
import pytest

from baselines import Hypothesis, PersistentLoad, lqg, multiple_model
from baselines.design.motion import DenseMotion
from beamenv.task import resolve_task
from tests.train.in_a_loop import in_a_loop, python_steps
from train.export import exported, motions
from train.export.simulate import simulated

STEPS = 300


def plant():
    return resolve_task().design_plant


def hypotheses(**more):
    return [
        Hypothesis(plant(), load=PersistentLoad(), **more),
        Hypothesis(plant(), load=PersistentLoad(), actuator_gain=[1.0, 0.2, 1.0, 1.0], deflection=5.0),
    ]


def agrees(law, scenario="nominal", lost=()):
    """On the readings of the law's own loop, some of which show the one before."""
    step = python_steps(law, plant())
    measured, _ = in_a_loop(step, scenario, steps=STEPS)
    for k, sensor in lost:
        measured[k, sensor] = measured[k - 1, sensor]
    fresh = python_steps(law, plant())
    voltages = np.array([fresh(row) for row in measured])
    written = simulated(exported(law, plant()).diagram, measured)
    assert np.ptp(voltages) > 0.0
    np.testing.assert_allclose(written, voltages, rtol=0.0, atol=1e-9 * plant().voltage_limits.max())
    return voltages


def test_law_without_a_fallback():
    agrees(multiple_model(hypotheses()))


def test_law_whose_fallback_takes_over():
    law = multiple_model(hypotheses(), lqg(plant()), allowance=0.01, window=5)
    other = agrees(multiple_model(hypotheses()))
    assert np.abs(agrees(law) - other).max() > 1.0  # it did


@pytest.mark.parametrize("holds", [(True, True), (True, False)])
def test_lost_readings_say_nothing_to_filters_that_know(holds):
    own = [Hypothesis(plant(), delay=k, holds_lost_readings=each) for k, each in enumerate(holds)]
    law = multiple_model(own, lqg(plant()))
    lost = [(10, 0), (11, 0), (12, 3), *((60, sensor) for sensor in range(4)), (250, 1), (250, 2)]
    assert np.abs(agrees(law, lost=lost) - agrees(law)).max() > 1.0  # they were lost


def test_law_whose_hypotheses_follow_each_other():
    agrees(multiple_model(hypotheses(), lqg(plant()), transition=[[0.99, 0.01], [0.02, 0.98]]))


@pytest.mark.parametrize("transition", [None, [[0.99, 0.01], [0.02, 0.98]]])
def test_law_that_moves_by_whole_matrices(transition, monkeypatch):
    law = multiple_model(hypotheses(), lqg(plant()), transition=transition)
    monkeypatch.setattr(motions, "motion_of", lambda bank, state_gain, mixed: DenseMotion.of(bank, state_gain))
    agrees(law)


def test_states_of_filters_of_two_sizes():
    agrees(multiple_model([*hypotheses(), Hypothesis(plant(), sensor_gain=[1.0, 0.0, 1.0, 1.0])], lqg(plant())))


def test_law_that_nothing_rules_out():
    agrees(multiple_model(hypotheses(), lqg(plant()), floor=0.2))
