"""The list of public names, read from each package's ``__init__`` when the pages are built."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

PACKAGES = {
    "beamenv": "Environments, blades, plants, scenarios",
    "beamenv.structure": "Mechanics",
    "beamenv.patches": "Patches",
    "beamenv.plant": "Plants",
    "beamenv.blade": "Blades as users describe them",
    "beamenv.baselines": "Controllers and their evaluation",
    "beamenv.baselines.placement": "Placement of patches",
    "beamenv.train.benchmark": "Benchmark",
    "beamenv.train.datasets": "Data sets",
    "beamenv.train.export": "Export",
    "beamenv.train.explore": "Explorer",
    "beamenv.train.page": "Report page",
    "beamenv.train.rllib": "RLlib",
}
"""Packages whose ``__all__`` is public, as scripts import them."""

MARK = "<!-- public names -->"


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Fill in the list where a page asks for it."""
    return markdown.replace(MARK, public_names()) if MARK in markdown else markdown


def public_names() -> str:
    """A table for each package: names, linked to their entries, with the first sentence about each."""
    from train.shared.markdown import markup_table

    parts = []
    for package, title in PACKAGES.items():
        rows = [[f"[`{name}`][{home}]", opening(home)] for name, home in homes(package).items()]
        parts.append(f"## {title}\n\n`from {package} import …`\n\n{markup_table(['name', 'what it is'], rows)}")
    return "\n\n".join(parts)


def homes(package: str) -> dict[str, str]:
    """Where each public name of a package is defined: module and name, by the folders' own names."""
    return {name: home_of(package, name) for name in sorted(public(package), key=str.lower)}


def public(package: str) -> list[str]:
    """The strings of ``__all__``."""
    for node in body_of(package):
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return [str(each) for each in ast.literal_eval(node.value)]
    raise LookupError(f"{package} has no __all__.")


def home_of(module: str, name: str) -> str:
    """Follow imports from one module to the next, to the one that defines the name."""
    for node in imports(body_of(module)):
        for alias in node.names:
            if (alias.asname or alias.name) == name and node.module:
                return home_of(node.module, alias.name)
    return f"{in_folders(module)}.{name}"


def imports(body: list[ast.stmt]) -> Iterator[ast.ImportFrom]:
    """What a module imports from others, for the type checker too."""
    for node in body:
        if isinstance(node, ast.ImportFrom):
            yield node
        elif isinstance(node, ast.If):
            yield from imports(node.body)


def opening(home: str) -> str:
    """The first sentence of what is written about a name; nothing for what has no docstring of its own."""
    module, _, name = home.rpartition(".")
    body = body_of(module)
    for place, node in enumerate(body):
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.name == name:
            return first_sentence(ast.get_docstring(node) or "")
        if name in assigned(node):
            after = body[place + 1] if place + 1 < len(body) else None
            return first_sentence(literal(after)) or value_of(node)
    return ""


def value_of(node: ast.stmt) -> str:
    """What a constant is given, if that is short."""
    value = getattr(node, "value", None)
    return f"`{ast.unparse(value)}`" if isinstance(value, ast.Constant | ast.Tuple) else ""


def assigned(node: ast.stmt) -> set[str]:
    """Names that a statement gives a value."""
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
    return {target.id for target in targets if isinstance(target, ast.Name)}


def literal(node: ast.stmt | None) -> str:
    """The text of a statement that is only a string."""
    value = node.value if isinstance(node, ast.Expr) else None
    return value.value if isinstance(value, ast.Constant) and isinstance(value.value, str) else ""


def first_sentence(text: str) -> str:
    """Up to the first full stop, or to the end of the first paragraph, on one line, fit for a cell."""
    line = " ".join(text.strip().partition("\n\n")[0].split())
    sentence, stop, _ = line.partition(". ")
    return (sentence + stop.strip()).replace("|", "\\|").replace("``", "`")


def body_of(module: str) -> list[ast.stmt]:
    """The statements of a module or of a package's ``__init__``."""
    place = ROOT / in_folders(module).replace(".", "/")
    file = place / "__init__.py" if place.is_dir() else place.with_suffix(".py")
    return ast.parse(file.read_text(encoding="utf-8")).body


def in_folders(module: str) -> str:
    """The module by its folder's name: the wings lie beside ``beamenv``."""
    for wing in ("baselines", "train"):
        if module == f"beamenv.{wing}" or module.startswith(f"beamenv.{wing}."):
            return module.removeprefix("beamenv.")
    return module
