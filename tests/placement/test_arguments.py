"""What is handed to the placement functions and makes no sense is refused in one sentence, and nothing that is kept is changed."""

import threading
from dataclasses import fields, replace

import gymnasium
import numpy as np
import pytest

from baselines.placement import PlacementProblem, check_reach, optimal_layout, optimal_positions, place, reach
from baselines.placement import optimal as optimal_module
from baselines.placement.cost.damping import design_poles, open_loop_poles
from baselines.placement.model.contributions import contributions
from baselines.placement.search.evolution import Evolution
from baselines.placement.search.genetic import Genetic
from baselines.placement.search.grid import Grid
from baselines.placement.search.search import InTurn
from baselines.placement.search.sqp import MultiStart, SequentialQuadratic
from beamenv import ENV_ID, VectorPlacementWrapper
from beamenv.blade.bounds import Bounds
from beamenv.blade.presets import blade_config
from train.placement.placed import place_sides

CONFIG = blade_config()
GOOD = [0.1, 0.5]
QUICK = SequentialQuadratic(iterations=1)
SOMETHING_ELSE = [
    None,
    "x",
    b"x",
    True,
    np.nan,
    np.inf,
    -1,
    1.5,
    1e300,
    10**40,
    [],
    {},
    object(),
    [None, 0.5],
    [np.nan, 0.5],
    CONFIG,
]
NO_LAYOUT = [
    *SOMETHING_ELSE,
    *([0.1], [0.1, 0.5, 0.9], [[0.1, 0.5]], ["a", "b"], [True, False], [0.1, 0.12], [-0.1, 0.5], [0.1, 2.0], [0.1 + 1j, 0.5]),
    *(np.zeros((2, 2, 2)), np.ma.masked_array(GOOD, [1, 0])),
]


@pytest.fixture(scope="module")
def problem():
    return PlacementProblem.of(CONFIG, "actuators", 2)


DOORS = {
    "config": lambda problem, wrong: PlacementProblem.of(wrong),
    "side": lambda problem, wrong: PlacementProblem.of(CONFIG, wrong),
    "count": lambda problem, wrong: PlacementProblem.of(CONFIG, "sensors", wrong),
    "bounds": lambda problem, wrong: PlacementProblem.of(CONFIG, "sensors", 2, wrong),
    "problem of place": lambda problem, wrong: place(wrong),
    "method": lambda problem, wrong: place(problem, wrong),
    "seed": lambda problem, wrong: place(problem, QUICK, wrong),
    "start": lambda problem, wrong: place(problem, QUICK, 0, wrong),
    "progress": lambda problem, wrong: place(problem, QUICK, 0, None, wrong),
    "problem of reach": lambda problem, wrong: reach(wrong, GOOD),
    "problem of check_reach": lambda problem, wrong: check_reach(wrong, GOOD),
    "optimal_layout": lambda problem, wrong: optimal_layout(wrong),
    "config of optimal_positions": lambda problem, wrong: optimal_positions(wrong, "actuators"),
    "side of optimal_positions": lambda problem, wrong: optimal_positions(CONFIG, wrong),
    "config of place_sides": lambda problem, wrong: place_sides(wrong, {"actuators": 1}, "sqp", 0),
    "counts": lambda problem, wrong: place_sides(CONFIG, {"actuators": wrong}, "sqp", 0),
    "method of place_sides": lambda problem, wrong: place_sides(CONFIG, {"actuators": 1}, wrong, 0),
    "population": lambda problem, wrong: Genetic(population=wrong),
    "generations": lambda problem, wrong: Genetic(generations=wrong),
    "bits": lambda problem, wrong: Genetic(bits=wrong),
    "mutation": lambda problem, wrong: Genetic(mutation=wrong),
    "evaluations": lambda problem, wrong: Evolution(evaluations=wrong),
    "points": lambda problem, wrong: Grid(points=wrong),
    "candidates": lambda problem, wrong: MultiStart(candidates=wrong),
    "descent": lambda problem, wrong: MultiStart(descent=wrong),
    "iterations": lambda problem, wrong: SequentialQuadratic(iterations=wrong),
}
TAKEN = {"config": [CONFIG], "optimal_layout": [CONFIG], "config of optimal_positions": [CONFIG], "config of place_sides": [CONFIG]}
NONE_MEANS = ("count", "bounds", "start", "progress")


def check_sentence(told):
    sentence = str(told.value)
    assert "\n" not in sentence and sentence.endswith(".") and len(sentence) < 500


