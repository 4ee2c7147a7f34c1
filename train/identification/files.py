"""What an identification leaves in a folder."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from baselines.identification.identified import Identified
from beamenv.configuration.writing import write_whole
from train.identification.figures import draw_figures
from train.identification.report import markdown
from train.identification.trial import Trial
from train.shared.files import write_json

PLANT = "plant.npz"
ENSEMBLE = "ensemble"


def write_all(found: Identified, folder: Path, members: int, seed: int, about: Mapping[str, Any], trial: Trial) -> list[Path]:
    """Write plant, ensemble, report and figures, each whole or not at all; their paths, the plant's first."""
    plant, ensemble = folder / PLANT, folder / ENSEMBLE
    found.save(plant, **about)
    for k, each in enumerate(found.ensemble(members, seed) if members else []):
        found.save(ensemble / f"{k:03d}.npz", each, **about)
    write_json(folder / "report.json", {**found.to_dict(), "lqg": trial.to_dict()})
    write_whole(folder / "report.md", markdown(found, trial))
    figures = draw_figures(found, folder)
    return [plant, *([ensemble] if members else []), folder / "report.json", folder / "report.md", *figures]
