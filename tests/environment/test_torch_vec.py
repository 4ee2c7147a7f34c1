"""The batch of tensors: NumPy's episodes of equal seeds, the same distribution of its own, and Gymnasium's rules."""

import copy

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamVectorEnv
from beamenv.arrays import Arrays
from tests.environment.test_vector_env import BRITTLE

torch = pytest.importorskip("torch")

COUNT, DURATION = 7, 0.03
SHARES = {"float64": 1e-10, "float32": 1e-4}


def batch_of(count=COUNT, **arguments):
    return beamenv.torch_vec(count, device="cpu", **{"duration": DURATION, **arguments})


def acting(steps, count=COUNT):
    random = np.random.default_rng(1)
    return [random.uniform(-1.2, 1.2, (count, 4)) for _ in range(steps)]


def assert_alike(ours, theirs, share, largest):
    """Each tensor within a share of the largest number that its name has had; masked entries are left out."""
    further = {name: mask for name, mask in ours.items() if name.startswith("_") and name not in theirs}
    assert not any(mask.any() for mask in further.values()), list(further)
    for name, value in theirs.items():
        if isinstance(value, dict):
            assert_alike(ours[name], value, share, largest)
        elif name.startswith("_") and name not in ("_note", "_assumed"):
            np.testing.assert_array_equal(ours[name].numpy(), value, err_msg=name)
        elif not name.startswith("_") and name not in ("note", "assumed"):
            rows = theirs.get(f"_{name}", np.ones(len(value), bool))
            expected = np.stack(value[rows]) if rows.any() else np.zeros(0)
            largest[name] = max(largest.get(name, 0.0), np.abs(expected).max(initial=0.0))
            np.testing.assert_allclose(ours[name].numpy()[rows], expected, rtol=0, atol=share * largest[name], err_msg=name)


def told(returned):
    names = ("observation", "reward", "terminated", "truncated")
    first, *between, info = returned
    return {**info, **dict(zip(names, (first, *between), strict=False))}


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize(
    ("scenario", "dtype"),
    [
        ("nominal", "float64"),
        ("nominal", "float32"),
        (BRITTLE, "float64"),  # readings a hundred full scales large, were they not clipped: 32 bits do not tell their small ones
        ("mid-failure", "float64"),
        ("mid-failure", "float32"),
        ({"plants": {"speed_ratio": [0.8, 1.2], "bank": 4}}, "float64"),
        ({"plants": {"speed_ratio": [0.8, 1.2], "bank": 4}}, "float32"),
        ({"preset": "heat", "plants": {"bank": 4, "drift_onset": 0.0, "drift_duration": 0.02}}, "float64"),
        ({"preset": "heat", "plants": {"bank": 4, "drift_onset": 0.0, "drift_duration": 0.02}}, "float32"),
    ],
    ids=str,
)
def test_a_seed_for_each_blade_gives_the_episodes_of_numpy(scenario, dtype, mode):
    arguments = {"scenario": scenario, "duration": DURATION, "autoreset_mode": mode}
    ours, theirs = batch_of(dtype=dtype, **arguments), RotatingBeamVectorEnv(COUNT, dtype="float64", **arguments)
    seeds, largest = list(range(50, 50 + COUNT)), {}
    assert_alike(told(ours.reset(seed=seeds)), told(theirs.reset(seed=seeds)), SHARES[dtype], largest)
    ended = 0
    for actions in acting(150):
        returned = theirs.step(actions)
        assert_alike(told(ours.step(torch.tensor(actions))), told(returned), SHARES[dtype], largest)
        ended += (returned[2] | returned[3]).sum()
    assert ended >= 2 * COUNT


