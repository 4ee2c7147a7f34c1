"""What an evaluation is not made of: other spaces than the blade's, unlike blades, too many seeds, doctored references."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium import wrappers
from gymnasium.spaces import Box
from gymnasium.vector import SyncVectorEnv

import beamenv
from baselines import evaluate, lqg, lqr, no_control, roll_out

SHORT = {"duration": 0.02, "blade": {"model": "thesis"}}
ONE, HUGE = np.float32(1.0), 10**9


def single(**changes):
    return gymnasium.make(beamenv.ENV_ID, **{**SHORT, **changes})


def batch(**changes):
    return gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **{**SHORT, **changes})


@pytest.fixture(name="env", scope="module")
def _env():
    return single()


@pytest.fixture(name="reference", scope="module")
def _reference(env):
    return evaluate(np.zeros_like, env, range(2)).reference


@pytest.fixture(name="law", scope="module")
def _law(env):
    return no_control(env.unwrapped.design_plant)


ACTS_OTHERWISE = {
    "rescaled": lambda: wrappers.RescaleAction(single(), np.float32(0.0), ONE),
    "rescaled batch": lambda: wrappers.vector.RescaleAction(batch(), np.float32(0.0), ONE),
    "rescaled blades of a batch": lambda: SyncVectorEnv([lambda: wrappers.RescaleAction(single(), np.float32(0.0), ONE)] * 2),
    "in V": lambda: wrappers.RescaleAction(single(physical_units=True), -ONE, ONE),
    "discrete": lambda: wrappers.DiscretizeAction(single(), 3),
}
SHOWS_OTHERWISE = {
    "rescaled": lambda: wrappers.RescaleObservation(single(), np.float32(0.0), ONE),
    "normalised": lambda: wrappers.NormalizeObservation(single()),
    "normalised batch": lambda: wrappers.vector.NormalizeObservation(batch()),
    "normalised blades of a batch": lambda: SyncVectorEnv([lambda: wrappers.NormalizeObservation(single())] * 2),
    "rescaled batch": lambda: wrappers.vector.RescaleObservation(batch(), np.float32(0.0), ONE),
    "history": lambda: beamenv.SensorHistory(single(), length=2),
}


@pytest.mark.parametrize("make", ACTS_OTHERWISE.values(), ids=ACTS_OTHERWISE.keys())
def test_zero_of_other_actions_is_not_taken_for_no_control(law, make):
    for controller in (law, lambda seen: np.zeros((len(seen), 4))):
        for run in (evaluate, roll_out):
            with pytest.raises(ValueError, match="^(env|controller) .*(voltages as the blade does|physical_units)") as told:
                run(controller, make(), range(2))
            assert "\n" not in str(told.value)


@pytest.mark.parametrize("make", SHOWS_OTHERWISE.values(), ids=SHOWS_OTHERWISE.keys())
def test_a_law_reads_the_sensors_as_they_are(law, make):
    with pytest.raises(ValueError, match="^env is .*, but must be one that shows the sensors' readings as they are"):
        evaluate(law, make(), range(2))
    assert evaluate(lambda seen: np.zeros((len(seen), 4)), make(), range(2)).relative_cost.value == 1.0


def test_wrappers_that_change_no_number_are_let_through(env, law):
    plain = evaluate(law, env, range(2)).cost.value
    for wrapped in (
        wrappers.ClipAction(single()),
        wrappers.DtypeObservation(single(), np.float32),
        wrappers.TimeLimit(single(), 40),
        SyncVectorEnv([single] * 2),
        SyncVectorEnv([lambda: wrappers.ClipAction(single())] * 2),
        beamenv.PlacementWrapper(single(physical_units=False)),
        wrappers.vector.ClipAction(batch()),
    ):
        assert evaluate(law, wrapped, range(2)).cost.value == pytest.approx(plain, rel=1e-5)
    state = lqr(env.unwrapped.design_plant)
    assert evaluate(state, wrappers.NormalizeObservation(single()), range(2)).cost.value == pytest.approx(
        evaluate(state, env, range(2)).cost.value, rel=1e-5
    )


@pytest.mark.parametrize(
    ("changes", "what"),
    [
        ({"scenario": "white"}, "scenario"),
        ({"duration": 0.03}, "duration"),
        ({"max_episode_steps": 20}, "max_episode_steps"),
        ({"blade": {"model": "thesis", "control_interval": 1e-3}, "duration": 0.04}, "control_interval"),
        ({"blade": {"model": "thesis", "voltage_limits": (-400.0, 1500.0)}}, "voltage_limits"),
    ],
)
def test_blades_of_one_batch_have_one_kind_of_episode(law, changes, what):
    envs = SyncVectorEnv([single, lambda: single(**changes)], observation_mode="different")
    with pytest.raises(ValueError, match=f"^env has blades that differ in their {what}: blade 1 has another than blade 0"):
        evaluate(law, envs, range(2))


@pytest.mark.parametrize("seeds", [range(HUGE), range(10**30), range(10**6 + 1)])
def test_more_seeds_than_anybody_has_time_for_are_refused_at_once(env, seeds):
    for run in (evaluate, roll_out):
        with pytest.raises(ValueError, match="^seeds is range.*, but must be a list of one or more seeds, at most 1000000"):
            run(np.zeros_like, env, seeds)


def test_an_episode_counts_once(env):
    with pytest.raises(ValueError, match="^seeds has 3 more than once, but must be unlike each other"):
        evaluate(np.zeros_like, env, [3, 4, 3])


@pytest.mark.parametrize(
    ("name", "made", "words"),
    [
        ("cost", lambda cost: cost[:, :1], r"has shape \(40, 1\), but must be an array of numbers in shape \(40, 2\)"),
        ("cost", lambda cost: cost.tolist(), r"is \[\["),
        ("cost", lambda _: None, "is None"),
        ("effort", lambda effort: effort[:3], r"has shape \(3, 2\)"),
        ("load_response", lambda response: response[..., :1], r"has shape \(40, 2, 1\)"),
        ("voltages", lambda volts: volts[..., :1], r"has shape \(40, 2, 1\)"),
        ("voltage_limits", lambda _: 3.0, r"is 3.0"),
        ("failed", lambda failed: failed[:1], r"has shape \(1,\)"),
        ("failed", lambda failed: failed.astype(float), "is array"),
        ("interval", lambda _: -1.0, "is -1.0"),
    ],
)
def test_episodes_have_the_shapes_that_they_tell(reference, name, made, words):
    with pytest.raises(ValueError, match=f"^episodes.{name} {words}"):
        replace(reference, **{name: made(getattr(reference, name))})


@pytest.mark.parametrize("rows", [slice(0, 1), slice(3, 5), slice(None)])
def test_costs_that_are_no_numbers_are_told_as_such(env, reference, rows):
    cost = reference.cost.copy()
    cost[rows, 1] = np.nan
    with pytest.raises(ValueError, match=r"^reference has costs that are no numbers \(NaN\) before an episode's end"):
        evaluate(np.zeros_like, env, range(2), reference=replace(reference, cost=cost))


def test_observations_are_arrays():
    both = gymnasium.spaces.Dict({"readings": Box(-1.0, 1.0, (4,))})
    env = wrappers.TransformObservation(single(), lambda seen: {"readings": seen}, both)
    with pytest.raises(ValueError, match="^env is .*, but must be one whose observations are arrays, in a Box, and not in Dict.$"):
        evaluate(lambda seen: np.zeros((1, 4)), env, range(2))


@pytest.mark.parametrize("progress", [lambda: None, lambda done: None, lambda a, b, c: None, lambda a, b, *, c: None])
def test_progress_takes_the_number_done_and_their_total(env, progress):
    for run in (evaluate, roll_out):
        with pytest.raises(ValueError, match="^progress is .*, but must be None, or a function of the number done and their total"):
            run(np.zeros_like, env, range(2), progress=progress)


def test_progress_may_take_more_where_it_need_not(env):
    told = []
    roll_out(np.zeros_like, env, range(1), progress=lambda done, total, *rest, last=0: told.append((done, total)))
    assert told == [(1, 1)]


def test_a_law_that_takes_readings_for_others_is_refused(env, law):
    plant = env.unwrapped.design_plant
    doubled = replace(plant, sensor_full_scale=plant.sensor_full_scale * np.array([1.0, 1.0, 2.0, 1.0]))
    for each in (env, batch()):
        with pytest.raises(
            ValueError, match="^controller = LQG takes a reading of 1 of sensor 3 for .*, its full scale: design"
        ) as told:
            evaluate(lqg(doubled), each, range(2))
        assert "\n" not in str(told.value)
    cost = evaluate(lqg(plant), env, range(2)).cost.value
    in_units = evaluate(lqg(doubled).in_physical_units(), single(physical_units=True), range(2))  # where there is no scale
    assert in_units.cost.value == pytest.approx(cost, rel=1e-5)
    evaluate(lqr(doubled), env, range(2))  # which reads no sensor
