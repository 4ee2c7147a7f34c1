"""What a name that nobody has may have been meant for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from types import MappingProxyType
from typing import Any

LONGEST = 64
"""Characters of a name that is looked for: comparing takes their number squared."""


def near(name: Any, known: Iterable[str], titles: Mapping[str, str] = MappingProxyType({})) -> str:
    """The end of a sentence that tells up to three ``known`` names like this one, whatever its letters' size; empty without any.

    ``titles`` are what some of them are called there.
    """
    if not isinstance(name, str) or len(name) > LONGEST:
        return ""
    plain, names = name.strip().lower().replace("_", "-").replace(" ", "-"), list(dict.fromkeys(known))
    begun = [each for each in names if plain and each.startswith(plain)]
    found = list(dict.fromkeys(titles.get(each, each) for each in [*get_close_matches(plain, names), *begun]))[:3]
    return f"; near it {'is' if len(found) == 1 else 'are'} {', '.join(found)}" if found else ""
