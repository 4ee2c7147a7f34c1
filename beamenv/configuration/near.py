"""What a name that nobody has may have been meant for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from types import MappingProxyType
from typing import Any

LONGEST = 64
"""Characters of a name that is looked for: comparing takes their number squared."""

ALIKE = 0.65
"""Least share of letters in common: of three, two may be swapped; "storm" is not meant for "rotor"."""


def near(name: Any, known: Iterable[Any], titles: Mapping[str, str] = MappingProxyType({})) -> list[str]:
    """Up to three ``known`` names that are like this one, whatever its letters' size, hyphens and underscores.

    ``titles`` are what some of them are called there.
    """
    if not isinstance(name, str) or len(name) > LONGEST:
        return []
    wanted, names = _plain(name), {_plain(each): each for each in known if isinstance(each, str)}
    begun = [each for each in names if wanted and each.startswith(wanted)]
    found = [*get_close_matches(wanted, names, cutoff=ALIKE), *begun]
    alike = sorted(found, key=lambda each: sorted(each) != sorted(wanted))  # those with letters swapped first
    return list(dict.fromkeys(titles.get(names[each], names[each]) for each in alike))[:3]


def meant(name: Any, known: Iterable[Any], titles: Mapping[str, str] = MappingProxyType({})) -> str:
    """What is put behind a name that nobody has: `` (did you mean lqg?)``, and nothing where no ``known`` one is ``near``."""
    *others, last = ["", *near(name, known, titles)]
    return f" (did you mean {' or '.join(part for part in (', '.join(others[1:]), last) if part)}?)" if last else ""


def _plain(name: str) -> str:
    return name.strip().lower().replace("_", "-").replace(" ", "-")
