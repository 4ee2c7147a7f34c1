"""Plants of any origin in motion: sensors that feel the actuators, other disturbances than line loads, coordinates of their own."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import block_diag

from baselines import PersistentLoad, clipped_lqg, h_infinity, lqg, lqr, mpc, no_control, reference_lqg, stationary_cost
from baselines.design.hypothesis import Hypothesis
from baselines.design.loop import closed_loop, sampled, spectral_radius
from baselines.laws.lqg import optimal_filter, optimal_regulator
from baselines.laws.multiple_model import multiple_model
from beamenv.plant import Plant, Signal, fingerprint
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.simulation.blades import Blades, reward_scale
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.sampled_bank import sampled_bank

OMEGA, DAMPING, INTERVAL = np.array([40.0, 130.0]), 0.01, 2e-3
FORCE, VELOCITY = np.array([[1.0, 0.6], [0.4, -1.1]]), np.array([1.0, -0.7])


def oscillators(**changes):
    """Two modes x = [ωη; η̇], two voltages that are forces; one sensor of velocity and one of acceleration, which feels these."""
    A = np.block([[np.zeros((2, 2)), np.diag(OMEGA)], [-np.diag(OMEGA), -2.0 * DAMPING * np.diag(OMEGA)]])
    B = np.vstack([np.zeros((2, 2)), FORCE])
    moving = np.concatenate([np.zeros(2), VELOCITY])
    feels = VELOCITY @ A[2:]
    parts = {
        "A": A,
        "B": B,
        "C": np.vstack([moving, feels]),
        "D": np.vstack([np.zeros(2), VELOCITY @ FORCE]),
        "disturbance_input": np.vstack([np.zeros((2, 1)), [[0.8], [0.5]]]),
        "tip_displacement": np.zeros((0, 4)),
        "strain": np.zeros((0, 4)),
        "natural_frequencies": OMEGA,
        "state_weight": 0.5 * np.eye(4),
        "input_weight": 1e-4 * np.eye(2),
        "process_noise": np.array([[2e-2]]),
        "sensor_noise": np.diag([1e-5, 3e-2]),
        "voltage_limits": np.array([[-1e4, -1e4], [1e4, 1e4]]),
        "sensor_full_scale": np.array([50.0, 5000.0]),
        "control_interval": INTERVAL,
        "disturbances": (Signal("force", "N"),),
        "sensors": (Signal("velocity", "m/s"), Signal("acceleration", "m/s²")),
    }
    return Plant(**{**parts, **changes})


def turned(plant, seed=0):
    """The same plant in other coordinates, x' = T x."""
    T = np.random.default_rng(seed).normal(size=plant.A.shape) + 2.0 * np.eye(len(plant.A))
    back = np.linalg.inv(T)
    return replace(
        plant,
        A=T @ plant.A @ back,
        B=T @ plant.B,
        C=plant.C @ back,
        disturbance_input=T @ plant.disturbance_input,
        tip_displacement=plant.tip_displacement @ back,
        strain=plant.strain @ back,
        state_weight=back.T @ plant.state_weight @ back,
        energy=back.T @ plant.energy @ back,
    ), T


def simulated_cost(plant, law, blades=256, settle=3000, steps=4000, seed=5):
    """Mean of J per second in the environment's own simulation under white noise."""
    moving, generator = Blades(plant, SCENARIOS["white"], blades), np.random.default_rng(seed)
    motion, memory, total = moving.begin(generator), None, []
    for step in range(settle + steps):
        action, memory = law.predict(motion.observation, memory)
        motion = moving.step(action, generator)
        if step >= settle:
            total.append(motion.cost_increment.mean())
    return np.mean(total) / plant.control_interval


def test_lqg_with_sensors_that_feel_the_voltages_reaches_its_analytic_optimum_in_simulation():
    plant = oscillators()
    law = lqg(plant)
    optimum = stationary_cost(plant, law)
    assert simulated_cost(plant, law) == pytest.approx(optimum, rel=0.03)  # 256 blades × 8 s: 1 % is one standard deviation
    # dynamic programming: tr(P W) of the state, and what not knowing it costs, from the Riccati solutions by themselves
    held = sampled(plant)
    (P, K), (predicted, L) = ((each.matrix, each.gain) for each in (optimal_regulator(plant, held), optimal_filter(plant, held)))
    S = predicted - L @ held.C @ predicted
    W = held.disturbance_input @ held.process_noise @ held.disturbance_input.T
    n, m = held.B.shape
    loads = held.cost[n + m :, n + m :]
    price = K.T @ (held.input_weight + held.B.T @ P @ held.B) @ K
    value = np.trace(P @ W) + np.trace(price @ S) + np.trace(loads @ held.process_noise)
    assert optimum == pytest.approx(value / held.interval, rel=1e-9)


