"""Keyword arguments that a constructor does not have."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from beamenv.configuration.near import meant
from beamenv.configuration.sentence import shown

P = ParamSpec("P")
R = TypeVar("R")


class UnknownKeyword(ValueError, TypeError):
    """As of any other value that is not allowed, and as of Python's own: libraries try keywords, and go by the ``TypeError``."""


def known_keywords(path: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Make a constructor refuse keywords that it does not have in one sentence about ``path``, with those that are like them.

    Python itself would raise a ``TypeError``, which ``gymnasium.make`` repeats with all that it was given.
    """

    def checking(constructor: Callable[P, R]) -> Callable[P, R]:
        names = [name for name in inspect.signature(constructor).parameters if name != "self"]

        @functools.wraps(constructor)
        def checked(*args: P.args, **kwargs: P.kwargs) -> R:
            if wrong := [name for name in kwargs if name not in names]:
                near = meant(wrong[0], names)
                told = f"{path} got an unexpected keyword argument {shown(wrong[0])}{near}: its arguments are {', '.join(names)}."
                raise UnknownKeyword(told)
            return constructor(*args, **kwargs)

        return checked

    return checking
