"""Stable-Baselines3 vectorises the blade in every way it has."""

import gymnasium
import numpy as np
import pytest

import beamenv
from tests.clients.lines import assert_lines_run

stable_baselines3 = pytest.importorskip("stable_baselines3")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


@pytest.mark.parametrize("kind", ["DummyVecEnv", "SubprocVecEnv"])
def test_its_vectorisations_step_and_learn(kind):
    from stable_baselines3.common import vec_env
    from stable_baselines3.common.env_util import make_vec_env

    short, cls = {"duration": 0.01}, getattr(vec_env, kind)
    envs = make_vec_env("beamenv:beamenv/RotatingBeam-v0", 2, seed=0, env_kwargs=short, vec_env_cls=cls)
    stable_baselines3.PPO("MlpPolicy", vec_env.VecFrameStack(envs, 4), n_steps=64, batch_size=64).learn(128)
    envs.close()


def test_the_native_batch_learns_with_callbacks_and_monitors():
    from stable_baselines3.common.callbacks import EvalCallback
    from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

    envs, judged = (VecNormalize(VecMonitor(beamenv.BladeVecEnv(4, seed=seed, duration=0.01))) for seed in range(2))
    callback = EvalCallback(judged, n_eval_episodes=4, eval_freq=32, verbose=0)
    stable_baselines3.SAC("MlpPolicy", envs, learning_starts=10).learn(200, callback=callback)
    assert np.isfinite(callback.best_mean_reward)


def test_a_model_goes_through_a_file_and_evaluates_like_a_law(tmp_path):
    from stable_baselines3.common.evaluation import evaluate_policy

    env = gymnasium.make(beamenv.ENV_ID, duration=0.01)
    model = stable_baselines3.TD3("MlpPolicy", env, learning_starts=10)
    model.learn(30)
    model.save(tmp_path / "model")
    loaded = stable_baselines3.TD3.load(tmp_path / "model")
    reward, _ = evaluate_policy(loaded, env, n_eval_episodes=2, warn=False)
    assert np.isfinite(reward)


def test_the_lines_of_the_page_run(tmp_path):
    assert_lines_run("Stable-Baselines3", tmp_path)
