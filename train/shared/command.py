"""The command that this process is."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path

NAME = "beamenv"


def command_line() -> str:
    """As it was typed; empty where the process is another one than ``beamenv``, such as a notebook."""
    return shlex.join([NAME, *sys.argv[1:]]) if Path(sys.argv[0]).stem == NAME else ""
