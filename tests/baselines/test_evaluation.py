"""Evaluation of any controller on any environment of the blade, paired by seed."""

import json
from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import beamenv
from baselines import PersistentLoad, evaluate, lqg, lqr, no_control, roll_out, velocity_feedback
from baselines.evaluation.episodes import Episodes
from baselines.evaluation.metrics import measure, settling_band

SHORT = {"duration": 0.05, "blade": {"model": "thesis"}}
"""In the thesis' world, where the plant that laws are designed for is the one that moves."""


@pytest.fixture(name="env", scope="module")
def _env():
    return gymnasium.make(beamenv.ENV_ID, **SHORT)


@pytest.fixture(name="plant", scope="module")
def _plant(env):
    return env.unwrapped.design_plant


def numbers(evaluation):
    return np.array([value for value in evaluation.row().values() if not isinstance(value, str)], dtype=float)


@pytest.mark.parametrize("law", [lqg, lqr])
@pytest.mark.parametrize("mode", [AutoresetMode.NEXT_STEP, AutoresetMode.SAME_STEP])
def test_single_and_batched_environments_give_the_same_numbers(env, plant, law, mode):
    seeds = range(5, 10)
    single = evaluate(law(plant), env, seeds)
    for count in (2, 5):
        envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=count, autoreset_mode=mode, **SHORT)
        np.testing.assert_allclose(numbers(evaluate(law(plant), envs, seeds)), numbers(single), rtol=1e-6, atol=1e-15)


def test_environments_that_gymnasium_vectorises_serve_too(env, plant):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, vectorization_mode="sync", **SHORT)
    np.testing.assert_allclose(
        numbers(evaluate(lqr(plant), envs, range(3))), numbers(evaluate(lqr(plant), env, range(3))), rtol=1e-9
    )


def test_an_id_is_as_good_as_an_environment():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2)
    plant = envs.unwrapped.design_plant
    by_id, by_env = evaluate(lqg(plant), beamenv.ENV_ID, [3, 4]), evaluate(lqg(plant), envs, [3, 4])
    assert by_id.row() == by_env.row()


def test_no_control_relative_to_itself_is_one_with_no_uncertainty(env, plant):
    relative = evaluate(no_control(plant), env, range(4)).relative_cost
    assert (relative.value, relative.low, relative.high) == (1.0, 1.0, 1.0)


def test_a_reference_spares_the_run_without_control_and_changes_nothing(env, plant):
    first = evaluate(lqg(plant), env, range(4))
    assert evaluate(lqg(plant), env, range(4), reference=first.reference).row() == first.row()
    with pytest.raises(ValueError, match=r"reference has seeds \(0, 1, 2, 3\), but the evaluation has \(0, 1\)"):
        evaluate(lqg(plant), env, range(2), reference=first.reference)


def test_intervals_hold_the_value_and_narrow_with_less_confidence(env, plant):
    wide = evaluate(lqg(plant), env, range(12))
    narrow = evaluate(lqg(plant), env, range(12), reference=wide.reference, confidence=0.5)
    for name, estimate in wide.estimates().items():
        assert estimate.low <= estimate.value <= estimate.high
        inner = narrow.estimates()[name]
        assert estimate.low <= inner.low <= inner.high <= estimate.high


def test_pairing_by_seed_makes_the_relative_cost_surer_than_the_cost(env, plant):
    result = evaluate(lqg(plant), env, range(16))
    spread = [(e.high - e.low) / e.value for e in (result.relative_cost, result.cost)]
    assert spread[0] < spread[1]


def test_a_result_is_json_and_one_row_of_a_table(env, plant):
    result = evaluate(lqg(plant), env, range(3))
    kept = json.loads(json.dumps(result.to_dict(), allow_nan=False))
    assert kept["controller"] == result.row()["controller"] == "LQG"
    assert kept["seeds"] == [0, 1, 2]
    assert kept["estimates"]["relative_cost"]["value"] == result.row()["relative_cost"]
    assert len(kept["per_seed"]["cost"]) == 3


