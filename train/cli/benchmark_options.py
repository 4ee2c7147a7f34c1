"""The options of ``beamenv benchmark``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from beamenv.scenarios.named import GROUPS
from train.cli.quick import told

SEEDS = 128

ScenariosOption = Annotated[
    list[str] | None,
    typer.Option(
        help=f"Scenario name (see beamenv list scenarios), TOML file, or a group: {', '.join(GROUPS)}. Repeat for several. "
        "Default: all."
    ),
]
ControllersOption = Annotated[
    list[str] | None,
    typer.Option(
        help="Id of a controller or of a shipped agent (see beamenv list), or the folder of a trained agent. Repeat for several. "
        "Default: all that have an id."
    ),
]
EpisodesOption = Annotated[int | None, typer.Option(min=2, help=f"Number of held-out episodes. Default: {SEEDS}.")]
RunsOption = Annotated[
    int | None, typer.Option(min=1, help="Number of training runs of each agent, from the first on. Default: all.")
]
FolderOption = Annotated[
    Path | None,
    typer.Option(
        help="Folder for cells, tables, heat map and page. Default: results/benchmark, with the names of what you choose appended."
    ),
]
ModelsOption = Annotated[
    list[Path] | None,
    typer.Option(help="File of a Stable-Baselines3 model that takes part. Loading such a file can run code: see --trust."),
]
TrustOption = Annotated[bool, typer.Option("--trust", help="Load the model files: you know where they come from.")]
QuickOption = Annotated[
    bool, typer.Option("--quick", help=f"About a minute on two cores: {told()}. Other options override these choices.")
]
SubmitOption = Annotated[
    str | None,
    typer.Option(
        help="Run a trained agent (its folder), a model (.zip) or a controller (its id) in every scenario, and enter it on the "
        "leaderboard."
    ),
]
TierOption = Annotated[int | None, typer.Option(help="Tier of the entry: 0, 1 or 2. Default: what it says of itself, or else 1.")]
DocsOption = Annotated[
    Path | None,
    typer.Option(
        help="Folder that gets benchmark.md and its heat map. With --submit: folder of the leaderboard (default: results)."
    ),
]
