"""Pictures of a batch: all of its blades, or those that are asked for."""

import warnings

import gymnasium
import numpy as np
import pytest

import beamenv

SHORT = {"duration": 0.01}  # 20 control intervals


def test_all_blades_are_drawn_by_default(tmp_path, monkeypatch):
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    pytest.importorskip("moviepy")
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, render_mode="rgb_array", **SHORT)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of moviepy's own
        recorded = gymnasium.wrappers.vector.RecordVideo(envs, str(tmp_path), video_length=2, episode_trigger=lambda _: True)
        recorded.reset(seed=0)
        for _ in range(3):
            recorded.step(np.zeros((3, 4)))
        recorded.close()
    assert len(list(tmp_path.glob("*.mp4"))) == 1


def test_pictures_in_a_window_show_all_blades(monkeypatch):
    pytest.importorskip("cv2")
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, render_mode="rgb_array", **SHORT)
    shown = gymnasium.wrappers.vector.HumanRendering(envs)
    shown.reset(seed=0)
    shown.step(np.zeros((2, 4)))
    shown.close()


def test_a_wide_batch_must_be_told_which_blades_are_drawn():
    with pytest.raises(ValueError, match="^render_index is None, but must be given where more than 64 blades are to be drawn"):
        gymnasium.make_vec(beamenv.ENV_ID, num_envs=65, render_mode="rgb_array")
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=65, render_mode="rgb_array", render_index=64)
    envs.reset(seed=0)
    assert len(envs.render()) == 1
