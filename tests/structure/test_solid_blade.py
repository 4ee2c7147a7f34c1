"""The thesis' blade against 27-node solid elements of it: bare, at 200 rad/s under linear prestress, 20 modes; and at rest.

The elements are themselves within 0.1 % in bending and 0.6 % in twist of a finer mesh.
"""

from dataclasses import dataclass, replace
from weakref import WeakValueDictionary

import numpy as np
import pytest

from beamenv import load_plant
from beamenv.blade.config import BeamConfig
from beamenv.patches import PatchLayout, actuation, sensing
from beamenv.structure.geometrically_exact import sections_along
from beamenv.structure.modes import normal_modes
from beamenv.structure.section import solid_sections

SPEED = 200.0
SOLID = load_plant("solid-blade")
AT_REST = np.array([41.2, 133.7, 269.9, 612.0, 664.0, 943.0, 1203.0])
BARE = BeamConfig(steady_state="linear")
LAYOUT = PatchLayout(passive=False)
INTERIOR = [1, 2, 3]
"""Patches that do not touch the clamp."""
TWIST = [3, 6, 8]
"""Modes in which the tip's centre stays where it is: of stretch and twist."""
BENDING = [0, 1, 2, 4, 5, 7, 9, 10]


def percent(found, reference):
    return 100.0 * (np.asarray(found) / np.asarray(reference) - 1.0)


@dataclass(frozen=True)
class Modal:
    """Unit modal mass, signs as the solid's."""

    frequencies: np.ndarray
    actuation: np.ndarray
    charges: np.ndarray
    line_load: np.ndarray
    tip: np.ndarray
    gyroscopic: np.ndarray


@pytest.fixture(scope="module")
def beam():
    blade = BARE.build()
    point = blade.at(SPEED)
    frequencies, shapes = normal_modes(point.mass, point.stiffness, 20)
    force = shapes.T @ actuation(blade, LAYOUT, SPEED)
    shapes = shapes * np.sign((force * SOLID.actuation).sum(axis=1))
    rows = blade.displacements(blade.length)
    return Modal(
        frequencies=frequencies,
        actuation=shapes.T @ actuation(blade, LAYOUT, SPEED),
        charges=sensing(blade, LAYOUT, SPEED) @ shapes,
        line_load=shapes.T @ blade.line_load(),
        tip=np.vstack([rows["u"], rows["v"]]) @ shapes,
        gyroscopic=shapes.T @ point.gyroscopic @ shapes,
    )


def test_frequencies_at_200_rad_per_s(beam):
    """Eight modes within 3 % and eleven within 6 % are asked; 1.4 % is kept."""
    off = percent(beam.frequencies, SOLID.natural_frequencies)[:11]
    assert np.abs(off).max() < 1.4


def test_frequencies_at_rest():
    assert np.abs(percent(BARE.build().natural_frequencies(0.0, 7), AT_REST)).max() < 1.0


def with_distortions(monkeypatch, count):
    """Frequencies when all but the first shapes are of no extent."""
    every = solid_sections.distortion_shapes
    monkeypatch.setattr(sections_along, "_ALIVE", WeakValueDictionary())  # sections are shared with other blades else

    def few(system, loads):
        shapes = every(system, loads)
        return shapes * (np.arange(shapes.shape[-1]) < count)

    monkeypatch.setattr(solid_sections, "distortion_shapes", few)
    return BARE.build().natural_frequencies(SPEED, 11, gyroscopic=False)


def test_what_the_second_torsion_mode_lacks_without_distortion_is_distortion(monkeypatch):
    """Mode 9 is 8.7 % too high while sections only warp as Saint-Venant says; all others are within 1.7 %. With shapes of the
    section's own vibration it comes down, and nothing else moves by more.
    """
    with monkeypatch.context() as patch:
        without = percent(with_distortions(patch, 0), SOLID.natural_frequencies[:11])
    whole = percent(BARE.build().natural_frequencies(SPEED, 11, gyroscopic=False), SOLID.natural_frequencies[:11])
    assert without[8] == pytest.approx(8.7, abs=0.2)
    assert np.abs(np.delete(without, 8)).max() < 1.7
    assert whole[8] == pytest.approx(-0.74, abs=0.2)
    assert np.abs(np.delete(whole - without, 8)).max() < 2.0


