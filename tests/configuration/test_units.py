"""Numbers in another unit than is meant are refused with the unit that may have been meant; what is built passes."""

import warnings

import numpy as np
import pytest

from beamenv.blade.build import build_beam
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.blade.units import in_radians

LAB = "aluminium-cantilever"


def strip(width, thickness):
    return {"shape": "strip", "width": width, "thickness": thickness}


MISTAKEN = {
    "all in mm": (
        LAB,
        {"beam": {"length": 300.0, "section": strip(30.0, 2.0)}},
        "beam.length is 300.0 (did you give millimetres?)",
    ),
    "span in mm": (
        LAB,
        {"beam": {"length": 300.0}},
        "beam.length is 300.0 (did you give millimetres?), but must be a number above 0 and at most 250 (m).",
    ),
    "short span in mm": (LAB, {"beam": {"length": 100.0}}, "but must be at most 2000 times the section's size, 60 (m)"),
    "strip in mm": (LAB, {"beam": {"section": strip(30.0, 2.0)}}, "beam.section.width is 30.0 (did you give millimetres?)"),
    "narrow strip in mm": (LAB, {"beam": {"section": strip(10.0, 0.1)}}, "section.width is 10.0 (did you give millimetres?)"),
    "strip's thickness in mm": (
        LAB,
        {"beam": {"section": strip(0.03, 2.0)}},
        "section.thickness is 2.0 (did you give millimetres?)",
    ),
    "wall in mm": ("thesis", {"beam": {"thickness": 10.16}}, "beam.thickness is 10.16 (did you give millimetres?)"),
    "ply in mm": (
        "thesis",
        {"beam": {"thickness": 0.127}},
        "beam.thickness is 0.127 (did you give millimetres?), but must be below",
    ),
    "hub in mm": ("thesis", {"beam": {"hub_radius": 2023.0}}, "beam.hub_radius is 2023.0 (did you give millimetres?)"),
    "patch in mm": ("thesis", {"patches": {"length": 85.0}}, "patches.length is 85.0 (did you give millimetres?)"),
    "patch's width in mm": ("thesis", {"patches": {"width": 57.0}}, "patches.width is 57.0 (did you give millimetres?)"),
    "sheet in mm": (
        "thesis",
        {"patches": {"material": {"thickness": 0.3}}},
        "patches.material.thickness is 0.3 (did you give millimetres?)",
    ),
    "moduli in GPa": (
        LAB,
        {"beam": {"material": {**dict.fromkeys(("E1", "E2"), 70.0), **dict.fromkeys(("G12", "G13", "G23"), 26.0)}}},
        "beam.material.E1 is 70.0 (did you give GPa?), but must be at least 1e+06 (Pa).",
    ),
    "moduli in MPa": (
        LAB,
        {"beam": {"material": {**dict.fromkeys(("E1", "E2"), 2.07e5), **dict.fromkeys(("G12", "G13", "G23"), 8e4)}}},
        "beam.material.E1 is 207000.0 (did you give MPa?)",
    ),
    "density in g/cm³": (LAB, {"beam": {"material": {"density": 2.7}}}, "beam.material.density is 2.7 (did you give g/cm³?)"),
}


@pytest.mark.parametrize(("preset", "given", "told"), MISTAKEN.values(), ids=MISTAKEN)
def test_another_unit_is_refused_in_one_sentence(preset, given, told):
    with pytest.raises(ValueError, match="^blade[.]") as refused:
        build_beam(blade_config(preset, given))
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


BUILT = {
    "a helicopter's": ("thesis", {"beam": {"length": 10.0, "width": 0.4, "depth": 0.06}, "speed": 30.0}),
    "a wind turbine's": (
        "thesis",
        {"beam": {"length": 60.0, "width": 3.0, "depth": 0.6, "thickness": 0.06, "hub_radius": 1.5}, "speed": 1.2},
    ),
    "the longest": (
        "thesis",
        {"beam": {"length": 150.0, "width": 6.5, "depth": 2.0, "thickness": 0.15, "hub_radius": 3.0}, "speed": 0.8},
    ),
    "a strip of 2 cm": (LAB, {"beam": {"length": 0.02, "section": strip(0.005, 0.0001)}}),
    "of foam": (LAB, {"beam": {"material": {"density": 52.0}}}),
}


@pytest.mark.parametrize(("preset", "given"), [*BUILT.values(), *((name, {}) for name in PRESETS)], ids=[*BUILT, *PRESETS])
def test_what_is_built_passes_without_a_word(preset, given):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        blade_config(preset, given)


@pytest.mark.parametrize("angles", [[0.5236] * 6, [np.pi / 4, -np.pi / 4], [0.0, 1.5708], [1.0472, -0.7854]])
def test_angles_that_look_like_radians_are_warned_of(angles):
    with pytest.warns(UserWarning, match=r"^blade\.beam\.ply_angles_deg\.all is taken for .* degrees; if these are radians, give "):
        blade_config("thesis", {"beam": {"ply_angles_deg": angles}})


@pytest.mark.parametrize("angles", [[0.5, -0.5], [30.0], [0.0], [1.0], [0.35], [0.96], [2.5, 0.7854], [90.0]])
def test_small_angles_in_degrees_are_taken_as_they_are(angles):
    assert not in_radians(angles)
