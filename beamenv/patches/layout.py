"""Which patches a blade has: actuators and sensors, each in one group or in several."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any, Literal, get_args

from pydantic_core import CoreSchema, core_schema

from beamenv.configuration import Choice, Flag, Number, Patches, Refused, checked, configuration
from beamenv.configuration.composite import Items
from beamenv.configuration.kinds import JsonSchema
from beamenv.patches.group import PatchGroup, Positions
from beamenv.patches.material import MFC_STRAIN, PATCH_MATERIALS, PatchMaterial
from beamenv.structure.sizes import SPAN, WIDTH
from beamenv.structure.walls.inlay import Inlay

Side = Literal["actuators", "sensors"]
SIDES: tuple[Side, ...] = get_args(Side)

ACTUATOR_WALL, SENSOR_WALL = "top", "bottom"
WALLS: Mapping[Side, str] = {"actuators": ACTUATOR_WALL, "sensors": SENSOR_WALL}
"""Where patches lie that are given as a number or by positions alone."""

OUTERMOST = 0.7
"""Those lie between the root and this share of the span: nearer the tip they act as added mass (thesis §5.5)."""

Groups = tuple[PatchGroup, ...]


@dataclass(frozen=True, slots=True, eq=False)
class PatchesOrGroups(Items):
    """A number of patches, their positions, or groups of patches."""

    least: int = 1
    """How many groups."""

    @property
    def allowed(self) -> str:
        """All three."""
        return f"{Patches().allowed}, or {Items.allowed.fget(self)}"  # type: ignore[attr-defined]

    def core(self) -> CoreSchema:
        """An integer, a tuple of floats, or one of groups."""
        several = core_schema.tuple_variable_schema(core_schema.is_instance_schema(self.of), min_length=self.least, strict=True)
        groups = core_schema.no_info_before_validator_function(_as_groups, several)
        return core_schema.union_schema([groups, Patches().core()], mode="left_to_right")

    def json(self) -> JsonSchema:
        """Any of them."""
        return {"anyOf": [Patches().json(), {"type": "array", "items": {"type": "object"}}]}

    def __get_pydantic_json_schema__(self, schema: Any, handler: Any) -> JsonSchema:
        groups, group = Items.__get_pydantic_json_schema__(self, schema, handler)["anyOf"]
        return {"anyOf": [Patches().json(), {**groups, "minItems": self.least}, group]}


def _as_groups(value: Any) -> Any:
    return (value,) if isinstance(value, PatchGroup) else tuple(value) if isinstance(value, list) else value


@configuration("blade.patches", slots=False)
class PatchLayout:
    """The patches of a blade: as numbers or positions, of one kind, actuators in the top wall and sensors in the bottom one; or as
    groups of any kind anywhere.
    """

    actuators: Annotated[int | Positions | Groups, PatchesOrGroups(PatchGroup)] = 4
    """Root-side edges in m from the root, or a number of patches to be spaced equally over 0 … 0.7 L, or groups."""
    sensors: Annotated[int | Positions | Groups, PatchesOrGroups(PatchGroup, 0)] = 4
    """Likewise; an empty list: none."""
    material: Annotated[str | PatchMaterial, Choice(PATCH_MATERIALS, PatchMaterial)] = "MFC"
    """Of patches that are in no group, as is what follows."""
    length: Annotated[float, SPAN] = 0.085
    """m along the span: the active area of an M-8557-P1."""
    width: Annotated[float, WIDTH] = 0.057
    """m across."""
    passive: Annotated[bool, Flag()] = True
    """Whether the patches' own mass and stiffness count."""
    ganged: Annotated[bool, Flag()] = False
    """One voltage for all actuators (the thesis' first method) instead of one each (its second)."""

    def groups(self, side: Side) -> Groups:
        """The groups of one side."""
        return self._actuators if side == "actuators" else self._sensors

    def named_groups(self) -> Iterator[tuple[str, PatchGroup]]:
        """All groups, with the paths of the tables that say what they are made of."""
        for side in SIDES:
            given = getattr(self, side)
            listed = isinstance(given, tuple) and any(isinstance(each, PatchGroup) for each in given)
            for k, group in enumerate(self.groups(side)):
                yield f"patches.{side}[{k}]" if listed else "patches", group

    @cached_property
    def _actuators(self) -> Groups:
        return self._as_groups("actuators", self.actuators)

    @cached_property
    def _sensors(self) -> Groups:
        return self._as_groups("sensors", self.sensors)

    def _as_groups(self, side: Side, given: Any) -> Groups:
        if given == () or (isinstance(given, tuple) and isinstance(given[0], PatchGroup)):
            return given
        return (
            PatchGroup(
                positions=given,
                material=self.material,
                length=self.length,
                width=self.width,
                wall=WALLS[side],
                passive=self.passive,
                ganged=self.ganged and side == "actuators",
                outermost=OUTERMOST,
            ),
        )

    def without_mass(self) -> PatchLayout:
        """The layout with patches whose mass and stiffness do not count."""
        own = {side: tuple(replace(group, passive=False) for group in self.groups(side)) for side in SIDES}
        listed = {side: own[side] if self._in_groups(side) else getattr(self, side) for side in SIDES}
        return replace(self, actuators=listed["actuators"], sensors=listed["sensors"], passive=False)

    def _in_groups(self, side: Side) -> bool:
        given = self.actuators if side == "actuators" else self.sensors
        return isinstance(given, tuple) and isinstance(given[0], PatchGroup)

    def only(self, side: Side) -> PatchGroup:
        """The one group of a side; ``ValueError`` where there are several."""
        groups = self.groups(side)
        if len(groups) != 1:
            raise ValueError(f"blade.patches.{side} has {len(groups)} groups, but must have one where patches are to be placed.")
        return groups[0]

    def pair(self) -> tuple[PatchGroup, PatchGroup]:
        """The one group of actuators and the one of sensors, for placement; ``ValueError`` where they differ in what it takes."""
        actuators, sensors = (self.only(side) for side in SIDES)
        for name in ("length", "passive", "outermost"):
            own, other = getattr(sensors, name), getattr(actuators, name)
            if own != other:
                raise Refused(f"blade.patches.sensors.{name}", own, f"the actuators', {other!r}, for patches to be placed")
        if sensors.ganged or (actuators.wall, actuators.face) == (sensors.wall, sensors.face):
            raise ValueError(
                "blade.patches.sensors must not be ganged, and on another wall or face than the actuators, to be placed."
            )
        return actuators, sensors

    def positions(self, side: Side, beam_length: float) -> Positions:
        """Root-side edges in m, group after group; ``ValueError`` if patches of one overlap or leave its span."""
        length = checked("beam_length", beam_length, Number(gt=0.0, unit="m"))
        return tuple(position for group in self.groups(side) for position in group.at(side, length))

    def actuator_positions(self, beam_length: float) -> Positions:
        """Those of the actuators."""
        return self.positions("actuators", beam_length)

    def sensor_positions(self, beam_length: float) -> Positions:
        """Those of the sensors."""
        return self.positions("sensors", beam_length)

    def placed(self, side: Side, patches: int | Sequence[float]) -> PatchLayout:
        """The layout with the patches of one side elsewhere (m): of several groups as many as those have, in their order."""
        own: Any = self.actuators if side == "actuators" else self.sensors
        given: Any = patches
        if own == () or (isinstance(own, tuple) and isinstance(own[0], PatchGroup)):
            given = _moved(side, own, patches)
        return replace(self, actuators=given) if side == "actuators" else replace(self, sensors=given)

    def inlays(self, beam_length: float) -> tuple[Inlay, ...]:
        """The patches as foreign material in the walls or on them, those that are passive."""
        groups = [(side, group) for side in SIDES for group in self.groups(side) if group.passive]
        return tuple(inlay for side, group in groups for inlay in group.inlays(side, beam_length))

    @property
    def failure_strain(self) -> float:
        """At which the first of its sheets breaks: the least of their limits, whether or not they are passive."""
        return min((group.patch.failure_strain for side in SIDES for group in self.groups(side)), default=MFC_STRAIN)

    def channels(self, side: Side) -> int:
        """How many voltages or currents one side has."""
        return sum(group.channels for group in self.groups(side))


def _moved(side: Side, groups: Groups, patches: int | Sequence[float]) -> Groups:
    given: Any = patches
    if len(groups) == 1:
        return (replace(groups[0], positions=given),)
    if not groups and not isinstance(patches, int) and not len(patches):
        return ()
    counts = [group.count for group in groups]
    if not groups:
        raise Refused(f"blade.patches.{side}", patches, "left out where the blade has none of them to be placed")
    if isinstance(patches, int) or len(patches) != sum(counts):
        raise Refused(f"blade.patches.{side}", patches, f"{sum(counts)} positions (m), {counts} of its groups in turn")
    there = iter(patches)
    return tuple(replace(group, positions=tuple(next(there) for _ in range(group.count))) for group in groups)
