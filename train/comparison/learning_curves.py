"""How the shipped agents of Stable-Baselines3 learnt: every training run, without exploration, on validation seeds.

``python -m train.comparison.learning_curves`` writes ``learning.png`` and ``learning-dark.png``, for dark pages, into
``docs/images``, or the folder that is its argument.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.task import resolve_task
from train.controllers.named import named
from train.controllers.shipped import FOLDER as SHELF
from train.controllers.shipped import Shipped, shipped
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import LINES, NEUTRAL, colour
from train.figures.paper import draw_panel, name_ends, save_themes, styled
from train.learning.validation import Validation
from train.shared.curve import read_curve

Array = NDArray[np.float64]

FOLDER = Path("docs/images")
AGENTS = ("ppo", "ppo-belief-idle", "ppo-belief", "sac")
"""Whose runs are drawn, where they ship."""
LOWEST, HIGHEST = 0.9, 2.0
"""Of J over that of LQG: what is above is a blade that shakes itself."""
COLUMNS, WIDTH, HEIGHT = 2, 8.4, 2.1
"""Inches: of the figure, as wide as a page, and of a row."""


def reference_cost(scenario: str) -> float:
    """LQG's J relative to no control on the seeds that ``Validation`` has."""
    task = resolve_task(scenario=scenario)
    controller: Any = named("lqg").build_for(task)
    return Validation([task]).cost(controller)


def learning_panels(runs: Sequence[Shipped]) -> list[Panel]:
    """One for each recipe and scenario, named so: J over LQG's, against control intervals, a curve for each run."""
    panels: list[Panel] = []
    for agent, scenario in sorted({(run.agent, run.scenario) for run in runs}, key=lambda pair: (AGENTS.index(pair[0]), pair[1])):
        own = [run for run in runs if (run.agent, run.scenario) == (agent, scenario)]
        reference = reference_cost(scenario)
        curves = []
        for place, run in enumerate(own):
            seen = read_curve(run.folder)
            look = Look(colour(place), width=1.2)
            curves.append(Curve(seen[:, 1] / 1e6, seen[:, 2] / reference, f"seed {run.seed}", LINES[place % len(LINES)], look))
        end = max(float(curve.x[-1]) for curve in curves)
        level = Curve(np.array([0.0, end]), np.ones(2), "LQG", "solid", Look(NEUTRAL, width=0.8))
        name = "J / J of LQG" if len(panels) % COLUMNS == 0 else ""
        title, x_label, y_limits = f"{agent}, scenario {scenario}", "million control intervals", (LOWEST, HIGHEST)
        panels.append(Panel(title, x_label, name, [level, *curves], x_limits=(0.0, end), y_limits=y_limits))
    return panels


def learning_curves(panels: Sequence[Panel], theme: str = "light") -> Any:
    """The figure."""
    import matplotlib.pyplot as plt

    rows = -(-len(panels) // COLUMNS)
    with styled(theme):
        size = (WIDTH, HEIGHT * rows + 0.3)
        figure, axes = plt.subplots(rows, COLUMNS, figsize=size, layout="constrained", squeeze=False)
        for axis, panel in zip(axes.ravel(), panels, strict=False):
            draw_panel(axis, panel)
        for axis in axes.ravel()[len(panels) :]:
            axis.set_axis_off()
        figure.suptitle("The policy without exploration on validation episodes: lower is better", fontsize=10, x=0.01, ha="left")
        figure.draw_without_rendering()
        for axis, panel in zip(axes.ravel(), panels, strict=False):
            name_ends(axis, panel)
    return figure


def main(arguments: Sequence[str] = ()) -> None:
    """Draw what ships."""
    folder = Path(arguments[0]) if arguments else FOLDER
    panels = learning_panels([run for run in shipped(SHELF) if run.agent in AGENTS])
    save_themes(lambda theme: learning_curves(panels, theme), folder / "learning.png")


if __name__ == "__main__":
    main(sys.argv[1:])
