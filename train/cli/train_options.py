"""The options of ``beamenv train``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from train.learning.recipes import NAMES

AgentsArgument = Annotated[
    list[str], typer.Argument(help=f"Recipe: {', '.join(NAMES)}; or with --recipe any name for the agent. Several may be given.")
]
ScenariosOption = Annotated[
    list[str] | None,
    typer.Option(
        help="Scenario name (see beamenv list scenarios), .toml file, or generalist: all scenarios but those kept for judging. "
        "Repeat for several. Default: nominal."
    ),
]
MinutesOption = Annotated[float | None, typer.Option(help="Minutes of training. The result then depends on the machine's speed.")]
UpdatesOption = Annotated[int | None, typer.Option(help="Number of policy updates. Default, without --minutes: the recipe's.")]
SeedsOption = Annotated[
    list[int] | None, typer.Option(min=0, max=2**63 - 1, help="Random seed of the training; repeat for several. Default: 0.")
]
FolderOption = Annotated[
    Path | None,
    typer.Option(
        help="Folder of the training. Default: results/agents/AGENT-SCENARIO-SEED. For several trainings: the folder above theirs."
    ),
]
RecipeOption = Annotated[Path | None, typer.Option(help="TOML file with a recipe of your own.")]
StartOption = Annotated[
    Path | None,
    typer.Option("--from", help="Folder of a trained policy that is cloned first and then trained on. Of several runs: the best."),
]
LooksOption = Annotated[
    int | None,
    typer.Option(
        min=0,
        max=10_000,
        help="How often the policy is tested without exploration, on validation episodes, for the learning curve; 0 for never. "
        "Default: 12, or fewer if the tests would take more than a tenth of the training time. Recipes that set validation test "
        "by themselves.",
    ),
]
ResumeOption = Annotated[
    bool,
    typer.Option(
        "--resume",
        help="Resume from the checkpoint in the folder. With the same arguments the result is that of an uninterrupted training.",
    ),
]
DeviceOption = Annotated[
    str | None, typer.Option(help="cpu or cuda, for recipes trained through the plant. Default: the recipe's.")
]
