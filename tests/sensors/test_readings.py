"""What sensors show is what handbooks say of a strip, and what one says of another."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import expm

from beamenv.blade import Blade, blade_config
from beamenv.plant.plant import Plant
from beamenv.sensors.points import PointRows, felt_acceleration

LENGTH, WIDTH, THICKNESS, E = 0.3, 0.03, 0.002, 68.9e9
STRIP = {"passive": False}


def strip(*sensors: dict[str, object], **changes: object) -> Blade:
    return Blade(replace(blade_config("aluminium-cantilever", {"sensors": list(sensors)}), **changes))


def gain(plant: Plant, inputs: np.ndarray, through: np.ndarray) -> np.ndarray:
    """(p, k): what is shown in the static state."""
    return plant.C @ np.linalg.solve(-plant.A, inputs) + through


def test_a_displacement_sensor_shows_the_tip_and_a_vibrometer_its_velocity():
    blade = strip({"kind": "displacement"}, {"kind": "velocity"}, {"kind": "displacement", "direction": [2.0, 0.0, 0.0]})
    plant, r = blade.plant, len(blade.plant.natural_frequencies)
    np.testing.assert_allclose(plant.C[[2, 0]], plant.tip_displacement, rtol=1e-12, atol=1e-18)
    np.testing.assert_allclose(plant.C[1, r:] / plant.natural_frequencies, plant.C[0, :r], rtol=1e-12)
    assert [(each.name, each.unit) for each in plant.sensors] == [
        ("displacement 0", "m"), ("velocity 1", "m/s"), ("displacement 2", "m")
    ]  # fmt: skip


def test_an_accelerometer_shows_the_rate_of_a_vibrometer_with_the_voltages_in_it():
    plant = strip(
        {"kind": "velocity", "position": 0.2, "point": [0.01, 0.0]},
        {"kind": "accelerometer", "position": 0.2, "point": [0.01, 0.0]},
    ).plant
    np.testing.assert_allclose(plant.C[1], plant.C[0] @ plant.A, rtol=1e-10, atol=1e-12 * np.abs(plant.C[1]).max())
    np.testing.assert_allclose(plant.D[1], plant.C[0] @ plant.B, rtol=1e-10)
    step, voltage = 1e-6, np.array([100.0])
    state = np.random.default_rng(0).normal(size=len(plant.A))
    later = expm(plant.A * step) @ state + step * plant.B @ voltage
    rate = plant.C[0] @ (later - state) / step
    assert plant.C[1] @ state + plant.D[1] @ voltage == pytest.approx(rate, rel=1e-2)


def test_a_point_beside_the_axis_moves_with_the_twist_of_its_section():
    axis, right, left = (
        strip({"kind": "displacement", "position": 0.2, "point": [x, 0.0]}).plant.C[0] for x in (0.0, 0.015, -0.015)
    )
    np.testing.assert_allclose(right + left, 2.0 * axis, atol=1e-12 * np.abs(axis).max())
    assert np.abs(right - left).max() > 0.1 * np.abs(axis).max()  # torsion modes


def test_a_gauge_on_a_strip_shows_the_strain_of_a_beam():
    """ε = M h / 2EI under a uniform load, M = w (L − z)²/2, on the upper face; as much with the other sign below."""
    groups = blade_config("aluminium-cantilever").patches
    bare = replace(
        groups, actuators=(replace(groups.actuators[0], passive=False),), sensors=(replace(groups.sensors[0], passive=False),)
    )
    gauges = [{"kind": "strain-gauge", "position": 0.15, "wall": "strip", "face": face} for face in ("outer", "inner")]
    plant = strip(*gauges, patches=bare, modes=40).plant
    shown = gain(plant, plant.disturbance_input[:, 1:], 0.0)[:, 0]
    wanted = 0.5 * 0.15**2 * (THICKNESS / 2.0) / (E * WIDTH * THICKNESS**3 / 12.0)
    assert np.abs(shown) == pytest.approx([wanted, wanted], rel=0.03)  # 1 % of it: the middle of the layer lies below the face
    assert shown[0] < 0.0 < shown[1]  # bent up, the upper face is shorter


def test_gauges_in_four_directions_are_a_rosette():
    angles = (0.0, 45.0, 90.0, -45.0)
    plant = strip(*({"kind": "strain-gauge", "position": 0.18, "wall": "strip", "angle_deg": angle} for angle in angles)).plant
    along, plus, across, minus = plant.C
    np.testing.assert_allclose(along + across, plus + minus, atol=1e-9 * np.abs(along).max())
    bent = np.abs(along) > 0.1 * np.abs(along).max()
    assert across[bent] / along[bent] == pytest.approx(-0.33, abs=0.05)  # Poisson's ratio, the strip being free across


def test_the_rate_of_a_charge_is_the_current():
    plant = strip({"kind": "charge"}, {"kind": "current"}).plant
    np.testing.assert_allclose(plant.C[0] @ plant.A, plant.C[1], rtol=1e-9, atol=1e-12 * np.abs(plant.C[1]).max())


@pytest.mark.parametrize(
    "sensor",
    [
        {"kind": "charge"},
        {"kind": "displacement", "position": 0.1},
        {"kind": "strain-gauge", "position": 0.035, "wall": "strip", "face": "inner"},
        {"kind": "strain-gauge", "position": 0.2, "wall": "strip"},
    ],
)
def test_what_a_constant_voltage_shows_does_not_depend_on_how_many_modes_are_kept(sensor):
    few, many = (strip(sensor, modes=modes).plant for modes in (3, 12))
    assert gain(few, few.B, few.D) == pytest.approx(gain(many, many.B, many.D), rel=1e-9)
    behind = strip(sensor).truth
    assert gain(behind, behind.B, behind.D) == pytest.approx(gain(few, few.B, few.D), rel=1e-9)
    assert np.any(few.D)


def test_a_gauge_over_the_actuator_shows_the_strain_of_a_sandwich():
    """Beneath a sheet on one face of a beam far from its ends: N and M of the sheet on the axial and the bending stiffness."""
    groups = blade_config("aluminium-cantilever").patches
    bare = replace(
        groups, actuators=(replace(groups.actuators[0], passive=False),), sensors=(replace(groups.sensors[0], passive=False),)
    )
    gauge = {"kind": "strain-gauge", "position": 0.045, "wall": "strip", "face": "inner"}
    plant = strip(gauge, patches=bare).plant
    force = 180e-12 / 16.1e-12 * 0.025 * (1.0 - 0.33) / (1.0 - 0.34)  # N per volt: E d31 b, and what it pushes across
    lever = 0.5 * (THICKNESS + 0.5e-3)
    wanted = force / (E * WIDTH * THICKNESS) - force * lever * (THICKNESS / 2.0) / (E * WIDTH * THICKNESS**3 / 12.0)
    assert abs(gain(plant, plant.B, plant.D)[0, 0]) == pytest.approx(abs(wanted), rel=0.12)  # the sheet is narrower than the strip


@pytest.mark.parametrize("speeding_up", [0.0, 700.0])
def test_an_accelerometer_on_a_turning_blade_feels_its_point_s_path_in_space(speeding_up):
    """Second differences of the path of a point that vibrates, along an axis that turns with hub and section."""
    generator, speed, step = np.random.default_rng(1), 40.0, 1e-5
    rows = PointRows(generator.normal(size=(3, 2)), generator.normal(size=(3, 2)), np.array([0.1, 0.02, 1.5]))
    direction = np.array([0.3, 0.8, -0.5])
    q, rate, second = 1e-4 * generator.normal(size=(3, 2)) * np.array([1.0, 1e2, 1e4])[:, None]

    def at(time: float) -> tuple[np.ndarray, np.ndarray]:
        now = q + rate * time + 0.5 * second * time**2
        turned = speed * time + 0.5 * speeding_up * time**2
        c, s = np.cos(turned), np.sin(turned)
        hub = np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])
        return hub @ (rows.stands + rows.moved @ now), hub @ (direction + np.cross(rows.turned @ now, direction))

    before, here, after = (at(time)[0] for time in (-step, 0.0, step))
    still = direction @ (speeding_up * np.cross([0.0, 1.0, 0.0], rows.stands) - speed**2 * rows.stands * [1.0, 0.0, 1.0])
    wanted = at(0.0)[1] @ (before - 2.0 * here + after) / step**2 - still
    felt = sum(
        row @ part for row, part in zip(felt_acceleration(rows, direction, speed, speeding_up), (q, rate, second), strict=True)
    )
    assert felt == pytest.approx(wanted, rel=1e-3)
