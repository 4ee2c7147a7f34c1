"""A model of one's own in the place of a blade: environments, every controller, agents, pictures."""

import json
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env
from scipy.linalg import block_diag

import beamenv
from baselines import evaluate, lqg, no_control, roll_out
from beamenv import PlacementWrapper, Plant
from beamenv.plant.model_files import plant_from_table, plant_table
from beamenv.task import resolve_task
from train.controllers.named import discover, named
from train.learning.job import Job, run
from train.learning.recipe import named_recipe
from train.learning.session import Budget


def oscillator(omega, damping):
    return np.array([[0.0, omega], [-omega, -2.0 * damping * omega]])


A = block_diag(oscillator(30.0, 0.01), oscillator(95.0, 0.02))
B = np.array([[0.0, 0.0], [1.0, 0.3], [0.0, 0.0], [0.7, -0.9]])
C = np.array([[0.0, 1.0, 0.0, 0.9], [0.0, 0.3, 0.0, -0.8]])
ROTOR = {"rotor-lqg", "scheduled-lqg"}
"""Controllers that are told the speed of a rotor."""


@pytest.fixture(name="plant", scope="module")
def _plant():
    return Plant.from_state_space(A, B, C, interval=0.01, sensor_units=["m/s", "m/s"])


@pytest.fixture(name="uncommon", scope="module")
def _uncommon():
    """An odd number of states in coordinates of its own, three sensors that feel its one voltage, three disturbances."""
    generator = np.random.default_rng(0)
    basis, own = generator.normal(size=(5, 5)), block_diag(A, [[-60.0]])
    return Plant.from_state_space(
        basis @ own @ np.linalg.inv(basis),
        basis @ [0.0, 1.0, 0.0, 0.7, 1.0],
        generator.normal(size=(3, 5)) @ np.linalg.inv(basis),
        0.005 * np.ones((3, 1)),
        interval=0.01,
        disturbance_input=basis @ generator.normal(size=(5, 3)),
        disturbance_units=["N", "N", "N m"],
        tip_displacement=generator.normal(size=5),
    )


@pytest.fixture(name="file")
def _file(tmp_path):
    path = tmp_path / "mine.npz"
    np.savez(path, A=A, B=B, C=C, interval=0.01, sensor_units=["m/s", "m/s"])
    return path


def first_steps(env, count=5):
    observation, _ = env.reset(seed=3)
    shape = env.action_space.shape
    return np.stack([observation, *(env.step(np.full(shape, 0.1 * k))[0] for k in range(count))])


def test_a_plant_its_file_its_table_and_its_spec_are_one_environment(plant, file):
    made = gym.make(beamenv.ENV_ID, plant=plant)
    wanted = first_steps(made)
    again = gym.make(EnvSpec.from_json(made.spec.to_json()))
    of_path = gym.make(EnvSpec.from_json(gym.make(beamenv.ENV_ID, plant=str(file)).spec.to_json()))
    of_table = gym.make(beamenv.ENV_ID, plant={"A": A, "B": B, "C": C, "interval": 0.01})
    for each in (again, of_path, of_table):
        np.testing.assert_array_equal(first_steps(each), wanted)


@pytest.mark.parametrize("which", ["plant", "uncommon"])
def test_gymnasiums_checker_has_nothing_to_say(which, request):
    check_env(gym.make(beamenv.ENV_ID, plant=request.getfixturevalue(which)).unwrapped, skip_render_check=True)


@pytest.mark.parametrize("which", ["plant", "uncommon"])
def test_a_table_of_a_plant_is_the_plant(which, request):
    plant = request.getfixturevalue(which)
    back = plant_from_table(json.loads(json.dumps(plant_table(plant))))
    for name in Plant.__dataclass_fields__:
        np.testing.assert_array_equal(getattr(back, name), getattr(plant, name))


