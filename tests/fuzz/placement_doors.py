"""Doors of placing patches."""

from functools import cache

from baselines import placement
from beamenv.blade import BladeConfig
from tests.fuzz import small
from tests.fuzz.meaning import COUNT, FLAG, NUMBERS, TEXT, choice, instance, maybe
from tests.fuzz.oracle import Door


@cache
def problem():
    return placement.PlacementProblem.of(small.config(), "actuators", 2)


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
]
