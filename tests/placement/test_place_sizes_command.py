"""``beamenv place --size`` and ``--together``: what they print, draw, save and refuse."""

import json
from functools import partial

import gymnasium
import pytest
from typer.testing import CliRunner

import beamenv
from baselines.placement import Budget, JointProblem, SizingSearch, place_jointly
from baselines.placement.sizing.own_layouts import THESIS
from beamenv.blade.files import load_config
from beamenv.blade.presets import blade_config
from train.cli.app import app
from train.placement.front_picture import front_panels
from train.placement.sized import size_patches

QUICK = SizingSearch(population=12, generations=3, polished=3, iterations=5)
TWO = ("--actuators", "2", "--sensors", "1")


def run(*arguments):
    return CliRunner().invoke(app, ["place", *arguments])


@pytest.fixture
def quick(monkeypatch):
    monkeypatch.setattr("train.cli.place_sizes.size_patches", partial(size_patches, search=QUICK, placed=False))


def test_json_tells_the_front_and_the_saved_blade_is_the_chosen_point(quick, tmp_path):
    saved = tmp_path / "blade.json"
    result = run("--size", *TWO, "--mass", "0.03", "--json", "--output", str(saved))
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    chosen = told["points"][told["chosen"]]
    assert told["complete"] and chosen["cost"] == min(each["cost"] for each in told["points"])
    assert chosen["mass"] <= 0.03 * (1.0 + 1e-9) and chosen["cost_on_plant"] == pytest.approx(chosen["cost"], rel=0.02)
    patches = load_config(saved).patches
    assert sum(group.count for group in patches.groups("actuators")) == len(chosen["actuators"]["patches"]) == chosen["channels"]
    assert patches.groups("sensors")[0].width == chosen["sensors"]["width"]
    env = gymnasium.make(beamenv.ENV_ID, blade=str(saved))
    observation, _ = env.reset(seed=0)
    assert observation.shape == (len(chosen["sensors"]["patches"]),)


def test_the_screen_shows_the_front_and_a_picture_is_drawn(quick, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "sizes.png"
    result = run("--size", *TWO, "--picture", str(picture))
    assert result.exit_code == 0, result.output
    edges = "chosen, root-side edges: actuators 0."
    for word in ("stationary cost of LQG over mass", "chosen", edges, "own size, as configured: 63.26 g", "½CV²f at"):
        assert word in result.stdout
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_the_thesis_layout_is_on_the_same_axes():
    """Although its four actuators are more than the budget has voltages."""
    sized = size_patches(blade_config(), None, Budget(channels=1), search=QUICK, placed=False)
    assert [each.name for each in sized.layouts] == ["as configured", THESIS]
    assert sized.layouts[1].cost < sized.layouts[0].cost and sized.layouts[1].mass == sized.layouts[0].mass
    cost, patches = front_panels(sized)
    assert f"own size, {THESIS}" in [curve.label for curve in cost.curves]
    assert len(patches.curves) == 2 * len(sized.front.points)


def test_what_was_found_before_an_interruption_is_told(monkeypatch):
    calls = []

    def polished(*_):
        calls.append(1)
        raise KeyboardInterrupt

    monkeypatch.setattr("baselines.placement.sizing.search.polished", polished)
    monkeypatch.setattr("train.cli.place_sizes.size_patches", partial(size_patches, search=QUICK))
    result = run("--size", *TWO, "--json")
    assert result.exit_code == 130 and calls
    told = json.loads(result.stdout)
    assert not told["complete"] and told["points"]
    assert result.stderr == "beamenv: interrupted.\n"


def test_together_tells_both_sides_and_the_gain_and_saves_the_blade(tmp_path):
    saved = tmp_path / "placed.json"
    result = run("--together", "--actuators", "1", "--sensors", "1", "--json", "--output", str(saved))
    assert result.exit_code == 0, result.output
    told = json.loads(result.stdout)
    found = place_jointly(JointProblem.of(blade_config(), 1, 1))
    assert told["actuators"] == list(found.actuators) and told["cost"] == found.cost
    assert told["gain"] == pytest.approx(1.0 - told["cost"] / told["in_turn_cost"])
    patches = load_config(saved).patches
    assert [patches.only(side).positions for side in ("actuators", "sensors")] == [tuple(found.actuators), tuple(found.sensors)]


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--mass", "0.1"], "--mass limits patches that are sized: add --size."),
        (["--together", "--size"], "--together places patches as they are and draws nothing: leave --size out."),
        (["--together", "--picture", "x.png"], "leave --picture out."),
        (["--size", "--method", "sqp"], "--size searches in a way of its own: leave --method out."),
        (["--size", "--leave-unreached"], "--size leaves modes that no patch reaches alone: leave --leave-unreached out."),
        (["--together", "--method", "ga"], "--together searches in a way of its own: leave --method out."),
        (["--size", "--mass", "0.0001"], "--mass is 0.0001, but must be at least 0.001977 kg"),
        (["--size", "--power", "nan"], "--power is nan, but must be"),
        (["--size", "--actuators", "9"], "--actuators is 9, but must be"),
        (["--size", "--output", "blade.txt"], "output is 'blade.txt', but must"),
    ],
)
def test_bad_input_is_one_sentence(arguments, sentence):
    result = run(*arguments, "--json")
    assert result.exit_code == 2
    assert sentence in result.stderr and result.stderr.strip().count("\n") == 0
    assert result.stdout == ""
