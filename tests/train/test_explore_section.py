"""The explorer's section: drawn to scale with the plies and patches that are there, chord and twist tables, and units."""

import xml.etree.ElementTree
from base64 import b64decode
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from beamenv.blade.files import load_config
from beamenv.blade.presets import PRESETS, THESIS

pytest.importorskip("dash", reason="dash is not installed")

from train.explore import Settings  # noqa: E402 - they need the package asked for above
from train.explore.along import angles, as_table, as_text, chords  # noqa: E402
from train.explore.app import redraw  # noqa: E402
from train.explore.controls import THESIS_PAGE, Page  # noqa: E402
from train.explore.section_picture import Cut, first_patch, plies_picture, section_picture, section_said  # noqa: E402
from train.explore.units import angular, nearest_round, number, one_digit, unit_of  # noqa: E402

EXAMPLES = Path(__file__).resolve().parents[2] / "examples" / "blades"
BLADES = {**PRESETS, **{path.stem: load_config(path) for path in sorted(EXAMPLES.glob("*.toml"))}}
SPACE = "{http://www.w3.org/2000/svg}"


def cut_of(config, at=None):
    return Cut.at(config, config.beam.build(config.patches, config.model), first_patch(config) if at is None else at)


def corners(picture, kind):
    root = xml.etree.ElementTree.fromstring(b64decode(picture.partition(",")[2]))
    drawn = [each.get("points") for each in root.iter(f"{SPACE}polygon") if each.get("class") == kind]
    return [np.array([corner.split(",") for corner in points.split()], dtype=float) for points in drawn]


