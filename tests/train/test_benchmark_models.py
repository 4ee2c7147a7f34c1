"""Models of Stable-Baselines3 from files: trusted or not, with spaces that fit or not."""

import gymnasium
import numpy as np
import pytest
from stable_baselines3 import PPO, SAC

import beamenv
from baselines import evaluate
from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from train.benchmark import benchmark
from train.controllers.models import fitted, load_model
from train.shared.held_out import HELD_OUT

SHORT = {"duration": 0.02}
SMALL = {"scenarios": ["nominal"], "controllers": [], "seeds": 3, "environment": SHORT}


@pytest.fixture(scope="module")
def ppo():
    env = beamenv.SensorHistory(gymnasium.make(beamenv.ENV_ID, **SHORT), length=3)
    return PPO("MlpPolicy", env, n_steps=8, batch_size=8, seed=0, device="cpu")


@pytest.fixture(scope="module")
def path(ppo, tmp_path_factory):
    path = tmp_path_factory.mktemp("models") / "mine.zip"
    ppo.save(path)
    return path


def test_a_model_file_is_not_loaded_unless_it_is_trusted(path):
    with pytest.raises(ValueError, match="a model file can run any code when it is loaded.*--trust"):
        benchmark(models=[path], **SMALL)


def test_a_model_from_a_file_does_what_it_does_behind_the_wrapper_it_was_trained_with(ppo, path):
    row = benchmark(models=[path], trusted=True, **SMALL).row("nominal", "mine")
    envs = beamenv.VectorSensorHistory(gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, scenario="nominal", **SHORT), length=3)
    expected = evaluate(ppo, envs, range(HELD_OUT, HELD_OUT + 3))
    assert row.title == "PPO"
    assert row.estimates["rms_voltage"].value > 0.0
    for name, estimate in expected.estimates().items():
        assert row.estimates[name].value == pytest.approx(estimate.value, rel=1e-4), name


def test_the_algorithm_of_a_file_is_found(tmp_path):
    model = SAC("MlpPolicy", gymnasium.make(beamenv.ENV_ID, **SHORT), buffer_size=8, device="cpu")
    model.save(tmp_path / "soft.zip")
    loaded = load_model(tmp_path / "soft.zip")
    assert isinstance(loaded, SAC)
    plant = build_plant(blade_config())
    assert fitted(loaded, plant) is loaded
    readings = np.full((2, 4), 0.1)
    np.testing.assert_array_equal(loaded.predict(readings, deterministic=True)[0], model.predict(readings, deterministic=True)[0])


@pytest.mark.parametrize("content", [None, b"no archive"])
def test_a_file_that_holds_no_model_is_told_in_one_sentence(content, tmp_path):
    path = tmp_path / "mine.zip"
    if content is not None:
        path.write_bytes(content)
    table = benchmark(models=[path], trusted=True, **SMALL)
    assert "model 'mine.zip' must be a .zip file saved by Stable-Baselines3" in table.row("nominal", "mine").sentences[0]
    assert table.row("nominal", "lqg").measured


@pytest.mark.parametrize(
    ("env_id", "sentence"), [("Pendulum-v1", "acts in Box"), ("CartPole-v1", "acts in Discrete"), (beamenv.ENV_ID, "observes Box")]
)
def test_a_model_whose_spaces_do_not_fit_is_told_in_one_sentence(env_id, sentence):
    arguments = {"physical_units": True} if env_id == beamenv.ENV_ID else {}
    env = gymnasium.make(env_id, **arguments)
    if arguments:
        env = gymnasium.wrappers.RescaleAction(env, np.float32(-1.0), np.float32(1.0))
    model = PPO("MlpPolicy", env, n_steps=8, batch_size=8, device="cpu")
    row = benchmark({"mine": model}, **SMALL).row("nominal", "mine")
    assert row.sentences[0].startswith("PPO ")
    assert sentence in row.sentences[0]
    assert not row.measured
