"""One id for each controller, agent, scenario and preset: listed, found in Python, and the name of what is made."""

import json
import re
import subprocess
import sys
from pathlib import Path

import gymnasium
import pytest
import typer.main
from typer.testing import CliRunner

import beamenv
from baselines.placement import METHODS
from beamenv.task import resolve_task
from beamenv.titles import BLADES, LEARNT
from train.benchmark.listed import agents as listed_agents
from train.benchmark.listed import listed_controllers
from train.cli.app import app
from train.cli.listing import Kind
from train.controllers import controller
from train.controllers.choice import chosen, chosen_runs
from train.controllers.ids import folder_id
from train.controllers.known import FORMER, known_agents, known_controllers
from train.controllers.named import discover, named
from train.controllers.shipped import FOLDER, shipped_agents
from train.export import FORMATS, PRECISIONS
from train.learning.recipes import NAMES as RECIPES

KINDS = [kind.value for kind in Kind]
LONG_TO_BUILD = {"multiple-model-general", "informed-lqg", "informed-mpc"}
"""A bank, or a search that need not have been made on this machine."""


def listed(kind, *options):
    result = CliRunner().invoke(app, ["list", kind, *options], env={"COLUMNS": "80", "TERMINAL_WIDTH": "80"})
    assert result.exit_code == 0, result.stderr
    return result.stdout


def ids(kind):
    return [each["id"] for each in json.loads(listed(kind, "--json"))]


@pytest.fixture(scope="module")
def env():
    env = gymnasium.make(beamenv.ENV_ID, duration=0.05)
    yield env
    env.close()


def test_what_is_listed_is_what_there_is():
    assert ids("controllers") == list(discover()) == list(known_controllers())
    assert ids("agents") == list(shipped_agents()) == [each.name for each in listed_agents(FOLDER)]
    assert sorted(ids("scenarios")) == sorted(beamenv.SCENARIOS)
    assert ids("presets") == list(beamenv.PRESETS) == list(BLADES)
    assert {each.name for each in listed_controllers(None, {}, [], False)} == {*ids("controllers"), *ids("agents")}


def test_what_a_file_tells_unread_is_what_it_tells_once_imported():
    for name, each in known_controllers().items():
        real = discover()[name]
        assert (each.kind, each.tier) == (real.kind, real.tier)
    assert {each.tier for each in known_agents().values()} == {LEARNT}


@pytest.mark.parametrize("kind", KINDS)
def test_a_table_fits_into_80_columns_and_cuts_no_id(kind):
    text, names = listed(kind), ids(kind)
    rows, _, python = text.partition("In Python: ")
    assert max(map(len, rows.splitlines())) <= 80
    assert [line.split()[0] for line in rows.splitlines() if line[:1].strip() and line.split()[0] in names] == names
    assert python.count("\n") == 1


@pytest.mark.parametrize("kind", KINDS)
def test_every_id_has_a_title_and_its_way_in_python(kind):
    for each in json.loads(listed(kind, "--json")):
        assert each["title"].endswith(".") and each["title"][0].isupper(), each
        assert f'"{each["id"]}"' in each["python"] or f"-{each['id']}-v0" in each["python"]


def asked_for(line):
    """The arguments of the environment that a line of Python makes."""

    class Gymnasium:
        @staticmethod
        def make(env_id, **arguments):
            return gymnasium.spec(env_id).kwargs | arguments

    return eval(line, {"gym": Gymnasium})  # noqa: S307 - our own line


def test_scenarios_and_presets_are_made_as_their_line_says():
    for each in json.loads(listed("scenarios", "--json")):
        assert beamenv.scenario(asked_for(each["python"])["scenario"]) == beamenv.SCENARIOS[each["id"]]
    for each in json.loads(listed("presets", "--json")):
        assert beamenv.blade_config(**asked_for(each["python"])) == beamenv.PRESETS[each["id"]]


@pytest.mark.parametrize("name", sorted({*discover()} - LONG_TO_BUILD))
def test_a_controller_is_called_by_its_id(name, env):
    assert controller(name, env).name == name


