"""What ``beamenv identify`` leaves in a folder, and what it says of bad input."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from beamenv import Plant
from tests.identification.conftest import DAMPING_RATIOS, FREQUENCIES, INTERVAL, record
from train.cli.app import app

FILES = {"plant.npz", "ensemble", "report.json", "report.md", "stabilisation.png", "fit.png"}


@pytest.fixture(scope="module", name="folder")
def _folder(tmp_path_factory):
    """Of a measurement of 20 s, identified by the command."""
    folder, of = tmp_path_factory.mktemp("identified"), record(1, 20.0)
    table = np.column_stack([INTERVAL * np.arange(len(of.volts)), of.volts, of.readings])
    data = folder / "data.csv"
    np.savetxt(data, table, delimiter=",", header="time,u1,u2,y1 [A],y2 [A]", comments="", fmt="%.8e")
    asked = ["identify", str(data), "--folder", str(folder / "mine"), "--collocated", "1.5", "--ensemble", "3"]
    result = CliRunner().invoke(app, asked)
    assert result.exit_code == 0, result.output
    assert "60." in result.stdout and "free run" in result.stdout
    return folder / "mine"


def test_the_folder_has_plant_ensemble_report_and_figures(folder):
    assert {each.name for each in folder.iterdir()} == FILES
    assert len(list((folder / "ensemble").glob("*.npz"))) == 3
    assert all((folder / name).stat().st_size > 10_000 for name in FILES if name.endswith(".png"))


def test_the_report_has_the_modes_with_their_spread(folder):
    modes = json.loads((folder / "report.json").read_text())["modes"]
    for mode, frequency, ratio in zip(modes, FREQUENCIES, DAMPING_RATIOS, strict=True):
        assert abs(mode["frequency"] - frequency) < 4.0 * mode["frequency_spread"]
        assert abs(mode["damping_ratio"] - ratio) < 4.0 * mode["damping_spread"]
    assert "| mode | rad/s | Hz | damping ratio, % | certainty |" in (folder / "report.md").read_text()


def test_the_ensemble_is_of_other_plants_of_the_same_size(folder):
    with np.load(folder / "plant.npz") as plant, np.load(folder / "ensemble" / "000.npz") as other:
        assert set(plant.files) == set(other.files)
        assert plant["A"].shape == other["A"].shape
        assert not np.array_equal(plant["A"], other["A"])


def test_bad_input_is_one_sentence_and_leaves_no_folder(tmp_path):
    data = tmp_path / "data.csv"
    data.write_text("time,u,y\n0,1,2\n0.1,2,nan\n")
    result = CliRunner().invoke(app, ["identify", str(data), "--folder", str(tmp_path / "mine")])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "column 'y' is nan on line 3" in result.stderr
    assert not (tmp_path / "mine").exists()


def test_ranges_of_sensors_are_one_for_each_reading(tmp_path):
    moved = record(1, 4.0)
    data = tmp_path / "data.csv"
    table = np.column_stack([INTERVAL * np.arange(len(moved.volts)), moved.volts, moved.readings])
    np.savetxt(data, table, delimiter=",", header="time,u1,u2,y1,y2", comments="")
    command = ["identify", str(data), "--order", "6", "--ensemble", "0", "--folder", str(tmp_path / "mine")]
    short = CliRunner().invoke(app, [*command, "--full-scale", "2"])
    assert (short.exit_code, (tmp_path / "mine").exists()) == (2, False)
    assert "--full-scale is [2.0], but must be 2 numbers, one for each of y1, y2." in short.stderr
    assert CliRunner().invoke(app, [*command, "--full-scale", "2", "--full-scale", "3"]).exit_code == 0
    assert Plant.from_file(tmp_path / "mine" / "plant.npz").sensor_full_scale.tolist() == [2.0, 3.0]


def test_voltages_of_another_measurement_identify_nothing_and_leave_no_folder(tmp_path):
    """A structure that loads move, and voltages that it never saw."""
    volts, readings = record(1, 8.0).volts, record(9, 8.0).readings
    data = tmp_path / "data.csv"
    table = np.column_stack([INTERVAL * np.arange(len(volts)), volts, readings])
    np.savetxt(data, table, delimiter=",", header="time,u1,u2,y1,y2", comments="")
    result = CliRunner().invoke(app, ["identify", str(data), "--folder", str(tmp_path / "mine")])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "nothing could be identified: voltages explain" in result.stderr
    assert not (tmp_path / "mine").exists()
