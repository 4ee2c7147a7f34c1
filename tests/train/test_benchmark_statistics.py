"""Estimates over runs and seeds against numbers known by hand and by distribution."""

import numpy as np
import pytest
from scipy.stats import ttest_rel

from baselines.evaluation.statistics import paired_draws, resamples
from train.benchmark.statistics import (
    better,
    difference,
    doubt,
    interquartile_mean,
    mean,
    pooled_interquartile_mean,
    rejected,
    relative_cost,
)


def test_the_interquartile_mean_of_0_to_99_is_that_of_25_to_74():
    assert interquartile_mean(np.arange(100.0)) == 49.5
    assert interquartile_mean(np.arange(100.0)[::-1].reshape(2, 50)).tolist() == [74.5, 24.5]


def test_a_quarter_of_outliers_does_not_move_the_interquartile_mean():
    values = np.arange(100.0)
    values[80:] = np.inf
    assert interquartile_mean(values) == 49.5
    values[70:] = np.inf
    assert interquartile_mean(values) == np.inf


def test_a_tie_is_half_an_improvement():
    cost, rival = np.array([[1.0, 2.0, 3.0, np.inf]]), np.array([2.0, 2.0, 2.0, np.inf])
    assert better(cost, rival).tolist() == [[1.0, 0.5, 0.0, 0.5]]
    assert mean(better(rival[None], rival)).value == 0.5


@pytest.mark.parametrize(("runs", "seeds"), [(1, 40), (30, 40)])
def test_the_bootstrap_interval_of_a_normal_mean_has_its_textbook_width(runs, seeds):
    """±1.96 σ/√N of one run; runs that differ by σ_r widen it to ±1.96 √(σ_r²/K + σ²/N), where seeds act on all runs alike."""
    generator = np.random.default_rng(7)
    by_seed, by_run = generator.normal(size=(1, seeds)), generator.normal(size=(runs, 1)) if runs > 1 else np.zeros((1, 1))
    estimate = mean(by_seed + by_run)
    spread = np.sqrt(by_seed.var() / seeds + by_run.var() / runs)
    assert estimate.high - estimate.low == pytest.approx(2 * 1.96 * spread, rel=0.06)
    assert estimate.low < estimate.value < estimate.high


def test_19_of_20_intervals_hold_the_mean_of_a_normal_distribution():
    generator, held = np.random.default_rng(3), 0
    for _ in range(400):
        estimate = mean(generator.normal(loc=5.0, size=(1, 60)))
        held += estimate.low <= 5.0 <= estimate.high
    assert 0.91 < held / 400 < 0.975


def test_pairing_takes_away_what_seeds_have_in_common():
    generator = np.random.default_rng(1)
    load = generator.gamma(1.0, size=64)
    cost, rival = 0.5 * load[None], 0.6 * load[None]
    gap = difference(cost, rival, load)
    assert (gap.value, gap.low, gap.high) == pytest.approx((-0.1, -0.1, -0.1))
    estimate = relative_cost(cost, load)
    assert (estimate.value, estimate.low, estimate.high) == pytest.approx((0.5, 0.5, 0.5))
    unpaired = mean(cost)
    assert unpaired.high - unpaired.low > 0.1


def test_a_blade_that_breaks_makes_the_mean_infinite_and_is_not_left_out():
    cost = np.ones((2, 50))
    cost[0, 3] = np.inf
    estimate = mean(cost)
    assert estimate.value == estimate.high == np.inf
    assert estimate.low == 1.0  # some resamples do not draw it
    assert pooled_interquartile_mean(cost).value == 1.0


def test_two_controllers_that_break_every_blade_are_not_told_apart():
    lost = np.full((1, 10), np.inf)
    assert difference(lost, lost, np.ones(10)).value == 0.0
    assert difference(np.ones((1, 10)), lost, np.ones(10)).value == -np.inf
    assert difference(lost, np.ones((1, 10)), np.ones(10)).low == np.inf


def test_counts_give_the_means_of_the_drawn_values():
    drawn, values = resamples(3, 11), np.random.default_rng(0).normal(size=(3, 11))
    np.testing.assert_allclose(drawn.mean(values), drawn.pooled(values).mean(axis=1), rtol=1e-12, atol=1e-14)


def test_seeds_are_drawn_alike_however_many_runs_there_are():
    assert np.array_equal(resamples(1, 20).seeds, resamples(5, 20).seeds)


def test_draws_that_every_comparison_shares_cannot_be_written_to():
    drawn = resamples(2, 5)
    for kept in (paired_draws(5), drawn.runs, drawn.seeds, drawn.run_counts, drawn.seed_counts):
        with pytest.raises(ValueError, match="read-only"):
            kept[...] = 0


def test_holms_method_rejects_what_his_rule_does():
    """Of four p values 0.005 is below 0.05/4 and 0.01 below 0.05/3; 0.03 is not below 0.05/2, and ends it."""
    assert rejected([0.01, 0.04, 0.03, 0.005]) == [True, False, False, True]
    assert rejected([0.01, 0.04, 0.03, 0.005], level=0.1) == [True, True, True, True]
    assert rejected([]) == []


@pytest.mark.parametrize("shift", [0.15, 0.25])
def test_the_doubt_of_a_paired_difference_is_near_that_of_a_t_test(shift):
    generator = np.random.default_rng(4)
    rival = generator.gamma(4.0, size=(1, 128))
    cost = rival - shift + generator.normal(size=(1, 128))
    expected = ttest_rel(cost[0], rival[0]).pvalue
    assert expected > 1e-4
    assert doubt(cost, rival) == pytest.approx(expected, rel=0.3)
    assert doubt(rival, cost) == pytest.approx(doubt(cost, rival))
    assert doubt(rival, rival) == 1.0
