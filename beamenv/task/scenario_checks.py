"""Whether a scenario suits a blade."""

from __future__ import annotations

from dataclasses import replace

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Refused
from beamenv.plant.plant import Plant
from beamenv.scenarios.own_loads import of_blade
from beamenv.scenarios.sampling import check_frequencies, largest_speed
from beamenv.scenarios.scenario import Scenario


def check_failures(chosen: Scenario, plant: Plant) -> None:
    """``ValueError`` for more broken actuators or sensors than the blade has."""
    failures = chosen.failures
    for name, broken, there in (
        ("dead_actuators", failures.dead_actuators, plant.B.shape[1]),
        ("faulty_sensors", failures.faulty_sensors, len(plant.C)),
    ):
        if broken > there:
            raise Refused(f"scenario.failures.{name}", broken, f"at most the {there} that the blade has")


def under_loads(config: BladeConfig, chosen: Scenario) -> BladeConfig:
    """The blade with the places of a scenario's loads; ``ValueError`` for one that has others, of which nobody says how large."""
    places = tuple(load.place for load in chosen.loads)
    if config.loads and config.loads != places:
        shapes = [place.shape for place in config.loads]
        raise Refused("blade.loads", shapes, "left out, or the places of the scenario's loads, which say how large they are")
    return replace(config, loads=places)


def with_own_loads(chosen: Scenario, true: Blade) -> Scenario:
    """The scenario with what its own loads leave to the blade."""
    if not chosen.loads:
        return chosen
    return replace(chosen, loads=of_blade(chosen.loads, true.beam, true.reference_load))


def check_loads(chosen: Scenario, true: Blade, path: str = "scenario") -> None:
    """``ValueError`` for loads that cannot be shown at the blade's control interval."""
    interval, lowest = true.config.control_interval, float(true.plant.natural_frequencies[0])
    check_frequencies(chosen, interval, lowest, largest_speed(chosen, true.config.speed), path)
