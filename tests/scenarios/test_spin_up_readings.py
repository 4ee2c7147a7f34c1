"""Sensors and loads of one's own along a spin-up: those of a steady speed where it is steady, and kinematics on the way."""

import numpy as np
import pytest

from baselines.laws.spin_up_lqg import spin_up_lqg
from beamenv import RotatingBeamEnv
from beamenv.simulation.plants.spin_up import Cycloid
from beamenv.task import resolve_task

SENSORS = [
    {"kind": "accelerometer", "position": 1.5, "point": [0.05, 0.01], "direction": [0.3, 1.0, 0.2]},
    {"kind": "charge"},
    {"kind": "velocity", "position": 1.0},
    {"kind": "current"},
    {"kind": "displacement", "direction": [1.0, 0.0, 0.0]},
    {"kind": "strain-gauge", "position": 0.5, "wall": "top", "angle_deg": 20.0},
]
LOADS = [
    {"position": 1.0, "direction": [1.0, 1.0, 0.0], "magnitude": 20.0},
    {"shape": "base", "course": "noise", "magnitude": 3.0},
    {"shape": "line", "span": [0.5, 1.5], "course": "harmonic", "magnitude": 10.0, "frequency": 20.0},
]
RAW = {"amplifier_bandwidth": None, "filter_cutoff": None}


def spin_up(low, high, sensors, loads=(), **arguments):
    blade = {"sensors": [{**each, "range": 1e4} for each in sensors], **arguments.pop("blade", {})}
    chosen = {"preset": "quiet", "plants": {"spin_up": [low, high]}, "loads": list(loads)}
    return RotatingBeamEnv(blade=blade, scenario=chosen, dtype="float64", physical_units=True, **arguments)


def shown(env, steps, action=None):
    """Readings (steps + 1, p) and tip displacements (steps + 1, 2) without voltages, or under an ``action``."""
    observation, info = env.reset(seed=0)
    readings, tips = [observation], [info["tip_displacement"]]
    for _ in range(steps):
        observation, _, _, _, info = env.step(np.zeros(4) if action is None else action)
        readings.append(observation)
        tips.append(info["tip_displacement"])
    return np.array(readings), np.array(tips)


@pytest.mark.parametrize("electronics", [{}, {"amplifier_bandwidth": None}], ids=["amplifiers", "no amplifiers"])
def test_at_a_speed_that_stays_every_sensor_and_load_is_that_of_the_steady_blade(electronics):
    blade = {"sensors": SENSORS, "electronics": electronics}
    steady = RotatingBeamEnv("sound-blade", 80.0, blade, scenario={"preset": "quiet", "loads": LOADS}, dtype="float64")
    still = {"preset": "quiet", "loads": LOADS, "plants": {"spin_up": [80.0, 80.0]}}
    running = RotatingBeamEnv("sound-blade", 80.0, blade, scenario=still, dtype="float64")
    for env in (steady, running):
        env.reset(seed=3)
    generator, largest = np.random.default_rng(0), 0.0
    for _ in range(150):
        action = generator.uniform(-1.0, 1.0, 4)
        ours, theirs = running.step(action), steady.step(action)
        np.testing.assert_allclose(ours[0], theirs[0], rtol=0.0, atol=1e-9)
        assert ours[4]["energy"] == pytest.approx(theirs[4]["energy"], rel=1e-7)
        largest = np.maximum(largest, np.abs(theirs[0]))
    assert (largest > 1e-3).all()


def test_on_the_way_a_displacement_sensor_shows_the_tip_and_a_vibrometer_its_rate():
    sensors = [
        {"kind": kind, "direction": way} for kind in ("displacement", "velocity") for way in ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])
    ]
    blade = {"electronics": RAW, "control_interval": 1e-4, "truth_modes": 6}
    readings, tips = shown(spin_up(100.0, 300.0, sensors, LOADS[:1], blade=blade, duration=0.2), 1000)
    np.testing.assert_allclose(readings[:, :2], tips, rtol=0.0, atol=1e-9 * np.abs(tips).max())
    rate = (tips[2:] - tips[:-2]) / 2e-4
    error = np.abs(readings[1:-1, 2:] - rate).max(axis=0) / np.abs(rate).max(axis=0)
    assert (error < 5e-3).all()  # 1.4e-3: that mode shapes change with the speed is left out of rates


