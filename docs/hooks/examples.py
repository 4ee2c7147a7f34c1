"""Pages of the examples: text, code, and below each cell what it printed and drew when the outputs were last written.

``python docs/hooks/examples.py`` runs the examples and writes ``examples/printed`` and ``docs/images/examples``; names as arguments
run those alone. A test compares what an example prints with what is kept.
"""

from __future__ import annotations

import contextlib
import io
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
PRINTED = EXAMPLES / "printed"
PICTURES = ROOT / "docs" / "images" / "examples"
GREY = "#7f7f7f"
"""Letters and axes of figures: to be read on white and on black."""


def on_files(files: Any, config: Any) -> Any:
    """Every example is a page."""
    from mkdocs.structure.files import File

    for script in sorted(EXAMPLES.glob("[0-9]*.py")):
        files.append(File.generated(config, f"examples/{script.stem}.md", content=example_page(script)))
    return files


def example_page(script: Path) -> str:
    """A script in percent format as Markdown: ``# %% [markdown]`` cells are text, the others code with what they print."""
    parts = [f"*This page is `examples/{script.name}`. To run it, type `python examples/{script.name}`.*"]
    shown = kept(script)
    for place, (is_text, body) in enumerate(cells(script)):
        if is_text:
            parts.insert(len(parts) if len(parts) > 1 else 0, re.sub(r"^# ?", "", body.strip(), flags=re.MULTILINE))
            continue
        parts.append(f"```python\n{body.strip()}\n```")
        if place in shown:
            parts.append(f'```text title="Output"\n{shown[place]}```')
        if (PICTURES / f"{script.stem}-{place}.png").is_file():
            parts.append(f"![What the lines above draw](../images/examples/{script.stem}-{place}.png)")
    return "\n\n".join(parts) + "\n"


def cells(script: Path) -> list[tuple[bool, str]]:
    """(whether it is text, what is in it) of each cell."""
    found = []
    for cell in re.split(r"^# %%", script.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]:
        head, _, body = cell.partition("\n")
        found.append(("[markdown]" in head, body))
    return found


def kept(script: Path) -> dict[int, str]:
    """What each cell printed, by its place in the script, as it was last written; nothing where it never was."""
    file = PRINTED / f"{script.stem}.txt"
    if not file.is_file():
        return {}
    parts = re.split(r"^# %% (\d+)\n", file.read_text(encoding="utf-8"), flags=re.MULTILINE)[1:]
    return {int(place): text for place, text in zip(parts[::2], parts[1::2], strict=True)}


def printed_by(script: Path, draw: Callable[[int], None] = lambda place: None) -> dict[int, str]:
    """Run a script cell by cell: what each printed. After each, ``draw`` may save what it has drawn."""
    namespace: dict[str, Any] = {"__name__": "__main__", "__file__": str(script)}
    shown = {}
    for place, (is_text, body) in enumerate(cells(script)):
        if is_text:
            continue
        with contextlib.redirect_stdout(io.StringIO()) as out:
            exec(compile(body, str(script), "exec"), namespace)
        if out.getvalue():
            shown[place] = out.getvalue()
        draw(place)
    return shown


def write(script: Path) -> None:
    """Run an example and keep what it prints and draws."""
    import matplotlib
    import matplotlib.pyplot as plt

    matplotlib.use("agg")
    names = ("text.color", "axes.labelcolor", "xtick.color", "ytick.color", "axes.edgecolor")
    plt.rcParams.update(dict.fromkeys(names, GREY))
    plt.show = lambda: None

    def save(place: int) -> None:
        if plt.get_fignums():
            PICTURES.mkdir(parents=True, exist_ok=True)
            plt.savefig(PICTURES / f"{script.stem}-{place}.png", dpi=150, transparent=True)
            plt.close("all")

    shown = printed_by(script, save)
    PRINTED.mkdir(exist_ok=True)
    text = "".join(f"# %% {place}\n{printed}" for place, printed in shown.items())
    (PRINTED / f"{script.stem}.txt").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    wanted = sys.argv[1:]
    sys.argv[1:] = []
    sys.path.insert(0, str(ROOT))
    for each in sorted(EXAMPLES.glob("[0-9]*.py")):
        if not wanted or each.stem in wanted:
            write(each)
