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
        help=f"Name (see beamenv list scenarios) or TOML file of a scenario, or {', '.join(GROUPS)} of them; repeat for more. "
        "All if left out."
    ),
]
ControllersOption = Annotated[
    list[str] | None,
    typer.Option(
        help="Id of a controller or of an agent that ships (see beamenv list), or a trained one's folder; repeat for more. "
        "All with an id if left out."
    ),
]
EpisodesOption = Annotated[int | None, typer.Option(min=2, help=f"How many held-out episodes; {SEEDS} if left out.")]
RunsOption = Annotated[
    int | None, typer.Option(min=1, help="How many training runs of each agent, the first ones; all of them if left out.")
]
FolderOption = Annotated[
    Path | None,
    typer.Option(help="Where cells, tables, heat map and page are written; results/benchmark, or …-WHAT IS CHOSEN, if left out."),
]
ModelsOption = Annotated[
    list[Path] | None,
    typer.Option(help="Stable-Baselines3 model to take part. Such a file can run code when it is loaded: see --trust."),
]
TrustOption = Annotated[bool, typer.Option("--trust", help="Load model files: I know where they are from.")]
QuickOption = Annotated[
    bool, typer.Option("--quick", help=f"Less than a minute on two cores: {told()}. What else is given comes first.")
]
SubmitOption = Annotated[
    str | None,
    typer.Option(
        help="Enter a trained agent's folder, a model's .zip or a controller by its id on the leaderboard, once it has been run "
        "in every scenario."
    ),
]
TierOption = Annotated[int | None, typer.Option(help="Of the entry: 0, 1 or 2; what it says of itself, or 1, if left out.")]
DocsOption = Annotated[
    Path | None,
    typer.Option(help="Folder that gets benchmark.md and its heat map; with --submit that of the leaderboard, else results."),
]
