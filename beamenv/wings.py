"""``beamenv.baselines`` and ``beamenv.train``: the other two wings, by names that no script and no other package can take.

A script of a user's own is often called train.py, and a package called ``baselines`` is on the index. Where Python would find
such a one first, modules of the wings are loaded under the long names alone, and import each other by these. Elsewhere the short
names and the long ones are the same modules.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from functools import cache
from importlib import import_module
from importlib.abc import Loader, MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from importlib.util import find_spec, spec_from_loader
from pathlib import Path
from types import CodeType, ModuleType
from typing import Any

WINGS = ("baselines", "train")
_HERE = Path(__file__).resolve().parent
_HOME = next(folder for folder in (_HERE / "_wings", _HERE.parent) if (folder / "baselines").is_dir())
"""Where their folders lie: inside the package once it is installed, where no other one overwrites them, else beside it."""


def _is_ours(wing: str) -> bool:
    """Whether the short name is this very wing's; what another one holds is not run for that."""
    try:
        spec = find_spec(wing)
    except ValueError:  # a module that was made by hand
        return False
    places = spec.submodule_search_locations if spec is not None else None
    return any(Path(place).resolve() == _HOME / wing for place in places or ())


@cache
def _are_ours() -> bool:
    """Whether both short names are, for the wings know each other."""
    return all(_is_ours(wing) for wing in WINGS)


def _short(name: str) -> str | None:
    """``train.page`` of ``beamenv.train.page``; None of what is in neither wing."""
    package, _, rest = name.partition(".")
    return rest if package == __package__ and rest.partition(".")[0] in WINGS else None


def _long(name: str) -> str:
    return f"{__package__}.{name}" if name.partition(".")[0] in WINGS else name


class LongNames(MetaPathFinder):
    """Finds modules by their long names."""

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        """The module of the short name where that is ours, else one loaded on its own."""
        short = _short(fullname)
        if short is None:
            return None
        if _are_ours():
            return spec_from_loader(fullname, _SameModule(short))
        spec = PathFinder.find_spec(fullname, [str(_HOME)] if short in WINGS else path)
        if spec is not None and isinstance(spec.loader, SourceFileLoader):
            spec.loader = _LongNamed(spec.loader.name, spec.loader.path)
        return spec


class ShortNames(MetaPathFinder):
    """Finds the wings by their short names where nothing else is called so: asked last."""

    def find_spec(self, fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        """The wing itself; what is in it Python finds."""
        return PathFinder.find_spec(fullname, [str(_HOME)]) if fullname in WINGS else None


class _SameModule(Loader):
    """Gives a module a second name."""

    def __init__(self, name: str) -> None:
        self._name = name

    def exec_module(self, module: ModuleType) -> None:
        sys.modules[module.__name__] = import_module(self._name)

    def get_code(self, fullname: str) -> Any:
        """What ``python -m`` runs."""
        spec = find_spec(self._name)
        assert spec is not None
        return spec.loader.get_code(self._name)  # type: ignore[union-attr]


class _LongNamed(SourceFileLoader):
    """Loads a module whose imports of the wings mean the long names."""

    def get_code(self, fullname: str) -> CodeType:
        """Compiled anew: what Python has kept of the file imports by short names."""
        import ast

        tree = ast.parse(self.get_data(self.path), self.path)
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and node.module and not node.level:
                node.module = _long(node.module)
            elif isinstance(node, ast.Import):
                for each in node.names:
                    if each.name in WINGS:  # a longer one would bind another name
                        each.name, each.asname = _long(each.name), each.asname or each.name
        return compile(tree, self.path, "exec", dont_inherit=True)


def install() -> None:
    """Let Python find the wings so, once."""
    if not any(type(finder).__name__ == LongNames.__name__ for finder in sys.meta_path):
        sys.meta_path.insert(0, LongNames())
        sys.meta_path.append(ShortNames())
