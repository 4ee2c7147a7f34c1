"""Walls as stacks of plies: moments through the thickness, and the wall law with the hoop resultant condensed out."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from types import MappingProxyType
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Number, Numbers, Refused, Table, Text, checked, configuration
from beamenv.configuration.numbers import DEGREES
from beamenv.configuration.read_only import Sealed
from beamenv.structure.walls.graded import FunctionallyGraded, laminae_through
from beamenv.structure.walls.materials import Lamina

Array = NDArray[np.float64]

# The wall strains, as (stress component, power of n): ε_ss, then ε0, ε1, ε3 (spanwise) and γ0, γ1, γ2 (membrane shear).
WALL_STRAINS = ((0, 0), (1, 0), (1, 1), (1, 3), (2, 0), (2, 1), (2, 2))
COMPONENT = np.array([component for component, _ in WALL_STRAINS])
POWER = np.array([power for _, power in WALL_STRAINS])
HIGHEST_MOMENT = 2 * int(POWER.max())

PLY_ANGLES = Numbers(DEGREES, least=1, most=1000, of="ply angles")
"""Of one wall, inner to outer face."""


@configuration("ply")
class Ply:
    """One layer: its material and the angle of its fibres from the contour tangent (0 = hoop, 90 = spanwise), degrees."""

    material: Lamina | FunctionallyGraded
    angle_deg: Annotated[float, DEGREES]

    @property
    def uniform(self) -> Lamina | None:
        """Its material where that is the same through its thickness, else None."""
        return self.material if isinstance(self.material, Lamina) else self.material.uniform

    def at(self, temperature_K: float) -> Ply:
        """The ply at a temperature; ``ValueError`` beyond its material's data."""
        material = self.material.at(temperature_K)
        return self if material is self.material else Ply(material, self.angle_deg)

    @property
    def turned_over(self) -> Ply:
        """From its outer face to its inner."""
        return self if isinstance(self.material, Lamina) else Ply(self.material.turned_over, self.angle_deg)

    def inner_part(self, share: float) -> Ply:
        """What is left of it where the outermost part goes, of its thickness a share."""
        return self if isinstance(self.material, Lamina) else Ply(self.material.part(0.0, share), self.angle_deg)


@dataclass(frozen=True, slots=True)
class Layup:
    """Plies of each wall, from the inner to the outer face; those of one wall are equally thick."""

    default: tuple[Ply, ...] | None
    walls: Mapping[str, tuple[Ply, ...]] = field(default_factory=dict, hash=False)

    def __post_init__(self) -> None:
        if self.default is not None:
            object.__setattr__(self, "default", _plies("layup.default", self.default))
        walls = {wall: _plies(f"layup.walls.{wall}", plies) for wall, plies in checked("layup.walls", self.walls, Table()).items()}
        object.__setattr__(self, "walls", MappingProxyType(walls))

    def __reduce__(self) -> tuple[type[Layup], tuple[tuple[Ply, ...] | None, dict[str, tuple[Ply, ...]]]]:
        # A mapping proxy cannot be pickled, and blades travel to worker processes.
        return Layup, (self.default, dict(self.walls))

    @classmethod
    def uniform(cls, material: Lamina | FunctionallyGraded, angles_deg: Sequence[float]) -> Layup:
        """The same plies all around the contour: a circumferentially uniform stiffness (CUS) box, say.

        A graded material goes through the whole wall, from face to face, whatever the number of angles.
        """
        return cls(default=stack(material, angles_deg, "angles_deg"))

    @classmethod
    def by_wall(cls, material: Lamina | FunctionallyGraded, /, **angles_deg: Sequence[float]) -> Layup:
        """Plies wall by wall, by the names of the section's walls (a box: top, bottom, left, right)."""
        return cls(default=None, walls={wall: stack(material, angles, wall) for wall, angles in angles_deg.items()})

    def plies(self, wall: str) -> tuple[Ply, ...]:
        """The plies of a wall; ``ValueError`` for a wall that the lay-up leaves out."""
        plies = self.walls.get(checked("wall", wall, Text()), self.default)
        if plies is None:
            raise ValueError(f"layup has no plies for wall {wall!r}; it has them for {', '.join(sorted(self.walls))}.")
        return plies

    def check_walls(self, walls: Sequence[str]) -> None:
        """``ValueError`` unless there are plies for every one of ``walls`` and for no other."""
        for wall in walls:
            self.plies(wall)
        unknown = sorted(set(self.walls) - set(walls))
        if unknown:
            raise ValueError(f"layup has plies for wall {unknown[0]!r}; the section has {', '.join(dict.fromkeys(walls))}.")

    def mirrored(self) -> Layup:
        """Every ply angle with its sign changed."""
        return self._each(lambda ply: Ply(ply.material, -ply.angle_deg))

    def at(self, temperature_K: float) -> Layup:
        """Every ply at a temperature; ``ValueError`` beyond the data of a material."""
        return self._each(lambda ply: ply.at(temperature_K))

    def _each(self, change: Callable[[Ply], Ply]) -> Layup:
        default = None if self.default is None else tuple(map(change, self.default))
        return Layup(default, {wall: tuple(map(change, plies)) for wall, plies in self.walls.items()})