@pytest.mark.parametrize("door", DOORS)
def test_what_makes_no_sense_is_refused_in_one_sentence(door, problem):
    for wrong in SOMETHING_ELSE:
        if any(wrong is each for each in TAKEN.get(door, [])) or (wrong is None and door in NONE_MEANS):
            continue
        with pytest.raises(ValueError) as told:
            DOORS[door](problem, wrong)
        check_sentence(told)


@pytest.mark.parametrize("function", [reach, check_reach, design_poles, open_loop_poles, PlacementProblem.configuration])
def test_a_layout_that_cannot_be_is_refused_in_one_sentence(function, problem):
    for wrong in NO_LAYOUT:
        with pytest.raises(ValueError) as told:
            function(problem, wrong)
        check_sentence(told)


@pytest.mark.parametrize("function", [PlacementProblem.cost, PlacementProblem.reduced, PlacementProblem.cost_and_slopes])
def test_layouts_of_another_shape_are_refused_in_one_sentence(function, problem):
    for wrong in [
        *SOMETHING_ELSE,
        np.zeros(3),
        np.zeros((1, 3)),
        np.zeros((1, 1, 2)),
        np.array([GOOD, [np.nan, 1.0]]),
        np.array("x"),
    ]:
        with pytest.raises(ValueError) as told:
            function(problem, wrong)
        check_sentence(told)


def test_what_is_kept_of_a_blade_cannot_be_changed(problem, monkeypatch, tmp_path):
    with pytest.raises(ValueError, match="read-only"):
        problem.parts.stiffness[...] = 0.0
    monkeypatch.setenv("BEAMENV_CACHE", str(tmp_path))
    monkeypatch.setattr(optimal_module, "computed_layout", lambda config: {"actuators": (0.0,), "sensors": (0.1,)})
    optimal_module.kept_layout.cache_clear()
    optimal_layout(CONFIG)["actuators"] = (9.0,)
    assert optimal_layout(CONFIG)["actuators"] == (0.0,)
    optimal_module.kept_layout.cache_clear()


