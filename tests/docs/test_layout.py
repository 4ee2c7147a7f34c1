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


def modules():
    """Every module with those of the project that it imports, for types alone too."""
    files = {dotted(path): path for wing in WINGS for path in (ROOT / wing).rglob("*.py")}
    found = {}
    for name, path in files.items():
        nodes = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.ImportFrom)]
        targets = {f"{node.module}.{each.name}" for node in nodes for each in node.names} | {node.module for node in nodes}
        found[name] = {each for each in targets if each in files and each != name}
    return found


def dotted(path):
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def test_no_module_leads_back_to_itself():
    """What a package offers comes from its modules, which may name it no further: only its own modules are followed."""
    imported = {name: {each for each in there if not (ROOT / each.replace(".", "/")).is_dir()} for name, there in modules().items()}
    order, pending = [], dict(imported)
    while ready := [name for name, there in pending.items() if not there & pending.keys()]:
        order += ready
        for name in ready:
            del pending[name]
    assert sorted(pending) == []
    assert (
        order.index("baselines.design.loop") < order.index("baselines.design.verification") < order.index("baselines.design.linear")
    )
