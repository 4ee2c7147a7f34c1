"""What is handed to the placement functions and makes no sense is refused in one sentence, and nothing that is kept is changed."""

import threading

import numpy as np
import pytest

from baselines.placement import PlacementProblem, check_reach, optimal_layout, optimal_positions, place, reach
from baselines.placement import optimal as optimal_module
from baselines.placement.cost.damping import design_poles, open_loop_poles
from baselines.placement.search.evolution import Evolution
from baselines.placement.search.genetic import Genetic
from baselines.placement.search.grid import Grid
from baselines.placement.search.sqp import MultiStart, SequentialQuadratic
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
