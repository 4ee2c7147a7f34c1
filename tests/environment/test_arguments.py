"""Bad input gets one sentence that names it, and changes nothing."""

import copy

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv, SensorHistory, VectorSensorHistory
from beamenv.envs.placement import PlacementWrapper, VectorPlacementWrapper
from beamenv.task import resolve_task

STATES = len(resolve_task().plant.A)

WRONG = [
    ({"preset": "wing"}, "preset is 'wing', but must be one of thesis"),
    ({"speed": 1e5}, "speed is 100000.0, but must be at least 0 and below the critical speed"),
    ({"blade": {"beam": {"thickness": -0.01}}}, "thickness"),
    ({"blade": {"beam": {"colour": "red"}}}, "colour"),
    ({"blade": {"strain_limit": "static"}}, "blade.strain_limit is 'static', but must be one of vibration, total"),
    ({"blade": {"patches": {"actuators": (0.0, 0.01)}}}, "overlap"),
    ({"blade": {"patches": {"sensors": (2.0,)}}}, "sensors"),
    ({"design": "wing"}, "'wing'"),
    ({"scenario": "storm"}, "scenario is 'storm', but must be one of nominal"),
    ({"duration": 0.0}, "duration is 0.0, but must be a number above 0.00025 and at most 500000 .s."),
    ({"duration": -1.0}, "duration is -1.0"),
    ({"duration": float("nan")}, "duration is nan"),
    ({"duration": "long"}, "duration is 'long'"),
    ({"physical_units": "yes"}, "physical_units is 'yes', but must be True or False"),
    ({"render_mode": "ansi"}, "render_mode is 'ansi'"),
]


