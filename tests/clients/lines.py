"""The lines of the page "Your library in five lines" that are of one library, run by themselves."""

import subprocess
import sys
from pathlib import Path

from tests.docs.written import blocks

PAGE = Path(__file__).parents[2] / "docs" / "libraries.md"
BEFORE = "import gymnasium as gym\nimport beamenv\nfrom beamenv.baselines import evaluate\n"
"""What earlier lines of the page have imported."""


def assert_lines_run(heading, folder):
    """All Python blocks below a heading of the page, in one process."""
    texts = PAGE.read_text(encoding="utf-8").splitlines()
    starts = [line for line, text in enumerate(texts, 1) if text.startswith("## ")]
    begin = next(line for line in starts if texts[line - 1] == f"## {heading}")
    end = min((line for line in starts if line > begin), default=len(texts) + 1)
    code = BEFORE + "\n".join(text for line, _, text in blocks(PAGE, "python") if begin < line < end)
    done = subprocess.run([sys.executable, "-c", code], cwd=folder, capture_output=True, text=True, timeout=500)
    assert done.returncode == 0, done.stderr