def test_an_agent_is_called_by_its_id_and_has_all_of_its_runs(env):
    task = env.unwrapped.task
    for name in ("residual-generalist", "ppo-belief-specialist"):
        runs = chosen_runs(name, task, "nominal")
        assert list(runs) == [str(run) for run in known_agents()[name].runs]
        assert {law.name for law in runs.values()} == {name}
    assert (
        controller("residual-generalist", env, trained_seed=3).weights.keys()
        == controller("residual-generalist", env).weights.keys()
    )
    (alone,) = chosen_runs("residual-generalist", task, "nominal", 2)
    assert alone == ""


def test_a_recipe_s_name_means_its_specialist_where_there_is_one_and_else_its_generalist(env):
    task = env.unwrapped.task
    assert controller("residual", env).name == "residual-generalist"
    assert next(iter(chosen_runs("optimised-linear", task, "delay").values())).name == "optimised-linear-specialist"
    assert next(iter(chosen_runs("optimised-linear", task, "nominal").values())).name == "optimised-linear-generalist"


def test_former_ids_still_mean_their_controllers():
    for former, now in FORMER.items():
        assert named(former) == named(now)
        assert chosen(former, resolve_task(duration=0.02), "nominal").name == now
        assert now in {each.name for each in listed_controllers([former], {}, [], False)}
        assert former not in discover()


@pytest.mark.parametrize(
    ("asked", "sentence"),
    [
        (("lqgg", "nominal"), r"controller is 'lqgg' \(did you mean lqg\?\), but must be one of "),
        (
            ("ppo-specialist", "delay"),
            "scenario is 'delay', but must be one that the agent 'ppo-specialist' was trained on: failure, nominal",
        ),
        (
            ("residual-generalist", "nominal", 9),
            "trained_seed is 9, but must be that of a run of 'residual-generalist': 0, 1, 2, 3, 4",
        ),
        (("lqg", "nominal", 0), "trained_seed is 0, but must be left out, for 'lqg' is no agent that ships"),
    ],
)
def test_what_there_is_not_is_told_in_one_sentence(asked, sentence, env):
    name, *others = asked
    with pytest.raises(ValueError, match=sentence):
        chosen_runs(name, env.unwrapped.task, *others)


def test_an_environment_of_others_has_no_task_to_build_for():
    with pytest.raises(ValueError, match="env is .*, but must be an environment of this package"):
        controller("lqg", gymnasium.make("CartPole-v1"))


def test_a_folder_is_called_by_its_name_and_a_run_in_it_by_both(tmp_path):
    for folder in (tmp_path / "mine", tmp_path / "mine" / "3"):
        folder.mkdir()
    assert folder_id(tmp_path / "mine") == "mine"
    assert folder_id(tmp_path / "mine" / "3") == "mine-3"


def test_names_are_listed_without_what_controllers_are_made_of():
    """Heavy packages take seconds: a name that is not there is told at once."""
    script = (
        "import sys, train.controllers.known as known, beamenv.titles, beamenv.scenarios.named as scenarios\n"
        "known.known_controllers(), known.known_agents(), scenarios.titles()\n"
        "print(sorted({name.partition('.')[0] for name in sys.modules} & {'scipy', 'torch', 'baselines', 'stable_baselines3'}))\n"
    )
    root = str(Path(__file__).parents[2])
    result = subprocess.run([sys.executable, "-c", script], cwd=root, capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "[]"


def help_of(command, parameter):
    """Of an option or an argument."""
    found = {each.name: each.help for each in typer.main.get_command(app).commands[command].params}
    return found[parameter]


def test_help_names_just_what_there_is():
    """Where a list stands in a help text, it is that of the registry."""
    words = {"method": ("place", METHODS), "format": ("export", FORMATS), "precision": ("export", PRECISIONS)}
    for parameter, (command, registry) in words.items():
        text = help_of(command, parameter)
        assert all(re.search(rf"(?<![\w+-]){re.escape(name)}(?![\w+-])", text) for name in registry), text
    for command in ("evaluate", "record", "export", "compare"):
        listed_there = help_of(command, "scenario").partition(": ")[2].partition(", or a TOML")[0]
        assert listed_there.split(", ") == ids("scenarios")
        assert help_of(command, "preset").partition(": ")[2].rstrip(".").split(", ") == ids("presets")
    assert help_of("train", "agent").partition(": ")[2].partition(";")[0].split(", ") == list(RECIPES)
