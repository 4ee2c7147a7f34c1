"""True plants beside the design's: what varies does what it must, and every plant is that of its configuration."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import lqg
from baselines.analysis.stationary import closed_loop_poles
from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.blade.build import Blade, build_plant
from beamenv.blade.changed import changed_blade
from beamenv.blade.presets import blade_config
from beamenv.plant.plant import normalised
from beamenv.scenarios.load_cases import static_deflection
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.scenarios.tables import PlantVariation
from beamenv.simulation.kernel import Operators, advance
from beamenv.simulation.plants.banks import build_bank, varied
from beamenv.task import resolve_task

CONFIG = blade_config()


def assert_steps_like(bank, k, plant):
    """The bank's step, in its own axes, is that of the plant in its own: state, reading, tip and cost of random blades."""
    plain, turned = Operators.from_plant(normalised(plant)), bank.operators if len(bank) == 1 else bank.operators.pick(k)
    z = np.random.default_rng(0).normal(size=(5, len(plant.A) + 6)) * 1e-2
    z[:, -6:] *= 100.0
    n = len(plant.A)
    moved = np.hstack([z[:, :n] @ bank.axes[k].T, z[:, n:]])
    expected, (state, *found) = advance(plain, z), advance(turned, moved)
    for ours, theirs in zip([state @ bank.axes[k], *found], expected, strict=True):
        np.testing.assert_allclose(ours, theirs, rtol=1e-10, atol=1e-12 * np.abs(theirs).max())


@pytest.mark.parametrize("name", ["off-speed", "off-model"])
def test_a_plant_of_a_bank_is_that_of_its_configuration(name):
    variation = replace(SCENARIOS[name].plants, bank=6)
    bank = build_bank(Blade(CONFIG), Blade(CONFIG), variation, 1000)
    assert len(bank) == 6
    blade = Blade(CONFIG)
    fixed = {"sensor_full_scale": float(blade.plant.sensor_full_scale[0]), "truth_modes": len(blade.truth.natural_frequencies)}
    for k, row in enumerate(varied(variation, CONFIG)):
        config = changed_blade(replace(CONFIG, **fixed), *row)
        plant = Blade(config).truth
        assert_steps_like(bank, k, plant)
        np.testing.assert_allclose(bank.release[k] @ bank.axes[k], static_deflection(plant, np.eye(2)), rtol=1e-9, atol=1e-15)
        np.testing.assert_allclose(bank.axes[k].T @ bank.tip[k], plant.tip_displacement.T, rtol=1e-9, atol=1e-15)
        assert bank.speeds[k] == config.speed
        assert plant.control_interval == bank.plant.control_interval
        np.testing.assert_array_equal(plant.sensor_full_scale, bank.plant.sensor_full_scale)


def test_patches_without_mass_and_stiffness_leave_frequencies_to_the_laminate():
    """ω ~ √(modulus/density) of a blade at rest, for every mode."""
    bare = replace(CONFIG, speed=0.0, patches=replace(CONFIG.patches, passive=False))
    nominal = build_plant(bare).natural_frequencies
    stiffer = build_plant(changed_blade(bare, 1.0, 1.0, 1.21, 1.0, 0.01)).natural_frequencies
    heavier = build_plant(changed_blade(bare, 1.0, 1.0, 1.0, 1.44, 0.01)).natural_frequencies
    np.testing.assert_allclose(stiffer / nominal, 1.1, rtol=1e-8)
    np.testing.assert_allclose(heavier / nominal, 1.0 / 1.2, rtol=1e-8)


def test_sums_of_squared_frequencies_are_concave_in_the_squared_speed():
    """Ky Fan: K_e + Ω² K_Ω, linear in Ω² in the thesis' world, has ω₁² + … + ω_k² above its chord for every k; bending stiffens."""
    thesis = replace(CONFIG, model="thesis")
    slow, design, fast = (
        build_plant(changed_blade(thesis, ratio, 1.0, 1.0, 1.0, 0.01)).natural_frequencies for ratio in (0.7, 1, 1.3)
    )
    share = (1.0 - 0.7**2) / (1.3**2 - 0.7**2)
    chord = (1.0 - share) * np.cumsum(slow**2) + share * np.cumsum(fast**2)
    assert np.all(np.cumsum(design**2) > chord)
    assert np.all(((slow < design) & (design < fast))[:6])


def test_every_stratum_of_the_latin_hypercube_is_hit_once():
    variation = replace(SCENARIOS["off-model"].plants, speed_ratio=(0.7, 1.3), bank=64, seed=3)
    rows = varied(variation, CONFIG)
    ranges = [(0.7, 1.3), (0.9, 1.1), (0.9, 1.1), (0.9, 1.1)]
    columns = [(rows[:, k] - low) / (high - low) for k, (low, high) in enumerate(ranges)]
    columns.append(np.log(rows[:, 4] / 0.003) / np.log(0.02 / 0.003))  # damping on a logarithmic scale
    for column in columns:
        assert sorted(np.floor(64 * column).astype(int)) == list(range(64))
    assert np.abs(np.corrcoef(np.array(columns)) - np.eye(5)).max() < 0.4
    assert not np.array_equal(rows, varied(replace(variation, seed=4), CONFIG))
    np.testing.assert_array_equal(rows, varied(variation, CONFIG))


