"""``python -m train.probing``: probe the memory of a recurrent agent that ships, and write the table; two minutes."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from beamenv.configuration import checked
from train.probing.table import FILE, measured, write_rows
from train.shared.held_out import SEEDS, validation


def main(arguments: Sequence[str]) -> int:
    """Measure and write; 2 for an argument that is refused, in one sentence."""
    parser = argparse.ArgumentParser(prog="python -m train.probing", description=__doc__)
    parser.add_argument("--episodes", type=float, default=128, help="of each question, on validation seeds")
    parser.add_argument("--to", type=Path, default=FILE, help="the table that is written")
    given = parser.parse_args(arguments)
    try:
        write_rows(given.to, measured(validation(checked("--episodes", given.episodes, SEEDS)), _say))
    except (ValueError, OSError) as error:
        sys.stderr.write(f"{error}\n")
        return 2
    return 0


def _say(line: str) -> None:
    sys.stderr.write(f"{line}\n")
    sys.stderr.flush()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
