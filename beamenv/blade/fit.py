"""What is said of patches that do not fit a blade's walls: the words of its file, not those of the beam, whose inlays they are."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from beamenv.configuration import Refused
from beamenv.patches import PatchLayout
from beamenv.patches.group import UNTOLD, USUAL, PatchGroup
from beamenv.patches.layout import SIDES, Side
from beamenv.structure.inlays import Room
from beamenv.structure.walls.inlay import Inlay

FIELDS = {"thickness": "material.thickness", "start": "positions"}
"""Of a group, for those of an inlay that are called otherwise there."""


def in_words(error: ValueError, layout: PatchLayout, room: Room, boxed: bool) -> ValueError:
    """The refusal of a beam with a layout's patches, of which the first that does not fit is called by its group.

    ``boxed``: no section was given, so it is a box.
    """
    for side, path, group in _groups(layout):
        if (refused := _misfit(room, group.inlays(side, room.length))) is not None:
            return _told(refused, layout, side, path, boxed)
    return ValueError(str(error).replace("inlays at", "patches at", 1))


def _misfit(room: Room, inlays: Sequence[Inlay]) -> Refused | None:
    try:
        for inlay in inlays:
            room.check_fit(inlay)
    except Refused as refused:
        return refused
    return None


def _groups(layout: PatchLayout) -> Iterator[tuple[Side, str, PatchGroup]]:
    paths = iter(layout.named_groups())
    for side in SIDES:
        for group in layout.groups(side):
            yield side, next(paths)[0], group


def _told(refused: Refused, layout: PatchLayout, side: Side, path: str, boxed: bool) -> Refused:
    field = refused.name.removeprefix("inlay.")
    if field != "wall":
        return Refused(f"blade.{path}.{FIELDS.get(field, field)}", refused.value, refused.allowed, refused.meant)
    if path == "patches":  # of no group
        allowed = f"a list of groups, each with its wall, where the section has no wall {refused.value!r}: {_walls(refused)}"
        given = getattr(layout, side)
        return Refused(f"blade.patches.{side}", given, allowed, UNTOLD[side] if given == USUAL else "")
    hint = "; without a blade.beam.section it is a box" if boxed else ""
    return Refused(f"blade.{path}.wall", refused.value, refused.allowed + hint, refused.meant)


def _walls(refused: Refused) -> str:
    return f"its walls are {refused.allowed.partition(': ')[2]}"