def test_a_generator_waits_while_its_blade_rests():
    """The noise of 64 intervals is drawn at a time: where episodes end just before, the resting step is the one to draw more."""
    arguments = {"duration": 0.1, "max_episode_steps": 63}
    ours, theirs = batch_of(dtype="float64", **arguments), RotatingBeamVectorEnv(COUNT, dtype="float64", **arguments)
    seeds, largest = list(range(COUNT)), {}
    assert_alike(told(ours.reset(seed=seeds)), told(theirs.reset(seed=seeds)), 1e-10, largest)
    for actions in acting(70):
        assert_alike(told(ours.step(torch.tensor(actions))), told(theirs.step(actions)), 1e-10, largest)


def episode(envs, seed, steps=80):
    first, _ = envs.reset(seed=seed)
    return [first, *(envs.step(torch.tensor(0.02 * actions))[0] for actions in acting(steps))]  # full voltages clip readings


def test_one_seed_gives_the_same_episodes_again_and_another_gives_others():
    first, second, other = (episode(batch_of(), seed) for seed in (7, 7, 8))
    assert all(torch.equal(one, two) for one, two in zip(first, second, strict=True))
    assert not any(torch.equal(one, two) for one, two in zip(first, other, strict=True))


def test_seeds_that_differ_beyond_64_bits_differ():
    assert not torch.equal(batch_of().reset(seed=3)[0], batch_of().reset(seed=3 + 2**64)[0])


def test_a_reset_without_a_seed_goes_on_with_the_generator():
    envs = batch_of()
    first, _ = envs.reset(seed=7)
    second, _ = envs.reset()
    again, _ = envs.reset(seed=7)
    assert torch.equal(first, again)
    assert not torch.equal(first, second)
    assert envs.np_random_seed == 7


@pytest.mark.parametrize("dtype", ["float64", "float32"])
def test_spaces_and_tensors_have_the_numbers_that_were_asked_for(dtype):
    envs = batch_of(dtype=dtype)
    observation, _ = envs.reset(seed=0)
    observation, reward, terminated, truncated, info = envs.step(envs.action_space.sample())
    assert envs.observation_space.dtype == np.dtype(dtype)
    assert envs.observation_space.contains(observation.numpy())
    for each in (observation, reward, info["energy"], info["volts"]):
        assert each.dtype == getattr(torch, dtype)
    assert terminated.dtype == truncated.dtype == info["_energy"].dtype == torch.bool
    assert not reward.requires_grad


@pytest.fixture(params=["rows", "masks"])
def looking(request, monkeypatch):
    """Batches that look which episodes are over, as on the processor, and such that do not, as on a GPU."""
    if request.param == "masks":
        monkeypatch.setattr(Arrays, "on_host", property(lambda arrays: arrays.of_numpy))


CERTAIN = {"white_load": False, "sensor_noise": False, "step": 1.0, "pulse": 0.0, "deflection": 0.0, "harmonic": 0.0}
CERTAIN |= {"direction_deg": [40.0, 40.0], "onset": [0.001, 0.001]}


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("load", [30.0, 6000.0], ids=["truncated", "terminated"])
@pytest.mark.usefixtures("looking")
def test_what_is_certain_happens_as_it_does_to_the_batch_of_numpy(mode, load):
    arguments = {"scenario": {**CERTAIN, "magnitude": [load, load]}, "duration": DURATION, "autoreset_mode": mode}
    ours, theirs = batch_of(dtype="float64", **arguments), RotatingBeamVectorEnv(COUNT, dtype="float64", **arguments)
    options, largest, ended = {"elapsed": np.arange(COUNT) * 5}, {}, 0
    assert_alike(told(ours.reset(seed=1, options=options)), told(theirs.reset(seed=1, options=options)), 1e-10, largest)
    for actions in acting(150):
        returned = theirs.step(actions)
        assert_alike(told(ours.step(torch.tensor(actions))), told(returned), 1e-10, largest)
        ended += (returned[2] if load > 1000.0 else returned[3]).sum()
    assert ended >= 2 * COUNT


