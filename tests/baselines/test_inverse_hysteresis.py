"""A linear law behind the inverse of its actuators' hysteresis: what acts is what it asks for, on paper and on the blade."""

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import full_order_lqg, inverse_hysteresis, lqg, no_control, roll_out
from beamenv.simulation.signals.hysteresis import prandtl_ishlinskii

SMALL = {"model": "thesis", "modes": 3, "beam": {"terms": 4}}
STILL = {"preset": "step", "white_load": False, "sensor_noise": False, "magnitude": 2.0}


def made(loop, num_envs=4, **scenario):
    return gymnasium.make_vec(
        beamenv.ENV_ID,
        num_envs=num_envs,
        scenario={**STILL, "drive": {"hysteresis": loop}, **scenario},
        dtype="float64",
        blade=SMALL,
        duration=0.1,
    )


def test_a_voltage_that_is_inverted_acts_as_wanted():
    operator, generator = prandtl_ishlinskii(0.2, -1.0 / 3.0, 1.0), np.random.default_rng(0)
    plays = np.zeros((50, 4, 8))
    low, high = np.full(4, -1.0 / 3.0), np.ones(4)
    for _ in range(20):
        wanted = generator.uniform(-0.1, 0.3, (50, 4))
        voltage = operator.inverse(wanted, plays, low, high)
        acting, plays = operator.step(voltage, plays)
        inside = (voltage > low + 1e-6) & (voltage < high - 1e-6)
        assert np.abs(acting - wanted)[inside].max() < 1e-9
        assert inside.mean() > 0.5


@pytest.mark.parametrize("loop", [0.05, 0.5])
def test_what_acts_along_a_random_path_is_what_the_law_asks_for(small_plant, loop):
    """Kuhnen's test, H[H⁻¹[w]] = w, with the operator fed from outside: by the law's actions alone."""
    plant, generator = small_plant(), np.random.default_rng(1)
    law = full_order_lqg(plant)
    inverted, operator = inverse_hysteresis(law, loop), prandtl_ishlinskii(loop, -1.0 / 3.0, 1.0)
    memory = own = None
    plays, seen, free = np.zeros((8, 2, 8)), np.zeros((8, 2)), np.ones(8, dtype=bool)
    for _ in range(60):
        seen = 0.9 * seen + 0.001 * generator.normal(size=(8, 2))
        wanted, own = law.predict(seen, own)
        action, memory = inverted.predict(seen, memory)
        acting, plays = operator.step(action, plays)
        free &= ((action > -1.0 / 3.0 + 1e-9) & (action < 1.0 - 1e-9)).all(axis=1)  # at a limit their ways part
        assert np.abs(acting - wanted)[free].max() < 1e-9
    assert free.sum() > 4
    assert np.abs(action - wanted).max() > 1e-3


def test_a_blade_with_hysteresis_moves_as_without_it_under_the_inverse():
    plain, warped = made(1e-12), made(0.2)  # of another drive, episodes would draw other loads
    law = lqg(plain.unwrapped.plant)
    without, inverted, blind = (
        roll_out(each, envs, range(4)).tip_displacement
        for each, envs in ((law, plain), (inverse_hysteresis(law, 0.2), warped), (law, warped))
    )
    size = np.abs(without).max()
    assert np.abs(inverted - without).max() < 1e-8 * size
    assert np.abs(blind - without).max() > 1e-2 * size


def test_at_the_limits_what_acts_comes_as_near_as_it_can(small_plant):
    plant = small_plant()
    inverted = inverse_hysteresis(full_order_lqg(plant), 0.2)
    actions = [inverted.predict(np.array([sign, sign]))[0] for sign in (1.0, -1.0)]
    low, high = plant.voltage_limits / np.abs(plant.voltage_limits).max(axis=0)
    for action in actions:
        assert ((action >= low) & (action <= high)).all()
    assert np.isclose(actions, high, atol=1e-9).any()
    assert np.isclose(actions, low, atol=1e-9).any()


def test_without_a_loop_it_is_the_law_itself(small_plant):
    plant, seen = small_plant(), 0.1 * np.random.default_rng(2).normal(size=(20, 3, 2))
    law = full_order_lqg(plant)
    memories = [None, None]
    for each in seen:
        (one, memories[0]), (other, memories[1]) = (
            made.predict(each, memory) for made, memory in zip((law, inverse_hysteresis(law, 0.0)), memories, strict=True)
        )
        assert one == pytest.approx(other, abs=1e-10)


def test_in_physical_units_it_asks_for_the_same(small_plant):
    plant = small_plant()
    inverted, reading = inverse_hysteresis(full_order_lqg(plant), 0.2), np.array([0.02, -0.01])
    action, _ = inverted.predict(reading)
    volts, _ = inverted.in_physical_units().predict(reading * plant.sensor_full_scale)
    assert volts == pytest.approx(1500.0 * action, rel=1e-9)


def test_what_is_no_linear_law_and_what_is_no_loop_are_refused(small_plant):
    with pytest.raises(ValueError, match="^law is None, but must be a LinearController"):
        inverse_hysteresis(None, 0.1)
    with pytest.raises(ValueError, match="^loop is 0.6, but must be"):
        inverse_hysteresis(no_control(small_plant()), 0.6)
