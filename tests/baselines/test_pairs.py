"""What an evaluation is relative to: the very same episodes without control, or else nothing."""

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode

import beamenv
from baselines import evaluate, lqg, no_control, reference_lqg, roll_out

SHORT = {"duration": 0.05, "blade": {"model": "thesis"}}


@pytest.fixture(name="env", scope="module")
def _env():
    return gymnasium.make(beamenv.ENV_ID, **SHORT)


@pytest.fixture(name="reference", scope="module")
def _reference(env):
    return evaluate(no_control(env.unwrapped.design_plant), env, range(2)).reference


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"duration": 0.1}, "reference has control intervals in an episode 100, but the evaluation has 200"),
        ({"max_episode_steps": 50}, "reference has control intervals in an episode 100, but the evaluation has 50"),
        ({"scenario": "white"}, "reference is of another scenario, but must be of the very episodes of the evaluation"),
        ({"scenario": {"magnitude": 16.0}}, "reference is of another scenario"),
        ({"speed": 150.0}, "reference is of another blade"),
        ({"blade": {"model": "thesis", "damping_ratio": 0.02}}, "reference is of another blade"),
        (
            {"blade": {"model": "thesis", "control_interval": 1e-3}},
            r"reference has control intervals of \(s\) 0.0005, but .* 0.001",
        ),
        ({"physical_units": True}, "reference has physical_units False, but the evaluation has True"),
    ],
)
@pytest.mark.parametrize("batch", [False, True])
def test_a_reference_of_other_episodes_is_refused_in_one_sentence(reference, change, sentence, batch):
    arguments = {**SHORT, **change}
    other = gymnasium.make_vec(beamenv.ENV_ID, num_envs=2, **arguments) if batch else gymnasium.make(beamenv.ENV_ID, **arguments)
    law = no_control(other.unwrapped.design_plant)
    law = law.in_physical_units() if "physical_units" in change else law
    with pytest.raises(ValueError, match=f"^{sentence}") as refused:
        evaluate(law, other, range(2), reference=reference)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("mode", [{"autoreset_mode": AutoresetMode.SAME_STEP}, {"vectorization_mode": "sync"}, {}])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_reference_of_the_same_episodes_serves_however_they_are_run(reference, mode, count):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=count, **mode, **SHORT)
    assert evaluate(np.zeros_like, envs, range(2), reference=reference).relative_cost.value == pytest.approx(1.0, rel=1e-6)


def test_what_is_designed_for_is_no_part_of_an_episode(reference):
    other = gymnasium.make(beamenv.ENV_ID, **SHORT, design={"model": "thesis", "speed": 190.0})
    assert evaluate(no_control(other.unwrapped.design_plant), other, range(2), reference=reference).relative_cost.value == 1.0


@pytest.mark.parametrize("reference", [3, "none", {}, np.zeros(2)])
def test_what_is_no_reference_is_named(env, reference):
    with pytest.raises(
        ValueError, match="^reference is .*, but must be None, or the reference of an evaluation of the same episodes"
    ):
        evaluate(np.zeros_like, env, range(2), reference=reference)


@pytest.mark.parametrize("law", [np.zeros_like, np.ones_like])
def test_where_nothing_moves_no_cost_is_relative_to_it(law):
    quiet = gymnasium.make(beamenv.ENV_ID, scenario="quiet", **SHORT)
    with pytest.raises(ValueError, match="^scenario moves nothing, and J without control is zero: no cost is relative to it.$"):
        evaluate(law, quiet, range(2))
    assert np.isfinite(roll_out(law, quiet, range(2)).cost).all()


def test_where_some_episodes_are_quiet_the_others_tell():
    some = {"step": 0.0, "pulse": 0.0, "harmonic": 0.0, "deflection": 0.5, "white_load": False, "sensor_noise": False}
    env = gymnasium.make(beamenv.ENV_ID, scenario=some, **SHORT)
    result = evaluate(lqg(env.unwrapped.design_plant), env, range(4))
    assert 0 < np.count_nonzero(result.uncontrolled) < 4
    assert 0.0 < result.relative_cost.low <= result.relative_cost.value <= result.relative_cost.high < 1.0


def test_a_law_of_another_clock_is_refused():
    slow = gymnasium.make(beamenv.ENV_ID, duration=0.05, blade={"model": "thesis", "control_interval": 1e-3})
    law = reference_lqg(gymnasium.make(beamenv.ENV_ID, **SHORT).unwrapped.design.full_plant)
    with pytest.raises(
        ValueError, match="^controller = LQG decides every 0.0005 s, but the environment wants one that does every 0.001 s"
    ):
        evaluate(law, slow, range(2))


def test_a_model_is_shown_the_spaces_that_it_was_trained_in(env):
    stable_baselines3 = pytest.importorskip("stable_baselines3")
    model = stable_baselines3.PPO("MlpPolicy", env, n_steps=8, batch_size=8, seed=0, device="cpu")
    assert evaluate(model, env, [0]).rms_voltage.value > 0.0
    for other, words in (
        (gymnasium.make(beamenv.ENV_ID, physical_units=True, **SHORT), "has the action space Box.-1.0, 1.0"),
        (beamenv.SensorHistory(gymnasium.make(beamenv.ENV_ID, **SHORT), length=4), "has the observation space"),
    ):
        with pytest.raises(ValueError, match=f"^controller = PPO {words}"):
            evaluate(model, other, [0])


def test_a_vec_env_of_stable_baselines3_is_named_for_what_it_is():
    pytest.importorskip("stable_baselines3")
    envs = beamenv.BladeVecEnv(2, duration=0.05)
    with pytest.raises(
        ValueError, match="^env is .*, but must be an environment with a blade, .* not a VecEnv of Stable-Baselines3.$"
    ):
        evaluate(np.zeros_like, envs, range(2))
    assert evaluate(np.zeros_like, envs.envs, range(2)).relative_cost.value == 1.0


@pytest.mark.parametrize("name", ["nope", "", "beamenv/RotatingBeam-v9", "no.such.module:Blade-v0", "CartPole-v1", "a\nb"])
def test_an_id_that_nobody_has_registered_is_named(name):
    with pytest.raises(
        ValueError, match="^env is .*, but must be an environment with a blade, a batch of them, or the id of one"
    ) as told:
        evaluate(np.zeros_like, name, range(2))
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("progress", [3, "bar", {}, []])
def test_progress_is_called_or_refused_before_anything_runs(env, progress):
    for run in (evaluate, roll_out):
        with pytest.raises(ValueError, match="^progress is .*, but must be None, or a function of the number done and their total"):
            run(np.zeros_like, env, range(2), progress=progress)


@pytest.mark.parametrize("seeds", [3, "ab", None, {}, {1, 2}, (seed for seed in range(3)), iter([1]), np.array(3), object()])
def test_what_is_no_list_of_seeds_is_named(env, seeds):
    for run in (evaluate, roll_out):
        with pytest.raises(ValueError, match="^seeds is .*, but must be a list of one or more seeds"):
            run(np.zeros_like, env, seeds)
