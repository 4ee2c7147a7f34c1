"""Figures as PNG."""

from __future__ import annotations

import io
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from train.shared.files import write_whole

STYLE: Mapping[str, Any] = {
    "font.size": 9,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 9,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "savefig.dpi": 160,
}

VOLTAGE_LINES = (("#000000", "-"), ("#0072b2", "-"), ("#d55e00", "--"), ("#7f7f7f", ":"))
"""Colour and dashes of actuators 1 to 4: told apart in greyscale too."""


def save(figure: Any, path: Path) -> None:
    """A PNG, whole or not at all."""
    import matplotlib.pyplot as plt

    picture = io.BytesIO()
    figure.savefig(picture, format="png", bbox_inches="tight")
    plt.close(figure)
    write_whole(path, picture.getvalue())
