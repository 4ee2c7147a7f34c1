"""What a tuning tries: what ships can be drawn for every recipe, what is drawn stays in it, and what is wrong is told."""

from dataclasses import asdict

import numpy as np
import pytest

from beamenv.configuration import read
from train.learning.agents import AGENTS
from train.learning.recipe import load_recipe, named_recipe, parsed
from train.learning.recipe_file import as_toml
from train.learning.recipes import NAMES
from train.tuning.space import PACE, drawn, space_of, value_of

OWN = 'agent = "ppo"\ntitle = "Own"\nupdates = 3\n[settings]\nunits = 32\nlearning_rate = 0.01\n'


def space(tmp_path, settings, recipe=None, agent="ppo"):
    (tmp_path / "space.toml").write_text(f'agent = "{agent}"\n[settings]\n{settings}\n')
    return space_of(parsed(OWN, "own") if recipe is None else recipe, tmp_path / "space.toml")


@pytest.mark.parametrize("name", NAMES)
def test_every_recipe_that_ships_can_be_tuned(name):
    recipe = named_recipe(name)
    tried = space_of(recipe)
    values = {tuple(value_of(drawn(recipe, tried, 0, k).settings, each) for each in tried.tried) for k in range(1, 9)}
    assert len(values) == 8
    assert drawn(recipe, tried, 0, 0) == recipe


def test_every_trainer_has_a_space_that_leaves_experience_alone():
    for name in AGENTS:
        assert not set(space_of(named_recipe(name)).tried) & set(PACE)


def test_what_is_drawn_stays_in_its_range_and_whole_numbers_stay_whole(tmp_path):
    tried = space(tmp_path, "learning_rate = {times = [0.5, 2.0]}\ntrace = {between = [0.8, 0.9]}\nunits = {times = [0.5, 2]}")
    settings = [drawn(parsed(OWN, "own"), tried, 0, trial).settings for trial in range(1, 400)]
    rates = np.log2([each.learning_rate / 0.01 for each in settings])
    assert np.abs(rates).max() <= 1.0
    assert np.abs(rates.mean()) < 4.0 / np.sqrt(3.0 * len(rates))  # uniform in the logarithm, four standard errors
    assert all(0.8 <= each.trace <= 0.9 for each in settings)
    assert {type(each.units) for each in settings} == {int}
    assert min(each.units for each in settings) >= 16
    assert max(each.units for each in settings) <= 64


def test_every_choice_is_drawn_and_nothing_else_changes(tmp_path):
    tried = space(tmp_path, 'epochs = {choices = [1, 2]}\nactor = {choices = ["tanh", "linear"]}')
    own = asdict(parsed(OWN, "own").settings)
    found = [asdict(drawn(parsed(OWN, "own"), tried, 0, trial).settings) for trial in range(1, 40)]
    assert {(each["epochs"], each["actor"]) for each in found} == {(1, "tanh"), (2, "tanh"), (1, "linear"), (2, "linear")}
    assert all({**each, "epochs": own["epochs"], "actor": own["actor"]} == own for each in found)


def test_a_trial_does_not_depend_on_how_many_there_are_but_on_the_seed():
    recipe = named_recipe("gradient")
    tried = space_of(recipe)
    assert drawn(recipe, tried, 3, 5) == drawn(recipe, tried, 3, 5)
    assert drawn(recipe, tried, 3, 5) != drawn(recipe, tried, 4, 5)


def test_settings_that_do_not_go_together_are_drawn_anew(tmp_path):
    recipe = parsed(OWN.replace("units = 32", "blades = 64\nrollout = 32\nbatch = 64"), "own")
    tried = space(tmp_path, "batch = {times = [0.1, 1000.0]}", recipe)
    assert all(drawn(recipe, tried, 0, trial).settings.batch <= 64 * 32 for trial in range(1, 60))
    hopeless = space(tmp_path, "batch = {times = [900.0, 1000.0]}", recipe)
    with pytest.raises(ValueError, match="space must leave settings that go together, but none of 1000 draws did: .*batch is"):
        drawn(recipe, hopeless, 0, 1)


def test_settings_within_a_table_are_tried_too(tmp_path):
    recipe = named_recipe("gradient")
    tried = space(tmp_path, "[settings.actor_settings]\nunits = {choices = [7, 9]}", recipe, "gradient")
    units = {drawn(recipe, tried, 0, trial).settings.actor_settings.units for trial in range(1, 20)}
    assert units == {7, 9}


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ("blades = {choices = [8]}", "space.settings.blades cannot be tried: an update has the same experience in all trials"),
        ("unit = {choices = [8]}", "space.settings has no field 'unit' .*: its fields are blades"),
        ("units = {between = [4, 32.5]}", "space.settings.units is 32.5, but must be a whole number"),
        ("units = {between = [32, 4]}", r"space.settings.units.between is \(?\[?32, 4"),
        ("units = {times = [0, 4]}", "space.settings.units.times is .*, but must be .*a range .low, high. from 1e-06"),
        ("actor = {between = [0, 1]}", "space.settings.actor must have choices: the recipe's value is 'tanh', no number"),
        ('actor = {choices = ["relu"]}', "space.settings.actor is 'relu', but must be one of tanh, linear"),
        ("actor = {choices = []}", "space.settings.actor.choices is .*, but must be a list of one or more values"),
        ("units = {choices = [8], times = [1, 2]}", "space.settings.units.between is None, but must be given, or times or choices"),
        ("units = {}", "space.settings.units.between is None, but must be given, or times or choices"),
        ("units = {chices = [8]}", "space.settings.units has no field 'chices' .*: its fields are between, times, choices"),
        ("units = 8", "space.settings.units is 8, but must be a table"),
        ("critic_first = {times = [1, 2]}", "critic_first must have a range or choices, not factors: the recipe's value is 0"),
        ("", "space.settings is {}, but must be a table of one setting or more"),
    ],
)
def test_what_is_wrong_is_told_in_a_sentence(tmp_path, settings, sentence):
    with pytest.raises(ValueError, match=sentence) as told:
        space(tmp_path, settings)
    assert "\n" not in str(told.value)


def test_a_space_is_of_the_recipe_s_trainer(tmp_path):
    with pytest.raises(ValueError, match="space.agent is 'sac', but must be 'ppo', as the recipe's"):
        space(tmp_path, "learning_rate = {times = [1, 2]}", agent="sac")


@pytest.mark.parametrize("name", NAMES)
def test_a_recipe_s_text_is_read_as_the_same_recipe(name, tmp_path):
    recipe = named_recipe(name)
    for trial in (0, 1):
        made = drawn(recipe, space_of(recipe), 0, trial)
        (tmp_path / "made.toml").write_text(as_toml(made, "Two\nlines."), encoding="utf-8")
        assert load_recipe(tmp_path / "made.toml") == made


def test_a_title_of_any_letters_is_written_as_it_is():
    recipe = read(named_recipe("ppo"), {"title": 'A "gain" \\ of é, \U0001f600'}, "recipe")
    assert parsed(as_toml(recipe), "made") == recipe
