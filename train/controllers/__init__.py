"""A controller by its id: one file each, trained policies, models, and those that ship."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from train.controllers.choice import controller

__all__ = ["controller"]


def __getattr__(name: str) -> Any:
    """Imported when it is first asked for: names are listed without what controllers are made of."""
    if name not in __all__:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from train.controllers.choice import controller

    return controller