def test_a_bank_of_what_does_not_vary_is_one_plant():
    bank = build_bank(Blade(CONFIG), Blade(CONFIG), PlantVariation(), 1000)
    assert len(bank) == 1
    assert_steps_like(bank, 0, Blade(CONFIG).truth)
    design = bank.axes[0].T @ bank.to_design[0]
    own, modes = np.zeros_like(design), len(bank.plant.natural_frequencies)  # of its modes the 11 of the design
    own[:11, :11] = own[modes : modes + 11, 11:] = np.eye(11)
    np.testing.assert_allclose(np.abs(design), own, atol=1e-9)  # the sign of a mode shape is no property


def test_the_tachometer_shows_the_speed_of_the_plant_that_moves():
    envs = RotatingBeamVectorEnv(200, scenario="off-speed")
    envs.reset(seed=0)
    assert envs.rotor_speed.min() < 150.0
    assert envs.rotor_speed.max() > 250.0
    assert np.all((envs.rotor_speed >= 140.0) & (envs.rotor_speed <= 260.0))
    assert envs.rotor_speed.mean() == pytest.approx(200.0, abs=4.0 * 35.0 / np.sqrt(200))


@pytest.mark.parametrize("name", ["off-speed", "off-model", "spillover", "spin-up"])
def test_the_design_sees_the_displacements_of_the_true_blade(name):
    """The tip by the design's coordinates is the true tip, as far as the design's modes can tell."""
    env = RotatingBeamEnv(scenario={"preset": name, "plants": {"bank": 6}})
    env.reset(seed=5, options={"load": {"case": "step", "magnitude": 30.0, "onset": 0.0}})
    seen, true = [], []
    for _ in range(300):
        *_, info = env.step(np.zeros(4))
        seen.append(env.design_plant.tip_displacement @ env.design_state)
        true.append(info["tip_displacement"])
    assert np.abs(np.array(seen) - true).max() < 0.01 * np.abs(true).max()


def spillover():
    task = resolve_task(scenario="spillover")
    return task.plant, task.design_plant


def test_design_and_truth_share_their_first_modes():
    true, design = spillover()
    assert len(design.A) == 10
    assert true.natural_frequencies[-1] > 0.8 * np.pi / true.control_interval
    np.testing.assert_allclose(design.natural_frequencies, true.natural_frequencies[:5], rtol=1e-9)


def test_five_mode_lqg_spills_over_into_the_modes_it_does_not_know():
    """The sampled loop is stable on the plant it was designed for; on the true one poles beyond the fifth mode grow."""
    true, design = spillover()
    assert closed_loop_poles(design, lqg(design)).real.max() < 0.0
    growing = [pole for pole in closed_loop_poles(true, lqg(design)) if pole.real > 10.0]
    assert sum(abs(pole.imag) > true.natural_frequencies[4] for pole in growing) >= 4
    assert closed_loop_poles(true, lqg(true)).real.max() < 0.0


def test_on_the_true_blade_five_mode_lqg_is_worse_than_none():
    """J of 16 short episodes some three times that of the blade left alone, LQG of all modes and the electronics below it."""
    costs = {}
    for name, controller in (("none", None), ("five", lqg(spillover()[1])), ("all", lqg(spillover()[0]))):
        envs = RotatingBeamVectorEnv(16, scenario="spillover", duration=0.25)
        observation, _ = envs.reset(seed=list(range(16)))
        state, action, total = None, np.zeros((16, 4)), 0.0
        for k in range(499):
            if controller is not None:
                action, state = controller.predict(observation, state, np.full(16, k == 0))
            observation, *_, info = envs.step(action)
            total += info["cost_increment"].sum()
        costs[name] = total
    assert costs["five"] > 2.0 * costs["none"]
    assert costs["all"] < 0.7 * costs["none"]


def test_a_bank_of_one_plant_steps_one_blade_as_it_steps_a_batch():
    """By itself such a blade met operators with an axis too many."""
    slower = {"plants": {"speed_ratio": 0.9, "bank": 1}}
    one, two = RotatingBeamEnv(scenario=slower), RotatingBeamVectorEnv(2, scenario=slower)
    one.reset(seed=3)
    two.reset(seed=[3, 4])
    action = np.full(one.action_space.shape, 0.5)
    for _ in range(5):
        alone, reward, *_ = one.step(action)
        batch, rewards, *_ = two.step(np.stack([action, action]))
        np.testing.assert_allclose(batch[0], alone, rtol=1e-5, atol=1e-6)
        assert rewards[0] == pytest.approx(reward, rel=1e-5) and rewards[0] != rewards[1]
