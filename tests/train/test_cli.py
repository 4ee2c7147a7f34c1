"""The command ``beamenv`` as a shell meets it."""

import json
from dataclasses import asdict
from types import SimpleNamespace

import numpy as np
import pytest
from typer.testing import CliRunner

from beamenv.blade.build import build_beam
from beamenv.blade.presets import blade_config
from beamenv.structure.steady_deformation import steady_deformation
from train.cli.app import app
from train.cli.frequencies import _slow
from train.shared.interruption import Interrupted

COMMANDS = ("frequencies", "evaluate", "train", "compare", "benchmark", "speed")


def run(*arguments):
    return CliRunner().invoke(app, list(arguments))


def test_help_says_what_each_command_does():
    general = run("--help")
    assert general.exit_code == 0
    for command in COMMANDS:
        assert command in general.stdout
        assert len(run(command, "--help").stdout.splitlines()) > 4


def test_frequencies_come_with_their_families():
    result = run("frequencies", "--speed", "0", "--speed", "200", "--count", "3", "--json")
    assert result.exit_code == 0
    still, turning = json.loads(result.stdout)["speeds"]
    assert still["speed"] == 0.0
    assert len(turning["natural_frequencies"]) == len(turning["families"]) == 3
    assert turning["natural_frequencies"] == sorted(turning["natural_frequencies"])
    assert set(turning["families"]) <= {"lag", "flap", "extension", "twist"}
    assert "rad/s" in run("frequencies", "--count", "2").stdout


def test_frequencies_printed_are_the_beam_s():
    speeds = json.loads(run("frequencies", "--speed", "0", "--speed", "200", "--count", "4", "--json").stdout)["speeds"]
    beam = build_beam(blade_config())
    for each in speeds:
        np.testing.assert_allclose(each["natural_frequencies"], beam.natural_frequencies(each["speed"], 4), rtol=1e-12)
    assert speeds[0]["natural_frequencies"] != speeds[1]["natural_frequencies"]


def test_frequencies_come_with_what_steady_rotation_does():
    content = json.loads(run("frequencies", "--json").stdout)
    still, turning = (each["static"] for each in content["speeds"])
    state = steady_deformation(build_beam(blade_config()), 200.0)
    assert turning == pytest.approx(asdict(state))
    assert set(still.values()) == {0.0}
    assert content["note"].startswith("Nearer to the clamp")
    printed = " ".join(run("frequencies").stdout.split())
    assert "tip 32.2 mm further out, untwisted by 15.1°" in printed
    assert "up to 2.8 %, at 0 m, beyond the 0.45 %" in printed
    assert "Nearer to the clamp" in printed
    sound = " ".join(run("frequencies", "--preset", "sound-blade").stdout.split())
    assert "up to 0.03 %" in sound
    assert "beyond" not in sound and "clamp" not in sound


@pytest.mark.parametrize("command", [("compare", "--minutes", "0", "--episodes", "2"), ("train", "gradient")])
def test_a_file_in_the_folder_s_place_is_told_at_once(command, tmp_path):
    (tmp_path / "note").write_text("kept")
    result = run(*command, "--folder", str(tmp_path / "note"))
    assert result.exit_code == 2
    assert "must be a folder" in result.stderr
    assert (tmp_path / "note").read_text() == "kept"


def test_what_is_told_the_truth_is_evaluated_on_the_solid():
    costs = {}
    for controller in ("lqg", "lqg-truth"):
        result = run("evaluate", controller, "--scenario", "solid-20", "--episodes", "2", "--json")
        assert result.exit_code == 0, result.stderr
        costs[controller] = json.loads(result.stdout)["estimates"]["relative_cost"]["value"]
    assert costs["lqg-truth"] < min(costs["lqg"], 0.8)


@pytest.mark.parametrize("controller", ["none", "lqg"])
def test_a_classical_law_is_evaluated_by_name(controller):
    result = run("evaluate", controller, "--episodes", "2", "--json")
    assert result.exit_code == 0
    content = json.loads(result.stdout)
    assert len(content["per_seed"]["cost"]) == 2
    assert (content["estimates"]["relative_cost"]["value"] < 1.0) is (controller == "lqg")


BRIEF = 'agent = "gradient"\ntitle = "Brief"\nupdates = 2\n[settings]\nepisodes = 8\nwindow = 20\n'


