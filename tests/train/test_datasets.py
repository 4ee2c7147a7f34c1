"""A controller's episodes as a Minari data set: what is in it is what happened, and it comes to be whole or not at all."""

import json
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import lqg
from beamenv.knowledge import on_recording_bank, on_training_bank, on_validation_bank
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.task import resolve_task
from train.controllers.choice import chosen

minari = pytest.importorskip("minari")

from train.datasets import record  # noqa: E402 - of what may be missing
from train.datasets.recording import Stage  # noqa: E402
from train.datasets.taped import episodes_of  # noqa: E402

SHORT = {"duration": 0.02}
MODEL = {"A": [[0.0, 1.0], [-400.0, -0.4]], "B": [[0.0], [0.01]], "C": [[0.0, 1.0]], "interval": 0.005}


def arrays(data):
    """Every array of a data set by its name, episode by episode."""
    kept = ("observations", "actions", "rewards", "terminations", "truncations")
    return [{**{name: getattr(each, name) for name in kept}, **each.infos} for each in data.iterate_episodes()]


def assert_equal(one, other):
    assert len(one) == len(other) > 0
    for mine, its in zip(one, other, strict=True):
        assert mine.keys() == its.keys()
        for name, values in mine.items():
            np.testing.assert_array_equal(values, its[name], err_msg=name)


def test_the_recovered_environment_replays_the_episodes(tmp_path):
    data = record("lqg", "delay", 3, folder=tmp_path, environment=SHORT)
    env = data.recover_environment()
    for about, episode in zip(data.storage.get_episode_metadata(range(3)), data.iterate_episodes(), strict=True):
        np.testing.assert_array_equal(env.reset(seed=about["seed"])[0], episode.observations[0])
        for k, action in enumerate(episode.actions):
            observation, reward, terminated, truncated, info = env.step(action)
            np.testing.assert_array_equal(observation, episode.observations[k + 1])
            assert reward == pytest.approx(episode.rewards[k], rel=1e-9)
            assert (terminated, truncated) == (episode.terminations[k], episode.truncations[k])
            np.testing.assert_allclose(info["volts"], episode.infos["volts"][k + 1])
            np.testing.assert_allclose(info["tip_displacement"], episode.infos["tip_displacement"][k + 1], atol=1e-15)
        assert truncated and len(episode) == 40


def test_actions_are_those_of_the_controller_on_the_readings(tmp_path):
    data = record("lqg-load", "nominal", 2, folder=tmp_path, environment=SHORT)
    law = chosen("lqg-load", resolve_task(**SHORT, scenario="nominal"), "nominal")
    for episode in data.iterate_episodes():
        memory = None
        for reading, acted in zip(episode.observations[:-1], episode.actions, strict=True):
            action, memory = law.predict(reading[None], state=memory)
            np.testing.assert_allclose(np.clip(action[0], -1.0, 1.0), acted, atol=2e-6)


def test_the_same_command_gives_the_same_arrays_and_more_episodes_begin_with_them(tmp_path):
    first, again = (arrays(record("residual", "nominal", 3, folder=tmp_path / name, environment=SHORT)) for name in "ab")
    assert_equal(first, again)
    assert_equal(first[:2], arrays(record("residual", "nominal", 2, folder=tmp_path / "c", environment=SHORT)))
    longer = arrays(record("residual", "nominal", 66, folder=tmp_path / "d", environment=SHORT))  # more than are run side by side
    assert len(longer) == 66
    assert_equal(first, longer[:3])
    assert len({each["observations"].tobytes() for each in longer}) == 66


@pytest.mark.parametrize(
    ("controller", "tier", "name", "width"),
    [("scheduled-lqg", 2, "rotor_speed", 1), ("lqr", 3, "design_state", 22), ("clairvoyant", 3, "episode_truth", 14)],
)
def test_what_a_controller_is_shown_besides_is_kept(tmp_path, controller, tier, name, width):
    data = record(controller, "nominal", 2, folder=tmp_path, environment=SHORT)
    for each in arrays(data):
        assert each[name].shape == (41, width)
    about = data.storage.metadata
    assert about["beamenv"]["tier"] == tier
    assert f"infos['{name}']" in about["description"]


