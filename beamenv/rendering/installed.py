"""What is drawn with must be there."""

from __future__ import annotations

from gymnasium.error import DependencyNotInstalled


def check_installed() -> None:
    """Raises DependencyNotInstalled without pygame, which draws, or matplotlib, which lends colour scales and letters."""
    try:
        import matplotlib  # noqa: F401
        import pygame  # noqa: F401
    except ImportError as error:
        raise DependencyNotInstalled(f'{error.name} is not installed, run `pip install "beamenv[render]"`') from error
