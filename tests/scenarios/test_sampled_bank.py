"""The plants of a bank as matrices: those that blades move by."""

import numpy as np
import pytest

from beamenv.plant.plant import normalised, sample
from beamenv.simulation.blades import Blades
from beamenv.simulation.plants.sampled_bank import sampled_bank
from beamenv.task import resolve_task

SMALL = {"modes": 3, "beam": {"terms": 6}, "truth_modes": 5}


@pytest.mark.parametrize("blade", [{}, {"electronics": {"amplifier_bandwidth": None}}, {"model": "thesis"}], ids=str)
def test_a_single_plant_is_the_sampled_one_in_its_axes(blade):
    bank = resolve_task(blade={**SMALL, **blade}, duration=0.01).bank
    held, found, turn = sample(normalised(bank.plant)), sampled_bank(bank), bank.axes[0]
    n, whole = len(held.A), np.eye(len(held.cost))
    whole[:n, :n] = turn
    expected = (turn @ held.A @ turn.T, turn @ held.B, turn @ held.disturbance_input, held.C @ turn.T, whole @ held.cost @ whole.T)
    for name, matrix in zip(("A", "B", "E", "C", "cost"), expected, strict=True):
        assert getattr(found, name)[0] == pytest.approx(matrix, rel=1e-9, abs=1e-9 * np.abs(matrix).max()), name


@pytest.mark.parametrize("plants", [{"speed_ratio": [0.8, 1.2], "bank": 3}, {"spin_up": [150.0, 250.0]}], ids=str)
def test_blades_move_and_cost_as_the_matrices_say(plants):
    task = resolve_task(blade=SMALL, scenario={"preset": "step", "plants": plants, "sensor_noise": False}, duration=0.02)
    found, blades, generators = (
        sampled_bank(task.bank),
        Blades(task.bank, task.scenario, 4),
        list(map(np.random.default_rng, range(4))),
    )
    blades.begin(generators)
    for _ in range(task.steps - 1):
        state, index, loads = blades.moving, blades.index, np.zeros((4, 2))
        blades.disturbances.loads(loads)
        action = np.random.default_rng(7).uniform(-1.0, 1.0, (4, 4))
        motion = blades.step(action, generators)
        A, B, E, cost = (getattr(found, name)[index] for name in ("A", "B", "E", "cost"))
        moved = sum((each @ part[..., None])[..., 0] for each, part in ((A, state), (B, action), (E, loads)))
        assert blades.moving == pytest.approx(moved, rel=1e-8, abs=1e-9 * np.abs(moved).max())
        both = np.hstack([state, action, loads])
        assert motion.cost_increment == pytest.approx(np.einsum("ki,kij,kj->k", both, cost, both), rel=1e-8)
        readings = (found.C[blades.index] @ blades.moving[..., None])[..., 0]
        assert motion.observation == pytest.approx(np.clip(readings, -1.0, 1.0), abs=1e-8)