def test_bad_arguments_are_named(env, plant):
    with pytest.raises(ValueError, match=r"seeds is \[\], but must be a list of one or more seeds"):
        evaluate(lqg(plant), env, [])
    with pytest.raises(ValueError, match="confidence is 95, but must be a number above 0 and below 1"):
        evaluate(lqg(plant), env, [0], confidence=95)


def test_a_plain_function_of_the_observations_is_a_controller(env, plant):
    law = velocity_feedback(plant, gain=0.02 * 1500.0 / plant.sensor_full_scale[0], verify=False)
    gain = law.measurement_gain * plant.sensor_full_scale / 1500.0
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, **SHORT)
    for where in (env, envs):
        function = evaluate(lambda readings: readings @ gain.T, where, range(3))
        np.testing.assert_allclose(numbers(function), numbers(evaluate(law, where, range(3))), rtol=1e-9)
        assert function.name == "function"
    assert function.relative_cost.value != 1.0
    assert roll_out(np.zeros_like, env, [0]).voltages.max() == 0.0
    alone = evaluate(lambda readings: gain @ readings[0], env, range(3))  # of a blade alone a row without a batch will do
    np.testing.assert_allclose(numbers(alone), numbers(evaluate(law, env, range(3))), rtol=1e-9)


@pytest.mark.parametrize(
    ("controller", "sentence"),
    [
        (3, "controller = 3 is not allowed: it must be an object with Stable-Baselines3's predict, or a function"),
        (PersistentLoad, "controller = <class .*PersistentLoad'> is not allowed"),
        (lambda readings: readings[0, 0], r"controller = function gives actions of shape \(\) for observations of shape \(1, 4\)"),
    ],
)
def test_what_is_no_controller_is_refused_in_one_sentence(env, controller, sentence):
    for run in (evaluate, roll_out):
        with pytest.raises(ValueError, match=sentence):
            run(controller, env, [0])


def test_an_evaluation_is_told_in_one_line(env, plant):
    result = evaluate(lqg(plant), env, range(6))
    line = repr(result)
    assert "\n" not in line
    assert len(line) < 160
    assert line.startswith(f"Evaluation('LQG': J {result.cost.value:.4g} [{result.cost.low:.4g}, {result.cost.high:.4g}] J s")
    assert line.endswith("6 seeds (0, 1, …, 5))")


def test_progress_counts_the_episodes(env, plant):
    told = []
    evaluate(no_control(plant), env, range(3), progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 3), (2, 3), (3, 3)]


def test_memory_and_episode_start_are_handed_on_as_sb3_does(env):
    class Recurrent:
        def __init__(self):
            self.seen = []

        def predict(self, observation, state=None, episode_start=None, deterministic=True):
            self.seen.append((state, episode_start.copy(), deterministic))
            return np.zeros((len(observation), 4)), 0 if state is None else state + 1

    model = Recurrent()
    roll_out(model, env, [0])
    steps = 100
    assert [state for state, *_ in model.seen] == [None, *range(steps - 1)] * 2
    assert [start.tolist() for _, start, _ in model.seen] == [[True], *[[False]] * (steps - 1)] * 2
    assert all(deterministic for *_, deterministic in model.seen)


def test_an_sb3_model_goes_through_the_same_door(env):
    stable_baselines3 = pytest.importorskip("stable_baselines3")
    single = beamenv.SensorHistory(env, length=4)
    model = stable_baselines3.PPO("MlpPolicy", single, n_steps=8, batch_size=8, seed=0, device="cpu")
    envs = beamenv.VectorSensorHistory(gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **SHORT), length=4)
    result = evaluate(model, envs, range(3))
    assert result.name == "PPO"
    assert result.rms_voltage.value > 0.0
    np.testing.assert_allclose(numbers(result), numbers(evaluate(model, single, range(3))), rtol=1e-4, atol=1e-12)


def test_knowing_of_loads_that_last_pays_on_the_default_load_cases():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=64, blade={"model": "thesis"})
    plant, costs, reference = envs.unwrapped.design_plant, {}, None
    for law in (lqg(plant), lqg(plant, persistent_load=PersistentLoad()), lqr(plant), lqr(plant, PersistentLoad())):
        result = evaluate(law, envs, range(64), reference=reference)
        costs[law.name], reference = result.metrics.cost, result.reference
    for less, more in (
        ("LQG with load estimate", "LQG"),
        ("LQR with load estimate (full state)", "LQR (full state)"),
        ("LQR with load estimate (full state)", "LQG with load estimate"),
    ):
        saved = costs[more] - costs[less]
        assert saved.mean() > 3.0 * saved.std(ddof=1) / np.sqrt(len(saved)), (less, more)


