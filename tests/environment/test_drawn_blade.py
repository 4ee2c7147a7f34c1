"""The drawn blade: where its points are, and what a camera sees of them."""

import numpy as np
import pytest

import beamenv
from beamenv import RotatingBeamEnv, blade_config
from beamenv.blade.build import Blade, displacement_operator
from beamenv.blade.shape import sides
from beamenv.scenarios.load_cases import static_deflection
from beamenv.structure import GRAPHITE_EPOXY, Layup, PolygonSection, RotatingBeam

pytest.importorskip("matplotlib")
pytest.importorskip("pygame")

from beamenv.rendering.camera import Camera, faces_camera
from beamenv.rendering.canvas import Canvas, Frame
from beamenv.rendering.palette import VOLTAGE_SCALE, colour_table, colours_of
from beamenv.rendering.scene import PLACE, Scene
from beamenv.rendering.solid import SHOWN_DEFLECTION, BladeSolid


def test_the_drawn_tip_moves_by_the_magnified_tip_displacement():
    config = blade_config()
    plant, solid = Blade(config).truth, BladeSolid(Blade(config))
    state = static_deflection(plant, [3.0, 30.0])
    operator = displacement_operator(config, solid.stations)
    rest, bent = (solid.pose(operator @ each).bodies[0].mean(axis=1) for each in (0.0 * state, state))
    np.testing.assert_allclose((bent - rest)[-1, :2], solid.magnification * plant.tip_displacement @ state, rtol=1e-9)
    np.testing.assert_allclose((bent - rest)[0], 0.0, atol=1e-12)


@pytest.mark.parametrize("preset", ["nominal", "spillover", "off-speed", "off-model", "spin-up"])
def test_the_shape_of_every_plant_of_a_bank_ends_at_its_tip_displacement(preset):
    few = {"plants": {"bank": 3}} if preset.startswith("off") else {}
    env = RotatingBeamEnv(render_mode="rgb_array", scenario={"preset": preset, **few}, duration=0.05)
    assert len(env.task.bank) == {"off-speed": 3, "off-model": 3, "spin-up": 100}.get(preset, 1)
    for seed in range(2):
        env.reset(seed=seed)
        for _ in range(40):
            _, _, _, _, info = env.step(np.full(4, 0.5))
        last = env._renderer._history.last
        shape = env._renderer._deformation.displacement(last.state, last.plant)
        np.testing.assert_allclose(shape[:2, -1], info["tip_displacement"], rtol=1e-6, atol=1e-12)


def test_a_twist_turns_the_section_about_its_axis_by_the_magnified_angle():
    solid = BladeSolid(Blade(blade_config(overrides={"beam": {"pretwist_deg": 0.0}})))
    twist = np.zeros((3, len(solid.stations)))
    twist[2, -1] = 0.3 / solid.magnification
    corner, turned = (solid.pose(each).bodies[0][-1, 1, :2] for each in (0.0 * twist, twist))
    np.testing.assert_allclose(turned, [[np.cos(0.3), -np.sin(0.3)], [np.sin(0.3), np.cos(0.3)]] @ corner, rtol=1e-12)


def test_the_solid_has_the_blade_s_pretwist_taper_and_outer_dimensions():
    config = blade_config(overrides={"beam": {"taper": 2.0}})
    beam, solid = config.beam, BladeSolid(Blade(config))
    walls = solid.pose(np.zeros((3, len(solid.stations)))).bodies[0]
    chord = walls[:, 1] - walls[:, 2]
    assert np.linalg.norm(chord[0]) == pytest.approx(beam.width + beam.thickness)
    assert np.linalg.norm(chord[-1]) == pytest.approx(0.5 * beam.width + beam.thickness)
    assert np.degrees(np.arctan2(chord[:, 1], chord[:, 0]))[[0, -1]] == pytest.approx([0.0, 30.0])


