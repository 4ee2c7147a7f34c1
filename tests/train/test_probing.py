"""Linear probes of what a recurrent agent remembers: what they can tell, and what they must not."""

import numpy as np
import pytest

from beamenv.task import resolve_task
from train.controllers.shipped import find_shipped
from train.controllers.sources import Trained
from train.probing.__main__ import main
from train.probing.memories import QUESTIONS, recorded
from train.probing.probe import balanced_accuracy, explained, probed
from train.probing.table import FEATURES, read_rows, rows_of, write_rows


@pytest.fixture
def generator():
    return np.random.default_rng(0)


def test_what_features_hold_linearly_is_told_and_noise_is_not(generator):
    truth = generator.normal(size=96)
    features = generator.normal(size=(96, 5, 12))
    nothing = probed(features, truth, classes=False)
    assert nothing.value < 0.1 and nothing.low < 0.0
    features[..., 3] += 2.0 * truth[:, None]
    told = probed(features, truth, classes=False)
    assert told.value > 0.85 and told.low <= told.value <= told.high


def test_kinds_are_told_by_their_indicators_and_noise_by_chance(generator):
    truth = np.repeat([0.0, 1.0, 2.0], [48, 24, 24])
    features = generator.normal(size=(96, 5, 12))
    assert probed(features, truth, classes=True).value < 0.5
    features[..., :3] += 2.0 * (truth[:, None] == np.arange(3))[:, None]
    assert probed(features, truth, classes=True).value > 0.9


def test_episodes_are_never_both_fitted_and_judged(generator):
    """An episode's own mark, the same at all its instants, would tell all of it to a probe that has seen another of them."""
    truth = generator.normal(size=64)
    marks = np.repeat(generator.normal(size=(64, 1, 63)), 20, axis=1)
    assert probed(marks, truth, classes=False).value < 0.1


def test_scores_by_hand():
    truth = np.array([0.0, 0.0, 0.0, 1.0])
    assert balanced_accuracy(np.zeros(4), truth) == 0.5
    assert explained(truth, truth) == 1.0 and explained(np.full(4, 0.25), truth) == 0.0


def test_a_recurrent_agent_is_recorded_with_what_it_was_shown(tmp_path):
    question = QUESTIONS[1]
    policy = Trained(find_shipped("gradient", "generalist", 0).folder).build(resolve_task(scenario=question.scenario))
    episodes = recorded(policy, question, range(16))
    assert episodes.hidden.shape == episodes.window.shape == (16, 250, 48)
    assert set(episodes.truth) <= {1.0, 2.0, 3.0}
    assert np.abs(episodes.hidden).max() <= 1.0 and np.abs(episodes.window).max() <= 1.0
    rows = list(rows_of(question, episodes))
    assert len(rows) == 10 * len(FEATURES)
    write_rows(tmp_path / "memory.csv", rows)
    again = read_rows(tmp_path / "memory.csv")
    assert [row.features for row in again] == [row.features for row in rows]
    np.testing.assert_allclose([row.score.value for row in again], [row.score.value for row in rows], atol=1e-4)


def test_an_agent_without_a_recurrent_unit_is_refused():
    policy = Trained(find_shipped("optimised-linear", "generalist", 0).folder).build(resolve_task())
    with pytest.raises(ValueError, match="policy is 'optimised linear', but must be one with a recurrent unit"):
        recorded(policy, QUESTIONS[0], range(2))


def test_the_command_refuses_in_a_sentence(capsys):
    assert main(["--episodes", "1"]) == 2
    assert "--episodes is 1" in capsys.readouterr().err