def test_rotor_speed_is_that_of_the_instant(tmp_path):
    data = record("scheduled-lqg", {"preset": "off-speed", "plants": {"bank": 3}}, 2, folder=tmp_path, environment=SHORT)
    env = data.recover_environment()
    for about, each in zip(data.storage.get_episode_metadata(range(2)), arrays(data), strict=True):
        env.reset(seed=about["seed"])
        np.testing.assert_array_equal(each["rotor_speed"], env.unwrapped.rotor_speed)


def test_a_data_set_tells_who_acted_and_how_well(tmp_path):
    data = record("residual", "nominal", 4, 17, folder=tmp_path, environment=SHORT, trained_seed=1)
    about = data.storage.metadata
    own = about["beamenv"]
    costs = [each["cost_increment"].sum() for each in arrays(data)]
    assert own["cost"] == pytest.approx(
        {"unit": "J s", "mean": np.mean(costs), "standard_deviation": np.std(costs), "failed_episodes": 0}
    )
    assert (own["controller"], own["trained_seed"], own["tier"], own["scenario"]) == (
        "residual-generalist",
        1,
        1,
        "nominal",
    )
    assert own["seeds"] == [17, 20] == [each["seed"] for each in data.storage.get_episode_metadata([0, 3])]
    assert own["versions"]["beamenv"] == beamenv.__version__ and len(own["code"]) == 16
    assert about["algorithm_name"] == "residual-generalist"
    assert about["dataset_id"] == "beamenv/residual-generalist-nominal-v0"
    assert f"None of the episodes ended by failure; the mean cost J is {np.mean(costs):.4g} J s" in about["description"]


@pytest.mark.parametrize(
    ("scenario", "judges"),
    [
        ("delay", False),
        ("long-delay", True),
        (beamenv.SCENARIOS["delay-failure"], True),
        ({"preset": "solid", "white_load": False}, False),  # one's own
    ],
)
def test_a_data_set_of_what_is_kept_for_judging_says_so(scenario, judges, tmp_path):
    told = record("none", scenario, 1, folder=tmp_path, environment=SHORT).storage.metadata
    assert told["beamenv"]["kept_for_judging"] is judges
    assert told["description"].endswith("kept for judging: it cannot judge what learns from these.") is judges


def test_returns_are_costs_by_the_environments_scale(tmp_path):
    (each,) = arrays(record("none", "step", 1, folder=tmp_path, environment=SHORT))
    ratio = -each["cost_increment"][1:] / each["rewards"]
    np.testing.assert_allclose(ratio, ratio[0], rtol=1e-9)
    assert each["cost_increment"][0] == 0.0


def test_an_episode_that_fails_ends_there_and_its_cost_is_not_in_the_mean(tmp_path):
    loads = {"preset": "step", "magnitude": [100.0, 20000.0], "onset": [0.0, 0.01]}
    data = record("none", loads, 8, folder=tmp_path, environment=SHORT)
    failed = [each for each in arrays(data) if each["terminations"][-1]]
    whole = [each for each in arrays(data) if not each["terminations"][-1]]
    assert failed and whole
    assert all(len(each["rewards"]) < 40 and not each["terminations"][:-1].any() for each in failed)
    assert all(len(each["observations"]) == len(each["rewards"]) + 1 for each in failed)
    told = data.storage.metadata["beamenv"]["cost"]
    assert told["failed_episodes"] == len(failed)
    assert told["mean"] == pytest.approx(np.mean([each["cost_increment"].sum() for each in whole]))


def test_plants_are_those_of_a_bank_that_nobody_else_has():
    off_model = SCENARIOS["off-model"]
    banks = [off_model, on_training_bank(off_model), on_validation_bank(off_model), on_recording_bank(off_model)]
    assert len({each.plants.seed for each in banks}) == 4
    assert {replace(each, plants=off_model.plants) for each in banks} == {off_model}


