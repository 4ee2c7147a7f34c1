"""What Gymnasium's wrappers and other people's libraries ask of the environments."""

import json
import subprocess
import sys
import warnings
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode, SyncVectorEnv

import beamenv
from beamenv import PlacementWrapper, SensorHistory, VectorPlacementWrapper, VectorSensorHistory

SHORT = {"duration": 0.01}  # 20 control intervals
IDS = [name for name in gymnasium.registry if name.startswith("beamenv/")]


# Specifications


@pytest.mark.parametrize(
    "arguments",
    [
        {"render_index": range(3)},
        {"render_index": np.array([0, 2]), "dtype": np.float64},
        {"speed": np.float64(150.0), "duration": np.array(0.02)},
        {"blade": {"patches": {"actuators": np.array([0.3, 0.9])}}, "autoreset_mode": AutoresetMode.DISABLED},
        {"scenario": Path(beamenv.__file__).parent / "scenarios" / "named" / "delay.toml"},
        {"scenario": {"magnitude": np.array([1.0, 2.0]), "plants": {"bank": np.int64(2)}}},
    ],
)
def test_whatever_arguments_are_of_the_spec_is_json(arguments):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, render_mode="rgb_array", **arguments)
    text = envs.spec.to_json()
    json.loads(text)
    again = gymnasium.make_vec(EnvSpec.from_json(text))
    assert again.unwrapped.task == envs.unwrapped.task
    assert again.spec.to_json() == text
    np.testing.assert_array_equal(again.reset(seed=3)[0], envs.reset(seed=3)[0])


def test_positions_of_patches_as_an_array_are_json():
    env = PlacementWrapper(gymnasium.make(beamenv.ENV_ID), actuators=np.array([0.3, 0.9]), sensors=(0.4, 1.0))
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert again.reset(seed=1)[1]["layout"] == env.reset(seed=1)[1]["layout"]


@pytest.mark.parametrize(("arguments", "steps"), [({}, 1000), ({"duration": 0.25}, 500), ({**SHORT, "max_episode_steps": 7}, 7)])
def test_the_spec_tells_how_long_an_episode_is(arguments, steps):
    env = gymnasium.make(beamenv.ENV_ID, **arguments)
    assert env.spec.max_episode_steps == steps
    assert gymnasium.make(EnvSpec.from_json(env.spec.to_json())).spec.max_episode_steps == steps
    assert gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **arguments).spec.max_episode_steps == steps
    longer = gymnasium.make(beamenv.ENV_ID, **{**SHORT, "max_episode_steps": 10**6}).unwrapped
    assert longer.spec.max_episode_steps == 20


def test_an_observation_of_time_ends_at_one():
    env = gymnasium.wrappers.TimeAwareObservation(gymnasium.make(beamenv.ENV_ID, **SHORT))
    env.reset(seed=0)
    truncated = False
    while not truncated:
        observation, _, _, truncated, _ = env.step(np.zeros(4))
    assert observation[-1] == 20


def test_a_fresh_process_knows_the_id_with_its_module_before_it(tmp_path):
    code = "import gymnasium; env = gymnasium.make('beamenv:beamenv/RotatingBeam-delay-v0'); print(env.reset(seed=0)[0].shape)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert run.stdout == "(4,)\n", run.stderr


# Numbers


