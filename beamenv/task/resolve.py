"""The task that the arguments of an environment mean."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.files import of_path
from beamenv.blade.given import given_blade
from beamenv.blade.model_blade import PlantArgument
from beamenv.blade.presets import blade_config
from beamenv.configuration import Flag, Refused, checked
from beamenv.plant.files import load_plant
from beamenv.plant.plant import Plant
from beamenv.plant.spread import Spread
from beamenv.scenarios.of_models import check_scenario, design_model, true_model
from beamenv.scenarios.scenario import Scenario
from beamenv.scenarios.scenario import scenario as as_scenario
from beamenv.task.designed import design_config, driven, same_electronics, with_modes
from beamenv.task.length import episode_steps
from beamenv.task.scenario_checks import check_failures, check_loads, under_loads, with_own_loads
from beamenv.task.sharing import shared
from beamenv.task.task import Task

BladeArgument = BladeConfig | Mapping[str, Any] | str | Path | None
DesignArgument = BladeConfig | Mapping[str, Any] | str | Path | Plant | None
ScenarioArgument = Scenario | Mapping[str, Any] | str | Path | None

DURATION = 0.5
"""s of an episode, of a model as much longer as its first mode is slower than the default blade's."""


def resolve_task(
    preset: str = "thesis",
    speed: float | None = None,
    blade: BladeArgument = None,
    design: DesignArgument = None,
    scenario: ScenarioArgument = None,
    duration: float | None = None,
    physical_units: bool = False,
    plant: PlantArgument | None = None,
    spread: Spread | Mapping[str, Any] | None = None,
) -> Task:
    """The task meant by the arguments of an environment; ValueError names the one that is wrong.

    A task that some environment has already is shared with it, and so is a blade. ``plant``, a model of one's own, is in the place
    of ``preset``, ``speed`` and ``blade``, and ``design`` is a model then, too.
    """
    if plant is not None:
        return _of_model(plant, preset, speed, blade, design, scenario, duration, physical_units, spread)
    if spread is not None:
        raise Refused("spread", spread, "None without a plant: what varies of a blade is in the scenario's plants")
    config = blade_config(preset, of_path(blade), speed)
    steps = episode_steps(duration, DURATION, config.control_interval, "blade.control_interval")
    physical_units = checked("physical_units", physical_units, Flag())
    chosen = as_scenario(scenario)
    truth, modes = chosen.plants.truth, chosen.plants.modes
    config = under_loads(config, chosen)
    own = driven(config if design is None else design_config(preset, speed, design), chosen)
    config = with_modes(driven(config, chosen), truth_modes=modes if truth is None else None)
    known = chosen.plants.design_modes
    designed = with_modes(own if design is not None else config, modes=known, truth_modes=known)  # designers know no further mode
    true = Blade(config) if truth is None else given_blade(config, load_plant(truth), truth, modes)
    true = shared(true)
    check_failures(chosen, true.plant)
    check_loads(chosen, true)
    chosen = with_own_loads(chosen, true)
    task = Task(
        blade=true,
        design_blade=true if designed == config else shared(same_electronics(designed, true)),
        scenario=chosen,
        steps=steps,
        physical_units=physical_units,
    )
    return shared(task)


def _of_model(
    plant: PlantArgument,
    preset: str,
    speed: float | None,
    blade: BladeArgument,
    design: Any,
    scenario: ScenarioArgument,
    duration: float | None,
    physical_units: bool,
    spread: Any,
) -> Task:
    for name, value, usual in (("preset", preset, "thesis"), ("speed", speed, None), ("blade", blade, None)):
        if value != usual:
            raise Refused(name, value, "left out with a plant of one's own, which is in the place of a blade")
    chosen = as_scenario(scenario)
    check_scenario(chosen)
    true = true_model(plant, spread, chosen)
    model = true.model
    steps = episode_steps(duration, DURATION * model.time_scale, model.control_interval, "plant.control_interval")
    check_failures(chosen, model)
    check_loads(chosen, true)
    task = Task(
        blade=true,
        design_blade=true if design is None else design_model(design, true, chosen),
        scenario=chosen,
        steps=steps,
        physical_units=checked("physical_units", physical_units, Flag()),
    )
    return shared(task)
