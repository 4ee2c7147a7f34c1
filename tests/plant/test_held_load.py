"""The reference load of a blade is what its patches can about hold, and all that happens to it goes by it."""

from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from beamenv.blade import PRESETS, BeamConfig, Blade, BladeConfig
from beamenv.blade.held_load import TIMES_HELD, held_load
from beamenv.patches import PatchLayout, PatchMaterial
from beamenv.patches.group import PatchGroup
from beamenv.structure import Lamina
from beamenv.structure.section.open_sections import StripSection
from beamenv.task import resolve_task

ALUMINIUM = Lamina.isotropic(E=70e9, nu=0.33, density=2700.0)
SHEET = PatchMaterial(Lamina.isotropic(E=62e9, nu=0.34, density=7800.0), -180e-12, -180e-12, 0.2e-3, 0.2e-3)
LENGTH, WIDTH, THICKNESS, START, PATCH = 0.3, 0.03, 0.002, 0.01, 0.05


def group(face, **other):
    return PatchGroup(
        positions=(START,), material=SHEET, length=PATCH, width=0.025, wall="strip", face=face, bonded=True, passive=False, **other
    )


STRIP = BladeConfig(
    beam=BeamConfig(
        length=LENGTH,
        section=StripSection(WIDTH, THICKNESS),
        material=ALUMINIUM,
        ply_angles_deg=(("all", (0.0,)),),
        hub_radius=0.0,
        pretwist_deg=0.0,
    ),
    patches=PatchLayout(actuators=(group("outer"),), sensors=(group("inner"),)),
    speed=0.0,
    modes=5,
    voltage_limits=(-100.0, 100.0),
)


@pytest.mark.parametrize("preset", ["thesis", "sound-blade", "thesis-untwisted", "thesis-pretwisted", "chandra-chopra"])
def test_the_boxes_keep_the_30_newtons_per_metre_that_scenarios_are_made_for(preset):
    plant = Blade(PRESETS[preset]).plant
    assert np.array_equal(plant.reference_load, [30.0, 30.0])
    assert plant.process_noise[0, 0] == 9.0 * plant.control_interval


def test_the_default_blade_s_30_newtons_per_metre_are_about_as_many_times_what_it_holds_as_the_rule_has():
    assert TIMES_HELD * held_load(Blade(PRESETS["thesis"]).plant) == pytest.approx(30.0, rel=0.05)


def test_voltages_at_their_limit_bring_the_tip_of_a_strip_back_from_the_load_that_is_held():
    plant = Blade(STRIP).plant
    load = [0.0, held_load(plant)]
    loaded, driven = (
        -plant.tip_displacement @ np.linalg.solve(plant.A, push)
        for push in (plant.disturbance_input @ load, plant.B @ plant.voltage_limits[1])
    )
    assert abs(loaded[1]) == pytest.approx(abs(driven[1]), rel=1e-9)


def test_a_strip_holds_the_load_that_a_couple_on_a_beam_does():
    """Couple M = E d31 V b (h + t)/2 over the patch: tip M l (L − z)/EI against w L⁴/8EI. Across the beam, which is free to
    contract, the sheet pushes too, and so by Poisson's ratio ν of beam and ν' of sheet along it: (1 − ν)/(1 − ν'). The clamp keeps
    the strip flat across, which makes it 2 % stiffer.
    """
    couple = 62e9 * 180e-12 * 100.0 * 0.025 * 0.5 * (THICKNESS + 0.2e-3) * (1.0 - 0.33) / (1.0 - 0.34)
    start = 0.12
    held = 8.0 * couple * PATCH * (LENGTH - start - 0.5 * PATCH) / LENGTH**4
    there = PatchLayout(actuators=(replace(group("outer"), positions=(start,)),), sensors=(group("inner"),))
    assert held_load(Blade(replace(STRIP, patches=there, modes=30)).plant) == pytest.approx(held, rel=0.03)


def test_half_the_voltage_makes_the_same_episode_of_half_the_size():
    whole, half = (
        gym.make(beamenv.ENV_ID, blade=replace(STRIP, voltage_limits=(-size, size)), dtype="float64", duration=0.05)
        for size in (100.0, 50.0)
    )
    actions = np.random.default_rng(0).uniform(-1.0, 1.0, (100, 1))
    (seen, _), (half_seen, _) = (env.reset(seed=3) for env in (whole, half))
    assert half_seen == pytest.approx(seen, abs=1e-9)
    for action in actions:
        (seen, reward, *_, info), (half_seen, half_reward, *_, half_info) = (env.step(action) for env in (whole, half))
        assert half_seen == pytest.approx(seen, abs=1e-9)
        assert half_reward == pytest.approx(reward, rel=1e-9)
        assert 2.0 * half_info["tip_displacement"] == pytest.approx(info["tip_displacement"], rel=1e-6, abs=1e-12)
    assert np.abs(seen).max() > 1e-3


def test_a_blade_whose_patches_bend_nothing_needs_a_reference_load_of_its_own():
    twins = PatchLayout(actuators=(group("outer", ganged=True),), sensors=(group("inner"),))
    still = replace(twins.actuators[0], material=replace(SHEET, d11=0.0, d12=0.0))
    idle = replace(STRIP, patches=replace(twins, actuators=(still,)))
    with pytest.raises(ValueError, match="blade.reference_load is None, but must be a number"):
        Blade(idle).plant  # noqa: B018
    assert np.array_equal(Blade(replace(idle, reference_load=2.0)).plant.reference_load, [2.0, 2.0])


def test_plants_that_are_drawn_and_designs_meet_the_loads_of_the_configured_blade():
    chosen = {"plants": {"modulus_ratio": [0.8, 1.2], "bank": 4, "design_modes": 3}, "drive": {"voltage_limits": [-60.0, 60.0]}}
    task = gym.make(beamenv.ENV_ID, blade=STRIP, scenario=chosen).unwrapped.task
    own = Blade(replace(STRIP, voltage_limits=(-4.0, 4.0))).reference_load  # 60 V of 1500 V, as a share of 100 V
    assert task.plant.reference_load == pytest.approx([own, own])
    assert np.array_equal(task.design_plant.reference_load, task.plant.reference_load)
    assert len(task.bank) == 4


def test_the_drive_of_a_scenario_is_a_share_of_the_blade_s_own():
    limits = resolve_task("aluminium-cantilever", scenario="hysteresis").plant.voltage_limits
    assert limits[:, 0] == pytest.approx([-50.0, 150.0])
    assert np.array_equal(resolve_task(scenario="hysteresis").plant.voltage_limits[:, 0], [-500.0, 1500.0])
