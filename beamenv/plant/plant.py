"""The plant, of a blade or of a model of another origin: what it is made from; and all that is done with one, by one name."""

from __future__ import annotations

import os
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

from numpy.typing import ArrayLike

from beamenv.configuration import Instance, checked
from beamenv.plant.matrices import PlantMatrices
from beamenv.plant.model_files import plant_from_file
from beamenv.plant.sampled import SampledPlant, sample, sample_all
from beamenv.plant.state_space import plant_of_arguments
from beamenv.plant.units import drive_limit, normalised

if TYPE_CHECKING:
    import control

__all__ = ["Plant", "SampledPlant", "drive_limit", "normalised", "sample", "sample_all"]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Plant(PlantMatrices):
    """Reduced-order blade with patches, or a model of another origin: n states, m voltages, p sensors, k disturbances.

    Its parts and their units are described at ``beamenv.plant.matrices.PlantMatrices``.
    """

    @classmethod
    def of(cls, matrices: PlantMatrices) -> Plant:
        """The plant that consists of these."""
        return cls(**{each.name: getattr(matrices, each.name) for each in fields(PlantMatrices)})

    @classmethod
    def from_state_space(cls, A: ArrayLike, B: ArrayLike, C: ArrayLike, D: ArrayLike | None = None, **about: Any) -> Plant:
        """The plant of ẋ = A x + B u, y = C x + D u, or with ``dt`` (s) of x⁺ = A x + B u. What may be said ``about`` it, and what
        is taken to be so where it is not, tells ``beamenv.plant.state_space.plant_of_model``.
        """
        return cls.of(plant_of_arguments({"A": A, "B": B, "C": C, "D": D, **about}))

    @classmethod
    def from_file(cls, path: str | os.PathLike[str]) -> Plant:
        """The plant of a model in a file, .npz, .mat or .json, by the names that ``from_state_space`` has for its arguments."""
        return cls.of(plant_from_file(path))

    @classmethod
    def from_control(cls, system: control.StateSpace, like: Plant | None = None, **changes: Any) -> Plant:
        """The plant of a ``control.StateSpace``: as ``from_state_space`` makes it, ``changes`` being what is known besides; or with
        ``like``, and all else as that plant has it. See ``interchange``.
        """
        from beamenv.plant.interchange import plant_from_control
        from beamenv.plant.of_system import plant_of_system

        if like is None:
            return cls.of(plant_of_system(system, changes))
        return plant_from_control(system, checked("like", like, Instance(cls)), **changes)
