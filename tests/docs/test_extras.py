"""The quick start lists every extra of the package, with the extras that it contains."""

import re
import sys
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

ROOT = Path(__file__).parents[2]
EXTRAS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]


def test_quick_start_lists_every_extra_and_what_it_contains():
    page = (ROOT / "docs" / "quick-start.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `\[(\w+)\]` \| ([^|]*)\|", page, flags=re.MULTILINE)
    told = {name: set(re.findall(r"`\[(\w+)\]`", contains)) for name, contains in rows}
    assert told == {name: contained(requirements) for name, requirements in EXTRAS.items()}


def contained(requirements):
    """The package's own extras among what one asks for."""
    names = "".join(re.findall(r"^beamenv\[(.*)\]$", "\n".join(requirements), flags=re.MULTILINE))
    return set(names.split(",")) - {""}
