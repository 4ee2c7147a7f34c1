"""Where pictures go: into a window, into files, nowhere."""

import os
import sys
import time

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv

pytest.importorskip("matplotlib")
pytest.importorskip("pygame")


@pytest.fixture
def no_screen(monkeypatch):
    monkeypatch.setitem(os.environ, "SDL_VIDEODRIVER", "dummy")


def test_rendering_without_a_mode_warns_and_draws_nothing():
    env = RotatingBeamEnv()
    env.reset(seed=0)
    with pytest.warns(UserWarning, match="without a render_mode"):
        assert env.render() is None


def test_a_window_shows_every_step_at_the_stated_rate(no_screen):
    import pygame

    env = gymnasium.make(beamenv.ENV_ID, render_mode="human", duration=0.01)
    env.reset(seed=0)
    assert pygame.display.get_surface().get_size() == (960, 540)
    start = time.perf_counter()
    for _ in range(10):
        env.step(np.full(4, 0.5))
    assert time.perf_counter() - start >= 0.9 * 10 / env.metadata["render_fps"]
    shown = pygame.surfarray.array3d(pygame.display.get_surface()).transpose(1, 0, 2)
    np.testing.assert_array_equal(shown, env.unwrapped._renderer.draw())
    assert env.render() is None
    env.close()
    assert not pygame.display.get_init()


@pytest.mark.parametrize("library", ["matplotlib", "pygame"])
def test_pictures_without_a_library_say_what_to_install(library, monkeypatch):
    monkeypatch.setitem(sys.modules, library, None)
    sentence = rf'{library} is not installed, run `pip install "beamenv\[render\]"`'
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match=sentence):
        RotatingBeamEnv(render_mode="rgb_array")
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match=sentence):
        RotatingBeamVectorEnv(render_mode="rgb_array")


def test_gymnasium_s_video_wrappers_write_files(tmp_path):
    pytest.importorskip("moviepy")
    env = gymnasium.wrappers.RecordVideo(
        gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array", duration=4e-3), str(tmp_path / "single"), disable_logger=True
    )
    envs = gymnasium.wrappers.vector.RecordVideo(
        RotatingBeamVectorEnv(num_envs=2, duration=4e-3, render_mode="rgb_array", render_index=range(2)), str(tmp_path / "batch")
    )
    for recorded, actions in ((env, np.zeros(4)), (envs, np.zeros((2, 4)))):
        recorded.reset(seed=0)
        for _ in range(8):
            recorded.step(actions)
        recorded.close()
    for folder in ("single", "batch"):
        files = list((tmp_path / folder).glob("*.mp4"))
        assert [file.stat().st_size > 1000 for file in files] == [True]
