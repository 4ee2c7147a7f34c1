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
from beamenv.rendering.largest import largest_of, reference_deflection
from beamenv.rendering.palette import DARK, INK, LIGHT, VOLTAGE_SCALE, colour_table, colours_of
from beamenv.rendering.scene import PLACE, Scene, Values
from beamenv.rendering.solid import SHOWN_DEFLECTION, BladeSolid
from beamenv.task import resolve_task


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
def test_a_step_of_the_reference_load_bends_the_drawn_blade_by_a_set_share_of_its_length_or_a_little_less(preset):
    blade = Blade(blade_config(preset))
    share = BladeSolid(blade).magnification * 2.0 * reference_deflection(blade.plant) / blade_config(preset).beam.length
    assert 0.5 * SHOWN_DEFLECTION < share <= SHOWN_DEFLECTION


@pytest.mark.parametrize("scenario", ["default", "overload", "white", "rotor"])
def test_the_largest_deflection_of_a_scenario_is_drawn_as_a_set_share_of_the_span_or_a_little_less(scenario):
    task = resolve_task(scenario=scenario)
    largest = largest_of(task)
    share = BladeSolid(task.blade, largest.deflection).magnification * largest.deflection / task.config.beam.length
    assert 0.5 * SHOWN_DEFLECTION < share <= SHOWN_DEFLECTION


def test_the_largest_deflection_is_that_of_an_episode_left_alone():
    env, largest = RotatingBeamEnv(scenario="pulse", dtype="float64"), largest_of(resolve_task(scenario="pulse"))
    found = []
    for seed in range(4):
        env.reset(seed=seed)
        found.append(max(np.linalg.norm(env.step(np.zeros(4))[-1]["tip_displacement"]) for _ in range(200)))
    assert 0.5 * largest.deflection < max(found) <= largest.deflection * (1.0 + 1e-9)
    assert largest.load == pytest.approx(45.0, rel=0.2)  # the strongest pulse, and a little white load on it


def test_where_nothing_moves_a_blade_it_is_drawn_for_a_step_of_the_reference_load():
    task = resolve_task(scenario="quiet")
    assert largest_of(task) == (2.0 * reference_deflection(task.plant), 30.0)


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


def sheet(scene, values=None, load=(0.0, 0.0), theme=LIGHT):
    """A blade at rest, its patches worth ``values``, as a picture."""
    canvas, still = Canvas(theme), np.zeros((3, len(scene.solid.stations)))
    canvas.clear()
    scene.draw_rest(canvas)
    canvas.keep()
    values = values or Values(np.zeros(4), np.zeros(4), np.zeros(4, dtype=bool), np.zeros(4, dtype=bool))
    scene.draw(canvas, still, values, np.array(load))
    return canvas.pixels().astype(int)


def test_dead_patches_are_crossed_out_and_no_others():
    scene = Scene(Blade(blade_config()))
    dead = np.array([False, True, False, False])
    sound, crossed = sheet(scene), sheet(scene, Values(np.zeros(4), np.zeros(4), dead, dead[::-1]))
    changed = np.abs(crossed - sound).max(axis=-1) > 60
    for patches, gone in ((scene._rest.actuators, dead), (scene._dropped(scene._rest), dead[::-1])):
        corners, _ = scene._camera.project(patches)
        for patch, is_dead in zip(corners, gone, strict=True):
            (left, top), (right, bottom) = patch.min(axis=0).astype(int), patch.max(axis=0).astype(int)
            assert changed[top : bottom + 1, left : right + 1].any() == is_dead
            x, y = np.rint(0.75 * patch[0] + 0.25 * patch[2]).astype(int)  # on the diagonal, away from the number
            ink = np.array([int(INK[k : k + 2], 16) for k in (1, 3, 5)])
            assert (np.abs(crossed[y - 1 : y + 2, x - 1 : x + 2] - ink).max(axis=-1) < 90).any() == is_dead


def test_a_cross_is_seen_on_the_darkest_colours_too():
    scene, nothing = Scene(Blade(blade_config())), np.zeros(4, dtype=bool)
    crossed = sheet(scene, Values(np.full(4, -1.0), np.ones(4), ~nothing, ~nothing))
    for patches in (scene._rest.actuators, scene._dropped(scene._rest)):
        for patch in scene._camera.project(patches)[0]:
            x, y = np.rint(0.75 * patch[0] + 0.25 * patch[2]).astype(int)
            assert crossed[y - 1 : y + 2, x - 1 : x + 2].min(axis=-1).max() > 180


@pytest.mark.parametrize(("load", "side"), [((0.0, 1.0), 1.0), ((0.0, -1.0), -1.0)])
def test_an_arrow_pushes_the_blade_the_way_the_load_does(load, side):
    scene = Scene(Blade(blade_config()))
    arrow = np.argwhere(np.abs(sheet(scene, load=load) - sheet(scene)).max(axis=-1) > 60)
    along = np.array([*scene.solid.stations[[0, -1]]])
    axis, _ = scene._camera.project(np.stack([[0.0, 0.0, z] for z in along]))
    level = np.interp(arrow[:, 1], axis[:, 0], axis[:, 1])  # y of the blade's axis there; y runs down
    tail = arrow[np.argmax(side * (arrow[:, 0] - level))]
    assert side * (tail[0] - np.interp(tail[1], axis[:, 0], axis[:, 1])) > 40.0
    assert np.min(np.abs(arrow[:, 0] - level)) < 3.0


def test_no_load_has_no_arrow_and_a_small_one_a_short_one():
    scene = Scene(Blade(blade_config()))
    whole, half, none = ((np.abs(sheet(scene, load=(0.0, x)) - sheet(scene)).max(axis=-1) > 60).sum() for x in (1.0, 0.5, 0.0))
    assert none == 0 < half < whole


def test_a_dark_page_is_dark_but_for_the_blade():
    picture = sheet(Scene(Blade(blade_config()), theme=DARK), theme=DARK)
    assert picture[0, 0].tolist() == [13, 17, 23]
    assert (picture.mean(axis=-1) > 100).mean() < 0.3


def test_a_blade_of_any_closed_section_is_drawn_with_its_patches():
    corners = ((0.127, 0.0), (0.09, 0.028), (-0.03, 0.028), (-0.127, 0.0), (-0.03, -0.018), (0.09, -0.018))
    section = PolygonSection(corners, ("nose", "top", "back", "tail", "bottom", "chin"), 0.006)
    blade = Blade(blade_config())
    vars(blade)["beam"] = RotatingBeam(section, Layup.uniform(GRAPHITE_EPOXY, [30.0] * 6), 2.023, 0.2, pretwist_deg=30.0)
    scene, sound = Scene(blade), np.zeros(4, dtype=bool)
    still = np.zeros((3, len(scene.solid.stations)))
    picture = sheet(scene, Values(np.array([1.0, -1.0, 1.0, -1.0]), np.zeros(4), sound, sound))
    corners, _ = scene._camera.project(scene.solid.pose(still).actuators)
    assert faces_camera(corners).all()
    for patch, sign in zip(corners, (1.0, -1.0, 1.0, -1.0), strict=True):
        (wanted,) = colours_of(colour_table(VOLTAGE_SCALE), np.array([sign]))
        x, y = np.rint(patch.mean(axis=0)).astype(int)
        assert (np.abs(picture[y - 4 : y + 5, x - 10 : x + 11] - wanted).max(axis=-1) <= 2).sum() > 40
