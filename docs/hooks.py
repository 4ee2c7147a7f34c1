"""What pages take from the package when they are built: scenarios, recipes, shipped agents, examples, the command line's help."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

SCENARIOS = ROOT / "beamenv" / "scenarios" / "named"
EXAMPLES = ROOT / "examples"
BLADES = EXAMPLES / "blades"


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Every example is a page."""
    for script in sorted(EXAMPLES.glob("[0-9]*.py")):
        files.append(File.generated(config, f"examples/{script.stem}.md", content=example_page(script)))
    return files


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Fill in what a page asks for by a comment."""
    for name, make in FILLED.items():
        mark = f"<!-- {name} -->"
        if mark in markdown:
            markdown = markdown.replace(mark, make())
    return markdown


def example_page(script: Path) -> str:
    """A script in percent format as Markdown: comments of ``# %% [markdown]`` cells are text, the other cells are code."""
    parts = [f"*This page is `examples/{script.name}`; run it with `python examples/{script.name}`.*"]
    for cell in re.split(r"^# %%", script.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        head, _, body = cell.partition("\n")
        if "[markdown]" in head:
            parts.insert(len(parts) if len(parts) > 1 else 0, re.sub(r"^# ?", "", body.strip(), flags=re.MULTILINE))
        else:
            parts.append(f"```python\n{body.strip()}\n```")
    return "\n\n".join(parts) + "\n"


def scenario_table() -> str:
    """One row for each file: the comment that it opens with, and what it sets."""
    from train.shared.markdown import markup_table

    rows = []
    for file in sorted(SCENARIOS.glob("*.toml")):
        lines = file.read_text(encoding="utf-8").splitlines()
        opening = [line.removeprefix("#").strip() for line in lines if line.startswith("#")]
        rows.append([f"`{file.stem}`", " ".join(opening), "<br>".join(settings(lines)) or "nothing: the default"])
    return markup_table(["scenario", "what is wrong", "what the file sets"], rows)


def gallery() -> str:
    """Each example of a blade: what its file opens with, the picture of its section, and the file."""
    return "\n\n".join(map(blade_page, sorted(BLADES.glob("*.toml"))))


def blade_page(file: Path) -> str:
    """One of them."""
    lines = file.read_text(encoding="utf-8").splitlines()
    opening = [line.removeprefix("#").strip() for line in lines if line.startswith("#")]
    content = "\n".join(line for line in lines if not line.startswith("#")).strip()
    title = file.stem.replace("-", " ").capitalize()
    picture = f"![The section at the root, with its patches and its centres](images/gallery/{file.stem}.png)"
    return f"## {title}\n\n{' '.join(opening)}\n\n{picture}\n\n`examples/blades/{file.name}`:\n\n```toml\n{content}\n```"


def settings(lines: list[str]) -> list[str]:
    """``table.key = value`` of a TOML file, each as code, with the remark behind it."""
    found, table = [], ""
    for line in lines:
        if line.startswith("["):
            table = line.strip("[] ") + "."
        elif "=" in line and not line.startswith("#"):
            value, _, remark = line.partition("#")
            found.append(f"`{table}{value.strip()}`" + (f" {remark.strip()}" if remark else ""))
    return found


def recipe_table() -> str:
    """The recipes that come with the package."""
    from train.learning.recipe import named_recipe
    from train.learning.recipes import NAMES
    from train.shared.markdown import markup_table

    found = [(name, named_recipe(name)) for name in NAMES]
    return markup_table(["recipe", "what it is", "updates"], [[f"`{name}`", each.title, str(each.updates)] for name, each in found])


def shipped_table() -> str:
    """The policies in ``train/controllers/trained``."""
    from train.controllers.policy_files import read_about
    from train.controllers.shipped import GENERALIST, shipped_agents
    from train.shared.markdown import markup_table

    homes = [
        (agent, *home) for agent in shipped_agents().values() for home in {GENERALIST: agent.everywhere, **agent.only_in}.items()
    ]
    rows = []
    for agent, scenario, runs in homes:
        if not runs:
            continue
        abouts = [read_about(each.folder) for each in runs.values()]
        longest = max(float(about["seconds"]) for about in abouts)
        updates = " to ".join(dict.fromkeys(str(choose(int(about["updates"]) for about in abouts)) for choose in (min, max)))
        where = "several scenarios at once" if scenario == GENERALIST else f"`{scenario}`"
        rows.append([f"`{agent.id}`", where, ", ".join(map(str, runs)), updates, f"{longest:.0f}"])
    if not rows:
        return "This copy holds no trained agent."
    return markup_table(["agent", "trained on", "runs", "updates", "s on the clock"], rows)


def command_line() -> str:
    """Each command with its arguments and options, from the command line itself."""
    import typer.main

    from train.cli.app import app

    group: Any = typer.main.get_command(app)
    return "\n\n".join(command_page(name, command) for name, command in group.commands.items())


def command_page(name: str, command: Any) -> str:
    """One command's help and a table of its parameters."""
    from train.shared.markdown import markup_table

    rows = []
    for parameter in command.params:
        if parameter.name == "help":
            continue
        spelled = parameter.opts[0] if parameter.param_type_name == "option" else parameter.name.upper()
        rows.append([f"`{spelled}`", shown_default(parameter), parameter.help or ""])
    return f"## beamenv {name}\n\n{command.help}\n\n" + markup_table(["option", "default", "what it does"], rows)


def shown_default(parameter: Any) -> str:
    """A parameter's default as code; nothing where there is none to tell."""
    if parameter.required:
        return "required"
    return "" if parameter.default is None or parameter.default is False else f"`{parameter.default}`"


FILLED = {
    "scenario table": scenario_table,
    "recipes": recipe_table,
    "shipped agents": shipped_table,
    "command line": command_line,
    "gallery": gallery,
}
"""What a comment of that name is replaced by."""
