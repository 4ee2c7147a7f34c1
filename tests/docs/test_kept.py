"""Pictures and tables that scripts have made and that are kept are what these scripts make."""

import csv
import re
from pathlib import Path

import pytest

from beamenv.scenarios.named import NAMES
from train.tools import axes_picture, scenario_pictures, scenario_returns

ROOT = Path(__file__).parents[2]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def test_every_scenario_has_its_picture_and_its_returns():
    pictures = {file.stem for file in (ROOT / scenario_pictures.FOLDER).glob("*.svg")}
    with (ROOT / scenario_returns.FILE).open(encoding="utf-8") as file:
        rows = {row["scenario"] for row in csv.DictReader(file)}
    assert pictures == rows == set(NAMES)


def test_the_picture_of_a_scenario_shows_what_happens_in_it():
    kept = (ROOT / scenario_pictures.FOLDER / "nominal.svg").read_text(encoding="utf-8")
    made = scenario_pictures.picture("nominal")
    assert NUMBER.sub("#", made) == NUMBER.sub("#", kept)
    numbers = [[float(each) for each in NUMBER.findall(text)] for text in (made, kept)]
    assert numbers[0] == pytest.approx(numbers[1], abs=0.3)  # px: a tenth is printed


def test_a_picture_stays_small():
    assert max(file.stat().st_size for file in (ROOT / scenario_pictures.FOLDER).glob("*.svg")) < 40_000


def test_returns_of_a_scenario_are_those_of_its_episodes():
    with (ROOT / scenario_returns.FILE).open(encoding="utf-8") as file:
        kept = next(row for row in csv.DictReader(file) if row["scenario"] == "nominal")
    made = scenario_returns.returns("nominal")
    assert {name: float(made[name]) for name in scenario_returns.COLUMNS[1:]} == pytest.approx(
        {name: float(kept[name]) for name in scenario_returns.COLUMNS[1:]}, rel=0.01
    )


def test_the_sketches_of_the_axes_are_those_that_are_drawn():
    for name, picture in axes_picture.pictures().items():
        assert (ROOT / axes_picture.FOLDER / f"{name}.svg").read_text(encoding="utf-8") == picture, name


def test_the_section_of_the_sketch_is_turned_from_x_towards_y():
    x, y = axes_picture.turned(1.0, 0.0, axes_picture.angle(1.0) - axes_picture.angle(0.0))
    assert x > 0.0 and y > 0.0
