"""Blades that do not bear their load: what they cost, with and without control, and that they never settle."""

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import evaluate, lqr, no_control
from baselines.evaluation.metrics import settling_band

HEAVY = {"preset": "step", "magnitude": 20000.0}
RESONANCE = {"preset": "harmonic", "harmonic_magnitude": 600.0, "frequency_ratio": 1.0}
UNLIMITED = {"voltage_limits": (-1e8, 1e8), "model": "thesis"}
STRONG = {"voltage_limits": (-4e5, 4e5), "model": "thesis"}


@pytest.fixture(name="crushed", scope="module")
def _crushed():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4, scenario=HEAVY)
    return evaluate(no_control(envs.unwrapped.design_plant), envs, range(4))


@pytest.fixture(name="saved", scope="module")
def _saved():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=6, scenario=RESONANCE, blade=STRONG)
    return evaluate(lqr(envs.unwrapped.design_plant), envs, range(6))


def test_blades_that_fail_never_settle_and_take_the_whole_episode(crushed):
    assert crushed.episodes.failed.all()
    assert (crushed.settled.value, crushed.settled.low, crushed.settled.high) == (0.0, 0.0, 0.0)
    assert (crushed.settling_time.value, crushed.settling_time.low, crushed.settling_time.high) == (0.5, 0.5, 0.5)
    assert crushed.metrics.settling_time.tolist() == [0.5] * 4
    assert crushed.episodes.time[-1] == pytest.approx(0.5)


def test_no_control_beside_itself_is_one_even_where_it_breaks_the_blade(crushed):
    assert (crushed.relative_cost.value, crushed.relative_cost.low, crushed.relative_cost.high) == (1.0, 1.0, 1.0)
    assert crushed.cost.value == np.inf


def test_a_blade_that_fails_without_control_is_charged_to_the_end_as_in_its_last_interval(crushed):
    for row, expected in enumerate(crushed.uncontrolled):
        spent = crushed.reference.cost[:, row]
        spent = spent[~np.isnan(spent)]
        assert 0 < len(spent) < 1000
        assert expected == pytest.approx(spent.sum() + (1000 - len(spent)) * spent[-1], rel=1e-12)
    assert crushed.to_dict()["uncontrolled"] == crushed.uncontrolled.tolist()


def test_a_law_that_saves_a_blade_is_judged_against_what_its_failure_is_charged(saved):
    lost = saved.reference.failed
    assert lost.any() and not lost.all() and not saved.episodes.failed.any()
    assert saved.uncontrolled[~lost] == pytest.approx(saved.reference.cost.sum(axis=0)[~lost], rel=1e-12)
    assert saved.relative_cost.value == pytest.approx(saved.metrics.cost.sum() / saved.uncontrolled.sum(), rel=1e-12)
    assert 0.2 < saved.relative_cost.low <= saved.relative_cost.high < 0.4


def test_a_saved_blade_settles_by_the_band_of_the_response_until_the_failure(saved):
    band, response = settling_band(saved.reference), np.linalg.norm(saved.reference.load_response, axis=-1)
    lost = saved.reference.failed
    np.testing.assert_allclose(band[lost], 0.05 * np.nanmax(response, axis=0)[lost])
    assert saved.settled.value == 0.0  # a harmonic load does not let it


def test_a_law_that_breaks_a_blade_alone_costs_infinitely_much_and_one_that_is_lost_anyway_counts_as_no_better():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=6, scenario={**RESONANCE, "harmonic_magnitude": 400.0}, blade=UNLIMITED)
    result = evaluate(np.sign, envs, range(6))
    lost = result.reference.failed
    assert result.episodes.failed.all() and lost.any() and not lost.all()
    np.testing.assert_array_equal(result.judged_cost, np.where(lost, result.uncontrolled, np.inf))
    assert result.relative_cost.value == np.inf
    always_lost = evaluate(np.sign, envs, np.flatnonzero(lost).tolist())
    assert always_lost.relative_cost.value == 1.0