def test_a_trained_agent_is_evaluated_from_its_folder(tmp_path):
    (tmp_path / "brief.toml").write_text(BRIEF)
    trained = run("train", "gradient", "--recipe", str(tmp_path / "brief.toml"), "--folder", str(tmp_path / "agent"))
    assert trained.exit_code == 0, trained.output
    assert (tmp_path / "agent" / "learning.csv").read_text().startswith("elapsed,steps,updates,cost,looked\n")
    assert (tmp_path / "agent" / "learning.png").read_bytes().startswith(b"\x89PNG")
    result = run("evaluate", str(tmp_path / "agent"), "--episodes", "2", "--json")
    assert result.exit_code == 0
    assert json.loads(result.stdout)["controller"] == "agent"
    refused = run("evaluate", str(tmp_path / "agent"), "--episodes", "2", "--scenario", "hysteresis")
    assert refused.exit_code == 2
    assert "is none of those the agent" in refused.stderr


def test_a_training_goes_on_where_it_stopped(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "brief.toml").write_text(BRIEF)
    arguments = ("train", "gradient", "--recipe", "brief.toml", "--scenario", "white", "--looks", "0", "--seed", "7")
    assert run(*arguments).exit_code == 0
    assert "looked" not in (tmp_path / "results/agents/gradient-white-7/learning.csv").read_text()
    home = tmp_path / "results/agents/gradient-white-7"
    weights = (home / "weights.npz").read_bytes()
    again = run(*arguments)
    assert again.exit_code == 2
    assert "holds a training already" in again.stderr
    resumed = run(*arguments, "--resume")
    assert resumed.exit_code == 0 and "gradient was finished already in " in resumed.stdout
    told = json.loads(run(*arguments, "--resume", "--json").stdout)
    home_of_it = "results/agents/gradient-white-7"
    about = {"agent": "gradient", "scenario": "white", "seed": 7, "folder": home_of_it, "finished_before": True}
    assert told == [{**about, "policies": [home_of_it], "failed": None}]
    assert (home / "weights.npz").read_bytes() == weights
    assert run(*arguments[:-1], "8").exit_code == 0
    other = run(*arguments[:-1], "8", "--folder", str(home))
    assert other.exit_code == 2
    assert (home / "weights.npz").read_bytes() == weights
    assert run(*arguments[:-1], "8", "--folder", str(home), "--overwrite").exit_code == 0
    assert (home / "weights.npz").read_bytes() != weights


