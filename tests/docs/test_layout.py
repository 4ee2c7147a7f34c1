"""The rooms of the code, as the page on extending lists them from the top down, and the imports between them."""

import ast
import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
WINGS = ("train", "baselines", "beamenv")


def listed():
    """Rooms as (wing, room) in the order of the table."""
    page = (ROOT / "docs" / "extending.md").read_text(encoding="utf-8")
    return [tuple(row.removesuffix(".py").split("/")) for row in re.findall(r"^\| `([\w/.]+)` \|", page, flags=re.MULTILINE)]


def imports():
    """(room that imports, room that is imported) over all files, rooms as (wing, room); (wing,) for what the wing itself offers."""
    found = set()
    for wing in WINGS:
        for file in (ROOT / wing).rglob("*.py"):
            here = file.relative_to(ROOT).with_suffix("").parts[:2]
            for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
                if isinstance(node, ast.ImportFrom) and node.level == 0:
                    targets = [node.module]
                else:
                    targets = [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
                found |= {(here, tuple(target.split(".")[:2])) for target in targets if target.split(".")[0] in WINGS}
    return found


def test_every_room_is_listed_and_no_other():
    rooms = {(wing, path.stem) for wing in WINGS for path in (ROOT / wing).iterdir() if is_room(path)}
    assert rooms == set(listed())


def is_room(path):
    return (path / "__init__.py").is_file() or (path.suffix == ".py" and path.name != "__init__.py")


def test_every_import_goes_down_the_table():
    floor = {room: height for height, room in enumerate(listed())}
    up = []
    for here, there in imports():
        if here == there or here[1] == "__init__":  # what a wing offers comes from all of its rooms
            continue
        down = floor[there] > floor[here] if len(there) == 2 else WINGS.index(there[0]) > WINGS.index(here[0])
        if not down:
            up.append(f"{'.'.join(here)} -> {'.'.join(there)}")
    assert sorted(up) == []


def test_imports_are_seen():
    assert (("beamenv", "plant"), ("beamenv", "structure")) in imports()
    assert len(imports()) > 60
