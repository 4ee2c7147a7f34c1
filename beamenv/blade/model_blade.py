"""What moves as a model of one's own says, in the place of a blade: it has no shape, does not turn, and bears any strain."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.configuration import Refused, checked, read
from beamenv.configuration.numbers import Number
from beamenv.configuration.read_only import sealed
from beamenv.patches import PatchResponse
from beamenv.plant.fingerprint import fingerprint
from beamenv.plant.limits import VOLTAGES
from beamenv.plant.model_files import ENDINGS, plant_from_file, plant_from_table, plant_table
from beamenv.plant.model_rules import priced_alike
from beamenv.plant.plant import Plant, drive_limit
from beamenv.plant.reduction import FullModel, ModalModel
from beamenv.plant.spread import Spread, plants_within
from beamenv.structure import RotatingBeam

Array = NDArray[np.float64]

PlantArgument = Plant | Mapping[str, Any] | str | Path | Sequence[Any]

INTERVAL = Number(ge=1e-6, le=1.0, unit="s")
"""As that of blades."""

PLANT, ENSEMBLE = "plant.npz", "ensemble"
"""In the folder of an identification: the plant, and the folder of those within its spread."""

_THE_SAME = ("sensor_full_scale", "sensor_noise", "process_noise", "reference_load", "input_weight", "time_scale")

DRIVE = 1500.0
"""V, the default blade's: what a scenario says of the drive is of it."""


@dataclass(frozen=True)
class ModelBlade(Blade):
    """A model in the place of a blade. ``config`` tells its clock and its drive, and nothing else that is true of it."""

    model: Plant
    """Controllers' design and what moves, unless others move."""
    spread: Spread = Spread()
    """Within which the plants that move are drawn."""
    others: tuple[Plant, ...] = ()
    """Plants that move in place of the model, one drawn for each episode, such as those of an identification's spread."""

    @classmethod
    def of(cls, models: tuple[Plant, ...], spread: Spread) -> ModelBlade:
        """The first is what controllers are designed for; of several, each episode has one."""
        model = models[0]
        low, high = model.voltage_limits
        interval = checked("plant.control_interval", model.control_interval, INTERVAL)
        drive = checked("plant.voltage_limits", (float(low.min()), float(high.max())), VOLTAGES)
        config = BladeConfig(speed=0.0, voltage_limits=drive, control_interval=interval)
        return cls(config, model, spread, models if len(models) > 1 else ())

    @property
    def plant(self) -> Plant:
        """The model."""
        return self.model

    @property
    def truth(self) -> Plant:
        """The model, from which the plants that move depart."""
        return self.model

    @cached_property
    def identity(self) -> str:
        """What it is, for comparisons of one run with another: the same for models that answer alike."""
        return f"{fingerprint(self.model)} {self.spread!r} {[fingerprint(each) for each in self.others]}"

    @property
    def varies(self) -> bool:
        """Whether episodes draw their plants."""
        return bool(self.others) or self.spread.anything

    def varied(self, count: int, seed: int) -> list[Plant]:
        """So many plants that may move, or all there are where they are given one by one."""
        if self.others:
            return list(self.others)
        return plants_within(self.model, self.spread, count, seed)

    @property
    def standing_strain(self) -> Array:
        """(s,): none."""
        return np.zeros(len(self.model.strain))

    def changed(self, config: BladeConfig) -> ModelBlade:
        """The same model: it has no configuration to be changed."""
        return self

    def with_fixed_range(self) -> ModelBlade:
        """The same."""
        return self

    def with_fixed_order(self) -> ModelBlade:
        """The same."""
        return self

    def displacement_operator(self, stations: Sequence[float] | Array) -> Array:
        """Refused: there are no stations."""
        _no_shape("a displacement along the span")

    @property
    def beam(self) -> RotatingBeam:
        """Refused."""
        _no_shape("a beam")

    @property
    def full(self) -> FullModel:
        """Refused."""
        _no_shape("a beam")

    @property
    def modal(self) -> ModalModel:
        """Refused."""
        _no_shape("mode shapes")

    @property
    def true_modal(self) -> ModalModel:
        """Refused."""
        _no_shape("mode shapes")

    @property
    def at_rest(self) -> PatchResponse | None:
        """Refused."""
        _no_shape("patches")


