"""The blades of the gallery."""

from pathlib import Path

import numpy as np
import pytest

from baselines import lqg, no_control, stationary_cost
from beamenv.blade.build import Blade
from beamenv.blade.files import load_config

ROOT = Path(__file__).parents[2]
BLADES = sorted((ROOT / "examples" / "blades").glob("*.toml"))


@pytest.mark.parametrize("file", BLADES, ids=lambda file: file.stem)
def test_every_blade_of_the_gallery_is_damped_by_lqg_and_has_a_picture(file):
    assert (ROOT / "docs" / "images" / "gallery" / f"{file.stem}.png").is_file()
    blade = Blade(load_config(file))
    plant = blade.plant
    assert np.linalg.eigvals(plant.A).real.max() < 0.0
    assert stationary_cost(plant, lqg(plant)) < 0.97 * stationary_cost(plant, no_control(plant))


def test_the_gallery_has_a_blade_of_every_shape_but_the_plain_strip():
    """Which the preset of the aluminium cantilever is."""
    shapes = {load_config(file).beam.section.shape for file in BLADES}
    assert shapes == {"box", "tube", "polygon", "airfoil", "i", "c", "z", "walls"}
