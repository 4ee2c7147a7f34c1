"""What scenarios can be of a model in the place of a blade: it has no rotor, no plies and no modes that a scenario could count."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from beamenv.blade.model_blade import ModelBlade, check_like, checked_spread, driven, model_of, models_of
from beamenv.configuration import Refused
from beamenv.plant.spread import Spread
from beamenv.scenarios.scenario import Scenario
from beamenv.scenarios.tables import PlantVariation

OF_SAMPLES = ("bank", "seed")
"""What of a scenario's plants is of a model's spread, too."""


def check_scenario(chosen: Scenario) -> None:
    """``ValueError`` for a scenario that says of blades what no model has."""
    usual = PlantVariation()
    for name in PlantVariation.__dataclass_fields__:
        own, allowed = getattr(chosen.plants, name), getattr(usual, name)
        if name not in OF_SAMPLES and own != allowed:
            raise Refused(f"scenario.plants.{name}", own, f"{allowed!r} with a plant of one's own, whose variety its spread says")
    if chosen.loads:
        shapes = [load.shape for load in chosen.loads]
        raise Refused("scenario.loads", shapes, "empty with a plant of one's own, whose disturbances are its own")
    if any(chosen.rotor.harmonics):
        harmonics = list(chosen.rotor.harmonics)
        raise Refused("scenario.rotor.harmonics", harmonics, "none with a plant of one's own, which does not turn")


def fits_models(chosen: Scenario) -> bool:
    """Whether a scenario can be of a model."""
    try:
        check_scenario(chosen)
    except ValueError:
        return False
    return True


def true_model(plant: Any, spread: Any, chosen: Scenario) -> ModelBlade:
    """What moves, behind the drive that a scenario gives it."""
    models, within = models_of(plant), checked_spread(spread)
    if len(models) > 1 and within.anything:
        raise Refused("spread", within, "left out where plants are given one by one")
    limits = chosen.drive.voltage_limits
    return ModelBlade.of(tuple(driven(each, limits) for each in models), within)


def design_model(design: Any, true: ModelBlade, chosen: Scenario) -> ModelBlade:
    """What controllers are designed for, behind what moves' own instruments; ``ValueError`` where it does not fit these."""
    plant = driven(model_of(design, "design"), chosen.drive.voltage_limits)
    check_like("design", plant, true.model)
    return ModelBlade.of((replace(plant, sensor_full_scale=true.model.sensor_full_scale),), Spread())