def test_laws_are_told_no_plant_that_moves():
    stage = Stage.of(lambda readings: 0.0 * readings, {"preset": "off-model", "plants": {"bank": 2}}, SHORT, None)
    moving = {each.tobytes() for each in stage.task.bank.operators.fused}
    told = {each.tobytes() for each in stage.task.prior.bank.operators.fused}
    assert len(moving) == len(told) == 2 and not moving & told


def test_the_environment_to_evaluate_in_has_the_plants_that_controllers_are_compared_on(tmp_path):
    data = record("none", {"preset": "off-model", "plants": {"bank": 2}}, 1, folder=tmp_path, environment=SHORT)
    judged, own = data.recover_environment(eval_env=True), data.recover_environment()
    assert judged.unwrapped.task.scenario.plants.seed == SCENARIOS["off-model"].plants.seed
    assert own.unwrapped.task.scenario == on_recording_bank(judged.unwrapped.task.scenario)


def test_a_model_of_ones_own_comes_back_without_its_file(tmp_path):
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(MODEL))
    data = record("lqg", "nominal", 2, folder=tmp_path / "sets", environment={"plant": str(path), "duration": 0.1})
    path.unlink()
    env = data.recover_environment()
    assert env.observation_space.shape == (1,)
    (first, _) = data.iterate_episodes()
    np.testing.assert_array_equal(env.reset(seed=4_000_000)[0], first.observations[0])
    assert "tip_displacement" not in first.infos  # it tells none


def test_controllers_may_be_objects_and_functions(tmp_path):
    plant = resolve_task(**SHORT).design.full_plant
    of_law = record(lqg(plant), "nominal", 1, folder=tmp_path, name="law-v0", environment=SHORT)
    of_function = record(lambda readings: -0.5 * readings, "nominal", 1, folder=tmp_path, name="own-v0", environment=SHORT)
    assert of_law.storage.metadata["beamenv"]["tier"] == 1  # nobody knows what it was made from
    (each,) = arrays(of_function)
    np.testing.assert_allclose(each["actions"], -0.5 * each["observations"][:-1], atol=1e-7)


def test_other_units_and_numbers_are_those_asked_for(tmp_path):
    asked = {**SHORT, "physical_units": True, "dtype": "float64"}
    (each,) = arrays(record("lqg", "nominal", 1, folder=tmp_path, environment=asked))
    (usual,) = arrays(record("lqg", "nominal", 1, folder=tmp_path, name="usual-v0", environment=SHORT))
    assert each["observations"].dtype == each["actions"].dtype == np.float64
    np.testing.assert_allclose(each["actions"], 1500.0 * usual["actions"], atol=0.01)


def test_actions_are_kept_within_their_space(tmp_path):
    (each,) = arrays(record(lambda readings: 1e3 * readings, "nominal", 1, folder=tmp_path, environment=SHORT))
    assert np.abs(each["actions"]).max() == 1.0
    np.testing.assert_allclose(each["volts"][1:], 1500.0 * each["actions"])


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        (
            {"seed": 1_000_000},
            "but must be at most 999998 for 2 episodes, or at least 4000000: on the seeds between, 1000000 to 3999999",
        ),
        ({"seed": 999_999}, "seed is 999999, but must be at most 999998"),
        ({"seed": 3_999_999}, "seed is 3999999"),
        ({"seed": -1}, "seed is -1"),
        ({"episodes": 0}, "episodes is 0"),
        ({"controller": "lqgg"}, "did you mean lqg"),
        ({"scenario": "gale"}, "scenario is 'gale'"),
        ({"name": "../mine-v0"}, "name is '../mine-v0', but must be as beamenv/lqg-nominal-v0"),
        ({"name": "mine"}, "name is 'mine'"),
        ({"environment": {"preset": "none"}}, "preset"),
        ({"environment": {"colour": 1}}, "environment has no field 'colour': its fields are preset, speed"),
        ({"environment": {**SHORT, "dtype": "float16"}}, "dtype"),
        ({"trained_seed": 1}, "trained_seed is 1, but must be left out"),
    ],
)
def test_what_is_wrong_is_said_and_nothing_is_written(tmp_path, wrong, said):
    given = {"controller": "lqg", "scenario": "nominal", "episodes": 2, "environment": SHORT, "folder": tmp_path / "sets", **wrong}
    with pytest.raises(ValueError, match=".*") as refused:
        record(**given)
    assert said in str(refused.value) and "\n" not in str(refused.value)
    assert not list(tmp_path.iterdir())


