"""The batch as Stable-Baselines3's VecEnv."""

import warnings

import numpy as np
import pytest

import beamenv

SHORT = {"duration": 0.01}  # 20 control intervals


def test_videos_of_the_vec_env_show_every_blade(tmp_path, monkeypatch):
    pytest.importorskip("moviepy")
    recorder = pytest.importorskip("stable_baselines3.common.vec_env").VecVideoRecorder
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    envs = beamenv.BladeVecEnv(2, seed=0, render_mode="rgb_array", **SHORT)
    assert envs.metadata["render_fps"] == 50
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        recorded = recorder(envs, str(tmp_path), record_video_trigger=lambda step: step == 0, video_length=2)
        recorded.reset()
        for _ in range(3):
            recorded.step(np.zeros((2, 4)))
        assert [picture.shape for picture in envs.get_images()] == [(540, 960, 3)] * 2
        recorded.close()
    assert len(list(tmp_path.glob("*.mp4"))) == 1


def test_options_of_the_vec_env_reach_its_next_reset_and_no_other():
    envs = beamenv.BladeVecEnv(3, seed=0, **SHORT)
    state = np.zeros(envs.envs.unwrapped.state.shape[1])
    state[0] = 1e-4
    push = {"load": {"case": "step", "magnitude": 30.0}}
    envs.set_options([push, {"initial_state": state}, push])
    envs.reset()
    np.testing.assert_allclose(envs.envs.unwrapped.state[1], state, atol=1e-12)
    assert not envs.envs.unwrapped.state[[0, 2]].any()
    assert envs.reset_infos[1]["energy"] == pytest.approx(0.5e-8)
    envs.set_options({"initial_state": state})
    envs.reset()
    np.testing.assert_allclose(envs.envs.unwrapped.state, np.tile(state, (3, 1)), atol=1e-12)
    envs.seed(4)
    first = envs.reset()
    np.testing.assert_array_equal(first, beamenv.BladeVecEnv(3, seed=4, **SHORT).reset())


@pytest.mark.parametrize("options", ["load", [{}], [{}, {}, 3], 3])
def test_options_of_the_vec_env_are_as_many_as_its_blades(options):
    with pytest.raises(ValueError, match="^options is .*, but must be a dictionary, or a list of 3 of them"):
        beamenv.BladeVecEnv(3, **SHORT).set_options(options)


def test_the_vec_env_has_the_one_autoreset_of_stable_baselines():
    with pytest.raises(ValueError, match="^autoreset_mode is 'NextStep', but must be left out"):
        beamenv.BladeVecEnv(3, autoreset_mode="NextStep")