def test_a_comparison_prints_json_alone(tmp_path):
    result = run("compare", "--folder", str(tmp_path), "--minutes", "0", "--episodes", "2", "--scenario", "deflection", "--json")
    assert result.exit_code == 0
    rows = json.loads(result.stdout)
    assert {"controller", "relative_cost", "settling_time"} <= set(rows[0])
    assert (tmp_path / "table.md").is_file()


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("frequencies", "--preset", "wind-turbine"), "wind-turbine"),
        (("frequencies", "--speed", "1e5"), "100000"),
        (("frequencies", "--count", "0"), "count"),
        (("frequencies", "--blade", "absent.json"), "absent.json"),
        (("evaluate", "pid"), "pid"),
        (("evaluate", "lqg", "--speed", "-3"), "-3"),
        (("evaluate", "lqg", "--scenario", "storm"), "storm"),
        (("evaluate", "none", "--episodes", "2", "--scenario", "quiet"), "moves nothing"),
        (("train", "dreamer"), "dreamer"),
        (("train", "ppo", "--minutes", "0"), "minutes"),
        (("train", "ppo", "--updates", "0"), "updates"),
        (("train", "ppo", "--updates", "1", "--minutes", "1"), "--minutes and --updates"),
        (("train", "ppo", "--scenario", "storm"), "storm"),
        (("train", "ppo", "--scenario", "quiet"), "nothing to learn"),
        (("train", "ppo", "--recipe", "absent.toml"), "absent.toml"),
        (("train", "ppo", "--from", "nowhere"), "nowhere"),
        (("train", "ppo", "--resume"), "checkpoint"),
        (("evaluate", "lqg", "--preset", "wing"), "wing"),
        (("compare", "--minutes", "-1"), "minutes"),
        (("compare", "--episodes", "1"), "episodes"),
    ],
)
def test_bad_input_gets_one_sentence_and_status_2(arguments, named, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = run(*arguments)
    assert result.exit_code == 2, result.output
    assert result.stdout == ""
    assert named in result.stderr
    assert "Traceback" not in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_training_seed_of_what_has_none_is_refused_and_not_ignored():
    refused = CliRunner().invoke(app, ["evaluate", "lqg", "--episodes", "2", "--trained-seed", "3"])
    assert refused.exit_code == 2
    assert refused.stderr == "beamenv: --trained-seed is 3, but must be left out, for 'lqg' is no agent that ships.\n"


@pytest.mark.parametrize(("interruption", "status"), [(KeyboardInterrupt(), 130), (Interrupted(15), 143), (Interrupted(2), 130)])
def test_an_interruption_gets_one_sentence_and_the_status_that_shells_know(interruption, status, monkeypatch):
    def interrupted():
        raise interruption

    monkeypatch.setattr("train.cli.speed.measured", interrupted)
    result = run("speed")
    assert (result.exit_code, result.stdout, result.stderr) == (status, "", "beamenv: interrupted.\n")


def test_pictures_end_in_png_and_minutes_are_named(tmp_path):
    for command in ("section", "place"):
        refused = run(command, "--picture", str(tmp_path / "made" / "it.jpg"))
        assert refused.exit_code == 2
        assert refused.stderr.endswith("it.jpg', but must be a file that ends in .png.\n")
    assert run("train", "ppo", "--minutes", "0").stderr == "beamenv: --minutes is 0.0, but must be a positive number.\n"
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("kept", [False, True])
def test_an_interrupted_training_says_the_whole_command_that_resumes_it(kept, tmp_path, monkeypatch):
    def interrupted(job, folder, *rest):
        if kept:
            folder.mkdir()
            (folder / "checkpoint.pt").touch()
        raise KeyboardInterrupt

    monkeypatch.setattr("train.learning.several.run", interrupted)
    monkeypatch.chdir(tmp_path)
    told = run("train", "ppo", "--seed", "3", "--overwrite", "--folder", "my ppo", "--preset", "sound-blade").stderr
    again = "with `beamenv train ppo --seed 3 --folder 'my ppo' --resume --preset sound-blade` it resumes"
    early = "it was too early for a checkpoint, so nothing is kept"
    assert told == f"beamenv: interrupted: {again if kept else early}.\n"


STRIP = """
[beam]
length = 0.3
hub_radius = 0.0
section = { shape = "strip", width = 0.03, thickness = 0.002 }
ply_angles_deg = [0]
pretwist_deg = 0.0
[patches]
actuators = [{ positions = [0.01], wall = "strip", bonded = true, material = "PIC255", length = 0.05, width = 0.025 }]
sensors = []
[[sensors]]
kind = "accelerometer"
"""


def test_what_a_blade_s_file_leaves_to_the_default_blade_is_told(tmp_path):
    file = tmp_path / "strip.toml"
    file.write_text(STRIP)
    words = ("frequencies", "--blade", str(file), "--count", "1")
    assert json.loads(run(*words, "--json").stdout)["assumed"] == [
        "beam.material graphite-epoxy",
        "speed 200 rad/s",
        "voltage_limits -1500 … 1500 V",
    ]
    printed = " ".join(run(*words).stdout.split())
    assert "assumed, as of the default blade: beam.material graphite-epoxy; speed 200 rad/s; voltage_limits" in printed
    assert "untwisted by 0°" in printed
    assert json.loads(run("frequencies", "--count", "1", "--json").stdout)["assumed"] == []


@pytest.mark.parametrize(("hertz", "told"), [(0.01, True), (0.019, True), (0.021, False), (5.0, False)])
def test_a_first_period_beyond_a_hundred_episodes_is_told(hertz, told):
    slow = _slow([SimpleNamespace(natural_frequencies=np.array([2.0 * np.pi * hertz, 90.0]))])
    said = f"the first period is {1.0 / hertz:.3g} s, an episode lasts 0.5 s: were lengths given in millimetres?"
    assert slow == (said if told else "")


def test_a_long_thin_blade_s_first_period_is_told(tmp_path):
    """A sheet of 200 m by 1 mm, as one of millimetres may have been given."""
    beam = "speed = 0.0\n[beam]\nlength = 200.0\npretwist_deg = 0.0\n"
    section = "[beam.section]\nshape = 'strip'\nwidth = 0.5\nthickness = 0.001\n"
    sheet = "positions = [1.0]\nwall = 'strip'\nlength = 0.05\nwidth = 0.025\n"
    patches = f"[[patches.actuators]]\n{sheet}[[patches.sensors]]\nface = 'inner'\n{sheet}"
    file = tmp_path / "sheet.toml"
    file.write_text(beam + section + patches)
    printed = " ".join(run("frequencies", "--blade", str(file)).stdout.split())
    assert "s, an episode lasts 0.5 s: were lengths given in millimetres?" in printed


def test_a_preset_beside_a_file_is_refused(tmp_path):
    file = tmp_path / "strip.toml"
    file.write_text("speed = 1.0\n")
    result = run("frequencies", "--blade", str(file), "--preset", "sound-blade")
    assert result.exit_code == 2
    assert "--preset is 'sound-blade', but must be left out beside --blade" in result.stderr
