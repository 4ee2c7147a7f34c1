"""An LQG that a neural network augments: what it is without the network, what bounds it, and what it is good for."""

import pickle
from contextlib import closing

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import AdaptationSettings, adaptive_neural, evaluate, full_order_lqg, lqr, no_control, reference_lqg
from baselines.evaluation.loop import instants
from train.shared.held_out import validation


def driven(law, readings, switch=None):
    """Actions (T, N, m) on given readings (T, N, p), off before the instant ``switch`` and on after it, or the other way round."""
    memory, actions, memories = None, [], []
    for instant, seen in enumerate(readings):
        now = law if switch is None else law.switched((instant < switch[0]) == switch[1])
        action, memory = now.predict(seen, memory)
        actions.append(action)
        memories.append(memory)
    return np.array(actions), memories


@pytest.fixture(scope="module")
def readings():
    """Slow and fast, and beyond full scale."""
    time = np.arange(300)[:, None, None]
    phases = np.random.default_rng(0).uniform(0.0, 6.0, (1, 5, 2))
    return 0.8 * np.sin(0.09 * time + phases) + 0.5 * np.sin(0.7 * time + 2.0 * phases)


def test_switched_off_it_is_its_base_to_the_last_bit(small_plant, readings):
    base = reference_lqg(small_plant(), order=4)
    law = adaptive_neural(small_plant(), base).switched(False)
    np.testing.assert_array_equal(driven(law, readings)[0], driven(base, readings)[0])


def test_that_learns_nothing_is_its_base_to_the_last_bit(small_plant, readings):
    base = full_order_lqg(small_plant())
    law = adaptive_neural(small_plant(), base, AdaptationSettings(outer_rate=0.0, inner_rate=0.0))
    np.testing.assert_array_equal(driven(law, readings)[0], driven(base, readings)[0])


def test_the_adaptive_voltage_and_the_weights_stay_within_their_bounds(small_plant, readings):
    settings = AdaptationSettings(authority=0.2, outer_bound=1.0, inner_bound=0.3)
    law = adaptive_neural(small_plant(), settings=settings)
    adaptations = [law.adaptation(memory) for memory in driven(law, 10.0 * readings)[1]]
    efforts = np.array([each.effort for each in adaptations])
    assert efforts.max() == pytest.approx(0.2) and efforts[0].max() == 0.0
    assert max(each.outer_norm.max() for each in adaptations) == pytest.approx(1.0)
    assert max(each.inner_norm.max() for each in adaptations) <= 0.3 + 1e-9
    assert min(each.error_energy.min() for each in adaptations) >= 0.0


@pytest.mark.parametrize("on_first", [True, False])
def test_switching_in_mid_episode_makes_no_jump(small_plant, readings, on_first):
    """At the instant itself the voltage is what it would have been; off, it comes back to the base's."""
    law, slow = adaptive_neural(small_plant()), 0.2 * readings
    switched, memories = driven(law, slow, (150, on_first))
    unswitched, _ = driven(law.switched(on_first), slow)
    np.testing.assert_array_equal(switched[:151], unswitched[:151])
    assert np.abs(switched[151] - unswitched[151]).max() < 0.02  # of a drive of which the network has half
    efforts = [law.adaptation(memory).effort.max() for memory in memories]
    before, after = efforts[149], efforts[-1]
    assert (before > 0.4 and after < 0.02 * before) if on_first else (before == 0.0 and after > 0.4)


def test_a_batch_is_its_blades_one_by_one_and_in_volts_the_same(small_plant, readings):
    law = adaptive_neural(small_plant())
    together = driven(law, readings)[0]
    alone = driven(law, readings[:, 2])[0]
    np.testing.assert_allclose(alone, together[:, 2], rtol=1e-9, atol=1e-12)
    scales = law.instruments
    volts = driven(law.in_physical_units(), readings * scales.measurement_scale)[0]
    np.testing.assert_allclose(volts, together * scales.voltage_scale, rtol=1e-9, atol=1e-9)


def test_unpickled_as_by_another_process_it_is_the_same_law(small_plant, readings):
    law = adaptive_neural(small_plant())
    copied = pickle.loads(pickle.dumps(law))
    np.testing.assert_array_equal(driven(copied, readings)[0], driven(law, readings)[0])


def test_of_no_blades_it_decides_nothing(small_plant):
    law = adaptive_neural(small_plant())
    action, memory = law.predict(np.zeros((0, 2)))
    assert action.shape == (0, 2) and law.adaptation(memory).effort.shape == (0,)


@pytest.mark.parametrize("on", [None, 1, "on"])
def test_what_is_neither_on_nor_off_is_refused(small_plant, on):
    with pytest.raises(ValueError, match="on is .*, but must be True or False"):
        adaptive_neural(small_plant()).switched(on)


def test_a_plant_without_modes_of_its_own_learns_voltages(scalar_plant, readings):
    law = adaptive_neural(scalar_plant())
    assert law.model.force_input.shape == (1, 1)
    assert np.isfinite(driven(law, readings[..., :1])[0]).all()


@pytest.mark.parametrize("scenario", ["failure", "overload", "delay"])
def test_its_voltages_are_finite_whatever_is_broken(scenario):
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4, scenario=scenario, dtype="float64", duration=0.1)
    law = adaptive_neural(envs.unwrapped.design.full_plant)
    for instant in instants(law, envs, range(4)):
        assert np.isfinite(instant.observation).all()
        assert np.isfinite(instant.info.get("volts", np.zeros(1))).all()
    envs.close()


@pytest.mark.slow
def test_on_the_design_it_costs_within_two_per_cent_of_its_base():
    with closing(gymnasium.make_vec(beamenv.ENV_ID, num_envs=32, dtype="float64")) as envs:
        plant = envs.unwrapped.design.full_plant
        base = evaluate(reference_lqg(plant), envs, seeds=validation(32))
        law = evaluate(adaptive_neural(plant), envs, seeds=validation(32), reference=base.reference)
    assert law.relative_cost.value < 1.02 * base.relative_cost.value


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ({"base": "lqg"}, "base is 'lqg', but must be"),
        ({"settings": {"hidden": 3}}, "settings is .*, but must be None or an AdaptationSettings"),
    ],
)
def test_what_is_no_base_or_no_settings_is_refused(small_plant, arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        adaptive_neural(small_plant(), **arguments)


def test_a_base_of_other_instruments_is_refused(small_plant):
    plant = small_plant()
    for base in (lqr(plant), no_control(small_plant(control_interval=1e-3))):
        with pytest.raises(ValueError, match="base has another .* than the plant"):
            adaptive_neural(plant, base)


@pytest.mark.parametrize(
    "wrong", [{"hidden": 0}, {"outer_rate": -1.0}, {"authority": 0.0}, {"forgetting": 1.0}, {"inner_rate": 2.0}, {"seed": -1}]
)
def test_settings_out_of_range_are_refused(wrong):
    with pytest.raises(ValueError, match=f"adaptation.{next(iter(wrong))} is "):
        AdaptationSettings(**wrong)


def test_a_memory_that_is_not_its_own_is_refused(small_plant):
    with pytest.raises(ValueError, match="memory has shape"):
        adaptive_neural(small_plant()).adaptation(np.zeros(3))
