"""What is refused, in the words of the command line: its options where a sentence has the names of Python's arguments."""

from __future__ import annotations

import re
from collections.abc import Mapping
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any

from beamenv.configuration import shown

OPTIONS: ContextVar[Mapping[str, str]] = ContextVar("OPTIONS", default=MappingProxyType({}))
"""Of the command that runs, by the arguments that they are in Python."""

OTHERWISE = {
    "teacher": "from",
    "seeds": "episodes",
    **{f"{table}.{side}": side for table in ("counts", "sizes") for side in ("actuators", "sensors")},
}
OTHERWISE |= {f"budget.{name}": name for name in ("mass", "channels", "power", "frequency")}
"""Arguments that are called otherwise than the option that they come from."""

_ARGUMENT = re.compile(r"(?:(?<=^)|(?<=: )|(?<=; )|(?<=, so )|(?<=, but )|(?<=, or ))([\w.]+)(?= (?:is|must)\b| = [^(])")
"""Where a sentence, or a part of it, begins with the name of an argument."""


def options_of(command: Any) -> dict[str, str]:
    """The options of a command by the names of its parameters, one that is given several times by their plural too."""
    long = {each.name: max(each.opts, key=len) for each in command.params if each.param_type_name == "option"}
    bare = {option.lstrip("-"): option for option in long.values()}
    also = {other: bare[name] for other, name in OTHERWISE.items() if name in bare}
    return {f"{name}s": option for name, option in long.items()} | also | bare | long


def in_options(sentence: str, options: Mapping[str, str]) -> str:
    """A sentence with options in place of arguments: where it begins with one, and of two words, ``leave_unreached``, anywhere."""
    told = _ARGUMENT.sub(lambda found: options.get(found[1], found[1]), sentence)
    for name, option in options.items():
        if "_" in name:
            told = re.sub(rf"(?<![\w.'-]){name}(?![\w'])", option, told)
    return told


def said(error: ValueError | OSError) -> str:
    """The sentence; of the system's own errors the file and what is wrong with it."""
    if isinstance(error, OSError) and error.strerror:
        return f"file {shown(error.filename)} cannot be used: {error.strerror}."
    return in_options(str(error), OPTIONS.get())