@pytest.mark.parametrize("which", ["plant", "uncommon"])
@pytest.mark.parametrize("scenario", ["nominal", "failure"])
def test_a_blade_of_a_batch_meets_what_it_meets_alone(which, scenario, request):
    arguments = {"plant": request.getfixturevalue(which), "scenario": scenario, "dtype": "float64"}
    envs, env = gym.make_vec(beamenv.ENV_ID, num_envs=3, **arguments), gym.make(beamenv.ENV_ID, **arguments)
    observations, info = envs.reset(seed=[5, 6, 7])
    observation, alone = env.reset(seed=6)
    np.testing.assert_array_equal(observations[1], observation)
    assert info["assumed"][1] == alone["assumed"] == arguments["plant"].assumed
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (20, *envs.action_space.shape))
    for each in actions:
        seen, rewards, *_, info = envs.step(each)
        observation, reward, *_, alone = env.step(each[1])
        np.testing.assert_allclose(seen[1], observation, rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(rewards[1], reward, rtol=1e-12)
        np.testing.assert_allclose(info["tip_displacement"][1], alone["tip_displacement"], rtol=1e-12, atol=1e-15)


def test_episodes_are_as_long_as_the_model_is_slow(plant):
    assert resolve_task(plant=plant).steps == round(0.5 * plant.time_scale / 0.01)
    assert resolve_task(plant=plant, duration=1.0).steps == 100
    assert resolve_task().steps == 1000


@pytest.fixture(name="reference", scope="module")
def _reference(uncommon):
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=4, plant=uncommon, scenario="white", dtype="float64")
    return envs, roll_out(no_control(uncommon), envs, range(4))


@pytest.mark.parametrize("name", [name for name in discover() if name not in ("informed-lqg", "informed-mpc", "robust-lqg")])
def test_every_controller_that_needs_no_rotor_damps_it(name, reference):
    envs, without = reference
    if name in ROTOR:
        with pytest.raises(ValueError, match=f"^plant is a model of one's own, but {name} asks for a blade"):
            named(name).build_for(envs.unwrapped.task)
        return
    found = evaluate(named(name).build_for(envs.unwrapped.task), envs, range(4), reference=without)
    assert found.relative_cost.value < 0.9 or name == "none"


@pytest.mark.parametrize("name", ["informed-lqg", "informed-mpc", "robust-lqg"])
def test_controllers_that_search_find_a_law_for_it(name, reference):
    envs, without = reference
    found = evaluate(named(name).build_for(envs.unwrapped.task), envs, range(4), reference=without)
    assert found.relative_cost.value < 0.6


def test_collocated_laws_damp_a_model_of_pairs(plant):
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=4, plant=plant, dtype="float64")
    for name in ("velocity", "positive-position-feedback"):
        assert evaluate(named(name).build_for(envs.unwrapped.task), envs, range(4)).relative_cost.value < 0.6


def test_what_is_not_told_of_the_tip_is_no_number(plant):
    envs = gym.make_vec(beamenv.ENV_ID, num_envs=2, plant=plant, dtype="float64")
    found = evaluate(lqg(plant), envs, range(2))
    told = found.row()
    assert told["relative_cost"] < 0.5 and told["peak_tip"] is None and told["settling_time"] is None
    assert envs.reset(seed=0)[1]["tip_displacement"].shape == (2, 0)


def test_plants_within_a_spread_are_others_for_training_and_for_judging(plant):
    spread = {"frequency": 0.05, "damping": 0.3, "actuator": 0.1, "sensor": 0.1}
    task = resolve_task(plant=plant, spread=spread, scenario={"plants": {"bank": 16}})
    assert len(task.bank) == len(task.prior.bank) == 16
    lowest = [np.sort([each.natural_frequencies[0] for each in task.blade.varied(16, seed)]) for seed in (0, 1)]
    assert not np.isin(lowest[0], lowest[1]).any()
    for each in lowest:
        assert 0.95 * 30.0 <= each.min() < 0.96 * 30.0 and 1.04 * 30.0 < each.max() <= 1.05 * 30.0
    drawn = task.blade.varied(16, 0)
    damping = [-np.linalg.eigvals(each.A).real.max() / each.natural_frequencies[0] for each in drawn]
    assert 0.007 <= min(damping) < 0.0074 and 0.0126 < max(damping) <= 0.013
    gains = np.array([each.B[1, 0] for each in drawn])
    assert gains.min() >= 0.9 and gains.max() <= 1.1


