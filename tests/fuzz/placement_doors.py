"""Doors of placing patches."""

from functools import cache

from baselines import placement
from beamenv.blade import BladeConfig
from tests.fuzz import small
from tests.fuzz.meaning import COUNT, FLAG, NUMBER, NUMBERS, TEXT, choice, instance, maybe
from tests.fuzz.oracle import Door


@cache
def problem():
    return placement.PlacementProblem.of(small.config(), "actuators", 2)


@cache
def joint():
    return placement.JointProblem.of(small.config(), 1, 1)


@cache
def sizing():
    return placement.SizingProblem.of(small.config(), placement.Sizes(actuators=1, sensors=1))


QUICK = placement.SizingSearch(population=8, generations=1, polished=2, iterations=1)


DOORS = [
    Door(
        "PlacementProblem.of",
        placement.PlacementProblem.of,
        {"config": instance(BladeConfig), "side": TEXT, "count": maybe(COUNT), "bounds": maybe(NUMBERS)},
        lambda: {"config": small.config(), "side": "actuators", "count": 2, "bounds": [0.0, 1.0]},
        told=("patches", "actuators", "sensors"),
        plain=False,
    ),
    Door(
        "place",
        lambda **given: placement.place(**given).positions,
        {
            "problem": instance(placement.PlacementProblem),
            "method": TEXT,
            "seed": COUNT,
            "start": maybe(NUMBERS),
            "leave_unreached": FLAG,
        },
        lambda: {"problem": problem(), "method": "sqp", "seed": 0, "start": [0.1, 0.6], "leave_unreached": False},
        told=("positions", "actuators"),
    ),
    Door(
        "reach",
        placement.reach,
        {"problem": instance(placement.PlacementProblem), "positions": NUMBERS},
        lambda: {"problem": problem(), "positions": [0.1, 0.6]},
        told=("actuators",),
    ),
    Door(
        "check_reach",
        placement.check_reach,
        {"problem": instance(placement.PlacementProblem), "positions": NUMBERS},
        lambda: {"problem": problem(), "positions": [0.1, 0.6]},
        told=("actuators",),
    ),
    Door(
        "optimal_positions",
        placement.optimal_positions,
        {"config": instance(BladeConfig), "side": choice("actuators", "sensors")},
        lambda: {"config": small.config(), "side": "actuators"},
    ),
    Door("optimal_layout", placement.optimal_layout, {"config": instance(BladeConfig)}, lambda: {"config": small.config()}),
    Door(
        "JointProblem.of",
        placement.JointProblem.of,
        {"config": instance(BladeConfig), "actuators": maybe(COUNT), "sensors": maybe(COUNT)},
        lambda: {"config": small.config(), "actuators": 1, "sensors": 1},
        told=("patches",),
        plain=False,
    ),
    Door(
        "place_jointly",
        lambda **given: placement.place_jointly(**given).actuators,
        {"problem": instance(placement.JointProblem), "seed": COUNT, "leave_unreached": FLAG},
        lambda: {"problem": joint(), "seed": 0, "leave_unreached": True},
    ),
    Door(
        "Sizes",
        placement.Sizes,
        {"length": maybe(NUMBERS), "width": maybe(NUMBERS), "thickness": maybe(NUMBERS), "actuators": maybe(COUNT)},
        lambda: {"length": [0.05, 0.1], "width": [0.02, 0.05], "thickness": [1e-4, 3e-4], "actuators": 2},
        told=("sizes",),
        plain=False,
    ),
    Door(
        "Budget",
        placement.Budget,
        {"mass": maybe(NUMBER), "channels": maybe(COUNT), "power": maybe(NUMBER), "frequency": maybe(NUMBER)},
        lambda: {"mass": 0.1, "channels": 2, "power": 3.0, "frequency": 10.0},
        told=("budget",),
        plain=False,
    ),
    Door(
        "SizingProblem.of",
        placement.SizingProblem.of,
        {"config": instance(BladeConfig), "sizes": instance(placement.Sizes), "budget": instance(placement.Budget)},
        lambda: {"config": small.config(), "sizes": placement.Sizes(actuators=1, sensors=1), "budget": placement.Budget()},
        told=("patches", "sizes", "budget"),
        plain=False,
    ),
    Door(
        "size",
        lambda **given: [each.cost for each in placement.size(**given).points],
        {"problem": instance(placement.SizingProblem), "seed": COUNT, "search": instance(placement.SizingSearch)},
        lambda: {"problem": sizing(), "seed": 0, "search": QUICK},
    ),
]
