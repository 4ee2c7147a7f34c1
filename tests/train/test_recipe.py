"""Recipes: those that ship all load, and what is wrong in one's own is told in a sentence."""

from dataclasses import fields, is_dataclass

import pytest

from beamenv.configuration import read
from beamenv.scenarios.named import BENCHMARK, OPEN, UNSEEN
from train.learning.agents import AGENTS
from train.learning.job import GENERALIST, Job
from train.learning.recipe import load_recipe, named_recipe, parsed
from train.learning.recipes import NAMES
from train.learning.session import Budget

WHOLE = 'agent = "ppo"\ntitle = "Brief"\nupdates = 3\n[settings]\nunits = 32\nlearning_rate = 1\n'


@pytest.mark.parametrize("name", NAMES)
def test_every_recipe_that_ships_names_a_known_trainer(name):
    recipe = named_recipe(name)
    assert recipe.agent in AGENTS
    assert isinstance(recipe.settings, AGENTS[recipe.agent].settings)
    assert recipe.title
    assert recipe.updates > 0


def test_every_trainer_has_a_recipe_of_its_name():
    assert set(AGENTS) <= set(NAMES)


def test_a_recipe_of_one_s_own_changes_what_it_names_and_nothing_else(tmp_path):
    (tmp_path / "own.toml").write_text(WHOLE)
    settings, default = load_recipe(tmp_path / "own.toml").settings, AGENTS["ppo"].settings()
    differing = {each.name for each in fields(settings) if getattr(settings, each.name) != getattr(default, each.name)}
    assert differing == {"units", "learning_rate"}
    assert (settings.units, settings.learning_rate) == (32, 1.0)
    assert isinstance(settings.learning_rate, float)


def test_a_table_within_the_settings_is_changed_field_by_field():
    text = 'agent = "gradient"\ntitle = "Small"\nupdates = 3\n[settings.actor_settings]\nunits = 8\n'
    settings = parsed(text, "own").settings
    assert is_dataclass(settings.actor_settings)
    assert settings.actor_settings.units == 8
    assert settings.actor_settings.input_gain == AGENTS["gradient"].settings().actor_settings.input_gain


@pytest.mark.parametrize(
    ("before", "after", "sentence"),
    [
        ('"ppo"', '"dreamer"', "recipe.agent is 'dreamer', but must be one of gradient, ppo"),
        ('"ppo"', "[1]", "recipe.agent is .1., but must be one of"),
        ("updates = 3", "updates = 0", "recipe.updates is 0, but must be a whole number not below 1"),
        ("updates = 3", "updates = true", "recipe.updates is True, but must be a whole number"),
        ('title = "Brief"\n', "", "recipe.title is missing"),
        ("updates", "upgrades", "recipe has no field 'upgrades' .*: its fields are agent, title, updates"),
        ("units = 32", "unit = 32", "recipe.settings has no field 'unit' .*: its fields are blades"),
        ("units = 32", 'units = "many"', "recipe.settings.units is 'many', but must be a whole number"),
        ("units = 32", "units = 32.5", "recipe.settings.units is 32.5, but must be a whole number"),
        ("[settings]\n", "settings = 3\n#", "recipe.settings is 3, but must be a table of fields"),
        ("units = 32", "units =", "file .own.toml. cannot be read: .*line 5"),
    ],
)
def test_what_is_wrong_is_told_in_a_sentence(before, after, sentence):
    text = WHOLE.replace(before, after) if "settings = 3" not in after else WHOLE.split("[settings]")[0] + "settings = 3\n"
    with pytest.raises(ValueError, match=sentence) as told:
        parsed(text, "own.toml")
    assert "\n" not in str(told.value)


def test_unknown_names_and_files_are_told(tmp_path):
    with pytest.raises(ValueError, match="agent is 'dreamer', but must be one of belief, gradient"):
        named_recipe("dreamer")
    with pytest.raises(ValueError, match="absent.toml"):
        load_recipe(tmp_path / "absent.toml")


def test_generalists_train_on_every_scenario_but_those_kept_for_judging():
    recipe = named_recipe("gradient")
    tasks = Job("gradient", recipe, GENERALIST, 0, Budget(updates=1), {}).tasks()
    assert set(tasks) == {*BENCHMARK, *OPEN} - set(UNSEEN)
    assert set(Job("gradient", recipe, "solid", 0, Budget(updates=1), {}).tasks()) == {"solid"}


MAY_BE_ZERO = {
    "compositions",
    "first",
    "last_share",
    "last_window",
    "critic_first",
    "critic_memory",
    "energy_horizon",
    "exploration",
    "output_gain",
    "trace",
    "smoothing",
    "validation",
}
"""Settings that mean something at zero: none, no wait, potential or look, a deviation of one, an idle start, a mean."""

NUMBERS = [
    (name, table, each.name)
    for name, agent in AGENTS.items()
    for table, settings in (("", agent.settings()), ("actor_settings", getattr(agent.settings(), "actor_settings", None)))
    for each in (fields(settings) if settings is not None else ())
    if isinstance(getattr(settings, each.name), int | float) and not isinstance(getattr(settings, each.name), bool)
]


@pytest.mark.parametrize(("agent", "table", "name"), NUMBERS)
def test_a_setting_out_of_its_range_is_refused_before_training(agent, table, name):
    default = AGENTS[agent].settings()
    standing = getattr(getattr(default, table) if table else default, name)
    refused = [float("nan"), float("inf"), True, str(standing), None, [standing]]
    refused += [0] if name not in MAY_BE_ZERO else []
    refused += [-1] if name != "exploration" else [-21.0, 3.0]
    refused += [standing + 0.5, 10**12] if isinstance(standing, int) else []
    for value in refused:
        given = {table: {name: value}} if table else {name: value}
        path = f"settings.{table}.{name}" if table else f"settings.{name}"
        with pytest.raises(ValueError, match=f"{path} is .*, but must be "):
            read(default, given, "settings")


@pytest.mark.parametrize(
    ("agent", "given", "sentence"),
    [
        ("ppo", {"blades": 8, "rollout": 4}, "settings.batch is 8192, but must be at most the 32 samples of a rollout"),
        ("recurrent-ppo", {"rollout": 1}, "settings.batch is 4096, but must be at most the 256 samples"),
        ("sac", {"buffer": 100}, "settings.buffer is 100, but must be at least one action of each of the 256 blades"),
        ("tqc", {"first": 200_000}, "settings.first is 200000, but must be at most what the buffer of 200000 holds"),
    ],
)
def test_settings_that_together_learn_nothing_or_something_else_are_refused(agent, given, sentence):
    with pytest.raises(ValueError, match=sentence):
        read(AGENTS[agent].settings(), given, "settings")


def test_an_action_held_longer_than_an_episode_is_refused():
    (task,) = Job("ppo", named_recipe("ppo"), "nominal", 0, Budget(updates=1), {"duration": 0.02}).tasks().values()
    settings = read(AGENTS["ppo"].settings(), {"held": 41, "blades": 8, "batch": 32}, "settings")
    with pytest.raises(ValueError, match="settings.held is 41, but must be at most the 40 intervals of an episode"):
        AGENTS["ppo"].training([task], settings, 0, None)
