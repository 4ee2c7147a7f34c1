"""The options of ``beamenv train``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from train.learning.recipes import NAMES

AgentsArgument = Annotated[
    list[str], typer.Argument(help=f"A recipe: {', '.join(NAMES)}; or the agent of --recipe; several of them.")
]
ScenariosOption = Annotated[
    list[str] | None,
    typer.Option(
        help="A name (see beamenv list scenarios), a .toml file, or generalist: all but those kept for judging; repeat for more. "
        "nominal if left out."
    ),
]
MinutesOption = Annotated[float | None, typer.Option(help="Training time; by the clock, so not reproducible bit for bit.")]
UpdatesOption = Annotated[int | None, typer.Option(help="Updates of the policy; the recipe's if neither is given.")]
SeedsOption = Annotated[
    list[int] | None, typer.Option(min=0, max=2**63 - 1, help="Of the training; repeat for more. 0 if left out.")
]
FolderOption = Annotated[
    Path | None,
    typer.Option(
        help="Where it is written; results/agents/AGENT-SCENARIO-SEED if left out. Of several the folder of such folders."
    ),
]
RecipeOption = Annotated[Path | None, typer.Option(help="A recipe of your own, a TOML file.")]
StartOption = Annotated[
    Path | None, typer.Option("--from", help="Folder of a trained policy to clone first, then to tune; its best run of several.")
]
LooksOption = Annotated[
    int | None,
    typer.Option(
        min=0,
        max=10_000,
        help="At the policy without exploration, on validation episodes, for its learning curve; 0: none. Twelve if left out, or "
        "fewer where they would take more than a tenth of the training's time. Recipes with validation look by themselves.",
    ),
]
ResumeOption = Annotated[
    bool, typer.Option("--resume", help="Resume from the folder's checkpoint, with the same arguments, to the same result.")
]
DeviceOption = Annotated[
    str | None, typer.Option(help="cpu or cuda, of what is trained through the plant; the recipe's if left out.")
]
