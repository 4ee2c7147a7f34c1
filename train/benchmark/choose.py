"""Choose who stands for agents and for laws in the benchmark, on validation seeds: ``python -m train.benchmark.choose``."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from train.benchmark.campaign import benchmark
from train.benchmark.choice import FILE, SCENARIOS, Choice, choose, write_choice


def main(arguments: Sequence[str] | None = None) -> Choice:
    """Measure every controller and agent where contenders may be chosen, and write who is chosen."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--episodes", type=int, default=64, help="how many validation episodes")
    parser.add_argument("--jobs", type=int, default=2, help="processes at work side by side")
    parser.add_argument("--folder", type=Path, default=Path("results/validation"), help="where cells are kept")
    parser.add_argument("--scenario", action="append", choices=SCENARIOS, help="repeat for more; all if left out")
    parser.add_argument("--controller", action="append", help="repeat for more; all if left out")
    parser.add_argument("--to", type=Path, default=FILE, help="the file of who is chosen")
    given = parser.parse_args(arguments)
    table = benchmark(
        scenarios=given.scenario or SCENARIOS,
        controllers=given.controller,
        seeds=given.episodes,
        folder=given.folder,
        jobs=given.jobs,
        validation=True,
    )
    choice = choose(table)
    write_choice(given.to, choice)
    return choice


if __name__ == "__main__":
    main()
