"""The comparison of controllers on a model of one's own, which has no shape."""

import csv
import json
import re

import numpy as np
import pytest
from typer.testing import CliRunner

from train.cli.app import app
from train.comparison.compare import CLASSICAL, Comparison, Listener, compare
from train.comparison.figures import _tip_panel
from train.controllers.policy_files import read_about

A = np.array([[0.0, 30.0, 0.0], [-30.0, -0.6, 0.0], [0.0, 0.0, -60.0]])
B = np.array([[0.0, 0.0], [1.0, 0.3], [1.0, -0.9]])
C = np.array([[0.0, 1.0, 0.2], [0.3, 0.0, -0.8], [0.1, 0.5, 0.3]])
D = 0.01 * np.array([[1.0, 0.2], [0.3, -0.4], [0.0, 0.5]])
PAIRS = {"velocity", "positive-position-feedback"}
"""Laws that want a sensor to each actuator."""


def write(path, factor=1.0, **about):
    np.savez(path, A=factor * A, B=B, C=C, D=D, interval=0.01, sensor_names=["gauge", "laser", "knock"], **about)
    return str(path)


class Notes(Listener):
    """Remembers what it was told."""

    def __init__(self):
        self.without, self.updates = {}, 0

    def training(self, name, budget, progress):
        self.updates += 1

    def left_out(self, name, sentence):
        self.without[name] = sentence


@pytest.fixture(scope="module")
def finished(tmp_path_factory, ticking):
    home, notes = tmp_path_factory.mktemp("compare"), Notes()
    comparison = Comparison({"plant": write(home / "mine.npz"), "duration": 1.0}, {"gradient": 0.08, "ppo": 0.08}, seeds=3)
    with ticking(0.02):
        return comparison, home / "results", compare(comparison, home / "results", notes), notes


def test_laws_that_need_pairs_are_left_out_in_one_sentence_and_the_others_go_on(finished):
    _, folder, evaluations, notes = finished
    assert set(notes.without) == PAIRS and all("it needs one sensor to each actuator" in each for each in notes.without.values())
    assert len(evaluations) == len(CLASSICAL) - len(PAIRS) + 2
    with (folder / "table.csv").open() as file:
        rows = {row["controller"]: row for row in csv.DictReader(file)}
    assert rows["lqr"]["tier"] == "3" and rows["lqg"]["tier"] == "0" and rows["ppo"]["tier"] == "1"
    assert float(rows["lqg"]["relative_cost"]) < 0.5
    for name in PAIRS:
        assert f"\n{name} is left out: plant has 2 actuators and 3 sensors" in (folder / "table.md").read_text()


def test_its_figures_and_its_page_are_of_what_needs_no_shape(finished):
    _, folder, *_ = finished
    assert all((folder / f"{name}.png").stat().st_size > 1e4 for name in ("episode", "poles", "learning"))
    page = (folder / "report.html").read_text(encoding="utf-8")
    shown = dict(re.findall(r'data-figure="(.*?)">(.*?)</script>', page))
    assert set(shown) == {"time-series", "spectra", "poles", "learning"}
    assert "<h2>Readings and voltages</h2>" in page and "no blade is drawn" in page
    titles = [each["text"] for each in json.loads(shown["time-series"])["layout"]["annotations"]]
    assert titles[:3] == ["gauge", "laser", "knock"]


def test_the_readings_on_the_page_are_those_of_the_episode(finished):
    import gymnasium as gym

    import beamenv
    from baselines import lqg
    from train.page import record

    comparison, *_ = finished
    env = gym.make(beamenv.ENV_ID, dtype="float64", scenario="quiet", **comparison.environment)
    recording = record(lqg(env.unwrapped.plant), env, 0, {"initial_state": [1e-3, 0.0, 0.0]})
    expected = recording.states @ C.T + recording.volts @ D.T  # what was on while it was read; nothing is noisy
    np.testing.assert_allclose(recording.readings, expected, atol=1e-12)
    assert np.abs(recording.readings).max() > 1e-4


def test_it_is_resumed_while_the_file_says_the_same(finished, ticking):
    comparison, folder, *_ = finished
    notes, path = Notes(), comparison.environment["plant"]
    with ticking(0.02):
        compare(comparison, folder, notes)
    assert notes.updates == 0
    (plant,) = set(read_about(folder / "agents" / "ppo")["plants"].values())
    assert json.loads((folder / "configuration.json").read_text())["comparison"]["environment"]["plant"] == [plant]
    write(path, factor=1.01)
    try:
        with pytest.raises(ValueError, match="holds another comparison: name another folder, or empty this one"):
            compare(comparison, folder)
    finally:
        write(path)


def test_displacements_that_a_model_tells_are_drawn(tmp_path):
    plant = write(tmp_path / "mine.npz", tip_displacement=1e-3 * np.eye(3))
    evaluations = compare(Comparison({"plant": plant, "duration": 0.3}, {}, seeds=2), tmp_path / "results")
    assert np.isfinite(evaluations[0].peak_tip.value)
    page = (tmp_path / "results" / "report.html").read_text(encoding="utf-8")
    assert "<h2>Displacements and voltages</h2>" in page and "displacement 2" in page


@pytest.mark.parametrize("points", [1, 2, 3])
def test_displacements_of_a_model_are_not_called_lag_and_flap(tmp_path, points):
    import gymnasium as gym

    import beamenv
    from baselines import evaluate

    arguments = {"plant": write(tmp_path / "mine.npz", tip_displacement=1e-3 * np.eye(3)[:points])}
    for made, names in ((arguments, [f"displacement {point}" for point in range(points)]), ({}, ["lag", "flap"])):
        env = gym.make(beamenv.ENV_ID, duration=0.1, **made)
        found = evaluate(lambda seen: np.zeros((1, env.action_space.shape[0])), env, range(2))  # noqa: B023 - called here
        assert [curve.label for curve in _tip_panel(found, 0).curves[1::2]] == [f"tip, {name}" for name in names]


def test_a_folder_of_an_identification_is_compared_on(tmp_path):
    (tmp_path / "mine" / "ensemble").mkdir(parents=True)
    for name, factor in (("plant", 1.0), ("ensemble/000", 0.97), ("ensemble/001", 1.03)):
        write(tmp_path / "mine" / f"{name}.npz", factor)
    words = ("compare", "--folder", tmp_path / "results", "--plant", tmp_path / "mine", "--minutes", 0, "--episodes", 2)
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == 0, result.output
    told = json.loads((tmp_path / "results" / "configuration.json").read_text())
    assert len(set(told["comparison"]["environment"]["plant"])) == 3
    assert "beamenv: velocity is left out: plant has 2 actuators and 3 sensors" in " ".join(result.stderr.split())


def test_what_cannot_be_of_a_model_is_one_sentence_before_any_work(tmp_path):
    plant = write(tmp_path / "mine.npz")
    for words, sentence in (
        (("--scenario", "rotor"), "scenario.rotor.harmonics is "),
        (("--speed", "20"), "--speed is 20.0, but must be left out with a plant of one's own"),
    ):
        result = CliRunner().invoke(app, ["compare", "--folder", str(tmp_path / "results"), "--plant", plant, *words])
        assert result.exit_code == 2 and result.stderr.startswith(f"beamenv: {sentence}")
    assert not (tmp_path / "results").exists()