@pytest.mark.parametrize("preset", sorted(beamenv.PRESETS))
def test_the_reference_load_bends_the_drawn_blade_by_a_set_share_of_its_length_or_a_little_less(preset):
    solid = BladeSolid(Blade(blade_config(preset)))
    share = solid.magnification * solid.reference_deflection / blade_config(preset).beam.length
    assert 0.5 * SHOWN_DEFLECTION < share <= SHOWN_DEFLECTION


def test_a_camera_sees_a_length_in_inverse_proportion_to_its_distance():
    camera = Camera(np.zeros(3), np.array([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]]), 100.0, np.array([50.0, 40.0]))
    screen, depth = camera.project(np.array([[1.0, 1.0, 2.0], [1.0, 1.0, 4.0]]))
    np.testing.assert_allclose(screen, [[100.0, -10.0], [75.0, 15.0]])
    np.testing.assert_allclose(depth, [2.0, 4.0])


def test_three_faces_of_a_box_are_seen_from_above_beside_and_before_it():
    box = np.array([[1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
    walls = np.stack([np.column_stack([box, np.full(4, z)]) for z in (0.0, 4.0)])
    frame = Frame(0.0, 0.0, 300.0, 200.0)
    for towards, seen in (([0.5, 0.6, 0.7], [0, 1, 4]), ([-0.5, 0.6, 0.7], [1, 2, 4]), ([0.5, -0.6, -0.7], [0, 3])):
        camera = Camera.facing(walls.reshape(-1, 3), np.array(towards), 20.0, frame)
        corners, _ = camera.project(np.concatenate([sides(walls), walls[-1:]]))
        assert np.flatnonzero(faces_camera(corners)).tolist() == seen
        assert corners.min(axis=(0, 1)).min() >= -1e-9
        assert (corners.max(axis=(0, 1)) <= [300.0 + 1e-9, 200.0 + 1e-9]).all()


@pytest.mark.parametrize("preset", sorted(beamenv.PRESETS))
def test_every_actuator_and_sensor_of_every_preset_is_in_the_scene(preset):
    scene = Scene(Blade(blade_config(preset)))
    for patches in (scene._rest.actuators, scene._dropped(scene._rest)):
        corners, _ = scene._camera.project(patches)
        assert faces_camera(corners).all()
        assert (corners >= [PLACE.left, PLACE.top]).all()
        assert (corners <= [PLACE.left + PLACE.width, PLACE.top + PLACE.height]).all()


def test_a_blade_of_any_closed_section_is_drawn_with_its_patches():
    corners = ((0.127, 0.0), (0.09, 0.028), (-0.03, 0.028), (-0.127, 0.0), (-0.03, -0.018), (0.09, -0.018))
    section = PolygonSection(corners, ("nose", "top", "back", "tail", "bottom", "chin"), 0.006)
    blade = Blade(blade_config())
    vars(blade)["beam"] = RotatingBeam(section, Layup.uniform(GRAPHITE_EPOXY, [30.0] * 6), 2.023, 0.2, pretwist_deg=30.0)
    scene, canvas = Scene(blade), Canvas()
    canvas.clear()
    scene.draw_rest(canvas)
    canvas.keep()
    still = np.zeros((3, len(scene.solid.stations)))
    scene.draw(canvas, still, np.array([1.0, -1.0, 1.0, -1.0]), np.zeros(4))
    picture = canvas.pixels().astype(int)
    corners, _ = scene._camera.project(scene.solid.pose(still).actuators)
    assert faces_camera(corners).all()
    for patch, sign in zip(corners, (1.0, -1.0, 1.0, -1.0), strict=True):
        (wanted,) = colours_of(colour_table(VOLTAGE_SCALE), np.array([sign]))
        x, y = np.rint(patch.mean(axis=0)).astype(int)
        assert (np.abs(picture[y - 4 : y + 5, x - 10 : x + 11] - wanted).max(axis=-1) <= 2).sum() > 40