def test_the_seeds_beside_those_that_are_kept_are_taken(tmp_path):
    for seed in (999_998, 4_000_000):
        data = record("none", "nominal", 2, seed, folder=tmp_path, name=f"at-{seed}-v0", environment=SHORT)
        assert data.storage.metadata["beamenv"]["seeds"] == [seed, seed + 1]


def test_a_data_set_is_replaced_only_where_that_is_asked_for(tmp_path):
    record("none", "nominal", 1, folder=tmp_path, name="mine-v0", environment=SHORT)
    with pytest.raises(ValueError, match="^name = 'mine-v0' is a data set already, in .*: overwrite it, or give another name.$"):
        record("lqg", "nominal", 1, folder=tmp_path, name="mine-v0", environment=SHORT)
    data = record("lqg", "nominal", 2, folder=tmp_path, name="mine-v0", environment=SHORT, overwrite=True)
    assert data.total_episodes == 2
    assert [each.name for each in tmp_path.iterdir()] == ["mine-v0"]


def test_a_folder_that_is_no_data_set_is_never_replaced(tmp_path):
    (tmp_path / "mine-v0").mkdir()
    (tmp_path / "mine-v0" / "thesis.txt").write_text("years of work")
    with pytest.raises(ValueError, match="is there, and is no data set"):
        record("none", "nominal", 1, folder=tmp_path, name="mine-v0", environment=SHORT, overwrite=True)
    record("none", "nominal", 1, folder=tmp_path, name="whole-v0", environment=SHORT)
    with pytest.raises(ValueError, match="outside the data set 'whole-v0'"):
        record("none", "nominal", 1, folder=tmp_path, name="whole-v0/part-v0", environment=SHORT)


def test_an_interrupted_recording_leaves_what_was_there(tmp_path):
    def interrupt(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        record("none", "nominal", 1, folder=tmp_path / "sets", environment=SHORT, progress=interrupt)
    assert not list(tmp_path.iterdir())
    before = arrays(record("none", "nominal", 1, folder=tmp_path, name="mine-v0", environment=SHORT))
    with pytest.raises(KeyboardInterrupt):
        record("lqg", "nominal", 1, folder=tmp_path, name="mine-v0", environment=SHORT, overwrite=True, progress=interrupt)
    assert [each.name for each in tmp_path.iterdir()] == ["mine-v0"]
    assert_equal(before, arrays(minari.MinariDataset(tmp_path / "mine-v0" / "data")))


def test_what_a_killed_recording_has_left_goes_with_the_next(tmp_path):
    left = tmp_path / ".mine-v0.0123abcd.part"
    (left / "data").mkdir(parents=True)
    record("none", "nominal", 1, folder=tmp_path, name="mine-v0", environment=SHORT)
    assert [each.name for each in tmp_path.iterdir()] == ["mine-v0"]


def test_progress_is_told_in_episodes(tmp_path):
    told = []
    record("none", "nominal", 65, folder=tmp_path, environment=SHORT, progress=lambda *each: told.append(each))
    assert told == [(64, 65), (65, 65)]


def test_rows_of_a_batch_are_its_seeds():
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT)
    law = chosen("none", envs.unwrapped.task, "nominal")
    one, other = episodes_of(law, envs, [5, 6])
    again = episodes_of(law, envs, [6, 5])
    np.testing.assert_array_equal(one.observations, again[1].observations)
    assert (one.seed, other.seed) == (5, 6) and not np.array_equal(one.observations, other.observations)


def test_a_relative_folder_will_do_and_minari_finds_what_is_where_it_looks(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    data = record("none", "nominal", 1, folder="sets", environment=SHORT)
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path / "sets"))
    assert_equal(arrays(data), arrays(minari.load_dataset("beamenv/none-nominal-v0")))
    record("none", "white", 1, environment=SHORT)
    assert list(minari.list_local_datasets()) == ["beamenv/none-nominal-v0", "beamenv/none-white-v0"]
