"""Pictures: that they are drawn, and show what they say."""

import sys
import warnings

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, blade_config, build_plant
from beamenv.loads import static_deflection

pytest.importorskip("matplotlib")


def test_a_picture_is_an_rgb_array_that_follows_the_blade():
    env = RotatingBeamEnv(render_mode="rgb_array", scenario="quiet")
    env.reset(options={"load": {"case": "deflection", "magnitude": 30.0}})
    first = env.render()
    assert first.shape == (600, 960, 3)
    assert first.dtype == np.uint8
    np.testing.assert_array_equal(env.render(), first)
    env.step(np.full(4, 0.7))
    second = env.render()
    assert (first != second).any()
    env.reset(options={"load": {"case": "deflection", "magnitude": 30.0}})
    assert np.ptp(first.reshape(-1, 3), axis=0).min() > 100


@pytest.mark.parametrize("preset", sorted(beamenv.PRESETS))
def test_every_preset_can_be_drawn_without_a_warning(preset):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make(beamenv.ENV_ID, preset=preset, render_mode="rgb_array", blade={"patches": {"ganged": True}})
        env.reset(seed=0)
        env.step(env.action_space.sample())
        assert env.render().any()


def test_the_drawn_shape_ends_at_the_tip_displacement():
    from beamenv.rendering import BladeView

    config = blade_config()
    plant, view = build_plant(config), BladeView(config)
    state = static_deflection(plant, [3.0, 30.0])
    np.testing.assert_allclose(view.deflection(state)[:, -1], view.exaggeration * plant.tip_displacement @ state, rtol=1e-9)
    np.testing.assert_allclose(view.deflection(state)[:, 0], 0.0, atol=1e-12)
    assert view.exaggeration == 1000.0


def test_rendering_without_a_mode_warns_and_draws_nothing():
    env = RotatingBeamEnv()
    env.reset(seed=0)
    with pytest.warns(UserWarning, match="without a render_mode"):
        assert env.render() is None


def test_pictures_without_matplotlib_say_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "matplotlib", None)
    with pytest.raises(gymnasium.error.DependencyNotInstalled, match=r"beamenv\[train\]"):
        RotatingBeamEnv(render_mode="rgb_array")