def test_a_law_that_does_not_know_what_sensors_feel_does_worse():
    plant = oscillators()
    ignorant = lqg(replace(plant, D=np.zeros((2, 2))))
    assert stationary_cost(plant, ignorant) > 1.02 * stationary_cost(plant, lqg(plant))


def test_a_reading_shows_the_voltage_of_the_interval_before():
    plant = oscillators(process_noise=np.zeros((1, 1)), sensor_noise=np.zeros((2, 2)))
    moving, generator = Blades(plant, SCENARIOS["quiet"], None, physical_units=True), np.random.default_rng(0)
    assert moving.begin(generator).observation == pytest.approx(np.zeros(2))
    voltage = np.array([100.0, -40.0])
    motion = moving.step(voltage, generator)
    state = moving.state
    assert motion.observation == pytest.approx(plant.C @ state + plant.D @ voltage, rel=1e-12)
    motion = moving.step(np.zeros(2), generator)
    assert motion.observation == pytest.approx(plant.C @ moving.state, rel=1e-12)


@pytest.mark.parametrize(
    "build",
    [
        lqg,
        lambda plant: lqg(plant, persistent_load=PersistentLoad()),
        lambda plant: lqg(plant, design="continuous"),
        lqr,
        lambda plant: lqr(plant, PersistentLoad()),
        reference_lqg,
        h_infinity,
    ],
    ids=["lqg", "lqg-load", "continuous", "lqr", "lqr-load", "reference", "h-infinity"],
)
def test_linear_laws_are_stable_and_the_same_in_any_coordinates(build):
    plant = oscillators()
    other, _ = turned(plant)
    law, same = build(plant), build(other)
    assert spectral_radius(closed_loop(sampled(plant, law), law)[0]) < 1.0
    costs = stationary_cost(plant, law), stationary_cost(other, same)
    assert costs[0] == pytest.approx(costs[1], rel=1e-6)
    assert costs[0] < 1.5 * stationary_cost(plant, lqg(plant))


def test_other_coordinates_move_and_cost_the_same():
    plant = oscillators()
    other, T = turned(plant)
    generator = np.random.default_rng(1)
    actions = generator.uniform(-1.0, 1.0, (50, 3, 2)) * 1e-3
    motions, states = [], []
    for each in (plant, other):
        blades, own = Blades(each, SCENARIOS["nominal"], 3), np.random.default_rng(2)
        series = [blades.begin(own)] + [blades.step(action, own) for action in actions]
        motions.append(series)
        states.append(blades.state)
    for name in ("observation", "reward", "energy", "cost_increment"):
        one, two = (np.stack([getattr(each, name) for each in series]) for series in motions)
        assert two == pytest.approx(one, rel=1e-7, abs=1e-9 * np.abs(one).max())
    assert states[1] == pytest.approx(states[0] @ T.T, rel=1e-6, abs=1e-9)
    assert 0.5 * (states[0] ** 2).sum(axis=1) == pytest.approx(motions[1][-1].energy, rel=1e-7)
    assert reward_scale(other) == pytest.approx(reward_scale(plant), rel=1e-9)


def test_an_initial_state_is_told_in_the_plants_own_coordinates():
    other, _ = turned(oscillators())
    blades, start = Blades(other, SCENARIOS["quiet"], 2), np.array([[1.0, 2.0, -1.0, 0.5], [0.0, 0.1, 0.2, 0.3]])
    motion = blades.begin(np.random.default_rng(0), initial_state=start)
    assert blades.state == pytest.approx(start, rel=1e-9)
    assert motion.energy == pytest.approx(np.einsum("ni,ij,nj->n", start, other.energy, start), rel=1e-9)


def test_without_a_known_energy_the_cost_is_that_of_the_outputs():
    plant = oscillators()
    weight = np.diag([1.0, 0.0])
    unknown = replace(plant, energy=np.zeros((4, 4)), state_weight=plant.C.T @ weight @ plant.C)
    blades, generator = Blades(unknown, SCENARIOS["white"], 64), np.random.default_rng(3)
    motion, spent, shown = blades.begin(generator), 0.0, 0.0
    for _ in range(400):
        motion = blades.step(np.zeros((64, 2)), generator)
        now = INTERVAL * ((blades.state @ plant.C[0]) ** 2).sum()
        spent, shown = spent + motion.cost_increment.sum(), shown + now
    assert not motion.energy.any()
    assert spent == pytest.approx(shown - 0.5 * now, rel=5e-3)  # the trapezoidal rule, 24 instants to a period of the fast mode
    assert reward_scale(unknown) > 0.0
    assert stationary_cost(unknown, lqg(unknown)) < 0.5 * stationary_cost(unknown, no_control(unknown))


