"""The explorer of any blade: what its controls are, its picture, and the file that it is saved as."""

import xml.etree.ElementTree
from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pytest

from beamenv.blade.files import load_config
from beamenv.blade.presets import PRESETS, THESIS

pytest.importorskip("dash", reason="dash is not installed")

from train.explore.app import analyse, create_app, redraw  # noqa: E402 - they need the package asked for above
from train.explore.controls import RANGES, THESIS_PAGE, Page  # noqa: E402
from train.explore.picture import drawn, key  # noqa: E402
from train.explore.saved import saved  # noqa: E402
from train.figures.palette import PATCH_COLOURS, contrast  # noqa: E402
from train.figures.themes import THEMES  # noqa: E402

EXAMPLES = sorted((Path(__file__).resolve().parents[2] / "examples" / "blades").glob("*.toml"))
BLADES = {**PRESETS, **{path.stem: load_config(path) for path in EXAMPLES}}
EACH = [pytest.param(name, marks=pytest.mark.slow if name == "airfoil-two-webs" else ()) for name in BLADES]
"""Two webs and tables of chord and twist take 15 s to build."""
WITHOUT = {
    "airfoil-blade": {"ply_angle_deg"},
    "airfoil-two-webs": {"ply_angle_deg"},
    "channel": {"actuators", "sensors"},
    "round-tube": {"ply_angle_deg", "actuators", "sensors"},
    "t-section": {"ply_angle_deg", "actuators", "sensors"},
    "takacs-beam": {"sensors"},
    "two-cell-box": {"ply_angle_deg"},
    "wedge": {"ply_angle_deg"},
    "z-stringer": {"ply_angle_deg", "actuators", "sensors"},
}
"""Sliders of the thesis' blade that another one has not: patches in several groups have a slider for each group."""


@lru_cache
def page_of(name):
    return Page.of(BLADES[name])


@pytest.mark.parametrize("name", EACH)
def test_every_blade_has_the_sliders_that_mean_something_of_it(name):
    page = page_of(name)
    assert set(RANGES) - set(page.ranges) == WITHOUT.get(name, set())
    groups = {side: len(BLADES[name].patches.groups(side)) for side in ("actuators", "sensors")}
    for side, count in groups.items():
        assert len([each for each in page.ranges if each.startswith(side)]) == count


@pytest.mark.parametrize("name", EACH)
def test_every_blade_is_shown_as_it_is_until_a_control_moves(name):
    base = BLADES[name]
    page = page_of(name)
    assert page.settings(page.start).config(base) == base
    assert create_app(page).layout is not None
    shown, said = redraw(page, **page.start), analyse(page, **page.start)
    assert (shown["message"], said["lost"]) == ("", "")
    assert len(shown["damping"]) == base.modes
    assert len(said["margins"]) == 6


def test_a_slider_turns_plies_of_either_sign():
    page = page_of("sound-blade")
    assert page.settings(page.start | {"ply_angle_deg": 60.0}).config(page.base).beam.ply_angles_deg == (
        ("all", (60.0, -60.0) * 3),
    )


def test_patches_of_one_group_move_and_those_of_the_other_stay():
    page = page_of("channel")
    moved = page.settings(page.start | {"actuators-2": [90.0]}).config(page.base)
    assert moved.patches.actuator_positions(0.8) == (0.03, 0.09)
    assert moved.patches.sensors == page.base.patches.sensors


@pytest.mark.parametrize("name", EACH)
@pytest.mark.parametrize("moved", [False, True])
def test_the_file_says_the_blade_that_is_shown(tmp_path, name, moved):
    page = page_of(name)
    entry = page.ranges["speed"]
    values = page.start | ({"speed": entry.low + 7.0, "white_load": 1.1 * page.ranges["white_load"].value} if moved else {})
    blade = page.settings(values).config(page.base)
    file, text = saved(blade)
    (tmp_path / file).write_text(text, encoding="utf-8")
    assert load_config(tmp_path / file) == blade


def test_a_blade_with_a_field_that_toml_has_no_word_for_is_saved_as_json(tmp_path):
    blade = replace(THESIS, electronics=replace(THESIS.electronics, filter_cutoff=None))
    name, text = saved(blade)
    assert name == "blade.json"
    (tmp_path / name).write_text(text, encoding="utf-8")
    assert load_config(tmp_path / name) == blade


def test_the_page_offers_the_file_of_what_it_shows(tmp_path):
    offered = redraw(**THESIS_PAGE.start | {"taper": 1.25})["file"]
    (tmp_path / offered["name"]).write_text(offered["text"], encoding="utf-8")
    assert load_config(tmp_path / offered["name"]) == replace(THESIS, beam=replace(THESIS.beam, taper=1.25))


@pytest.mark.parametrize("name", EACH)
def test_the_picture_shows_every_patch_once_within_its_frame(name):
    base = BLADES[name]
    root = xml.etree.ElementTree.fromstring(drawn(base, base.beam.build(base.patches, base.model)))
    space = "{http://www.w3.org/2000/svg}"
    left, top, width, height = map(float, root.get("viewBox").split())
    for side in ("actuators", "sensors"):
        sheets = [each for each in root.iter(f"{space}polygon") if side[:-1] in each.get("class").split()]
        assert len(sheets) == sum(group.count for group in base.patches.groups(side))
    corners = [each.get("points") for each in root.iter() if each.get("points")]
    x, y = np.array([corner.split(",") for each in corners for corner in each.split()], dtype=float).T
    assert left <= x.min() and x.max() <= left + width
    assert top <= y.min() and y.max() <= top + height


def test_mfc_and_pzt_have_colours_of_their_own_wherever_they_are():
    assert key(THESIS) == {"MFC": PATCH_COLOURS["MFC"]}
    assert key(BLADES["channel"]) == {"PZT": PATCH_COLOURS["PZT"]}
    assert len(set(PATCH_COLOURS.values())) == len(PATCH_COLOURS)
    for theme in THEMES.values():
        assert min(contrast(each, theme.panel) for each in PATCH_COLOURS.values()) >= 3.0