def test_on_the_way_an_accelerometer_feels_the_path_of_its_point_in_space():
    """Of displacement sensors behind the same filters: p̈ + 2Ω ŷ × ṗ + Ω̇ ŷ × p − Ω² (p − ŷŷᵀp), and its own tilt."""
    ways, points = np.eye(3), [(0.0, 0.0), (0.1, 0.0), (0.0, 0.1)]
    direction = np.array([0.6, 0.64, 0.48])
    sensors = [{"kind": "accelerometer", "direction": direction.tolist()}]
    sensors += [{"kind": "displacement", "point": list(at), "direction": way.tolist()} for at in points for way in ways]
    blade = {"control_interval": 1e-4, "truth_modes": 4}
    env = spin_up(100.0, 300.0, sensors, LOADS[:1], blade=blade, duration=0.2)
    readings, _ = shown(env, 1000)
    beam, course = env.task.blade.beam, Cycloid(100.0, 300.0, 0.2)
    moved, beside, above = np.moveaxis(readings[:, 1:].reshape(-1, 3, 3), 1, 0)
    angle = np.radians(beam.pretwist_deg)
    arms = 0.1 * np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    tilts = np.linalg.solve(arms, np.stack([(beside - moved)[:, 2], (above - moved)[:, 2]]))  # of z: θx b − θy a for an arm (a, b)
    twist = (arms[0, 0] * (beside - moved)[:, 1] - arms[0, 1] * (beside - moved)[:, 0]) / (arms[0] @ arms[0])
    turned = np.stack([tilts[1], -tilts[0], twist], axis=1)
    times, step = 1e-4 * np.arange(1001), 1e-4
    speed, change = course.speed(times)[:, None], course.acceleration(times)[:, None]
    stands, axis, plane = np.array([0.0, 0.0, beam.hub_radius + beam.length]), np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 1.0])
    rate = np.gradient(moved, step, axis=0)
    second = np.zeros_like(moved)
    second[1:-1] = (moved[2:] - 2.0 * moved[1:-1] + moved[:-2]) / step**2
    still = change * np.cross(axis, stands) - speed**2 * plane * stands
    terms = [second, 2.0 * speed * np.cross(axis, rate), change * np.cross(axis, moved), -(speed**2) * plane * moved]
    felt = [each @ direction for each in terms] + [np.einsum("ti,ti->t", np.cross(turned, direction), still)]
    inner = slice(100, -100)
    wanted = sum(felt)[inner]
    error = np.abs(readings[inner, 0] - wanted).max() / np.abs(wanted).max()
    shares = np.array([np.abs(each[inner]).max() for each in felt]) / np.abs(wanted).max()
    assert (shares > 0.02).all()  # each of these is seen
    assert error < 0.01  # 0.004


def test_lqg_along_a_spin_up_reads_an_accelerometer():
    sensors = [{"kind": "accelerometer"}, {"kind": "strain-gauge", "position": 0.3, "wall": "top"}]
    chosen = {"preset": "white", "plants": {"spin_up": [200.0, 201.0]}}
    env = RotatingBeamEnv(blade={"sensors": sensors, "modes": 4, "truth_modes": 4}, scenario=chosen, dtype="float64", duration=0.1)
    law, energies = spin_up_lqg(env.task.prior), []
    for controlled in (False, True):
        observation, info = env.reset(seed=0)
        memory, energy = None, 0.0
        for _ in range(200):
            action, memory = law.predict(observation[None], memory)
            observation, _, _, _, info = env.step(action[0] if controlled else np.zeros(4))
            energy += float(info["energy"])
        energies.append(energy)
    assert energies[1] < 0.95 * energies[0]


def test_a_spin_up_tells_few_plants_of_sensors_from_others_as_it_does_of_currents():
    task = resolve_task(blade={"sensors": SENSORS, "truth_modes": 11}, scenario={"preset": "spin-up", "loads": LOADS}, duration=0.1)
    assert len(task.bank) == 200
    assert task.bank.plant.disturbance_input.shape[1] == 5
    assert len(task.bank.plant.C) == 12