def _plies(name: str, given: Any) -> tuple[Ply, ...]:
    """Plies as a tuple; ``ValueError`` for anything else, or none."""
    if not isinstance(given, (list, tuple)) or not given or not all(isinstance(each, Ply) for each in given):
        raise Refused(name, given, "a list of one or more of Ply")
    return tuple(given)


def stack(material: Lamina | FunctionallyGraded, angles_deg: Sequence[float], name: str) -> tuple[Ply, ...]:
    """Plies of one material at the given angles, inner to outer face; one ply of a graded material, which is graded once."""
    plies = tuple(Ply(material, angle) for angle in checked(name, angles_deg, PLY_ANGLES))
    return plies[:1] if isinstance(material, FunctionallyGraded) else plies


@dataclass(frozen=True, slots=True)
class Laminate:
    """A wall of given thickness: layers between ascending coordinates n (m, zero at the mid-line, outward positive)."""

    interfaces: tuple[float, ...]
    plies: tuple[Ply, ...]

    def __post_init__(self) -> None:
        plies = _plies("laminate.plies", self.plies)
        levels = checked("laminate.interfaces", self.interfaces, Numbers(Number(unit="m"), least=2))
        if len(levels) != len(plies) + 1 or any(low >= high for low, high in zip(levels[:-1], levels[1:], strict=True)):
            raise Refused("laminate.interfaces", levels, f"{len(plies) + 1} ascending numbers (m), one more than plies")
        object.__setattr__(self, "plies", plies)
        object.__setattr__(self, "interfaces", levels)

    @classmethod
    def equal_plies(cls, plies: tuple[Ply, ...], thickness: float) -> Laminate:
        """Equally thick plies filling ``thickness`` (m)."""
        count = len(_plies("plies", plies))
        return cls(tuple(np.linspace(-0.5 * thickness, 0.5 * thickness, count + 1).tolist()), plies)

    @property
    def thickness(self) -> float:
        """Metres."""
        return self.interfaces[-1] - self.interfaces[0]

    def with_outer_layer(self, ply: Ply, thickness: float) -> Laminate:
        """The same wall with its outermost ``thickness`` (m) replaced by ``ply``, flush with the outer face."""
        if not 0.0 < thickness < self.thickness:
            raise ValueError(f"thickness = {thickness!r} of an inlay must be positive and below the wall's {self.thickness:.6g} m.")
        level = self.interfaces[-1] - thickness
        kept = [k for k, start in enumerate(self.interfaces[:-1]) if start < level - 1e-12 * self.thickness]
        starts = tuple(self.interfaces[k] for k in kept)
        last = kept[-1]
        share = (level - starts[-1]) / (self.interfaces[last + 1] - starts[-1])
        cut = self.plies[last].inner_part(share) if share < 1.0 - 1e-12 else self.plies[last]
        return Laminate((*starts, level, self.interfaces[-1]), (*self.plies[:last], cut, ply))

    def with_layer_on_top(self, ply: Ply, thickness: float) -> Laminate:
        """The same wall with a further layer of ``thickness`` (m) on its outer face; the mid-line stays where it is."""
        thickness = checked("thickness", thickness, Number(gt=0.0, unit="m"))
        return Laminate((*self.interfaces, self.interfaces[-1] + thickness), (*self.plies, ply))

    def at(self, temperature_K: float) -> Laminate:
        """The same wall with its materials' constants at a temperature; ``ValueError`` beyond their data."""
        warm = {ply: ply.at(temperature_K) for ply in dict.fromkeys(self.plies)}
        return Laminate(self.interfaces, tuple(warm[ply] for ply in self.plies))

    @property
    def turned_over(self) -> Laminate:
        """The same plies from the outer face to the inner."""
        plies = tuple(ply.turned_over for ply in reversed(self.plies))
        return Laminate(tuple(-level for level in reversed(self.interfaces)), plies)

    def moments(self, values: Array, highest: int = HIGHEST_MOMENT) -> Array:
        """∫ value(n) nʲ dn for j = 0 … highest, from one value (any shape) per ply: (highest + 1, …)."""
        return np.tensordot(power_integrals(np.array(self.interfaces), highest), values, axes=1)

    def integrated(self, value: Callable[[Lamina, float], Any], highest: int = HIGHEST_MOMENT) -> Array:
        """∫ value nʲ dn for j = 0 … highest, of what a material has at an angle (rad) from s towards z: (highest + 1, …)."""
        angles = np.radians([ply.angle_deg for ply in self.plies])
        layers = list(zip(self.plies, self.interfaces[:-1], self.interfaces[1:], angles, strict=True))
        if any(ply.uniform is None for ply in self.plies):
            return np.sum([_integral(ply, low, high, angle, value, highest) for ply, low, high, angle in layers], axis=0)
        uniform = [(ply.uniform, angle) for ply, *_, angle in layers if ply.uniform is not None]
        return self.moments(np.array([value(*each) for each in uniform]), highest)


