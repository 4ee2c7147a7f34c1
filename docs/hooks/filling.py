"""What pages take from the package: scenarios, recipes, shipped agents, gallery, the command line's help.

Each stands in its page between two comments, so that whoever reads the unbuilt page has it too. A build makes them anew;
``python docs/hooks/filling.py`` writes them into the pages, and a test compares.
"""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

SCENARIOS = ROOT / "beamenv" / "scenarios" / "named"
EXAMPLES = ROOT / "examples"
BLADES = EXAMPLES / "blades"


def on_page_markdown(markdown: str, **_: Any) -> str:
    """Put what a page asks for by its comments in their place."""
    for name in FILLED:
        markdown = place_of(name).sub(lambda found: FILLED[found[1]](), markdown)
    return markdown


def written(markdown: str) -> str:
    """The page with what it asks for between the comments, as it is kept."""
    for name in FILLED:
        markdown = place_of(name).sub(lambda found: f"{found[0].splitlines()[0]}\n\n{FILLED[found[1]]()}\n\n{END}", markdown)
    return markdown


def place_of(name: str) -> re.Pattern[str]:
    """From a comment with a name to the end of what was put there."""
    return re.compile(rf"^<!-- ({re.escape(name)}): [^\n]*-->\n.*?^{re.escape(END)}$", flags=re.MULTILINE | re.DOTALL)


def scenario_table() -> str:
    """One row for each file: the comment that it opens with, and what it sets."""
    from train.shared.markdown import markup_table

    rows = []
    for file in sorted(SCENARIOS.glob("*.toml")):
        lines = file.read_text(encoding="utf-8").splitlines()
        opening = [line.removeprefix("#").strip() for line in lines if line.startswith("#")]
        rows.append([f"`{file.stem}`", " ".join(opening), "<br>".join(settings(lines)) or "nothing: the default"])
    return markup_table(["scenario", "what is wrong", "what the file sets"], rows)


def scenario_films() -> str:
    """A moving picture of each scenario, below what its file opens with; first the one with nothing wrong."""
    return "\n\n".join(map(scenario_film, sorted(SCENARIOS.glob("*.toml"), key=lambda file: (file.stem != "nominal", file.stem))))


def scenario_film(file: Path) -> str:
    """One of them, folded but for the first: HTML, which shows alike in a built page and in an unbuilt one."""
    lines = file.read_text(encoding="utf-8").splitlines()
    opening = " ".join(line.removeprefix("#").strip() for line in lines if line.startswith("#"))
    words = f"One episode of {file.stem} without control and under LQG"
    picture = f'<img class="film" loading="lazy" alt="{words}" src="images/scenarios/{file.stem}.svg">'
    state = " open" if file.stem == "nominal" else ""
    head = f'<details class="example" markdown="1"{state}>\n<summary>{file.stem}</summary>'
    return f"{head}\n\n{opening}\n\n{picture}\n\n</details>"


def return_table() -> str:
    """How large rewards are, from ``docs/returns.csv``."""
    from train.shared.markdown import markup_table

    with (ROOT / "docs" / "returns.csv").open(encoding="utf-8") as file:
        rows = [
            [f"`{row['scenario']}`", *(counted(row[key]) for key in ("idle", "idle_low", "idle_high", "lqg"))]
            for row in csv.DictReader(file)
        ]
    heads = ["scenario", "mean return without control", "5 % of episodes are below", "5 % are above", "mean return under LQG"]
    return markup_table(heads, rows, 1)


def counted(number: str) -> str:
    """As a whole number with a minus sign."""
    return f"{float(number):.0f}".replace("-", "−")


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
    "scenario films": scenario_films,
    "returns": return_table,
}
"""What a page asks for by a comment of that name."""
END = "<!-- end -->"


def main() -> None:
    """Write every page again that asks for something."""
    for page in sorted((ROOT / "docs").glob("*.md")):
        text = page.read_text(encoding="utf-8")
        if (full := written(text)) != text:
            page.write_text(full, encoding="utf-8")


if __name__ == "__main__":
    main()
