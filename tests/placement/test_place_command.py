"""``beamenv place``: what it prints, draws and refuses."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from baselines.placement import METHODS, PlacementProblem, place
from beamenv.blade.files import load_config, to_dict
from beamenv.blade.presets import blade_config
from train.cli.app import app
from train.placement.picture import cost_along_span
from train.placement.placed import place_sides


def run(*arguments):
    return CliRunner().invoke(app, ["place", *arguments])


@pytest.fixture(scope="module")
def sides():
    return place_sides(blade_config(), {"actuators": 2, "sensors": 2}, "sqp", 0)


def test_json_tells_positions_traces_and_damping():
    result = run("--actuators", "2", "--method", "sqp", "--json")
    assert result.exit_code == 0
    (told,) = json.loads(result.stdout)
    found = place(PlacementProblem.of(blade_config(), "actuators", 2), "sqp")
    assert told["positions"] == list(found.positions) and told["cost"] == found.cost
    assert (told["side"], told["trace"], told["unit"]) == ("actuators", "tr(P)", "s")
    assert told["gap_to_uniform"] == pytest.approx(1.0 - found.cost / told["uniform"]["cost"])
    assert np.min(told["damping_ratios"]["placed"]) > np.max(told["damping_ratios"]["without_control"])


def test_patches_next_to_the_clamp_are_told(sides):
    for side in sides:
        near = [z for z in side.placement.positions if z < blade_config().beam.depth]
        assert near and side.note.startswith("Nearer to the clamp")
        assert side.note.count(" at ") == len(near)
        assert side.to_dict()["note"] == side.note
    (told,) = json.loads(run("--actuators", "1", "--method", "sqp", "--preset", "sound-blade", "--json").stdout)
    assert bool(told["note"]) is (told["positions"][0] < blade_config("sound-blade").beam.depth)


def test_speed_blade_and_passive_effect_are_options(tmp_path):
    blade = tmp_path / "blade.json"
    blade.write_text(json.dumps({"patches": {"sensors": 1}, "speed": 50.0}))
    (told,) = json.loads(run("--sensors", "1", "--method", "sqp", "--blade", str(blade), "--speed", "100", "--json").stdout)
    problem = PlacementProblem.of(blade_config(overrides={"patches": {"sensors": 1}}, speed=100.0), "sensors")
    assert told["cost"] == pytest.approx(place(problem, "sqp").cost)
    (other,) = json.loads(run("--sensors", "1", "--method", "sqp", "--no-patches", "--json").stdout)
    assert other["cost"] != told["cost"]


def test_the_placed_blade_is_saved(tmp_path):
    saved = tmp_path / "placed.json"
    result = run("--actuators", "2", "--method", "sqp", "--json", "--output", str(saved))
    assert result.exit_code == 0, result.output
    (told,) = json.loads(result.stdout)
    config = load_config(saved)
    assert config == blade_config(overrides={"patches": {"actuators": told["positions"]}})
    refused = run("--output", str(tmp_path / "placed.toml"))
    assert refused.exit_code == 2 and "output is" in refused.stderr


def test_a_blade_without_sensor_patches_is_placed_and_saved(tmp_path):
    blade, saved = tmp_path / "blade.json", tmp_path / "placed.json"
    config = blade_config("aluminium-cantilever", {"patches": {"sensors": []}, "sensors": [{"kind": "accelerometer"}]})
    blade.write_text(json.dumps(to_dict(config)))
    words = ("--method", "sqp", "--leave-unreached", "--json", "--blade", str(blade), "--output", str(saved))
    result = run(*words)
    assert result.exit_code == 0, result.output
    (told,) = json.loads(result.stdout)
    assert load_config(saved).patches.actuator_positions(0.3) == tuple(told["positions"])
    assert load_config(saved).patches.sensors == ()
    assert run(*words, "--no-patches").exit_code == 0


STRIP = blade_config("aluminium-cantilever")


def test_actuators_lie_where_they_do_alone_when_sensors_are_placed_after_them():
    both = place_sides(STRIP, {"actuators": 1, "sensors": 1}, "sqp", 0, leave_unreached=True)
    alone = place_sides(STRIP, {"actuators": 1}, "sqp", 0, leave_unreached=True)
    assert both[0].placement.positions == alone[0].placement.positions
    assert both[0].placement.cost == alone[0].placement.cost
    assert both[0].problem.config.patches.sensors == STRIP.patches.sensors  # not moved to the clamp before their turn


def test_every_row_of_damping_says_what_moves(sides):
    for side in sides:
        assert len(side.families) == len(side.left_alone)
        assert {"lag", "flap"} <= set(side.families)
        assert side.to_dict()["damping_ratios"]["families"] == list(side.families)


def test_what_no_patch_moves_is_told_with_the_option_that_leaves_it():
    result = run("--preset", "aluminium-cantilever", "--actuators", "1", "--method", "sqp")
    assert result.exit_code == 2
    assert result.stderr.startswith("beamenv: actuators = (")
    assert result.stderr.endswith("or leave it alone by --leave-unreached.\n")


def test_the_screen_shows_both_sides_and_a_picture_is_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "blade.png"
    result = run("--method", "sqp", "--picture", str(picture))
    assert result.exit_code == 0
    for word in ("tr(P), s", "tr(S), J", "of uniform", "Damping ratios of the regulator", "Damping ratios of the filter"):
        assert word in result.stdout
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_sensors_are_placed_on_the_blade_with_its_actuators_placed(sides):
    actuators, sensors = sides
    assert sensors.problem.config.patches.actuators == actuators.placement.positions


def test_no_patch_can_be_moved_alone_to_anything_better(sides):
    """What the picture shows: each curve's minimum is where the patch lies."""
    for side in sides:
        for number in range(2):
            where, cost = cost_along_span(side, number)
            near = np.abs(where - side.placement.positions[number]) < 0.1
            assert np.nanmin(cost[near]) >= side.placement.cost * (1.0 - 1e-7)
            assert np.isnan(cost).any()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--actuators", "40"], "actuators is 40, but must be at most 16"),
        (["--actuators", "0"], "actuators is 0, but must be a whole number not below 1"),
        (["--method", "magic"], "method is 'magic', but must be one of " + ", ".join(METHODS)),
        (["--method", "grid"], "method = 'grid' serves one or two patches, not 4"),
        (["--speed", "nan"], "speed"),
        (["--preset", "rotor"], "preset is 'rotor', but must be one of thesis"),
    ],
)
def test_bad_input_is_one_sentence(arguments, sentence):
    result = run(*arguments, "--json")
    assert result.exit_code == 2
    assert sentence in result.stderr and result.stderr.strip().count("\n") == 0
    assert result.stdout == ""