@pytest.mark.usefixtures("looking")
def test_episodes_end_at_the_time_limit():
    envs = batch_of(max_episode_steps=4, autoreset_mode="SameStep")
    envs.reset(seed=0)
    ends = [envs.step(torch.zeros(COUNT, 4))[3].all().item() for _ in range(9)]
    assert ends == [False, False, False, True] * 2 + [False]


def test_a_masked_reset_leaves_the_other_blades_alone():
    envs, mask = batch_of(autoreset_mode="Disabled"), np.arange(COUNT) < 3
    envs.reset(seed=0)
    seen = envs.step(torch.zeros(COUNT, 4))[0]
    shown, info = envs.reset(options={"reset_mask": torch.tensor(mask)})
    assert torch.equal(shown[3:], seen[3:])
    assert not torch.isclose(shown[:3], seen[:3]).all()
    np.testing.assert_array_equal(info["_energy"].numpy(), mask)


def test_blades_that_have_ended_must_begin_again_before_a_step():
    envs = batch_of(max_episode_steps=1, autoreset_mode="Disabled")
    envs.reset(seed=0)
    envs.step(torch.zeros(COUNT, 4))
    with pytest.raises(gymnasium.error.ResetNeeded, match="ended"):
        envs.step(torch.zeros(COUNT, 4))


def test_blades_that_began_again_by_a_mask_may_step():
    envs, mask = batch_of(max_episode_steps=1, autoreset_mode="Disabled"), np.arange(COUNT) < 3
    envs.reset(seed=0)
    envs.step(torch.zeros(COUNT, 4))
    envs.reset(options={"reset_mask": mask})
    with pytest.raises(gymnasium.error.ResetNeeded, match=r"blades \[3, 4, 5, 6\]"):
        envs.step(torch.zeros(COUNT, 4))
    envs.reset(options={"reset_mask": ~mask})
    envs.step(torch.zeros(COUNT, 4))


@pytest.mark.parametrize("scenario", ["nominal", "mid-failure", {"rotor": {"turbulence": 5.0}}, "hysteresis"])
def test_an_equal_batch_goes_on_bit_for_bit_from_a_state(scenario):
    first, second = (batch_of(scenario=scenario) for _ in range(2))
    episode(first, 1, 33)
    episode(second, 2, 5)
    second.load_state_dict(first.state_dict())
    copied = copy.deepcopy(first)
    for actions in acting(40):
        one, *others = (envs.step(torch.tensor(actions, dtype=torch.float32)) for envs in (first, second, copied))
        for other in others:
            assert torch.equal(one[0], other[0]) and torch.equal(one[1], other[1]) and torch.equal(one[3], other[3])


def second_episodes(envs, count, zeros):
    """Of each blade's second episode: J without control, energy at the start, load at the start and half-way, and the truth."""
    envs.reset(seed=11)
    steps, cost, half = envs.steps, np.zeros(count), None
    for _ in range(steps):
        *_, info = envs.step(zeros)
    energy, begins, truth = info["energy"], envs.coming_loads, envs.episode_truth
    for k in range(steps):
        *_, info = envs.step(zeros)
        cost += np.asarray((info if k < steps - 1 else info["final_info"])["cost_increment"])
        half = envs.coming_loads if k == steps // 2 else half
    return [np.asarray(each, dtype=np.float64) for each in (cost, energy, begins, half, truth)]


MANY, SMALL = 1000, {"modes": 4, "truth_modes": 4, "beam": {"terms": 8}}