@pytest.mark.parametrize("cls", [RotatingBeamEnv, RotatingBeamVectorEnv])
@pytest.mark.parametrize(("arguments", "sentence"), WRONG)
def test_a_bad_argument_is_named(cls, arguments, sentence):
    with pytest.raises(ValueError, match=sentence) as caught:
        cls(**arguments)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"num_envs": 0}, "num_envs is 0, but must be a whole number not below 1"),
        ({"num_envs": 2.5}, "num_envs is 2.5"),
        ({"num_envs": True}, "num_envs is True"),
        ({"max_episode_steps": 0}, "max_episode_steps is 0, but must be a whole number not below 1"),
        ({"autoreset_mode": "Never"}, "autoreset_mode is 'Never', but must be one of 'NextStep', 'SameStep', 'Disabled'"),
        ({"autoreset_mode": np.zeros(2)}, "autoreset_mode is"),
        ({"render_index": [[0]]}, "render_index is .*, but must be None, an integer from 0 to 0, or a sequence of such integers"),
        ({"render_index": 1}, "render_index is 1, but must be"),
        ({"render_index": [[0], [0, 1]]}, "render_index is"),
    ],
)
def test_a_bad_argument_of_the_batch_is_named(arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        RotatingBeamVectorEnv(**arguments)


ACTIONS = [
    (lambda shape: np.zeros((*shape[:-1], shape[-1] + 1)), r"action has shape \(.*5,?\), but must have shape \(.*4,?\)"),
    (lambda shape: 0.0, r"action has shape \(\), but must have shape"),
    (lambda shape: np.full(shape, np.nan), r"action\[0.*\] is nan, but every number must be finite"),
    (lambda shape: np.full(shape, -np.inf), r"action\[0.*\] is -inf, but every number must be finite"),
    (lambda shape: "full", "action is 'full', but must be an array of real numbers"),
    (lambda shape: None, "action"),
    (lambda shape: [[1.0], [1.0, 2.0]], r"action is \[\[1.0\], \[1.0, 2.0\]\], but must be an array of real numbers"),
]


def environments():
    return [(RotatingBeamEnv(), (4,)), (RotatingBeamVectorEnv(3), (3, 4)), (RotatingBeamVectorEnv(3, physical_units=True), (3, 4))]


@pytest.mark.parametrize(("bad_action", "sentence"), ACTIONS)
def test_a_bad_action_is_named_and_changes_nothing(bad_action, sentence):
    for (env, shape), (twin, _) in zip(environments(), environments(), strict=True):
        for each in (env, twin):
            each.reset(seed=1)
            each.step(np.full(shape, 0.1))
        with pytest.raises(ValueError, match=sentence):
            env.step(bad_action(shape))
        assert np.array_equal(env.state, twin.state)
        for _ in range(3):
            assert np.array_equal(env.step(np.full(shape, 0.1))[0], twin.step(np.full(shape, 0.1))[0])


def test_one_bad_blade_stops_the_whole_batch():
    envs = RotatingBeamVectorEnv(3)
    envs.reset(seed=0)
    before = envs.state
    actions = np.zeros((3, 4))
    actions[1, 2] = np.nan
    with pytest.raises(ValueError, match=r"action\[1, 2\] is nan"):
        envs.step(actions)
    assert np.array_equal(envs.state, before)


def test_a_huge_but_finite_action_only_saturates():
    env = RotatingBeamEnv()
    env.reset(seed=0)
    *_, info = env.step(np.array([1e300, -1e300, 1e200, 0.0]))
    np.testing.assert_array_equal(info["volts"], [1500.0, -1500.0, 1500.0, 0.0])


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ({"wind": 1.0}, "options has no field 'wind': its fields are load, initial_state"),
        ({"load": 3.0}, r"options.load is 3.0, but must be a mapping"),
        ({"load": {"size": 3.0}}, r"options.load has no field 'size': its fields are case, magnitude"),
        ({"load": {"case": "gust"}}, r"options.load.case is 'gust', but must be one of step, pulse"),
        ({"load": {"magnitude": -3.0}}, "options.load.magnitude is -3.0"),
        ({"initial_state": np.zeros(5)}, r"options.initial_state has shape \(5,\), but must have shape \(" + str(STATES)),
        ({"initial_state": np.full(STATES, np.nan)}, r"options.initial_state strains the blade by nan, but must be finite"),
        ({"initial_state": np.full(STATES, 1e3)}, r"options.initial_state strains the blade by"),
        ({"initial_state": "rest"}, r"options.initial_state is 'rest', but must be an array of real numbers"),
    ],
)
def test_a_bad_reset_option_is_named_and_changes_nothing(options, sentence):
    for (env, shape), (twin, _) in zip(environments(), environments(), strict=True):
        env.reset(seed=1)
        twin.reset(seed=1)
        with pytest.raises(ValueError, match=sentence):
            env.reset(seed=2, options=options)
        assert np.array_equal(env.step(np.zeros(shape))[0], twin.step(np.zeros(shape))[0])


BAD_SEEDS = [[1, 2], [1, 2, -3], [1, 2, 0.5], [1, 2, True], "abc", b"abc", {1: 2}, 0.5, {1, 2, 3}, {1: 2, 2: 3, 3: 4}.keys()]


@pytest.mark.parametrize("seed", [*BAD_SEEDS, (number for number in (1, 2, True)), iter([1, 2, 3])])
def test_bad_seeds_of_a_batch_are_named(seed):
    envs = RotatingBeamVectorEnv(3)
    with pytest.raises(ValueError, match="seed is .*, but must be an integer, or a sequence of 3 integers that are not negative"):
        envs.reset(seed=seed)


@pytest.mark.parametrize("seed", [[1, 2, 3], (1, 2, 3), range(1, 4), np.array([1, 2, 3])])
def test_seeds_of_the_blades_are_a_list_a_tuple_a_range_or_an_array(seed):
    envs = RotatingBeamVectorEnv(3)
    envs.reset(seed=seed)
    assert envs.np_random_seed == (1, 2, 3)


def test_stepping_or_drawing_before_a_reset_is_refused():
    for env, shape in environments():
        with pytest.raises(gymnasium.error.ResetNeeded):
            env.step(np.zeros(shape))
    with pytest.raises(gymnasium.error.ResetNeeded):
        RotatingBeamEnv(render_mode="rgb_array").render()


@pytest.mark.parametrize("length", [0, -1, 2.5, True, "long"])
def test_a_bad_history_length_is_named(length):
    for wrap in (lambda: SensorHistory(RotatingBeamEnv(), length), lambda: VectorSensorHistory(RotatingBeamVectorEnv(2), length)):
        with pytest.raises(ValueError, match="length is .*, but must be a whole number from 1 to 10000"):
            wrap()


