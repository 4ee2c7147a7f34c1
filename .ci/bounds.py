"""Print pip constraints that hold every package the project runs on at the lowest version it declares, tools left out."""

import re
import sys
from pathlib import Path

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

TOOLS = ("dev", "docs")
"""Extras of tools, which are installed as they are."""

project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
extras = project["optional-dependencies"]
declared = project["dependencies"] + [each for name in extras if name not in TOOLS for each in extras[name]]
for requirement in sorted(set(declared)):
    found = re.match(r"([\w.-]+)(?:\[[\w,]+\])?>=([\w.]+)", requirement)
    if found and "python_version" not in requirement:
        sys.stdout.write(f"{found[1]}=={found[2]}\n")