def test_searches_in_several_threads_find_what_each_alone_finds(problem):
    alone = [place(problem, QUICK, seed).positions for seed in range(4)]
    found = [None] * 4

    def search(k):
        found[k] = place(PlacementProblem.of(CONFIG, "actuators", 2), QUICK, k).positions

    threads = [threading.Thread(target=search, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == alone


def test_stages_are_one_or_more_searches_and_a_class_of_them_is_none(problem):
    for wrong in [
        *SOMETHING_ELSE,
        (),
        (None,),
        (QUICK, "sqp"),
        [[QUICK]],
        QUICK,
        SequentialQuadratic,
        (SequentialQuadratic,),
        {QUICK},
    ]:
        with pytest.raises(ValueError, match="stages is .* but must be one or more searches") as told:
            InTurn(wrong)
        check_sentence(told)
    with pytest.raises(ValueError, match="method is"):
        place(problem, SequentialQuadratic)
    assert InTurn([QUICK, QUICK]).stages == (QUICK, QUICK)
    assert place(problem, InTurn((QUICK,))).positions == place(problem, QUICK).positions


BAD_NOISE = [[1.0, 1.0], np.eye(3), [[1.0, np.nan], [0.0, 1.0]], -np.eye(2), [[1.0, 0.5], [0.0, 1.0]], np.eye(2) * 1j]
BAD_BOUNDS = [Bounds("actuators", *numbers) for numbers in [(np.nan, 1.0, 0.085, 2), (0.9, 0.1, 0.085, 2), (0.0, 9.0, 0.085, 2)]]
BAD_BOUNDS += [Bounds("actuators", 0.0, 1.0, *rest) for rest in [(0.0, 2), (0.085, None), (0.085, 99), ("x", 2)]]
BAD_BOUNDS += [Bounds("sensors", 0.0, 1.0, 0.085, 2), Bounds("actuators", None, 1.0, 0.085, 2)]
FIELDS = {
    "config": [],
    "side": ["both"],
    "bounds": BAD_BOUNDS,
    "load_noise": BAD_NOISE,
    "sensor_noise": [-1e-9, [1e-9]],
    "parts": [],
    "reads": ["velocity"],
}


@pytest.mark.parametrize("name", FIELDS)
def test_parts_of_a_problem_that_cannot_be_are_refused_in_one_sentence(name, problem):
    assert {each.name for each in fields(problem)} == set(FIELDS)
    for wrong in [*SOMETHING_ELSE, *FIELDS[name]]:
        if (name == "config" and wrong is CONFIG) or (
            name == "sensor_noise" and type(wrong) in (int, float) and 0 <= wrong < np.inf
        ):
            continue
        with pytest.raises(ValueError, match=name if any(wrong is each for each in SOMETHING_ELSE) else None) as told:
            replace(problem, **{name: wrong})
        check_sentence(told)


def test_sensors_without_noise_are_no_problem_and_the_noise_of_one_is_read_only():
    sensors = PlacementProblem.of(CONFIG, "sensors", 2)
    with pytest.raises(ValueError, match="sensor_noise is 0"):
        replace(sensors, sensor_noise=0.0)
    own = np.eye(2)
    kept = replace(sensors, load_noise=own)
    own[:] = 7.0
    np.testing.assert_array_equal(kept.load_noise, np.eye(2))
    with pytest.raises(ValueError, match="read-only"):
        kept.load_noise[:] = 0.0


@pytest.fixture(scope="module")
def envs():
    return gymnasium.make_vec(ENV_ID, num_envs=2, duration=0.02)


OTHER_NUMBERS = (None, {}, [0.1], [0.1, 0.5, 0.9])
"""Which a side may have: the spaces follow."""
SIDEWISE = [each for each in NO_LAYOUT if not any(type(each) is type(may) and each == may for may in OTHER_NUMBERS)]
SIDEWISE += ["nowhere", {"from": 0.1}, {"low": "x"}, {"low": np.nan}, {"high": None}, {"count": 0}, {"count": 2.5}, {1: 0.1}]


@pytest.mark.parametrize("argument", ["actuators", "sensors"])
def test_sides_of_a_batch_that_cannot_be_are_refused_in_one_sentence(envs, argument):
    before = envs.unwrapped.tasks
    for wrong in SIDEWISE:
        with pytest.raises(ValueError, match=argument) as told:
            VectorPlacementWrapper(envs, **{argument: wrong})
        check_sentence(told)
    assert envs.unwrapped.tasks == before


@pytest.mark.parametrize(
    "wrong",
    [
        *(each for each in SOMETHING_ELSE if each not in (None, {})),
        "nowhere",
        ["uniform"],
        ["uniform"] * 3,
        ["uniform", None],
        ("uniform", 4),
    ],
)
def test_layouts_of_a_batch_that_cannot_be_are_refused_in_one_sentence(envs, wrong):
    before = envs.unwrapped.tasks
    with pytest.raises(ValueError) as told:
        VectorPlacementWrapper(envs, layouts=wrong)
    check_sentence(told)
    assert envs.unwrapped.tasks == before


def test_layouts_that_are_wrong_are_named_with_their_place(envs):
    for wrong, sentence in [
        (["uniform", {"top": [0.0]}], r"layouts\[1\] has no field 'top': its fields are actuators, sensors"),
        (["uniform", 4], r"layouts\[1\] is 4, but must be a name or a mapping"),
        (np.zeros((2, 2)), "layouts is .* must be one layout, or a sequence of 2, one for each blade"),
    ]:
        with pytest.raises(ValueError, match=sentence) as told:
            VectorPlacementWrapper(envs, layouts=wrong)
        check_sentence(told)


def test_a_side_beside_layouts_would_be_ignored_and_is_refused(envs):
    with pytest.raises(ValueError, match="sensors is 'uniform', but must be left out where layouts are given"):
        VectorPlacementWrapper(envs, sensors="uniform", layouts=["uniform", "uniform"])


@pytest.mark.parametrize("name", ["env", "bank"])
def test_other_arguments_of_a_placed_batch_are_refused_in_one_sentence(envs, name):
    for wrong in [*SOMETHING_ELSE, *([gymnasium.make(ENV_ID)] if name == "env" else [0])]:
        if name == "bank" and wrong == 10**40:
            continue  # more than there are blades is one for each
        with pytest.raises(ValueError) as told:
            VectorPlacementWrapper(wrong) if name == "env" else VectorPlacementWrapper(envs, bank=wrong)
        check_sentence(told)


@pytest.mark.parametrize(("beam", "named"), [({"temperature": 320.0}, "temperature"), ({"tip_springs": (1e3,) * 6}, "tip_springs")])
def test_a_blade_that_is_heated_or_held_is_refused_in_a_sentence(beam, named):
    with pytest.raises(ValueError, match=f"blade.beam.{named} is .* but must be None where patches are placed"):
        contributions(replace(CONFIG, beam=replace(CONFIG.beam, **beam)))