def test_a_controller_that_breaks_the_blade_cannot_win():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, blade={"voltage_limits": (-1e6, 1e6)})
    result = evaluate(np.sign, envs, range(4))
    assert result.episodes.failed.all()
    assert result.relative_cost.value == np.inf
    assert result.settled.value == 0.0
    assert json.loads(json.dumps(result.row(), allow_nan=False))["relative_cost"] is None


def test_the_load_response_is_what_the_load_case_did_to_a_linear_blade(plant):
    env = gymnasium.make(beamenv.ENV_ID, scenario="deflection", **SHORT)
    noiseless = gymnasium.make(
        beamenv.ENV_ID, scenario={"preset": "deflection", "white_load": False, "sensor_noise": False}, **SHORT
    )
    response, clean = (roll_out(no_control(plant), each, range(3)) for each in (env, noiseless))
    np.testing.assert_allclose(response.load_response, clean.tip_displacement, rtol=1e-6, atol=1e-12)


def ringing(decay, volts=0.0, failed=False, level=1.0):
    """One blade whose tip rings at 100 Hz about ``level`` m in lag, for 1 s at 1 ms, with ``volts`` half the time."""
    time = 1e-3 * np.arange(1, 1001)
    tip = np.zeros((1000, 1, 2))
    tip[:, 0, 0] = level + np.exp(-decay * time) * np.cos(200 * np.pi * time)
    voltages = np.zeros((1000, 1, 2))
    voltages[:500, 0, 0] = volts
    return Episodes(
        seeds=(0,),
        cost=np.full((1000, 1), 2e-3),
        effort=np.full((1000, 1), 5e-4),
        tip_displacement=tip,
        load_response=tip,
        voltages=voltages,
        failed=np.array([failed]),
        voltage_limits=np.array([[-500.0, -500.0], [1500.0, 1500.0]]),
        interval=1e-3,
    )


def test_settling_time_of_a_decaying_vibration_is_that_of_its_envelope():
    band = settling_band(ringing(1.0))
    metrics = measure(ringing(20.0), band)
    assert metrics.settling_time[0] == pytest.approx(np.log(1 / band[0]) / 20.0, abs=0.005)
    assert metrics.settled[0] == 1.0


def test_a_vibration_that_goes_on_never_settles():
    metrics = measure(ringing(0.5), settling_band(ringing(0.5)))
    assert metrics.settling_time[0] == pytest.approx(1.0, abs=0.01)
    assert metrics.settled[0] == 0.0


def test_metrics_of_a_trace_known_by_hand():
    metrics = measure(ringing(20.0, volts=-500.0, level=3.0), np.array([0.05]))
    assert metrics.cost[0] == pytest.approx(2.0)
    assert metrics.effort[0] == pytest.approx(0.5)
    assert metrics.peak_tip[0] == pytest.approx(3.0 + np.exp(-0.2), rel=1e-6)
    assert metrics.peak_voltage[0] == 500.0
    assert metrics.rms_voltage[0] == pytest.approx(250.0)
    assert metrics.saturation[0] == pytest.approx(0.25)
    offset = replace(ringing(20.0), tip_displacement=np.full((1000, 1, 2), 2.0))
    assert measure(offset, np.array([0.05])).rms_tip[0] == pytest.approx(np.sqrt(8.0))


def test_a_blade_that_fails_costs_infinitely_much_and_never_settles():
    lost = ringing(20.0, failed=True)
    for series in (lost.cost, lost.tip_displacement, lost.voltages):
        series[300:] = np.nan
    metrics = measure(lost, np.array([0.05]))
    assert metrics.cost[0] == np.inf
    assert metrics.settled[0] == 0.0
    assert metrics.to_dict()["cost"] == [None]
    assert np.isfinite(metrics.peak_tip[0])
