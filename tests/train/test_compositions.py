"""Scenarios that generalists meet in training alone, and what their blades have wrong."""

from dataclasses import replace

import numpy as np
import pytest
import torch

from beamenv.scenarios.named import UNSEEN
from beamenv.scenarios.scenario import SCENARIOS, scenario
from beamenv.task import resolve_task
from train.learning.through_plant.compositions import compositions, contents
from train.learning.through_plant.gradient import calmed
from train.learning.through_plant.modal_errors import FREQUENCY, MistakenTask, changed, mistaken
from train.learning.training import on_training_bank


def kinds(chosen):
    """Of fault, whatever their size."""
    plants, plain = chosen.plants, SCENARIOS["nominal"]
    there = {
        "delay": chosen.drive.delay != plain.drive.delay,
        "hysteresis": chosen.drive.hysteresis > 0.0,
        "failure": bool(chosen.failures.dead_actuators or chosen.failures.faulty_sensors),
        "off-model": plants.ply_angle_ratio != (1.0, 1.0) or plants.truth is not None,
        "off-speed": plants.speed_ratio != (1.0, 1.0),
        "rotor": bool(chosen.rotor.harmonics),
    }
    return {name for name, wrong in there.items() if wrong}


def test_no_composition_has_the_kinds_of_fault_of_a_scenario_kept_for_judging():
    kept = [kinds(SCENARIOS[name]) for name in UNSEEN]
    composed = [scenario(content) for content in contents(200, np.random.default_rng(0))]
    assert {"delay", "failure"} in kept and len(kept) == len(UNSEEN)
    for each in composed:
        assert len(kinds(each)) > 1 and kinds(each) not in kept
        assert each.drive.delay[1] <= 3 and each.failures.dead_actuators <= 1
    assert len({frozenset(kinds(each)) for each in composed}) == 11 + 20 + 15


def test_the_same_seed_composes_the_same_scenarios():
    first, second = (list(contents(12, np.random.default_rng(5))) for _ in range(2))
    assert first == second
    assert first != list(contents(12, np.random.default_rng(6)))


def test_a_blade_without_errors_is_the_blade():
    """By its modes alone it moves, is driven, senses and strains as before."""
    blade = resolve_task().blade.with_fixed_range().with_fixed_order()
    modes, patches = len(blade.true_modal.natural_frequencies), blade.full.forces.shape[1]
    (given,) = mistaken([blade], 0)
    none = changed(blade, np.ones(modes), np.ones((modes, patches)), np.full(modes, blade.config.damping_ratio))
    same = replace(given, given=none)
    vars(same).update(beam=blade.beam, modal=blade.modal, full=blade.full)
    for part in ("A", "B", "C", "disturbance_input", "input_weight", "sensor_noise", "sensor_full_scale"):
        own = getattr(blade.truth, part)
        np.testing.assert_allclose(getattr(same.truth, part), own, rtol=1e-9, atol=1e-9 * np.abs(own).max())
    assert not np.allclose(given.truth.A, blade.truth.A, rtol=1e-3)


def test_a_patch_errs_alike_as_actuator_and_as_sensor():
    """What a patch does to a mode and sees of it keeps its sign: a collocated pair still takes energy out of every mode."""
    blade = resolve_task().blade.with_fixed_range().with_fixed_order()
    (given,) = mistaken([blade], 3)
    true, wrong = (each.truth for each in (blade, given))
    r = len(true.natural_frequencies)
    assert np.abs(wrong.natural_frequencies / true.natural_frequencies - 1.0).max() < 2.0 * FREQUENCY  # modes may change places
    assert np.abs(wrong.natural_frequencies / true.natural_frequencies - 1.0)[:2].max() < 0.03
    pairs = [np.sum(each.B[r : 2 * r] * each.C[:, r : 2 * r].T, axis=0) for each in (true, wrong)]
    assert np.all(np.sign(pairs[0]) == np.sign(pairs[1]))


def test_of_six_compositions_one_has_nothing_but_wrong_modes():
    composed = compositions(resolve_task(duration=0.02), 12, 13)
    assert [k for k, each in enumerate(composed) if not kinds(each.scenario)] == [0, 6]
    assert all(isinstance(composed[k], MistakenTask) for k in (0, 6))


def test_composed_tasks_are_like_the_one_that_they_go_with():
    task = resolve_task(duration=0.02)
    first, second = (on_training_bank(each) for each in compositions(task, 2, 13))
    assert first.steps == second.steps == task.steps
    assert len(first.bank) == 16 and first.bank.operators.fused.shape == second.bank.operators.fused.shape


@pytest.mark.parametrize(("cost", "slope"), [(0.1, 1.0), (2.9, 1.0), (30.0, 0.1), (3e6, 1e-6)])
def test_what_a_window_costs_beyond_the_limit_counts_ever_less_and_never_nothing(cost, slope):
    given = torch.tensor([cost], dtype=torch.float64, requires_grad=True)
    calmed(given, 3.0).sum().backward()
    assert float(given.grad) == pytest.approx(slope)
    beyond = torch.tensor([3.0, 3.0 + 1e-9], dtype=torch.float64)
    assert float(calmed(beyond, 3.0).diff()) == pytest.approx(1e-9, rel=1e-5)
