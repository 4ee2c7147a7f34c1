"""Pictures of blades in a batch."""

import numpy as np
import pytest

from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv

pytest.importorskip("matplotlib")
pytest.importorskip("pygame")


def test_the_batch_draws_what_the_single_environment_draws():
    envs = RotatingBeamVectorEnv(num_envs=3, render_mode="rgb_array", render_index=[2, 0])
    envs.reset(seed=[5, 6, 7])
    single = RotatingBeamEnv(render_mode="rgb_array")
    single.reset(seed=7)
    for _ in range(4):
        envs.step(np.full((3, 4), 0.4))
        single.step(np.full(4, 0.4))
    pictures = envs.render()
    assert len(pictures) == 2
    np.testing.assert_array_equal(pictures[0], single.render())
    assert (pictures[1] != pictures[0]).any()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_the_batch_draws_the_start_of_the_next_episode(mode):
    envs = RotatingBeamVectorEnv(num_envs=2, duration=2e-3, autoreset_mode=mode, render_mode="rgb_array")
    envs.reset(seed=0)
    for _ in range(5 if mode == "NextStep" else 4):
        envs.step(np.zeros((2, 4)))
    history = envs._pictures.renderers[0]._history
    assert history.time == 0.0
    np.testing.assert_array_equal(history.last.state, envs.state[0])


@pytest.mark.parametrize("index", [3, -1, 0.5, "0", [], [0, 3]])
def test_a_blade_that_is_not_in_the_batch_cannot_be_drawn(index):
    with pytest.raises(ValueError, match="render_index is .* from 0 to 2"):
        RotatingBeamVectorEnv(num_envs=3, render_mode="rgb_array", render_index=index)


def test_a_batch_that_draws_nothing_makes_no_renderer_and_warns():
    envs = RotatingBeamVectorEnv(num_envs=2)
    envs.reset(seed=0)
    assert envs._pictures is None
    with pytest.warns(UserWarning, match="without a render_mode"):
        assert envs.render() is None