def test_one_of_the_plants_of_a_list_moves_in_each_episode(plant):
    softer = Plant.from_state_space(0.9 * A, B, C, interval=0.01, sensor_units=["m/s", "m/s"])
    task = resolve_task(plant=[plant, softer])
    assert len(task.bank) == 2 and task.design_plant is task.plant
    with pytest.raises(ValueError, match=r"^plant\[1\] has sensors 1, but must have 2, as what moves has\.$"):
        resolve_task(plant=[plant, Plant.from_state_space(A, B, C[:1], interval=0.01)])


def test_a_folder_of_an_identification_is_its_plant_and_those_within_its_spread(tmp_path):
    (tmp_path / "ensemble").mkdir()
    for name, factor in (("plant", 1.0), ("ensemble/000", 0.97), ("ensemble/001", 1.03)):
        np.savez(tmp_path / f"{name}.npz", A=factor * A, B=factor * B, C=C, interval=0.01)
    task = resolve_task(plant=tmp_path)
    assert len(task.bank) == 3
    np.testing.assert_array_equal(task.design_plant.A, A)
    first, *others = task.blade.others
    for each in others:  # what is asked of them is the same: the same outputs cost the same
        np.testing.assert_allclose(each.state_weight, first.state_weight, rtol=1e-12)
        np.testing.assert_array_equal(each.sensor_full_scale, first.sensor_full_scale)
    with pytest.raises(ValueError, match=r"^file '.*plant.npz' cannot be read: No such file"):
        resolve_task(plant=tmp_path / "ensemble")


def test_controllers_are_designed_for_another_model_where_one_is_given(plant):
    stiffer = Plant.from_state_space(1.05 * A, B, C, interval=0.01)
    task = resolve_task(plant=plant, design=stiffer)
    np.testing.assert_array_equal(task.design_plant.A, 1.05 * A)
    np.testing.assert_array_equal(task.design_plant.sensor_full_scale, plant.sensor_full_scale)
    env = gym.make(beamenv.ENV_ID, plant=plant, design=stiffer)
    env.reset(seed=0)
    with pytest.raises(ValueError, match="^the true blade's state cannot be told in the design's coordinates"):
        env.unwrapped.design_state  # noqa: B018