def test_load_cases_are_scaled_by_the_reference_load_and_leave_noise_inputs_alone():
    noisy = replace(
        oscillators(),
        disturbance_input=np.hstack([oscillators().disturbance_input, np.eye(4)[:, :1]]),
        process_noise=np.diag([2e-2, 1e-3]),
        disturbances=(Signal("force", "N"), Signal("noise", "")),
        reference_load=np.array([60.0, 0.0]),
    )
    blades = Blades(noisy, SCENARIOS["step"], 200)
    assert blades.plant.loads == 1
    quiet = replace(SCENARIOS["step"], white_load=False, onset=(0.0, 0.0))
    blades = Blades(noisy, quiet, 200)
    blades.begin(np.random.default_rng(0))
    loads = blades.coming_loads
    assert not loads[:, 1].any()
    assert np.abs(loads[:, 0]).min() >= 30.0 and np.abs(loads[:, 0]).max() <= 90.0
    assert 60 < (loads[:, 0] > 0.0).sum() < 140


def test_three_loads_come_from_any_direction():
    inputs = np.vstack([np.zeros((2, 3)), [[1.0, 0.0, 0.5], [0.0, 1.0, 0.5]]])
    plant = replace(
        oscillators(),
        disturbance_input=inputs,
        process_noise=1e-2 * np.eye(3),
        disturbances=tuple(Signal(f"force {k}", "N") for k in range(3)),
        reference_load=np.full(3, 30.0),
    )
    blades = Blades(plant, replace(SCENARIOS["step"], white_load=False, onset=(0.0, 0.0), magnitude=(30.0, 30.0)), 6000)
    blades.begin(np.random.default_rng(0))
    loads = blades.coming_loads
    assert np.linalg.norm(loads, axis=1) == pytest.approx(30.0)
    assert np.cov(loads.T) == pytest.approx(300.0 * np.eye(3), abs=20.0)  # uniform on a sphere: a third of 900 each
    seeded = Blades(plant, SCENARIOS["step"], 2)
    seeded.begin([np.random.default_rng(k) for k in range(2)])
    alone = Blades(plant, SCENARIOS["step"], None)
    alone.begin([np.random.default_rng(1)])
    assert np.array_equal(seeded.coming_loads[1], alone.coming_loads)


def test_laws_with_memory_of_their_own_know_what_sensors_feel():
    plant = oscillators()
    readings = np.random.default_rng(0).normal(size=(20, 2)) * 1e-3
    clipped, linear, plan = clipped_lqg(plant), lqg(plant), mpc(plant)
    bank = multiple_model([Hypothesis(plant)], rate_weight=0.0)
    memories = [None] * 4
    for reading in readings:
        actions = []
        for k, law in enumerate((linear, clipped, plan, bank)):
            action, memories[k] = law.predict(reading[None] if k == 3 else reading, memories[k])
            actions.append(np.ravel(action))
        assert actions[1] == pytest.approx(actions[0], rel=1e-9) and actions[2] == pytest.approx(actions[0], rel=1e-7)
    assert simulated_cost(plant, bank, 64, 1000, 1500) == pytest.approx(stationary_cost(plant, linear), rel=0.1)


def test_the_plants_of_a_bank_as_matrices_show_what_sensors_feel():
    plant = oscillators()
    matrices = sampled_bank(Bank.single(plant))
    held = sampled(plant)
    assert matrices.A.shape[1] == len(plant.A) + 2
    markov = [matrices.C[0] @ np.linalg.matrix_power(matrices.A[0], k) @ matrices.B[0] for k in range(4)]
    scale = 1e4 / plant.sensor_full_scale[:, None]
    for k, each in enumerate(markov):
        assert each == pytest.approx(held.C @ np.linalg.matrix_power(held.A, k) @ held.B * scale, rel=1e-9, abs=1e-9)


def test_a_fingerprint_does_not_depend_on_coordinates_and_tells_sensors_that_feel_voltages():
    plant = oscillators()
    first, second = (turned(plant, seed)[0] for seed in (1, 2))
    assert fingerprint(first) == fingerprint(second)
    assert fingerprint(replace(first, D=0.0 * plant.D)) != fingerprint(first)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"energy": -np.eye(4)}, "plant.energy has the eigenvalue -1"),
        ({"energy": block_diag(np.eye(3), [[1.0]]) + np.eye(4, k=1)}, "plant.energy differs from its transpose by 1"),
        ({"energy": np.eye(3)}, "plant.energy has shape"),
        ({"reference_load": np.array([-1.0])}, "plant.reference_load is"),
        ({"sensors": ("velocity", "acceleration")}, "plant.sensors is"),
    ],
)
def test_parts_that_cannot_be_are_refused_in_one_sentence(changes, words):
    with pytest.raises(ValueError, match=words) as refused:
        oscillators(**changes)
    assert str(refused.value).count(". ") == 0