def test_gyroscopic_coupling_of_bending(beam):
    """Entries among the eight bending modes within 2 % of the largest."""
    pick = np.ix_(BENDING, BENDING)
    assert np.abs(beam.gyroscopic[pick] - SOLID.gyroscopic[pick]).max() < 0.02 * np.abs(SOLID.gyroscopic[:11, :11]).max()


def test_uniform_loads_and_the_tip(beam):
    """Each bending mode, lag and flap together: within 1 % of the mode's own size to the eighth, 10 % in modes 10 and 11."""
    for ours, theirs in ((beam.line_load, SOLID.line_load), (beam.tip.T, SOLID.tip.T)):
        off = np.linalg.norm(ours - theirs, axis=1)[BENDING] / np.linalg.norm(theirs, axis=1)[BENDING]
        assert off[:6].max() < 0.02
        assert off.max() < 0.10


def test_modal_force_of_interior_patches_on_bending(beam):
    """Modes 2, 3, 5, 6, 8 within 4 % of the largest force of a patch on the mode; mode 1, which bends at the root, within 8 %."""
    off = np.abs(beam.actuation - SOLID.actuation)[:, INTERIOR] / np.abs(SOLID.actuation).max(axis=1)[:, None]
    assert off[[1, 2, 4, 5, 7]].max() < 0.04
    assert off[0].max() < 0.08


def test_modal_force_of_interior_patches_on_twist(beam):
    """Mode 4, the first torsion, within 4 % (5 % are asked; wall kinematics were 9 % too low, and 15 % per volt), mode 7 in 2 %."""
    off = percent(beam.actuation, SOLID.actuation)[:, INTERIOR]
    assert np.abs(off[3]).max() < 4.0
    assert np.abs(off[6]).max() < 2.0


def test_sensors_show_what_actuators_do(beam):
    """Charges follow the same strains: within 4 % of the largest in modes of bending, 5 and 2 % in modes 4 and 7."""
    off = np.abs(beam.charges - SOLID.charges).T[:, INTERIOR] / np.abs(SOLID.charges).T.max(axis=1)[:, None]
    assert off[[1, 2, 4, 5, 7]].max() < 0.04
    twist = percent(beam.charges.T, SOLID.charges.T)[:, INTERIOR]
    assert np.abs(twist[3]).max() < 5.0
    assert np.abs(twist[6]).max() < 2.5


def tip_per_volt(modal, frequencies, count=11):
    return modal.tip[:, :count] / frequencies[:count] ** 2 @ modal.actuation[:count]


def test_tip_flap_per_volt_of_interior_patches(beam):
    """By the first eleven modes: within 2 % (1.004, 0.988, 1.005); that at the clamp, where section theory ends, within 8 %."""
    ours = tip_per_volt(beam, beam.frequencies)[1]
    theirs = tip_per_volt(SOLID, SOLID.natural_frequencies)[1]
    assert np.abs(percent(ours, theirs))[INTERIOR].max() < 2.0
    assert abs(percent(ours, theirs)[0]) < 8.0


def test_patch_at_the_clamp(beam):
    """Lag per volt within 12 % where wall kinematics missed 76 %; force on the first torsion within 5 % where they missed 61 %."""
    ours, theirs = (
        tip_per_volt(each, each_frequencies)[0, 0]
        for each, each_frequencies in ((beam, beam.frequencies), (SOLID, SOLID.natural_frequencies))
    )
    assert abs(percent(ours, theirs)) < 12.0
    assert abs(percent(beam.actuation[3, 0], SOLID.actuation[3, 0])) < 5.0


def test_wall_kinematics_are_further_from_the_solid():
    """So that the new model is asked for something the old one did not give: modes 8, 9 and 11 are 7 to 10 % too high there."""
    walls = replace(BARE.build(), model="thesis", shear_flow="consistent", steady_state=None)
    off = percent(walls.natural_frequencies(SPEED, 11, gyroscopic=False), SOLID.natural_frequencies[:11])
    assert off[[7, 8, 10]] == pytest.approx([6.9, 10.4, 7.1], abs=0.8)