@pytest.mark.parametrize("env_id", IDS)
def test_the_checker_of_stable_baselines_has_nothing_to_say(env_id):
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    name = env_id.removeprefix("beamenv/RotatingBeam-").removesuffix("-v0")
    few = {"scenario": {"preset": name, "plants": {"bank": 2}}} if name in ("off-speed", "off-model") else {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        checker.check_env(gymnasium.make(env_id, **SHORT, **few).unwrapped)


def test_spaces_have_32_bits_and_what_is_stepped_64():
    short, long = (gymnasium.make(beamenv.ENV_ID, dtype=dtype).unwrapped for dtype in ("float32", np.float64))
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)
    assert short.observation_space.dtype == short.action_space.dtype == batch.action_space.dtype == np.float32
    assert long.observation_space.dtype == long.action_space.dtype == np.float64
    for env in (short, long, batch):
        env.action_space.seed(0)
    first = [short.reset(seed=1)[0], long.reset(seed=1)[0], batch.reset(seed=[1, 2])[0]]
    actions = short.action_space.sample()
    given = [first, *([short.step(actions)[0], long.step(actions)[0], batch.step(np.tile(actions, (2, 1)))[0]] for _ in range(9))]
    for one, two, both in given:
        assert (one.dtype, two.dtype, both.dtype) == (np.float32, np.float64, np.float32)
        np.testing.assert_array_equal(one, two.astype(np.float32))
        np.testing.assert_array_equal(both[0], one)
        assert short.observation_space.contains(one) and long.observation_space.contains(two)
    np.testing.assert_array_equal(short.state, long.state)


def test_readings_at_full_scale_are_in_the_space_of_amperes():
    env = gymnasium.make(beamenv.ENV_ID, physical_units=True, scenario="overload").unwrapped
    env.reset(seed=0)
    readings = np.array([env.step(np.zeros(4))[0] for _ in range(200)])
    assert (np.abs(readings) == env.observation_space.high).any()
    assert all(env.observation_space.contains(reading) for reading in readings)


@pytest.mark.parametrize("dtype", ["float16", "int32", None, "double precision", 32, {}])
def test_other_numbers_are_refused(dtype):
    for make in (gymnasium.make, gymnasium.make_vec):
        with pytest.raises(ValueError, match="^dtype is .*, but must be 'float32' or 'float64'[.]$"):
            make(beamenv.ENV_ID, dtype=dtype)


# Batches


def test_autoreset_disabled_begins_the_episodes_that_a_mask_names():
    count, ends = 3, [6, 9, 12]
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=count, autoreset_mode="Disabled", **SHORT)
    each = SyncVectorEnv([lambda: gymnasium.make(beamenv.ENV_ID, **SHORT)] * count, autoreset_mode=AutoresetMode.DISABLED)
    assert batch.autoreset_mode is batch.metadata["autoreset_mode"] is AutoresetMode.DISABLED
    for envs in (batch, each):
        envs.reset(seed=[5, 6, 7])
    rng = np.random.default_rng(0)
    for step in range(50):
        actions = rng.uniform(-1.0, 1.0, (count, 4)).astype(np.float32)
        one, two = batch.step(actions), each.step(actions)
        for mine, theirs in zip((one[0], *one[2:4]), (two[0], *two[2:4]), strict=True):
            np.testing.assert_array_equal(mine, theirs)
        np.testing.assert_allclose(one[1], two[1], rtol=1e-12)
        mask = one[2] | one[3]
        if step in ends:
            mask = mask | (np.arange(count) == ends.index(step))
        if mask.any():
            shown, info = batch.reset(options={"reset_mask": mask})
            expected, told = each.reset(options={"reset_mask": mask})
            np.testing.assert_array_equal(shown, expected)
            np.testing.assert_array_equal(info["_energy"], mask)
            np.testing.assert_allclose(info["energy"], told["energy"], rtol=1e-12)
            np.testing.assert_array_equal(info["static_strain"], told["static_strain"])
    assert mask.any() or step == 49


def test_an_ended_episode_is_not_stepped_without_a_reset():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, autoreset_mode=AutoresetMode.DISABLED, **SHORT)
    with pytest.raises(gymnasium.error.ResetNeeded, match="without a mask first"):
        envs.reset(options={"reset_mask": np.array([True, False])})
    envs.reset(seed=0, options={"elapsed": np.array([0, 15])})
    for _ in range(5):
        envs.step(np.zeros((2, 4)))
    state = envs.unwrapped.state
    with pytest.raises(gymnasium.error.ResetNeeded, match=r"Episodes of blades \[1\] have ended"):
        envs.step(np.zeros((2, 4)))
    np.testing.assert_array_equal(envs.unwrapped.state, state)
    envs.reset(options={"reset_mask": np.array([False, True])})
    assert not envs.step(np.zeros((2, 4)))[3].any()


