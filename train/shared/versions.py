"""What a result was computed with."""

from __future__ import annotations

import platform
from importlib import metadata
from pathlib import Path

import beamenv

PACKAGES = ("numpy", "scipy", "gymnasium", "control", "torch", "stable-baselines3", "sb3-contrib", "daqp", "plotly")


def versions() -> dict[str, str]:
    """Of beamenv, Python, system and machine, and those of ``PACKAGES`` that are installed. None of them is imported."""
    own = {
        "beamenv": beamenv.__version__,
        "Python": platform.python_version(),
        "platform": f"{platform.system()} {platform.machine()}",
    }
    return own | {name: version for name in PACKAGES if (version := installed_version(name))}


def machine() -> str:
    """The processor, system and versions that a speed was measured with, in one line."""
    shown = versions()
    return f"{processor()}, {shown['platform']}, Python {shown['Python']}, NumPy {shown['numpy']}"


def processor() -> str:
    """What the processor is called."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
    except OSError:
        lines = []
    named = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(named, platform.processor() or platform.machine())


def installed_version(package: str) -> str:
    """Version of an installed package by its name on the package index; empty if it is not installed."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return ""
