"""The batch of blades as Stable-Baselines3 sees it."""

import gymnasium
import numpy as np
import pytest
from gymnasium.vector import AutoresetMode
from stable_baselines3.common.vec_env import VecEnv, VecMonitor, VecNormalize

import beamenv
from beamenv.simulation.blades import reward_scale
from train.learning.sb3.side_by_side import SideBySide
from train.learning.sb3.vec_env import REWARD_UNIT, TrainingVecEnv

SHORT = {"duration": 0.01}  # 20 control intervals
COUNT = 4
FIRST_TO_END = COUNT - 1  # blades begin spread over the episode, the last one furthest on


def batch():
    return TrainingVecEnv(COUNT, SHORT, seed=5, history=3)


def plain_batch():
    """The wrapped Gymnasium batch in the same episodes."""
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=COUNT, autoreset_mode=AutoresetMode.SAME_STEP, **SHORT)
    envs = beamenv.VectorSensorHistory(envs, length=3)
    return envs, envs.reset(seed=5, options={"elapsed": np.arange(COUNT) * 20 // COUNT})[0]


def actions(step):
    return np.sin(step + np.arange(4.0 * COUNT)).reshape(COUNT, 4)


def test_it_is_a_vec_env_with_spaces_that_hold_what_it_gives():
    envs = batch()
    assert isinstance(envs, VecEnv)
    observations = envs.reset()
    assert observations.shape == (COUNT, *envs.observation_space.shape)
    observations, rewards, ends, infos = envs.step(np.zeros((COUNT, 4), np.float32))
    assert all(envs.observation_space.contains(row) for row in observations)
    assert rewards.shape == ends.shape == (COUNT,)
    assert (rewards.dtype, ends.dtype, len(infos)) == (np.float32, np.bool_, COUNT)


def test_its_episodes_are_those_of_the_gymnasium_batch():
    envs, (plain, expected) = batch(), plain_batch()
    np.testing.assert_array_equal(envs.reset(), expected)
    over = 0
    for step in range(45):
        observations, rewards, ends, infos = envs.step(actions(step))
        expected, reward, terminated, truncated, info = plain.step(actions(step))
        np.testing.assert_array_equal(observations, expected)
        np.testing.assert_allclose(rewards / rewards[0], reward / reward[0], rtol=1e-5)  # one unit for all
        np.testing.assert_array_equal(ends, terminated | truncated)
        for row in np.flatnonzero(ends):
            np.testing.assert_array_equal(infos[row]["terminal_observation"], info["final_obs"][row])
            assert infos[row]["TimeLimit.truncated"]
        over += np.count_nonzero(ends)
    assert over >= 2 * COUNT  # of 20 steps each, the first of them shorter


def test_a_terminal_observation_ends_in_the_voltages_of_the_last_action():
    envs = batch()
    envs.reset()
    for step in range(5):
        observations, _, ends, infos = envs.step(actions(step))
    assert ends.tolist() == [False, False, False, True]
    last = infos[FIRST_TO_END]["terminal_observation"].reshape(3, 8)
    np.testing.assert_allclose(last[-1, 4:], actions(4)[FIRST_TO_END], rtol=1e-6)
    np.testing.assert_array_equal(observations[FIRST_TO_END].reshape(3, 8)[-1, 4:], 0.0)


def test_a_terminal_observation_is_the_last_window_that_next_step_shows():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=COUNT, autoreset_mode=AutoresetMode.NEXT_STEP, **SHORT)
    waiting, at_once = beamenv.VectorSensorHistory(envs, length=3), batch()
    waiting.reset(seed=5, options={"elapsed": np.arange(COUNT) * 20 // COUNT})
    at_once.reset()
    for step in range(5):  # later on the two draw from the generator in another order
        windows, _, _, truncated, _ = waiting.step(actions(step))
        _, _, ends, infos = at_once.step(actions(step))
        np.testing.assert_array_equal(ends, truncated)
    assert truncated[FIRST_TO_END]
    np.testing.assert_array_equal(infos[FIRST_TO_END]["terminal_observation"], windows[FIRST_TO_END])


def test_episodes_end_at_different_steps():
    envs = batch()
    envs.reset()
    ended = {step: np.flatnonzero(envs.step(actions(step))[2]).tolist() for step in range(25)}
    assert {step: rows for step, rows in ended.items() if rows} == {4: [3], 9: [2], 14: [1], 19: [0], 24: [3]}


def test_one_seed_gives_identical_bits_and_another_does_not():
    def run(seed):
        envs = TrainingVecEnv(COUNT, SHORT, seed, history=3, energy_horizon=0.1, shows_state=True)
        return [envs.reset(), *(part for step in range(30) for part in envs.step(actions(step))[:3])]

    first, second, other = run(1), run(1), run(2)
    assert all(one.tobytes() == two.tobytes() for one, two in zip(first, second, strict=True))
    assert first[0].tobytes() != other[0].tobytes()


def test_held_actions_are_steps_of_the_blades_with_their_rewards_added():
    slow, fast = TrainingVecEnv(COUNT, SHORT, 5, history=3, held=2), TrainingVecEnv(COUNT, SHORT, 5, history=3)
    slow.reset()
    elapsed = np.arange(COUNT) * 20 // COUNT // 2 * 2
    fast.envs.reset(seed=5, options={"elapsed": elapsed})
    over = 0
    for step in range(12):
        observations, rewards, ends, infos = slow.step(actions(step))
        halves = [fast.step(actions(step)) for _ in range(2)]
        np.testing.assert_array_equal(observations, halves[1][0])
        np.testing.assert_allclose(rewards, halves[0][1] + halves[1][1], rtol=1e-5)
        np.testing.assert_array_equal(ends, halves[1][2])
        assert not halves[0][2].any()
        for row in np.flatnonzero(ends):
            np.testing.assert_array_equal(infos[row]["terminal_observation"], halves[1][3][row]["terminal_observation"])
        over += np.count_nonzero(ends)
    assert over >= COUNT


def test_wrappers_of_stable_baselines_work_on_top():
    envs = VecMonitor(VecNormalize(batch(), norm_obs=False, norm_reward=False))
    plain = batch()
    np.testing.assert_array_equal(envs.reset(), plain.reset())
    total = np.zeros(COUNT)
    for step in range(5):
        infos = envs.step(actions(step))[3]
        total += plain.step(actions(step))[1]
    assert infos[FIRST_TO_END]["episode"]["l"] == 5
    assert infos[FIRST_TO_END]["episode"]["r"] == pytest.approx(total[FIRST_TO_END], rel=1e-5)
    assert [("episode" in info) for info in infos] == [False, False, False, True]


@pytest.mark.parametrize("elapsed", [20, -1, 1.0, True, "soon", [1, 2], [[0, 0, 0, 0]], None, [0, 0, 0, 20]])
def test_time_elapsed_beyond_the_episode_is_refused_and_nothing_changed(elapsed):
    envs, untouched = (gymnasium.make_vec(beamenv.ENV_ID, num_envs=COUNT, **SHORT) for _ in range(2))
    envs.reset(seed=1)
    untouched.reset(seed=1)
    with pytest.raises(ValueError, match=r"options\['elapsed'\] is .*, but must be integers from 0 to 19, one or 4 of them"):
        envs.reset(seed=2, options={"elapsed": elapsed})
    for step in range(22):
        for one, two in zip(envs.step(actions(step))[:4], untouched.step(actions(step))[:4], strict=True):
            np.testing.assert_array_equal(one, two)


def test_time_elapsed_shortens_the_first_episode_alone():
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=COUNT, autoreset_mode=AutoresetMode.SAME_STEP, **SHORT)
    options = {"elapsed": 17}
    envs.reset(seed=0, options=options)
    assert options == {"elapsed": 17}
    ends = [envs.step(actions(step))[3].all() for step in range(43)]
    assert np.flatnonzero(ends).tolist() == [2, 22, 42]


def test_only_finished_episodes_have_an_info():
    envs = batch()
    envs.reset()
    seen = [envs.step(actions(step))[2:] for step in range(5)]
    assert all(infos is seen[0][1] for _, infos in seen[:4])
    assert seen[0][1] == [{}] * COUNT
    assert [bool(info) for info in seen[4][1]] == seen[4][0].tolist()


def test_a_failed_blade_is_not_truncated():
    weak = {"white_load": 1e6, "sensor_noise_fraction": 0.02}
    envs = TrainingVecEnv(2, {"blade": weak, **SHORT}, seed=0)
    envs.reset()
    _, _, ends, infos = envs.step(np.zeros((2, 4)))
    assert ends.all()
    assert not infos[0]["TimeLimit.truncated"]


def test_stored_energy_counts_as_cost_to_come():
    plain, shaped = batch(), TrainingVecEnv(COUNT, SHORT, seed=5, history=3, energy_horizon=0.1)
    plain.reset()
    shaped.reset()
    blade = shaped.blades.plant.blade_states
    before = 0.5 * (shaped.blades.state[:, :blade] ** 2).sum(axis=1)
    reward = plain.step(actions(0))[1]
    reward_shaped = shaped.step(actions(0))[1]
    after = 0.5 * (shaped.blades.state[:, :blade] ** 2).sum(axis=1)
    gain = reward_shaped - reward
    assert np.all(np.sign(gain) == np.sign(before - after))
    assert np.corrcoef(gain, before - after)[0, 1] > 0.999


def test_what_shaping_adds_over_an_episode_is_the_fall_of_the_potential():
    plain, shaped = batch(), TrainingVecEnv(COUNT, SHORT, seed=5, history=3, energy_horizon=0.1)
    gymnasium_batch, _ = plain_batch()
    plain.reset()
    shaped.reset()
    first, added = 0.5 * (plain.blades.state**2).sum(axis=1), np.zeros(COUNT)
    for step in range(5):
        added += shaped.step(actions(step))[1].astype(np.float64) - plain.step(actions(step))[1]
        info = gymnasium_batch.step(actions(step))[4]
    last = np.where(info["_final_info"], info["final_info"]["energy"], info["energy"])
    fall = REWARD_UNIT * 0.1 / reward_scale(plain.blades.plant) * (first - last)
    np.testing.assert_allclose(added, fall, atol=1e-5 * np.abs(fall).max())


def test_a_critic_may_be_shown_the_state_after_what_the_actor_sees():
    plain, full = batch(), TrainingVecEnv(COUNT, SHORT, seed=5, history=3, shows_state=True)
    windows, observations = plain.reset(), full.reset()
    np.testing.assert_array_equal(observations[:, : full.seen], windows)
    assert observations.shape[1] == full.seen + full.blades.state.shape[1]


def test_attributes_are_the_batch_s_and_cannot_be_set():
    envs = batch()
    assert envs.get_attr("plant", [0, 1]) == [envs.blades.plant] * 2
    assert envs.env_is_wrapped(gymnasium.Wrapper) == [False] * COUNT
    with pytest.raises(NotImplementedError, match="one environment"):
        envs.set_attr("duration", 1.0)


def test_the_plain_vec_env_steps_as_the_batch_it_wraps():
    plain, batch = beamenv.BladeVecEnv(3, seed=5, duration=0.002), gymnasium.make_vec(beamenv.ENV_ID, num_envs=3, duration=0.002)
    np.testing.assert_array_equal(plain.reset(), batch.reset(seed=5)[0])
    for step in range(4):
        observations, rewards, ends, infos = plain.step(np.full((3, 4), 0.1))
        expected = batch.step(np.full((3, 4), 0.1))
        assert ends.all() == (step == 3)
    np.testing.assert_allclose(rewards, expected[1], rtol=1e-6)
    np.testing.assert_array_equal(infos[1]["terminal_observation"], expected[0][1])
    assert infos[0]["TimeLimit.truncated"]


def test_options_reach_the_next_reset_and_no_other():
    envs = batch()
    state = np.zeros(envs.blades.state.shape[1])
    state[0] = 1e-4
    envs.set_options([{}, {"initial_state": state}, {}, {}])
    envs.reset()
    np.testing.assert_allclose(envs.blades.state[1], state, atol=1e-12)
    assert envs.reset_infos[1]["energy"] == pytest.approx(0.5e-8)
    ends = [envs.step(actions(step))[2] for step in range(5)]
    assert ends[-1].tolist() == [False, False, False, True]  # still out of step with one another
    envs.seed(5)
    np.testing.assert_array_equal(envs.reset(), batch().reset())


def test_options_reach_every_batch_side_by_side():
    envs = SideBySide([batch(), TrainingVecEnv(2, SHORT, seed=6, history=3)])
    state = np.zeros(envs.batches[1].blades.state.shape[1])
    state[0] = 1e-4
    envs.set_options([{}] * (COUNT + 1) + [{"initial_state": state}])
    envs.reset()
    np.testing.assert_allclose(envs.batches[1].blades.state[1], state, atol=1e-12)
    assert envs.reset_infos[-1]["energy"] == pytest.approx(0.5e-8)
    with pytest.raises(ValueError, match=f"^options is .*, or a list of {COUNT + 2} of them"):
        envs.set_options([{}])
