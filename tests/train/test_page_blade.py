"""The blade that a page draws: its shape, its motion, its patches, and what is dead."""

import base64
from dataclasses import replace

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import no_control
from beamenv.blade.shape import bodies
from beamenv.scenarios.load_cases import static_deflection
from train.page import record_episode
from train.page.blade import drawn_blade, frame_times, shapes_and_amplitudes


def unpacked(text, *shape):
    return np.frombuffer(base64.b64decode(text), dtype="<f4").reshape(*shape)


def moved(blade):
    """(F, 3, S) of each recording: shapes times amplitudes."""
    stations = len(unpacked(blade["stations"], -1))
    shapes = unpacked(blade["shapes"], -1, 3, stations).astype(float)
    return [np.einsum("fr,rds->fds", unpacked(each["amplitudes"], -1, len(shapes)), shapes) for each in blade["recordings"]]


@pytest.fixture(scope="module")
def drawn(page_content):
    return drawn_blade(page_content.episode)


def test_the_drawn_tip_moves_by_the_tip_displacement_and_the_root_stays(page_content, drawn):
    episode = page_content.episode
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    for recording, displacement in zip(episode.recordings, moved(drawn), strict=True):
        largest = np.abs(recording.tip).max()
        np.testing.assert_allclose(displacement[:, :2, -1], recording.tip[at], atol=1e-5 * largest)
        assert np.abs(displacement[:, :, 0]).max() < 1e-5 * largest


def test_the_plant_of_the_episode_is_drawn_and_not_the_design():
    """In "off-speed" each episode has another plant, whose states mean something else."""
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    episode = record_episode({"duration": 0.02, "scenario": {"preset": "off-speed", "plants": {"bank": 4}}}, 3, {"idle": idle})
    (displacement,) = moved(drawn_blade(episode))
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    tip = episode.without_control.tip[at]
    np.testing.assert_allclose(displacement[:, :2, -1], tip, atol=1e-4 * np.abs(tip).max())


def test_a_blade_that_failed_stays_as_it_was_last(page_content):
    short = page_content.episode.recordings[1]
    short = replace(short, **{name: getattr(short, name)[:60] for name in ("time", "states", "tip", "volts", "readings", "truth")})
    episode = replace(page_content.episode, recordings=(page_content.episode.without_control, short))
    whole, lost = drawn_blade(episode)["recordings"]
    assert whole["failed"] is None and lost["failed"] == pytest.approx(29.5)
    volts = unpacked(lost["volts"], -1, 4)
    assert len(volts) == len(frame_times(episode)) == 26
    np.testing.assert_allclose(volts[-10:], np.broadcast_to(short.volts[-1], (10, 4)), rtol=1e-6)


def test_a_blade_that_moves_out_of_all_bounds_takes_no_shape_from_the_others():
    small, shapes = np.random.default_rng(0).normal(size=(40, 3)), np.random.default_rng(1).normal(size=(3, 3, 9))
    displacements = [np.einsum("fr,rds->fds", 10.0**power * small, shapes) for power in (-4, 6)]
    found, amplitudes = shapes_and_amplitudes(displacements)
    assert len(found) == 3
    for expected, amplitude in zip(displacements, amplitudes, strict=True):
        np.testing.assert_allclose(np.einsum("fr,rds->fds", amplitude, found), expected, atol=1e-12 * np.abs(expected).max())


def test_the_blade_at_rest_is_the_beams_contour_and_has_its_patches_and_its_hub(page_content, drawn):
    blade = page_content.episode.blade
    at = {name: unpacked(values, -1) for name, values in drawn["vertices"].items()}
    turned = np.exp(1j * at["angle"]) * (at["along"] + 1j * at["across"])
    stations = unpacked(drawn["stations"], -1)
    (body,) = drawn["bodies"]
    here = slice(body["first"], body["first"] + body["stations"] * body["corners"])
    skin = bodies(blade.beam, stations.astype(float))[0].at_rest().reshape(-1, 3)
    np.testing.assert_allclose(np.stack([turned.real[here], turned.imag[here]], axis=-1), skin[:, :2], atol=1e-7)
    patches = blade.config.patches
    assert (len(drawn["actuators"]), len(drawn["sensors"]), drawn["points"]) == (4, 4, [])
    starts = [inlay.start for group in patches.groups("actuators") for inlay in group.inlays("actuators", blade.config.beam.length)]
    np.testing.assert_allclose(stations[at["station"][drawn["actuators"]].astype(int)], starts, atol=1e-6)
    assert max(corner[2] for face in drawn["hub"] for corner in face) == 0.0
    assert drawn["readBy"]["sensors"] == [0, 1, 2, 3]


def test_actuators_have_the_voltage_and_sensors_the_output_of_the_frame(page_content, drawn):
    episode = page_content.episode
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    for recording, told in zip(episode.recordings, drawn["recordings"], strict=True):
        np.testing.assert_allclose(unpacked(told["volts"], -1, 4), recording.volts[at], rtol=1e-6)
        outputs = unpacked(told["outputs"], -1, 4)
        np.testing.assert_allclose(outputs, (recording.readings / episode.blade.truth.sensor_full_scale)[at], rtol=1e-6)
        assert 0.0 < np.abs(outputs).max() <= 1.0


def test_the_load_that_is_drawn_is_the_one_that_bends_the_blade():
    """In the mean over many periods the tip stands where the mean load alone would hold it."""
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    episode = record_episode({"duration": 1.0, "scenario": "step"}, 3, {"idle": idle})
    told, still = episode.without_control, 200
    held = static_deflection(episode.blade.truth, np.diag(told.load[still:].mean(axis=0)))
    expected = (episode.blade.truth.tip_displacement @ held.T).sum(axis=1)
    np.testing.assert_allclose(told.tip[still:].mean(axis=0), expected, rtol=0.02)
    drawn = drawn_blade(episode)
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    loads = unpacked(drawn["recordings"][0]["load"], -1, 2)
    np.testing.assert_allclose(loads, told.load[at], rtol=1e-6)
    assert drawn["arrow"]["largest"] == pytest.approx(np.linalg.norm(loads, axis=1).max())
    length = episode.blade.config.beam.length
    assert unpacked(drawn["stations"], -1)[drawn["arrow"]["station"]] == pytest.approx(0.88 * length, abs=0.02 * length)


def test_what_is_dead_is_told_frame_by_frame():
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    dead = drawn_blade(record_episode({"duration": 0.02, "scenario": "two-dead-actuators"}, 3, {"idle": idle}))["recordings"][0][
        "dead"
    ]
    assert len(dead) == 6 and all(each == dead[0] for each in dead)
    assert len(dead[0]) == 2 and max(dead[0]) < 4
    later = record_episode({"duration": 0.4, "scenario": "mid-failure"}, 3, {"idle": idle})
    first, *_, last = drawn_blade(later)["recordings"][0]["dead"]
    assert first == [] and len(last) == 1


def test_the_solid_is_shown_as_far_as_the_beam_has_its_modes():
    idle = no_control(gym.make(beamenv.ENV_ID).unwrapped.plant)
    episode = record_episode({"duration": 0.05, "scenario": "solid-20"}, 3, {"idle": idle})
    assert episode.without_control.states.shape[1] == len(episode.blade.truth.A)
    (displacement,) = moved(drawn_blade(episode))
    at = np.rint(frame_times(episode) / episode.blade.config.control_interval).astype(int)
    true = episode.without_control.tip[at]
    assert np.abs(displacement[:, :2, -1] - true).max() < 0.05 * np.abs(true).max()