def _no_shape(what: str) -> NoReturn:
    raise ValueError(f"plant is a model without a shape, but {what} is asked for: give a blade instead.")


def model_of(given: Any, name: str = "plant") -> Plant:
    """The plant meant by a ``Plant``, the path of a file or a table of matrices; ``ValueError`` for anything else."""
    if isinstance(given, Plant):
        return given
    if isinstance(given, (str, Path)):
        return Plant.of(plant_from_file(given, name))
    if isinstance(given, Mapping):
        return Plant.of(plant_from_table(given))
    raise Refused(name, given, "a Plant, the path of a .npz, .mat or .json file, or a table of matrices")


def models_of(given: Any) -> tuple[Plant, ...]:
    """One or several, behind the same instruments, or those in a folder; ``ValueError`` where they are not."""
    models = _one_or_several(given)
    for k, each in enumerate(models[1:], start=1):
        check_like(f"plant[{k}]", each, models[0], alike=("disturbances", "reference_load"))
    return _behind_the_same(models)


def tables_of(given: Any) -> Any:
    """The models that are meant, as tables that JSON can hold: what their files say now, whatever they will say later."""
    tables = [plant_table(each) for each in _one_or_several(given)]
    return tables if len(tables) > 1 else tables[0]


def _one_or_several(given: Any) -> tuple[Plant, ...]:
    if isinstance(given, (str, Path)):
        if Path(given).is_dir():
            given = _in_folder(Path(given))
        elif Path(given).suffix.lower() not in ENDINGS and not Path(given).exists():
            allowed = (
                f"the folder of an identification or a file that ends in {' or '.join(ENDINGS)}, and there is none of this name"
            )
            raise Refused("plant", str(given), allowed)
    several = isinstance(given, (list, tuple))
    if several and not given:
        raise Refused("plant", given, "one model, or a list of them")
    return tuple(model_of(each, f"plant[{k}]") for k, each in enumerate(given)) if several else (model_of(given),)


def _in_folder(folder: Path) -> list[Path]:
    """The plant that an identification leaves in its folder, and those within its spread."""
    return [folder / PLANT, *sorted((folder / ENSEMBLE).glob("*.npz"))]


def _behind_the_same(models: tuple[Plant, ...]) -> tuple[Plant, ...]:
    """Noise, ranges and prices are the first one's: it is the plants that differ, not what is asked of them."""
    first = models[0]
    same = {name: getattr(first, name) for name in _THE_SAME}
    others = tuple(replace(each, **same) for each in models[1:])
    return (first, *(others if first.energy_known else (priced_alike(each, first) for each in others)))


def check_like(name: str, plant: Plant, first: Plant, alike: Sequence[str] = ()) -> None:
    """``ValueError`` for a plant that does not stand behind another one's instruments."""
    for what, own, there in (
        ("states", len(plant.A), len(first.A)) if alike else ("states", 0, 0),
        ("voltages", plant.B.shape[1], first.B.shape[1]),
        ("sensors", len(plant.C), len(first.C)),
        ("disturbances", plant.disturbance_input.shape[1], first.disturbance_input.shape[1]),
        ("control_interval", plant.control_interval, first.control_interval),
        ("voltage_limits", plant.voltage_limits.tolist(), first.voltage_limits.tolist()),
    ):
        if own != there and not (isinstance(own, float) and np.isclose(own, there, rtol=1e-9)):
            raise ValueError(f"{name} has {what} {own}, but must have {there}, as what moves has.")


def checked_spread(given: Any) -> Spread:
    """A spread, a table of its fields, or none for None."""
    if given is None or isinstance(given, Spread):
        return given or Spread()
    if not isinstance(given, Mapping):
        raise Refused("spread", given, "None, a Spread or a table of its fields")
    return read(Spread(), given, "spread")


def driven(plant: Plant, limits: tuple[float, float] | None) -> Plant:
    """The plant with the drive that a scenario gives the default blade, of ±1500 V, as shares of its own."""
    if limits is None:
        return plant
    shares = np.array(limits)[:, None] / DRIVE
    return replace(plant, voltage_limits=sealed(shares * drive_limit(plant)))
