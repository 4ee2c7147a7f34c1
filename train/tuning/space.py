"""What a tuning tries: ranges, factors and choices for settings of a recipe, and recipes drawn from them."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from beamenv.configuration import Range, Refused, checked, checked_table, configuration, read, shown
from beamenv.configuration.files import of_file, parsed_table, read_table
from beamenv.configuration.reading import made
from train.learning import spaces
from train.learning.recipe import AGENT, Recipe

KEYS = ("agent", "settings")

PACE = ("blades", "episodes", "runs", "window", "last_window", "last_share", "held", "rollout", "first", "device", "validation")
"""Settings that say how much experience an update has, or how often a policy is looked at: all trials have the same."""

DRAWS = 1000
"""Of settings that may turn out not to go together."""

Value = bool | int | float | str


@configuration("tried")
class Tried:
    """What is tried of one setting: just one of three."""

    between: Annotated[tuple[float, float] | None, Range()] = None
    """A range, each value in it as likely."""
    times: Annotated[tuple[float, float] | None, Range(ge=1e-6, le=1e6)] = None
    """Factors on the recipe's own value, each order of magnitude as likely."""
    choices: Any = None
    """A list of values, each as likely."""

    def __post_init__(self) -> None:
        if sum(each is not None for each in (self.between, self.times, self.choices)) != 1:
            raise Refused("between", self.between, "given, or times or choices, and just one of these")
        if self.choices is not None and not (isinstance(self.choices, list | tuple) and self.choices):
            raise Refused("choices", self.choices, "a list of one or more values")

    def drawn(self, own: Value, generator: np.random.Generator) -> Value:
        """A value, in the place of the recipe's ``own``; whole if that is."""
        if self.choices is not None:
            chosen: Value = self.choices[int(generator.integers(len(self.choices)))]
            return chosen
        if self.times is not None:
            low, high = self.times
            value = float(own) * math.exp(generator.uniform(math.log(low), math.log(high)))
        else:
            assert self.between is not None
            value = generator.uniform(*self.between)
        return round(value) if isinstance(own, int) else value

    def values(self) -> tuple[Value, ...]:
        """All choices, or the ends of a range."""
        return tuple(self.choices or self.between or ())


@dataclass(frozen=True, slots=True)
class Space:
    """What is tried of the settings of one trainer."""

    agent: str
    tried: Mapping[str, Tried]
    """By the setting's name, with a point before that of a setting within a table of settings."""

    def to_dict(self) -> dict[str, Any]:
        """As JSON has it."""
        table: dict[str, Any] = json.loads(json.dumps({name: asdict(each) for name, each in self.tried.items()}))
        return {"agent": self.agent, "settings": table}


def space_of(recipe: Recipe, path: Path | None = None) -> Space:
    """What is tried of a recipe: by a TOML or JSON file, or what ships for its trainer.

    ``ValueError`` names the file and what is wrong in it: an unknown setting, one of ``PACE``, a value that it cannot have.
    """
    if path is not None:
        return _space(read_table(path), str(path), recipe)
    file = files(spaces).joinpath(f"{recipe.agent}.toml")
    return _space(parsed_table(file.read_text(encoding="utf-8"), file.name), file.name, recipe)


def _space(content: dict[str, Any], source: str, recipe: Recipe) -> Space:
    with of_file(source):
        table = checked_table("space", content, KEYS)
        if missing := [key for key in KEYS if key not in table]:
            raise ValueError(f"space.{missing[0]} is missing: a space has {', '.join(KEYS)}.")
        agent = checked("space.agent", table["agent"], AGENT)
        if agent != recipe.agent:
            raise Refused("space.agent", agent, f"{recipe.agent!r}, as the recipe's")
        tried = dict(_read(table["settings"], recipe.settings, "space.settings"))
        if not tried:
            raise Refused("space.settings", {}, "a table of one setting or more")
        _check(tried, recipe.settings)
        return Space(agent, tried)


def _read(given: Any, settings: Any, path: str, before: str = "") -> Iterator[tuple[str, Tried]]:
    """Names and what is tried, tables of settings within the settings included."""
    own = asdict(settings)
    for name, each in checked_table(path, given, tuple(own)).items():
        if name in PACE:
            raise ValueError(f"{path}.{name} cannot be tried: an update has the same experience in all trials.")
        if isinstance(own[name], dict):
            yield from _read(each, getattr(settings, name), f"{path}.{name}", f"{before}{name}.")
        else:
            yield before + name, made(Tried, each, f"{path}.{name}")


def _check(tried: Mapping[str, Tried], settings: Any) -> None:
    """``ValueError`` for a value that the settings cannot have where the others are the recipe's."""
    for name, each in tried.items():
        own = value_of(settings, name)
        if each.choices is None and (isinstance(own, bool) or not isinstance(own, int | float)):
            raise ValueError(f"space.settings.{name} must have choices: the recipe's value is {shown(own)}, no number.")
        if each.times is not None and not own:
            raise ValueError(
                f"space.settings.{name} must have a range or choices, not factors: the recipe's value is {shown(own)}."
            )
        for value in each.values():
            read(settings, nested({name: value}), "space.settings")


def value_of(settings: Any, name: str) -> Any:
    """The value of a setting by its name, which may have points in it."""
    for part in name.split("."):
        settings = getattr(settings, part)
    return settings


def nested(values: Mapping[str, Any]) -> dict[str, Any]:
    """Tables within tables, of names with points in them."""
    table: dict[str, Any] = {}
    for name, value in values.items():
        *parts, last = name.split(".")
        place = table
        for part in parts:
            place = place.setdefault(part, {})
        place[last] = value
    return table


def drawn(recipe: Recipe, space: Space, seed: int, trial: int) -> Recipe:
    """The recipe of a trial: the first, 0, has the recipe as it is. Trials do not depend on how many there are.

    ``ValueError`` if settings drawn never go together.
    """
    if trial == 0:
        return recipe
    generator, refused = np.random.default_rng((seed, trial)), ""
    for _ in range(DRAWS):
        values = {name: each.drawn(value_of(recipe.settings, name), generator) for name, each in space.tried.items()}
        try:
            return replace(recipe, settings=read(recipe.settings, nested(values), "settings"))
        except ValueError as error:
            refused = str(error)
    raise ValueError(f"space must leave settings that go together, but none of {DRAWS} draws did: {refused}")
