"""What a result was computed with."""

from __future__ import annotations

import platform
from importlib import metadata
from importlib.util import find_spec

import plotly.offline

import beamenv

PACKAGES = ("numpy", "scipy", "gymnasium", "control", "torch", "stable-baselines3", "plotly")


def versions() -> dict[str, str]:
    """beamenv, Python, system and machine, and those of the packages that are installed."""
    own = {
        "beamenv": beamenv.__version__,
        "Python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }
    installed = {name: metadata.version(name) for name in PACKAGES if find_spec(name.replace("-", "_"))}
    return {**own, **installed, "plotly.js": plotly.offline.get_plotlyjs_version()}