def area(points):
    x, y = points.T
    return 0.5 * abs(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def test_areas_of_the_box_and_of_its_patches_are_drawn_to_one_scale():
    """Mid-line box 254 × 50.8 mm of 10.16 mm walls, 57 × 0.3 mm of it MFC on top and below."""
    picture = section_picture(cut_of(THESIS))
    whole = 2.0 * (254.0 + 50.8) * 10.16
    drawn = {kind: sum(map(area, corners(picture, kind))) for kind in ("ply", "actuators", "sensors")}
    scale = sum(drawn.values()) / whole
    assert drawn["actuators"] / scale == pytest.approx(57.0 * 0.3, rel=0.02)
    assert drawn["sensors"] / scale == pytest.approx(57.0 * 0.3, rel=0.02)
    wide, high = np.ptp(np.concatenate(corners(picture, "ply") + corners(picture, "actuators")), axis=0)
    assert wide / high == pytest.approx((254.0 + 10.16) / (50.8 + 10.16), rel=1e-3)


def test_a_section_between_patches_has_none():
    picture = section_picture(cut_of(THESIS, 0.3))
    assert corners(picture, "actuators") == corners(picture, "sensors") == []
    assert len(section_said(cut_of(THESIS, 0.3))) == 2


def test_the_words_say_which_patches_lie_on_which_wall():
    said = section_said(cut_of(BLADES["channel"]))
    assert said[0].startswith("31.05 mm × 52.1 mm")
    assert any(line.startswith("web with actuator 2 and sensor 2") and "PZT sensor 2" in line for line in said)
    assert any("6 × 30° graphite-epoxy (9.86 mm), MFC actuator 1 at 90° (300 µm)" in line for line in section_said(cut_of(THESIS)))


@pytest.mark.parametrize("name", BLADES)
def test_every_blade_s_section_is_drawn_within_its_frame(name):
    picture, bars = (draw(cut_of(BLADES[name])) for draw in (section_picture, plies_picture))
    root = xml.etree.ElementTree.fromstring(b64decode(picture.partition(",")[2]))
    width, height = map(float, root.get("viewBox").split()[2:])
    points = np.concatenate([each for kind in ("ply", "actuators", "sensors") for each in corners(picture, kind)])
    assert points.min() >= 0.0
    assert np.all(points.max(axis=0) <= (width, height))
    assert xml.etree.ElementTree.fromstring(b64decode(bars.partition(",")[2])).find(f".//{SPACE}rect") is not None


def test_a_tapered_section_is_smaller_at_the_tip():
    config = replace(THESIS, beam=replace(THESIS.beam, taper=2.0))
    assert section_said(cut_of(config, 0.0))[0].startswith("264.2 mm")
    assert section_said(cut_of(config, 2.023))[0].startswith("137.2 mm")  # 254/2 + 10.16


def test_a_twist_table_takes_the_place_of_the_pretwist():
    table = ((0.0, 30.0), (0.5, 12.0), (1.0, 0.0))
    beam = Settings(twist_table=table, pretwist_deg=45.0).config().beam
    assert (beam.twist_table, beam.pretwist_deg) == (table, 0.0)
    built = beam.build()
    np.testing.assert_allclose(angles(built, np.array([0.0, 0.25, 0.5, 1.0]) * built.length), [30.0, 21.0, 12.0, 0.0], atol=1e-12)


def test_a_chord_table_scales_the_chord():
    built = Settings(chord_table=((0.0, 1.0), (1.0, 0.5))).config().beam.build()
    np.testing.assert_allclose(chords(built, np.array([0.0, 0.5, 1.0]) * built.length), [0.254, 0.1905, 0.127])


def test_an_emptied_table_gives_the_even_twist_back():
    base = BLADES["airfoil-two-webs"]
    beam = Settings(twist_table=(), pretwist_deg=12.0).config(base).beam
    assert (beam.twist_table, beam.pretwist_deg) == (None, 12.0)
    assert beam.chord_table == base.beam.chord_table
    assert Settings(pretwist_deg=12.0).config(base).beam.twist_table == base.beam.twist_table


def test_tables_are_written_and_read_as_text():
    table = BLADES["airfoil-two-webs"].beam.twist_table
    assert as_table("twist_table", as_text(table)) == table
    assert as_table("twist_table", as_text(None)) == ()
    assert as_table("twist_table", "0: 30; 1 0") == ((0.0, 30.0), (1.0, 0.0))


@pytest.mark.parametrize("text", ["0 30, one 0", "0 30 5, 1 0", "30", "0 30, 0.5 12", "1 0, 0 30", "0 nan, 1 0"])
def test_a_table_that_is_none_is_told_in_one_sentence(text):
    shown = redraw(**THESIS_PAGE.start | {"twist_table": text})
    assert shown["results"] is True
    assert "twist_table" in shown["message"]
    assert shown["message"].endswith(".") and "\n" not in shown["message"]


@pytest.mark.parametrize(
    ("value", "told"), [(3.2e-10, "320 pm"), (1.2e-7, "120 nm"), (4.56e-5, "45.6 µm"), (0.35, "350 mm"), (1.0, "1 m"), (0.0, "0 m")]
)
def test_a_unit_s_prefix_follows_from_the_number(value, told):
    assert unit_of(value, "m")(value) == told


def test_numbers_have_the_digits_that_tell_them_apart():
    assert [number(each) for each in (181.114, 0.0325123, 12345.6, -2.5, np.inf, 0.0)] == [
        "181.1",
        "0.03251",
        "12346",
        "−2.500",
        "∞",
        "0",
    ]
    assert angular(2500.0)[1] == "Hz"
    assert angular(2.5e5)[0].name == "krad/s"
    assert (nearest_round(0.486), nearest_round(0.034), one_digit(400.0), one_digit(211.2)) == (0.5, 0.05, 400.0, 300.0)


def test_a_still_direction_is_drawn_at_rest_and_in_no_smaller_unit():
    """An untwisted, balanced strip that is loaded in flap does not move in lag but for rounding."""
    page = Page.of(PRESETS["aluminium-cantilever"])
    layout = redraw(page, **page.start)["response"]["layout"]
    lag, flap = (layout[name]["title"]["text"] for name in ("yaxis", "yaxis2"))
    assert lag.partition(", ")[2] == flap.partition(", ")[2]
    assert layout["yaxis"]["range"] == [-1.0, 1.0]


def test_the_heading_says_whether_the_blade_turns():
    page = Page.of(PRESETS["takacs-beam"], "takacs-beam")
    assert redraw(page, **page.start)["title"] == "takacs-beam, at rest"
    assert redraw(**THESIS_PAGE.start)["title"] == "thesis, rotating at 200 rad/s"


def test_pages_of_two_blades_have_two_keys():
    assert THESIS_PAGE.key == Page.of(THESIS, "thesis").key != Page.of(replace(THESIS, damping_ratio=0.02), "thesis").key
    assert THESIS_PAGE.key.startswith("thesis-")


def test_modes_that_begin_together_are_named_side_by_side():
    """The channel's first two frequencies at rest are 281 and 284 rad/s."""
    page = Page.of(BLADES["channel"])
    names = [note["text"] for note in redraw(page, **page.start)["campbell"]["layout"]["annotations"]]
    assert "1 lag, 2 flap" in names
    assert {"3 twist", "4 twist", "6 twist"} <= set(names)