@pytest.mark.usefixtures("looking")
def test_what_a_device_draws_has_the_distribution_of_what_numpy_draws():
    scenario = {"drive": {"delay": [0, 3]}, "failures": {"dead_actuators": 1, "faulty_sensors": 1}, "white_load": False}
    made = {"scenario": {**scenario, "plants": {"speed_ratio": [0.8, 1.2], "bank": 3}}, "duration": 0.02, "blade": SMALL}
    made["autoreset_mode"] = "SameStep"
    ours = second_episodes(batch_of(MANY, **made), MANY, torch.zeros(MANY, 4))
    theirs = second_episodes(RotatingBeamVectorEnv(MANY, **made), MANY, np.zeros((MANY, 4)))
    for mine, other in zip(ours, theirs, strict=True):  # medians too, for J has a long tail
        median = np.median(other, axis=0)
        for one, two in ((mine, other), (mine**2, other**2), (mine > median, other > median), (mine == 0.0, other == 0.0)):
            error = np.sqrt((one.var(axis=0) + two.var(axis=0)) / MANY)
            assert np.all(np.abs(one.mean(axis=0) - two.mean(axis=0)) <= 4.0 * error)
    assert ours[-1][:, 1].max() == 3.0 and set(ours[-1][:, 0]) == {0.0, 1.0, 2.0}


def noises(envs, zeros):
    """(N, 12): line loads and readings of each blade at the first two instants, where nothing acts but noise."""
    first, _ = envs.reset(seed=3)
    loads = envs.coming_loads
    second, *_ = envs.step(zeros)
    return np.column_stack([np.asarray(each, dtype=np.float64) for each in (loads, envs.coming_loads, first, second)])


def test_the_noise_of_a_device_has_the_strength_of_numpy_s_and_is_another_for_each_blade_and_instant():
    noisy = {**CERTAIN, "white_load": True, "sensor_noise": True, "magnitude": [0.0, 0.0]}
    made = {"scenario": noisy, "duration": 0.02, "blade": SMALL}
    ours = noises(batch_of(MANY, **made), torch.zeros(MANY, 4))
    theirs = noises(RotatingBeamVectorEnv(MANY, **made), np.zeros((MANY, 4)))
    assert theirs.std(axis=0).min() > 0.0
    for one, two in ((ours, theirs), (ours**2, theirs**2)):
        error = np.sqrt((one.var(axis=0) + two.var(axis=0)) / MANY)
        assert np.all(np.abs(one.mean(axis=0) - two.mean(axis=0)) <= 4.0 * error)
    correlation = np.corrcoef(ours[:, :4].T) - np.eye(4)  # of loads with those of the next instant, and of blades with the next
    assert np.abs(correlation).max() < 4.0 / np.sqrt(MANY)
    assert abs(np.corrcoef(ours[:-1, 0], ours[1:, 0])[0, 1]) < 4.0 / np.sqrt(MANY)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("num_envs", 0),
        ("device", "mps"),
        ("device", "cuda:99"),
        ("device", "gpu"),
        ("device", 0),
        ("dtype", "float16"),
        ("dtype", torch.float16),
        ("differentiable", "no"),
        ("autoreset_mode", "never"),
        ("max_episode_steps", 0),
    ],
)
def test_a_wrong_argument_is_named_in_one_sentence(name, value):
    with pytest.raises(ValueError, match=rf"^{name} is .*, but must be [^\n]*\.$"):
        beamenv.torch_vec(**{"num_envs": 2, name: value})


@pytest.mark.parametrize(
    ("actions", "told"),
    [
        (torch.zeros(COUNT, 3), "shape"),
        (np.zeros((1, 4)), "shape"),
        (torch.zeros(COUNT, 4, device="meta"), "on meta"),
        (torch.full((COUNT, 4), torch.nan), r"action\[0, 0\] is nan"),
        (torch.zeros(COUNT, 4, dtype=torch.bool), "real numbers"),
        (None, "real numbers"),
    ],
)
def test_wrong_actions_are_refused_and_nothing_moves(actions, told):
    envs, other = batch_of(), batch_of()
    envs.reset(seed=0)
    other.reset(seed=0)
    with pytest.raises(ValueError, match=told):
        envs.step(actions)
    assert torch.equal(envs.step(torch.zeros(COUNT, 4))[0], other.step(torch.zeros(COUNT, 4))[0])


def test_a_step_before_a_reset_is_refused():
    with pytest.raises(gymnasium.error.ResetNeeded):
        batch_of().step(torch.zeros(COUNT, 4))