@pytest.mark.parametrize("more", [(), ("--json",)])
def test_a_picture_that_cannot_be_written_is_told_before_the_search(more, tmp_path, monkeypatch):
    def searched(*_, **__):
        raise AssertionError("searched in vain")

    monkeypatch.setattr("train.cli.place_in_turn.place_sides", searched)
    (tmp_path / "note").write_text("kept")
    (tmp_path / "folder.png").mkdir()
    for picture in (tmp_path / "note" / "picture.png", tmp_path / "folder.png"):
        result = run("--picture", str(picture), *more)
        assert result.exit_code == 2, result.output
        assert result.stdout == "" and result.stderr.startswith("beamenv: --picture = ")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "results").write_text("")
    assert run(*more).exit_code == (1 if more else 2)  # without --json a picture is drawn in results


@pytest.mark.parametrize("error", [OSError(28, "No space left on device"), KeyboardInterrupt()])
def test_positions_are_told_even_if_the_picture_fails(error, sides, monkeypatch, tmp_path):
    def fail(*_):
        raise error

    monkeypatch.setattr("train.cli.place_in_turn.place_sides", lambda *_: sides)
    monkeypatch.setattr("train.placement.picture.draw_placement", fail)
    result = run("--json", "--picture", str(tmp_path / "picture.png"))
    assert result.exit_code == (2 if isinstance(error, OSError) else 130)
    assert [each["positions"] for each in json.loads(result.stdout)] == [list(side.placement.positions) for side in sides]
    assert list(tmp_path.iterdir()) == []


def test_the_sensors_best_places_are_not_told_beside_others_and_no_actuator_is_searched_for_before(monkeypatch):
    from baselines.placement import search
    from beamenv.blade.presets import blade_config
    from train.placement.placed import place_sides

    monkeypatch.setattr(search.search, "Recorder", lambda *_: pytest.fail("searched"))
    config = blade_config("thesis", {"sensors": [{"kind": "accelerometer"}]})
    with pytest.raises(ValueError, match="config.sensors is"):
        place_sides(config, {"actuators": 2, "sensors": 2}, "sqp", 0)
