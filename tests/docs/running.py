"""The blocks of a page, run one after the other: all in Python, and those of the shell below which the page shows what is printed.

``python -m tests.docs.running docs/lqg.md`` runs a page and writes below each block what it prints; a test compares the two.
"""

import contextlib
import importlib.util
import io
import os
import re
import sys
import tempfile
import time
from itertools import pairwise
from pathlib import Path

from tests.docs.written import BLOCK, ROOT, blocks, commands, line_of, shown_below

APART = {"torchrl": "torchrl", "ray": "tree", "skrl": "skrl", "stable_baselines3": "stable_baselines3", "minari": "minari"}
"""Libraries of others, and what shows that they can be imported: their blocks run where they are, and in ``make clients``."""


def wanting(text):
    """Libraries of others that a block imports and that are not here."""
    imported = set(re.findall(r"^(?:from|import) (\w+)", text, flags=re.MULTILINE)) | (
        {"ray"} if "beamenv.train.rllib" in text or "ray." in text else set()
    )
    return {name for name in imported & APART.keys() if importlib.util.find_spec(APART[name]) is None}


def outputs(page):
    """(line, what it printed) of each Python block as it ends, and of each shell block whose output the page shows.

    Python blocks whose library is not here, and what builds on them, are left out.
    """
    namespace, left_out = {"__name__": page.stem}, False
    typed = {line for line, _, _ in shown_below(page, "sh")}
    for line, language, text in blocks(page, "python", "sh"):
        if language == "sh" and line in typed:
            yield line, answers(text)
        if language == "sh":
            continue
        left_out = bool(wanting(text)) or (left_out and "algorithm" in text)
        if left_out:
            continue
        with contextlib.redirect_stdout(io.StringIO()) as out:
            exec(compile("\n" * (line - 1) + text, str(page), "exec"), namespace)  # tracebacks tell the page's own lines
        yield line, out.getvalue()


def answers(text):
    """What the commands of a shell block print, one below the other."""
    from typer.testing import CliRunner

    from train.cli.app import app

    printed = []
    for program, *words in commands(text):
        assert program == "beamenv", program
        result = CliRunner().invoke(app, words)
        assert result.exit_code == 0, result.output
        printed.append(result.stdout)
    return "".join(printed)


def write(page):
    """Run a page in a folder of its own and keep what its blocks print, each below its block."""
    titles = {line: title for line, title, _ in shown_below(page, "python", "sh")}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        printed = dict(timed(page))
        os.chdir(ROOT)
    text, parts, end = page.read_text(encoding="utf-8"), [], 0
    for each, following in pairwise([*BLOCK.finditer(text), None]):
        line = line_of(each, text)
        if printed.get(line):
            title = f" {titles[line]}" if titles.get(line) else ""
            lines = "\n".join(row.rstrip() for row in printed[line].rstrip().splitlines())
            parts.append(f"{text[end : each.end()]}\n\n```text{title}\n{lines}\n```")
            end = following.end() if line in titles else each.end()
    page.write_text("".join(parts) + text[end:], encoding="utf-8")


def timed(page):
    """The same, telling the processor time that each block takes."""
    start = time.process_time()
    for line, printed in outputs(page):
        print(f"{page.name}:{line} {time.process_time() - start:.1f} s", file=sys.stderr)
        yield line, printed
        start = time.process_time()


if __name__ == "__main__":
    for page in [Path(name).resolve() for name in sys.argv[1:]]:
        write(page)
