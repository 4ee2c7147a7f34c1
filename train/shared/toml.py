"""Tables as the text of a TOML file."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def as_toml(table: Mapping[str, Any], says: str = "") -> str:
    """A table of strings, numbers, booleans, lists and tables as a file; what it ``says`` is a comment at its head.

    TOML has no word for None: such fields are left out.
    """
    comment = [f"# {line}" for line in says.splitlines()]
    return "\n".join([*comment, *_body("", table), ""])


def _body(name: str, table: Mapping[str, Any]) -> Iterator[str]:
    """The lines of a table, and after them those of tables within it."""
    inner = {key: value for key, value in table.items() if isinstance(value, Mapping)}
    yield from (f"{_key(key)} = {_value(value)}" for key, value in table.items() if key not in inner and value is not None)
    for key, value in inner.items():
        path = f"{name}.{_key(key)}" if name else _key(key)
        yield from ("", f"[{path}]", *_body(path, value))


def _key(key: str) -> str:
    return key if _BARE.fullmatch(key) else json.dumps(key)


def _value(value: Any) -> str:
    """TOML's strings and booleans are JSON's, and its numbers Python's."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(each)}" for key, each in value.items() if each is not None) + " }"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_value, value))}]"
    return repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False)
