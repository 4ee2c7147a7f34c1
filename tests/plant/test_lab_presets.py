"""The blades of benches: their frequencies are those of handbooks, and an episode with each is worth controlling."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.linalg import eigh

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


@dataclass(frozen=True)
class Sheets:
    """Sheets on a strip: (start, end) in m and face, 1 or −1, of each; thickness and width in m, Pa, kg/m³."""

    places: tuple[tuple[float, float, int], ...]
    thickness: float
    width: float
    modulus: float
    density: float


def with_sheets(length: float, width: float, thickness: float, modulus: float, density: float, sheets: Sheets) -> np.ndarray:
    """Hz: a strip with sheets by finite elements of Hermite's cubics, with each cross-section's E I about its own neutral axis."""
    elements = round(length / 2e-3)
    size, middle = length / elements, (np.arange(elements) + 0.5) * length / elements
    stretch, first, second = modulus * width * thickness, 0.0, modulus * width * thickness**3 / 12.0
    mass = np.full(elements, density * width * thickness)
    for start, end, face in sheets.places:
        under, arm = (middle > start) & (middle < end), 0.5 * face * (thickness + sheets.thickness)
        axial = under * sheets.modulus * sheets.width * sheets.thickness
        stretch, first, second = stretch + axial, first + axial * arm, second + axial * (arm**2 + sheets.thickness**2 / 12.0)
        mass += under * sheets.density * sheets.width * sheets.thickness
    stiffness = second - first**2 / stretch
    bend = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) / size**3
    move = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) * size / 420.0
    scale = np.outer([1, size, 1, size], [1, size, 1, size])
    K, M = np.zeros((2, 2 * elements + 2, 2 * elements + 2))
    for k in range(elements):
        at = slice(2 * k, 2 * k + 4)
        K[at, at] += stiffness[k] * bend * scale
        M[at, at] += mass[k] * move * scale
    return np.sqrt(eigh(K[2:, 2:], M[2:, 2:], eigvals_only=True, subset_by_index=(0, 2))) / (2.0 * np.pi)


PAIR = Sheets(((0.01, 0.06, 1), (0.01, 0.06, -1)), 0.5e-3, 0.025, 1.0 / 16.1e-12, 7800.0)
WAFERS = Sheets(((0.014, 0.058, 1), (0.014, 0.058, -1), (0.09, 0.134, 1), (0.322, 0.366, 1)), 0.25e-3, 0.02, 1.0 / 16.4e-12, 7700.0)
STRIPS = {
    "aluminium-cantilever": with_sheets(LENGTH, WIDTH, THICKNESS, E, DENSITY, PAIR),
    "takacs-beam": with_sheets(0.55, 0.04, 0.003, 68e9, 2691.7, WAFERS),
}


@pytest.mark.parametrize("preset", STRIPS)
def test_the_sheets_stiffen_the_strip_as_they_do_a_beam_of_steps(preset):
    found, strip = hertz(replace(PRESETS[preset], modes=12)), hertz(bare(PRESETS[preset]))
    assert STRIPS[preset][0] > 1.02 * strip[0]
    for each in STRIPS[preset]:
        assert each < nearest(found, each) < each / np.sqrt(1.0 - NU**2)  # of a plate, kept flat across everywhere


A = np.array([[0.867074264700783, 1.118487994649831], [-0.214184972531195, 0.869746240894636]])
B = np.array([0.933601028678616e-3, 0.530974425107969e-3])
C = np.array([-0.552612993066737, 0.705187130687643])
INTERVAL = 0.01
"""s, and the model from volts to mm at the tip that Takács and Rohaľ-Ilkiv identified from their beam (n4s2s in parameters.mac of
github.com/gergelytakacs/vibration-control-ANSYS, MIT licence). It is not that of their finite elements, whose first mode has a
damping ratio of half BETAD ω, 0.39 %."""


def first_mode(poles: np.ndarray, weights: np.ndarray) -> tuple[float, float, float]:
    """Hz, damping ratio and static response per volt of the slowest pair of poles, given their residues."""
    pole, residue = poles[abs(poles).argmin()], weights[abs(poles).argmin()]
    return abs(pole) / (2.0 * np.pi), -pole.real / abs(pole), 2.0 * abs((residue / pole).real)


def residues(A: np.ndarray, B: np.ndarray, C: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    poles, shapes = np.linalg.eig(A)
    return poles, (C @ shapes) * np.linalg.solve(shapes, B.astype(complex))


def test_the_published_beam_is_a_little_stiffer_and_moves_more_per_volt_than_was_measured():
    multipliers, steps = residues(A, B, C)
    poles = np.log(multipliers) / INTERVAL
    frequency, damping, gain = first_mode(poles, steps * poles / (multipliers - 1.0))  # voltages are held over an interval
    assert (frequency, damping, gain) == pytest.approx((8.169, 0.00616, 1.894e-3), rel=1e-3)
    plant = Blade(PRESETS["takacs-beam"]).plant
    here = first_mode(*residues(plant.A, plant.B[:, 0], plant.C[0]))
    assert here[0] / frequency == pytest.approx(1.029, abs=1e-3)  # as the preset says
    assert here[1] == pytest.approx(damping, rel=0.01)  # which is given
    assert 1e3 * here[2] / gain == pytest.approx(1.212, abs=1e-3)


@pytest.mark.parametrize("preset", ["aluminium-cantilever", "takacs-beam", "airfoil-blade"])
def test_what_a_volt_does_to_the_tip_is_what_finite_elements_say(preset):
    """Within 0.2 % with sixteen trial functions, and no worse with more."""

    def told(**changes):
        config = PRESETS[preset]
        plant = Blade(replace(config, beam=replace(config.beam, **changes))).truth
        return np.abs(plant.tip_displacement @ np.linalg.solve(plant.A, plant.B)).sum(axis=1)[1]

    elements = told(discretisation="finite-elements")
    for terms in (16, 24):
        assert told(terms=terms) == pytest.approx(elements, rel=2e-3)


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


@pytest.mark.parametrize(("preset", "most"), [("aluminium-cantilever", 0.1), ("takacs-beam", 0.2), ("airfoil-blade", 0.1)])
def test_lqg_halves_the_cost_of_an_episode_with_voltages_neither_idle_nor_always_at_their_limits(preset, most):
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
    assert full < most