def _integral(ply: Ply, low: float, high: float, angle: float, value: Callable[[Lamina, float], Any], highest: int) -> Array:
    """That of one layer of a wall."""
    if ply.uniform is not None:
        return np.tensordot(power_integrals(np.array([low, high]), highest), [value(ply.uniform, angle)], axes=1)
    assert isinstance(ply.material, FunctionallyGraded)
    rule = ply.material.rule()
    half = 0.5 * (high - low)
    depth = 0.5 * (low + high) + half * rule.place
    powers = depth ** np.arange(highest + 1)[:, None] * (half * rule.weight)
    return np.tensordot(powers, np.array([value(material, angle) for material in laminae_through(ply.material)]), axes=1)


def power_integrals(interfaces: Array, highest: int) -> Array:
    """∫ nʲ dn over each layer, (highest + 1, layers)."""
    exponents = np.arange(1, highest + 2)[:, None]
    return np.diff(interfaces[None, :] ** exponents, axis=1) / exponents


@dataclass(frozen=True, slots=True, eq=False)
class WallLaw(Sealed):
    """What a wall contributes to a section, per unit area."""

    thickness: float
    stiffness: Array
    """(6, 6) for (ε0, ε1, ε3, γ0, γ1, γ2), with N_ss = 0."""
    hoop_coupling: Array
    """(6,): −∂ε_ss/∂(wall strains) under N_ss = 0; what a hoop stress does to the six resultants."""
    transverse_shear: Array
    """(7,): moments of Q̄44."""
    density: Array
    """(7,): moments of ρ."""


@lru_cache(maxsize=64)
def wall_law(laminate: Laminate) -> WallLaw:
    """Integrate a laminate through its thickness and condense out the hoop strain (N_ss = 0)."""
    q_bar = laminate.integrated(lambda material, angle: material.transformed_stiffness(angle))
    full = q_bar[POWER[:, None] + POWER[None, :], COMPONENT[:, None], COMPONENT[None, :]]
    hoop_coupling = full[0, 1:] / full[0, 0]
    return WallLaw(
        thickness=laminate.thickness,
        stiffness=full[1:, 1:] - np.outer(full[0, 1:], hoop_coupling),
        hoop_coupling=hoop_coupling,
        transverse_shear=laminate.integrated(Lamina.transverse_shear_stiffness),
        density=laminate.integrated(lambda material, _: material.density),
    )