@pytest.mark.parametrize("mask", [True, [True, False], np.array([0, 1]), np.array([False, False]), np.array([True]), "all", {}])
def test_a_mask_that_is_none_is_refused(mask):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT)
    envs.reset(seed=0)
    with pytest.raises(ValueError, match=r"^options\['reset_mask'\] is .*, but must be an array of 2 bools, one of them True[.]$"):
        envs.reset(options={"reset_mask": mask})


def test_a_masked_reset_takes_the_seeds_of_its_blades():
    envs, alone = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT), gymnasium.make(beamenv.ENV_ID, **SHORT)
    mask = np.array([False, True])
    envs.reset(seed=0)
    with pytest.raises(ValueError, match="^seed is 3, but must be None beside a reset_mask"):
        envs.reset(seed=3, options={"reset_mask": mask})
    envs.reset(seed=[1, 2])
    shown, _ = envs.reset(seed=[None, 9], options={"reset_mask": mask})
    np.testing.assert_array_equal(shown[1], alone.reset(seed=9)[0])
    assert envs.np_random_seed == (1, 9)


def test_none_among_seeds_goes_on_with_the_generator_of_its_blade():
    batch = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3)
    each = SyncVectorEnv([lambda: gymnasium.make(beamenv.ENV_ID)] * 3)
    for seed in ([4, 5, 6], [1, None, 3], None, [None, 8, None]):
        np.testing.assert_array_equal(batch.reset(seed=seed)[0], each.reset(seed=seed)[0])
        assert batch.np_random_seed == each.np_random_seed
        assert [one.bit_generator.state for one in batch.np_random] == [one.bit_generator.state for one in each.np_random]
    first = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3)
    first.reset(seed=[1, None, 3])
    assert first.np_random_seed[::2] == (1, 3)
    first.reset(seed=11)
    assert first.np_random_seed == 11


def test_a_generator_that_is_set_is_drawn_from():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)
    expected = envs.reset(seed=21)[0]
    envs.reset(seed=[1, 2])
    envs.np_random = gymnasium.utils.seeding.np_random(21)[0]
    np.testing.assert_array_equal(envs.reset()[0], expected)


@pytest.mark.parametrize("seed", [-1, 1.5, "one", True, 2j, {}])
def test_a_bad_seed_is_told_in_one_sentence(seed):
    for env in (gymnasium.make(beamenv.ENV_ID).unwrapped, gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)):
        env.reset(seed=1)
        before = env.state
        with pytest.raises(ValueError, match="^seed is .*, but must be"):
            env.reset(seed=seed)
        np.testing.assert_array_equal(env.state, before)


def test_placements_are_drawn_anew_where_blades_have_seeds_of_their_own_and_none_among_them():
    envs = VectorPlacementWrapper(batch(), actuators={"low": 0.0, "high": 1.3, "count": 2})
    one, two = (envs.reset(seed=[1, 2])[1]["layout"]["actuators"] for _ in range(2))
    np.testing.assert_array_equal(one, two)
    other = envs.reset(seed=[1, None])[1]["layout"]["actuators"]
    assert other.shape == (2, 2)
    envs.step(np.zeros((2, 2)))
    kept = envs.reset(options={"reset_mask": np.array([True, False])})[1]["layout"]["actuators"]
    np.testing.assert_array_equal(kept, other)
    with pytest.raises(ValueError, match=r"^options\['layout'\] is 'uniform', but must be left out beside a reset_mask"):
        envs.reset(options={"reset_mask": np.array([True, False]), "layout": "uniform"})
    envs.reset(options={"elapsed": 3})


