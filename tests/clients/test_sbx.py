"""SBX (Stable-Baselines3 in JAX) trains."""

import gymnasium
import pytest

import beamenv

sbx = pytest.importorskip("sbx")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


@pytest.mark.parametrize("algorithm", ["SAC", "PPO"])
def test_it_trains_on_the_blade(algorithm):
    env = beamenv.SensorHistory(gymnasium.make(beamenv.ENV_ID, duration=0.01), 2)
    short = {"n_steps": 64, "batch_size": 32} if algorithm == "PPO" else {"learning_starts": 20}
    model = getattr(sbx, algorithm)("MlpPolicy", env, seed=0, **short)
    model.learn(80)
    assert env.action_space.contains(model.predict(env.reset(seed=0)[0])[0])
