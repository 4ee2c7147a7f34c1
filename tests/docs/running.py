"""The Python blocks of a page, run one after the other.

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

from tests.docs.written import BLOCK, ROOT, blocks, line_of, shown_below

APART = {"torchrl": "torchrl", "ray": "tree", "skrl": "skrl", "stable_baselines3": "stable_baselines3", "minari": "minari"}
"""Libraries of others, and what shows that they can be imported: their blocks run where they are, and in ``make clients``."""


def wanting(text):
    """Libraries of others that a block imports and that are not here."""
    imported = set(re.findall(r"^(?:from|import) (\w+)", text, flags=re.MULTILINE)) | (
        {"ray"} if "beamenv.train.rllib" in text or "ray." in text else set()
    )
    return {name for name in imported & APART.keys() if importlib.util.find_spec(APART[name]) is None}


def outputs(page):
    """(line, what it printed) of each block as it ends; blocks whose library is not here, and what builds on them, are left out."""
    namespace, left_out = {"__name__": page.stem}, False
    for line, _, text in blocks(page, "python"):
        left_out = bool(wanting(text)) or (left_out and "algorithm" in text)
        if left_out:
            continue
        with contextlib.redirect_stdout(io.StringIO()) as out:
            exec(compile("\n" * (line - 1) + text, str(page), "exec"), namespace)  # tracebacks tell the page's own lines
        yield line, out.getvalue()


def write(page):
    """Run a page in a folder of its own and keep what its blocks print, each below its block."""
    titles = {line: title for line, title, _ in shown_below(page, "python")}
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        printed = dict(timed(page))
        os.chdir(ROOT)
    text, parts, end = page.read_text(encoding="utf-8"), [], 0
    for each, following in pairwise([*BLOCK.finditer(text), None]):
        line = line_of(each, text)
        if printed.get(line):
            title = f" {titles[line]}" if titles.get(line) else ""
            parts.append(f"{text[end : each.end()]}\n\n```text{title}\n{printed[line].rstrip()}\n```")
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