# Pictures


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


# Wrappers of this package


def single():
    return gymnasium.make(beamenv.ENV_ID, **SHORT)


def batch(**arguments):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT, **arguments)


WRAPPED = {
    "rescaled": lambda: gymnasium.wrappers.RescaleObservation(single(), np.float32(0.0), np.float32(1.0)),
    "stacked": lambda: gymnasium.wrappers.FrameStackObservation(single(), 4),
    "stacked and flat": lambda: gymnasium.wrappers.FlattenObservation(gymnasium.wrappers.FrameStackObservation(single(), 4)),
    "itself": lambda: SensorHistory(single()),
    "normalised": lambda: gymnasium.wrappers.NormalizeObservation(single()),
    "with the time": lambda: gymnasium.wrappers.TimeAwareObservation(single()),
    "cart": lambda: gymnasium.make("CartPole-v1"),
    "nothing": lambda: None,
    "a class": lambda: beamenv.RotatingBeamEnv,
}
WRAPPED_BATCHES = {
    "rescaled": lambda: gymnasium.wrappers.vector.RescaleObservation(batch(), np.float32(0.0), np.float32(1.0)),
    "itself": lambda: VectorSensorHistory(batch()),
    "normalised": lambda: gymnasium.wrappers.vector.NormalizeObservation(batch()),
    "carts": lambda: gymnasium.make_vec("CartPole-v1", num_envs=2),
    "one by one": lambda: gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, vectorization_mode="sync"),
    "single": single,
    "nothing": lambda: "envs",
}


@pytest.mark.parametrize("wrapper", [SensorHistory, PlacementWrapper])
@pytest.mark.parametrize("within", WRAPPED)
def test_a_wrapper_is_put_around_blades_that_show_their_readings(within, wrapper):
    env = WRAPPED[within]()
    with pytest.raises(ValueError, match="^env is .*, but must be (an environment with a blade|one that shows)") as told:
        wrapper(env)
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("wrapper", [VectorSensorHistory, VectorPlacementWrapper])
@pytest.mark.parametrize("within", WRAPPED_BATCHES)
def test_a_wrapper_is_put_around_batches_that_show_their_readings(within, wrapper):
    envs = WRAPPED_BATCHES[within]()
    with pytest.raises(ValueError, match="^env is .*, but must be (a batch of blades|one that shows)"):
        wrapper(envs)


def test_patches_are_placed_once():
    with pytest.raises(ValueError, match="^env is .*, but must be one whose patches no other wrapper places"):
        PlacementWrapper(PlacementWrapper(single()))
    with pytest.raises(ValueError, match="^env is .*, but must be one whose patches no other wrapper places"):
        VectorPlacementWrapper(VectorPlacementWrapper(batch()))


def test_a_history_may_be_put_around_what_changes_only_actions_or_rewards():
    rescaled = gymnasium.wrappers.RescaleAction(single(), np.float32(0.0), np.float32(1.0))
    env = SensorHistory(gymnasium.wrappers.NormalizeReward(rescaled), 2)
    env.reset(seed=0)
    observation = env.step(np.full(4, 0.75, np.float32))[0]
    np.testing.assert_allclose(observation[-4:], 0.5)


def test_a_masked_reset_forgets_the_past_of_its_blades_alone():
    envs = VectorSensorHistory(batch(autoreset_mode="Disabled"), length=3)
    envs.reset(seed=[1, 2])
    for _ in range(4):
        before = envs.step(np.full((2, 4), 0.5))[0]
    after, _ = envs.reset(options={"reset_mask": np.array([True, False])})
    np.testing.assert_array_equal(after[1], before[1])
    assert not after[0, :16].any()
    assert envs.step(np.zeros((2, 4)))[0][0, 8:12].any()


# Stable-Baselines3


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
