"""Patches next to the clamp: what solid elements say of them, and what the blade says of itself."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import Blade
from beamenv.blade.clamp import clamp_note
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.plant.files import load_plant

SOLID = load_plant("solid-blade")
"""Of the bare thesis blade, linear steady state."""


def bare(**changes):
    """The thesis' blade as the solid has it."""
    steady = {} if changes.get("model") == "thesis" else {"beam": {"steady_state": "linear"}}
    return Blade(blade_config("thesis", {"patches": {"passive": False}, "modes": 20, **steady, **changes}))


def driven(blade):
    """(20, 4): modal force per volt of each patch, and (2, 4): static tip displacement per volt of twenty modes."""
    modal, full = blade.modal, blade.full
    forces = modal.mode_shapes.T @ full.forces
    return forces, (full.tip @ modal.mode_shapes / modal.natural_frequencies**2) @ forces


def departure(blade):
    """(8,): of the modal forces of the patch at the clamp from the solid's, whichever way the modes are counted."""
    own, solid = np.abs(driven(blade)[0][:8, 0]), np.abs(SOLID.actuation[:8, 0])
    return own / solid - 1.0


def test_the_patch_at_the_clamp_is_seven_per_cent_from_solid_elements_mode_by_mode():
    blade = bare()
    assert np.abs(departure(blade)).max() == pytest.approx(0.072, abs=0.002)  # the figure that the note and the pages tell
    tip = SOLID.tip / SOLID.natural_frequencies**2 @ SOLID.actuation[:, 0]
    assert driven(blade)[1][:, 0] / tip - 1.0 == pytest.approx([-0.124, -0.066], abs=0.005)


def test_in_the_thesis_model_it_is_not():
    forces = driven(bare(model="thesis"))[0][:8, 0]
    solid = SOLID.actuation[:8, 0]
    assert np.abs(np.abs(forces / solid) - 1.0).max() == pytest.approx(1.1, abs=0.05)


def test_a_blade_with_patches_nearer_than_its_depth_says_so():
    assert clamp_note(PRESETS["thesis"]) == (
        "Nearer to the clamp than the section is deep (0.0508 m): actuator at 0 m, sensor at 0 m; what patches do there differs "
        "from solid elements by up to 7 %, mode by mode."
    )
    assert "110 %" in clamp_note(blade_config("thesis", {"model": "thesis"}))
    assert clamp_note(PRESETS["sound-blade"]) == ""


def test_a_depth_away_is_enough():
    config = PRESETS["thesis"]
    edge = config.beam.depth
    for first, told in ((edge, False), (0.99 * edge, True)):
        patches = replace(config.patches, actuators=(first, 0.5), sensors=(edge, 0.5))
        assert bool(clamp_note(replace(config, patches=patches))) is told