def test_a_history_wants_normalised_units():
    with pytest.raises(ValueError, match="env has physical_units=True"):
        SensorHistory(gymnasium.make(beamenv.ENV_ID, physical_units=True))


@pytest.mark.parametrize(
    ("design", "words"),
    [
        ({"control_interval": 1e-3}, "design.control_interval is 0.001"),
        ({"voltage_limits": (-500.0, 1500.0)}, "design.voltage_limits is"),
        ({"patches": {"actuators": 2}}, r"design has \(2, 4\) voltages and sensors"),
    ],
)
def test_a_design_plant_shares_the_electronics_of_the_true_one(design, words):
    with pytest.raises(ValueError, match=words):
        gymnasium.make(beamenv.ENV_ID, design=design)


def test_a_design_plant_reads_the_true_blade_s_instruments():
    env = gymnasium.make(beamenv.ENV_ID, design={"beam": {"pretwist_deg": 0.0}}).unwrapped
    assert env.design_plant.sensor_full_scale == pytest.approx(env.plant.sensor_full_scale)


def test_counts_of_wrappers_follow_the_rule_of_counts():
    for length in (3, 3.0, np.int8(3)):
        assert SensorHistory(RotatingBeamEnv(), length).observation_space.shape == (24,)
    assert VectorPlacementWrapper(RotatingBeamVectorEnv(2), bank=np.int8(3)).num_envs == 2


@pytest.mark.parametrize(
    "wrap", [lambda: PlacementWrapper(RotatingBeamEnv()), lambda: VectorPlacementWrapper(RotatingBeamVectorEnv(2))]
)
@pytest.mark.parametrize(
    ("options", "words"),
    [
        (3, "options is 3, but must be a mapping"),
        ([], r"options is \[\], but must be a mapping"),
        ({1: 2}, "options is {1: 2}, but must be a mapping"),
        ({"layout": {1: 1, "a": 2}}, "(options.'layout'.|layout) is {1: 1, 'a': 2}, but must be a mapping"),
        ({"layout": {"top": 1}}, "(options.'layout'.|layout) has no field 'top': its fields are actuators, sensors"),
    ],
)
def test_options_of_a_placement_are_told_by_name(wrap, options, words):
    env = wrap()
    with pytest.raises(ValueError, match=f"^{words}"):
        env.reset(options=options)


@pytest.mark.parametrize("wrong", [None, 3, resolve_task, [None]])
def test_a_refused_task_leaves_the_environment_as_it_was(wrong):
    single, batch = RotatingBeamEnv(), RotatingBeamVectorEnv(2)
    for env, given in ((single, wrong), (batch, [wrong])):
        env.reset(seed=1)
        twin = copy.deepcopy(env)
        with pytest.raises(ValueError, match="^task is .*, but must be a Task"):
            env.set_task(given)
        actions = np.full(env.action_space.shape, 0.3)
        assert np.array_equal(env.step(actions)[0], twin.step(actions)[0])


def test_a_task_whose_bank_cannot_be_built_leaves_the_environment_as_it_was():
    impossible = resolve_task(scenario={"plants": {"speed_ratio": [9.9, 10.0], "bank": 1}})
    single, batch = RotatingBeamEnv(), RotatingBeamVectorEnv(2)
    for env, given in ((single, impossible), (batch, [impossible])):
        before = env.task
        with pytest.raises(ValueError, match="^speed is 19.*, but must be a speed at which the blade has a steady state[.]$"):
            env.set_task(given)
        assert env.task is before
        env.reset(seed=1)


@pytest.mark.parametrize("wrong", [1j * np.ones(22), ["1"] * 22, [b"1"] * 22])
def test_numbers_are_neither_complex_nor_text(wrong):
    with pytest.raises(ValueError, match="^options.initial_state is .*, but must be an array of real numbers[.]$") as told:
        RotatingBeamEnv().reset(options={"initial_state": wrong})
    assert "\n" not in str(told.value)