def test_the_drive_of_a_scenario_is_a_share_of_the_models_own(plant):
    task = resolve_task(plant=plant, scenario="hysteresis")
    np.testing.assert_allclose(task.plant.voltage_limits, [[-10.0 / 3.0] * 2, [10.0] * 2])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"plant": "nobody.npz"}, r"^file 'nobody.npz' cannot be read: No such file"),
        ({"plant": 3}, r"^plant is 3, but must be a Plant, the path of a"),
        ({"plant": []}, r"^plant is \[\], but must be one model, or a list of them\.$"),
        ({"plant": "PLANT", "speed": 3.0}, r"^speed is 3.0, but must be left out with a plant of one's own"),
        ({"plant": "PLANT", "preset": "sound-blade"}, r"^preset is 'sound-blade', but must be left out with a plant"),
        (
            {"plant": "PLANT", "scenario": "off-speed"},
            r"^scenario.plants.speed_ratio is \(0.7, 1.3\), but must be \(1.0, 1.0\) with",
        ),
        ({"plant": "PLANT", "scenario": "rotor"}, r"^scenario.rotor.harmonics is .*, but must be none with a plant of one's own"),
        ({"plant": "PLANT", "spread": {"width": 0.1}}, r"^spread has no field 'width': its fields are frequency, damping"),
        ({"plant": "PLANT", "spread": {"frequency": 1.5}}, r"^spread.frequency is 1.5, but must be"),
        ({"spread": {"frequency": 0.1}}, r"^spread is .*, but must be None without a plant"),
        (
            {"plant": "bench"},
            r"^plant is 'bench', but must be the folder of an identification or a file .*, and there is none of this name",
        ),
        ({"plant": "PLANT", "design": "thesis"}, r"^design is 'thesis', but must be a file that ends in .npz"),
        ({"plant": {"A": 1.0}}, r"^B is missing\.$"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(arguments, words, plant):
    given = {name: plant if value == "PLANT" else value for name, value in arguments.items()}
    with pytest.raises(ValueError, match=words):
        gym.make(beamenv.ENV_ID, **given)


def test_what_needs_a_shape_says_so(plant):
    env = gym.make(beamenv.ENV_ID, plant=plant)
    with pytest.raises(ValueError, match="but must be one with a blade, on which patches can be placed"):
        PlacementWrapper(env, actuators="uniform")
    with pytest.raises(ValueError, match="^plant is a model without a shape, but a beam is asked for"):
        env.unwrapped.task.blade.beam  # noqa: B018


def test_its_pictures_are_time_histories(plant, uncommon):
    pytest.importorskip("pygame")
    for each in (plant, uncommon):
        env = gym.make(beamenv.ENV_ID, plant=each, render_mode="rgb_array")
        env.reset(seed=0)
        before = env.render()
        for _ in range(30):
            env.step(np.ones(env.action_space.shape))
        after = env.render()
        assert after.shape == (540, 960, 3) and (before != after).any()
        env.reset(seed=0)
        assert (env.render() == before).all()  # at the usual scale again


@pytest.mark.parametrize("agent", ["gradient", "ppo"])
def test_agents_train_on_it_and_are_its_own(agent, uncommon, tmp_path):
    job = Job(agent, named_recipe(agent), "nominal", 0, Budget(updates=1), {"plant": plant_table(uncommon), "duration": 0.5})
    places = run(job, tmp_path / agent, lambda progress: None)
    about = json.loads((places[0] / "agent.json").read_text())
    other = replace(uncommon, B=1.1 * uncommon.B)
    assert list(about["plants"].values()) == [beamenv.plant.fingerprint(uncommon)] != [beamenv.plant.fingerprint(other)]


def test_a_training_through_the_plant_meets_the_plants_of_a_spread(plant, tmp_path):
    environment = {"plant": plant_table(plant), "spread": {"frequency": 0.05, "actuator": 0.2}, "duration": 0.5}
    job = Job("gradient", named_recipe("gradient"), {"plants": {"bank": 8}}, 0, Budget(updates=1), environment)
    (task,) = job.tasks().values()
    assert len(task.prior.bank) == 8
    places = run(job, tmp_path / "agent", lambda progress: None)
    assert all((place / "weights.npz").is_file() for place in places)


def test_an_interval_longer_than_an_episode_is_told_by_its_own_name():
    given = {"A": 100.0 * A, "B": B, "C": C, "interval": 1.0}
    with pytest.raises(ValueError, match=r"^plant.control_interval is 1.0, but must be shorter than 0.05984 s, so that the usual"):
        resolve_task(plant=given)
    assert resolve_task(plant=given, duration=3.0).steps == 3
    with pytest.raises(ValueError, match=r"^duration is 0.2, but must be a number above 0.5 .*for plant.control_interval is 1"):
        resolve_task(plant=given, duration=0.2)
    with pytest.raises(ValueError, match=r"^blade.control_interval is 1.0, but must be shorter than 1 s, so that the usual"):
        resolve_task(blade={"control_interval": 1.0})
