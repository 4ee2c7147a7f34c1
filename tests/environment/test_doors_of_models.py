"""A model with two voltages, three sensors that feel them and no energy, sampled and in continuous time: laws, wrappers, agents."""

import json

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.wrappers import FrameStackObservation, RescaleAction, TimeLimit
from scipy.linalg import block_diag, expm
from stable_baselines3 import PPO
from stable_baselines3.common.env_checker import check_env

import beamenv
from baselines import evaluate, lqg, no_control, roll_out, stationary_cost
from beamenv import Plant
from train.controllers.named import discover, named

REFUSED = {
    "rotor-lqg": "plant is a model of one's own, but rotor-lqg asks for a blade",
    "scheduled-lqg": "plant is a model of one's own, but scheduled-lqg asks for a blade",
    "velocity": "plant has 2 actuators and 3 sensors, which velocity feedback cannot pair",
    "positive-position-feedback": "plant has 2 actuators and 3 sensors, which positive position feedback cannot pair",
}


def oscillator(omega, damping):
    return np.array([[0.0, omega], [-omega, -2.0 * damping * omega]])


def matrices():
    """In coordinates of no meaning; an accelerometer, a velocity and a displacement, with D of each."""
    basis = np.random.default_rng(1).normal(size=(5, 5))
    own = block_diag(oscillator(30.0, 0.01), oscillator(95.0, 0.02), [[-60.0]])
    inputs = np.array([[0.0, 0.0], [1.0, 0.3], [0.0, 0.0], [0.7, -0.9], [1.0, 0.2]])
    rate, place = np.array([[0.0, 1.0, 0.0, 0.9, 0.1]]), np.array([[1.0, 0.0, 0.4, 0.0, 0.0]])
    outputs = np.vstack([rate @ own / 95.0, rate, place])
    through = np.vstack([rate @ inputs / 95.0, [[0.0, 0.004]], [[0.002, 0.0]]])
    return basis @ own @ np.linalg.inv(basis), basis @ inputs, outputs @ np.linalg.inv(basis), through


def model(kind):
    A, B, C, D = matrices()
    if kind == "continuous":
        return {"A": A, "B": B, "C": C, "D": D, "interval": 0.01}
    held = expm(0.01 * np.block([[A, B], [np.zeros((2, 7))]]))
    return {"A": held[:5, :5], "B": held[:5, 5:], "C": C, "D": D, "dt": 0.01}


@pytest.fixture(name="world", scope="module", params=["continuous", "sampled"])
def _world(request):
    plant = Plant.from_state_space(**model(request.param))
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=4, plant=plant, scenario="white", dtype="float64")
    return envs, roll_out(no_control(plant), envs, range(4))


@pytest.mark.parametrize("name", list(discover()))
def test_every_law_damps_it_or_says_in_a_sentence_why_there_is_none(name, world):
    envs, without = world
    task = envs.unwrapped.task
    if name in REFUSED:
        for door in (named(name).build_for, named(name).check_for):
            with pytest.raises(ValueError, match=f"^{REFUSED[name]}"):
                door(task)
        return
    named(name).check_for(task)
    found = evaluate(named(name).build_for(task), envs, range(4), reference=without)
    assert found.relative_cost.value < 0.6 or name == "none"


def test_the_sampled_model_and_the_one_in_continuous_time_are_one():
    one, other = (Plant.from_state_space(**model(kind)) for kind in ("continuous", "sampled"))
    costs = [stationary_cost(each, lqg(each)) for each in (one, other)]
    assert costs[0] == pytest.approx(costs[1], rel=1e-6)


def test_wrappers_take_it():
    env = gym.make(beamenv.ENV_ID, plant=model("continuous"), duration=0.1)
    history = beamenv.SensorHistory(env, length=4)
    assert history.reset(seed=0)[0].shape == history.observation_space.shape
    stacked = TimeLimit(RescaleAction(FrameStackObservation(env, 3), np.float32(-0.5), np.float32(0.5)), 5)
    observation, _ = stacked.reset(seed=0)
    assert observation.shape == (3, 3)
    for _ in range(5):
        *_, truncated, _ = stacked.step(np.zeros(2, dtype=np.float32))
    assert truncated
    batch = beamenv.VectorSensorHistory(gym.make_vec(beamenv.ENV_ID, num_envs=2, plant=model("sampled")), length=4)
    assert batch.reset(seed=0)[0].shape == batch.observation_space.shape


def test_stable_baselines_trains_on_it_alone_and_in_a_batch():
    env = gym.make(beamenv.ENV_ID, plant=model("continuous"), duration=0.1)
    check_env(env.unwrapped, skip_render_check=True)
    for each in (env, beamenv.BladeVecEnv(2, plant=model("sampled"), duration=0.1)):
        trained = PPO("MlpPolicy", each, n_steps=16, batch_size=16, seed=0, device="cpu").learn(32)
        action, _ = trained.predict(np.zeros((1, 3), dtype=np.float32), deterministic=True)
        assert action.shape == (1, 2) and np.abs(action).max() <= 1.0


def folder(path):
    (path / "ensemble").mkdir(parents=True)
    for name, factor in (("plant", 1.0), ("ensemble/000", 0.97), ("ensemble/001", 1.03)):
        np.savez(path / f"{name}.npz", **{**model("continuous"), "A": factor * model("continuous")["A"]})
    return path


@pytest.mark.parametrize("given", ["file", "folder", "list of files", "table", "list of tables"])
def test_a_specification_makes_the_same_environment_again(given, tmp_path):
    home = folder(tmp_path / "mine")
    plant = {
        "file": str(home / "plant.npz"),
        "folder": str(home),
        "list of files": [str(home / "plant.npz"), str(home / "ensemble" / "000.npz")],
        "table": model("sampled"),
        "list of tables": [model("continuous"), {**model("continuous"), "A": 0.98 * model("continuous")["A"]}],
    }[given]
    env = gym.make(beamenv.ENV_ID, plant=plant, dtype="float64")
    told = env.spec.to_json()
    json.loads(told)
    again = gym.make(EnvSpec.from_json(told))
    for seed in range(3):
        np.testing.assert_array_equal(env.reset(seed=seed)[0], again.reset(seed=seed)[0])
        actions = np.full(2, 0.3)
        np.testing.assert_array_equal([env.step(actions)[0] for _ in range(4)], [again.step(actions)[0] for _ in range(4)])


def test_plants_of_a_list_are_mixed_in_a_batch_and_each_blade_is_what_it_is_alone(tmp_path):
    arguments = {"plant": str(folder(tmp_path / "mine")), "dtype": "float64"}
    envs, env = gym.make_vec(beamenv.ENV_ID, num_envs=8, **arguments), gym.make(beamenv.ENV_ID, **arguments)
    envs.reset(seed=list(range(8)))
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (30, 8, 2))
    batch = np.array([envs.step(each)[0] for each in actions])
    for seed in range(8):
        env.reset(seed=seed)
        alone = np.array([env.step(each[seed])[0] for each in actions])
        np.testing.assert_allclose(batch[:, seed], alone, rtol=1e-9, atol=1e-12)
    with pytest.raises(ValueError, match="^spread is Spread.*, but must be left out where plants are given one by one"):
        gym.make_vec(beamenv.ENV_ID, num_envs=2, spread={"frequency": 0.1}, **arguments)
