"""The blades of benches: their frequencies are those of handbooks, and an episode with each is worth controlling."""

from dataclasses import replace

import numpy as np
import pytest

from baselines.laws.reference_lqg import reference_lqg
from beamenv.blade import PRESETS, Blade, BladeConfig
from beamenv.simulation.blades import Blades
from beamenv.structure import AS4_3501_6
from beamenv.task import resolve_task

CANTILEVER = np.array([1.875104, 4.694091, 7.854757])
"""βL of a clamped and a free end (Blevins 1979, table 8-1)."""

LENGTH, WIDTH, THICKNESS, E, NU, DENSITY = 0.3, 0.03, 0.002, 68.9e9, 0.33, 2700.0


def hertz(config: BladeConfig) -> np.ndarray:
    return Blade(config).modal.natural_frequencies / (2.0 * np.pi)


def bending(stiffness: float, mass: float, length: float) -> np.ndarray:
    """Hz, Euler and Bernoulli."""
    return CANTILEVER**2 / (2.0 * np.pi * length**2) * np.sqrt(stiffness / mass)


def bare(config: BladeConfig) -> BladeConfig:
    groups = {
        side: tuple(replace(group, passive=False) for group in getattr(config.patches, side)) for side in ("actuators", "sensors")
    }
    return replace(config, patches=replace(config.patches, **groups), modes=12)


def nearest(frequencies: np.ndarray, wanted: float) -> float:
    return float(frequencies[np.abs(frequencies - wanted).argmin()])


def test_the_bare_strip_has_the_frequencies_of_the_handbook():
    found, mass = hertz(bare(PRESETS["aluminium-cantilever"])), DENSITY * WIDTH * THICKNESS
    for wanted in bending(E * WIDTH * THICKNESS**3 / 12.0, mass, LENGTH):
        assert wanted < nearest(found, wanted) < 1.025 * wanted  # the clamp keeps it flat across: between a beam and a plate
    edgewise = bending(E * THICKNESS * WIDTH**3 / 12.0, mass, LENGTH)[0]
    assert nearest(found, edgewise) == pytest.approx(edgewise, rel=0.01)
    torsion = 0.333 * (1.0 - 0.63 * THICKNESS / WIDTH) * WIDTH * THICKNESS**3 * E / (2.0 * (1.0 + NU))  # GJ
    polar = DENSITY * (WIDTH * THICKNESS**3 + THICKNESS * WIDTH**3) / 12.0
    twisting = np.sqrt(torsion / polar) / (4.0 * LENGTH)
    assert twisting < nearest(found, twisting) < 1.07 * twisting  # its warping is kept at the clamp


def with_sheets(elements: int = 240) -> np.ndarray:
    """Hz: the strip with both sheets by finite elements of Hermite's cubics, with the stiffness E I of each cross-section."""
    sheet, wide, density, modulus = 0.5e-3, 0.025, 7800.0, 1.0 / 16.1e-12
    size, ends = LENGTH / elements, np.linspace(0.0, LENGTH, elements + 1)
    under = (0.5 * (ends[1:] + ends[:-1]) > 0.01) & (0.5 * (ends[1:] + ends[:-1]) < 0.06)
    arm = 0.5 * (THICKNESS + sheet)
    stiffness = E * WIDTH * THICKNESS**3 / 12.0 + under * 2.0 * modulus * wide * (sheet * arm**2 + sheet**3 / 12.0)
    mass = DENSITY * WIDTH * THICKNESS + under * 2.0 * density * wide * sheet
    bend = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) / size**3
    move = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) * size / 420.0
    scale = np.outer([1, size, 1, size], [1, size, 1, size])
    K, M = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for k in range(elements):
        at = slice(2 * k, 2 * k + 4)
        K[at, at] += stiffness[k] * bend * scale
        M[at, at] += mass[k] * move * scale
    return np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(M[2:, 2:], K[2:, 2:])).real)[:3]) / (2.0 * np.pi)


def test_the_sheets_stiffen_the_strip_as_they_do_a_beam_of_steps():
    found, wanted = hertz(replace(PRESETS["aluminium-cantilever"], modes=12)), with_sheets()
    assert wanted[0] > 1.15 * bending(E * WIDTH * THICKNESS**3 / 12.0, DENSITY * WIDTH * THICKNESS, LENGTH)[0]
    for each in wanted:
        assert each < nearest(found, each) < each / np.sqrt(1.0 - NU**2)  # of a plate, kept flat across everywhere


def test_the_airfoil_bends_as_a_beam_of_its_skin():
    config = PRESETS["airfoil-blade"]
    still = replace(bare(config), speed=0.0, beam=replace(config.beam, pretwist_deg=0.0, hub_radius=0.0))
    x = 0.9 * (1.0 - np.cos(np.linspace(0.0, np.pi, 20001))) / 2.0
    y = 0.6 * (0.2969 * np.sqrt(x) - 0.126 * x - 0.3516 * x**2 + 0.2843 * x**3 - 0.1015 * x**4) * 0.1077
    along, middle = np.hypot(np.diff(0.1077 * x), np.diff(y)), 0.5 * (y[1:] + y[:-1])
    web, tail = 2.0 * np.interp(0.4 * 0.9, x, y), 2.0 * y[-1]
    membrane = np.mean([AS4_3501_6.transformed_stiffness(np.radians(angle)) for angle in (90.0, 45.0, -45.0) * 2], axis=0)
    modulus = 1.0 / np.linalg.inv(membrane)[1, 1]
    stiffness = modulus * 0.001 * (2.0 * (middle**2 * along).sum() + web**3 / 12.0 + tail**3 / 12.0)
    mass = 1444.8 * 0.001 * (2.0 * along.sum() + web + tail)
    flap = bending(stiffness, mass, 1.3)[0]
    assert hertz(still)[0] == pytest.approx(flap, rel=0.03)


@pytest.mark.parametrize("preset", ["aluminium-cantilever", "airfoil-blade"])
def test_lqg_halves_the_cost_of_an_episode_with_voltages_neither_idle_nor_always_at_their_limits(preset):
    task, count = resolve_task(preset), 24
    law = reference_lqg(task.design.full_plant)
    costs = []
    for controlled in (False, True):
        blades, generators = Blades(task.bank, task.scenario, count), [np.random.default_rng(k) for k in range(count)]
        motion, memory, cost, share, full = blades.begin(generators), None, np.zeros(count), 0.0, 0.0
        limit = np.abs(task.plant.voltage_limits).max(axis=0)
        for _ in range(task.steps):
            action = np.zeros((count, len(limit)))
            if controlled:
                action, memory = law.predict(motion.observation, memory)
            motion = blades.step(action, generators)
            assert np.isfinite(motion.observation).all()
            cost += motion.cost_increment
            used = np.abs(motion.volts) / limit
            share, full = share + used.mean() / task.steps, full + (used > 0.999).mean() / task.steps
        assert not motion.failed.any()
        costs.append(cost.mean())
    assert costs[1] < 0.5 * costs[0]
    assert 0.03 < share < 0.5
    assert full < 0.1
