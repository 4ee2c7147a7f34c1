"""JSON schemas of configurations, for editors: they complete the names of fields and mark a value that is refused."""

from __future__ import annotations

import ast
import inspect
from dataclasses import fields, is_dataclass
from typing import Any, get_args, get_type_hints

from pydantic import TypeAdapter

from beamenv.configuration.files import SCHEMA

DIALECT = "https://json-schema.org/draft/2020-12/schema"


def json_schema(cls: type[Any], further: dict[str, Any] | None = None) -> dict[str, Any]:
    """The schema (draft 2020-12) of a table of a configuration's fields, every one of them optional.

    Fields are described by the lines under them in the source. ``further`` are properties that files may have besides.
    """
    schema = TypeAdapter(cls).json_schema()
    described = {each.__name__: _described_fields(each) for each in _tables(cls)}
    for table in _objects(schema):
        table.pop("required", None)  # what is left out stays as it stood
        for name, entry in table.get("properties", {}).items():
            if text := described.get(table.get("title", ""), {}).get(name):
                entry["description"] = text
            entry.pop("title", None)
    schema["properties"] = {SCHEMA: {"type": "string"}, **(further or {}), **schema["properties"]}
    return {SCHEMA: DIALECT, **schema}


def _tables(cls: type[Any]) -> list[type[Any]]:
    """The configuration and those in its fields."""
    within = [kind for hint in get_type_hints(cls).values() for kind in (hint, *get_args(hint)) if is_dataclass(kind)]
    return [cls, *(table for kind in within if isinstance(kind, type) for table in _tables(kind))]


def _objects(schema: Any) -> list[dict[str, Any]]:
    """The tables of a schema, those within others too."""
    if isinstance(schema, list):
        return [table for each in schema for table in _objects(each)]
    if not isinstance(schema, dict):
        return []
    own = [schema] if "properties" in schema else []
    return own + [table for each in schema.values() for table in _objects(each)]


def _described_fields(cls: type[Any]) -> dict[str, str]:
    """Of each field the line under it."""
    body = ast.parse(inspect.cleandoc("\n" + inspect.getsource(cls))).body[0].body  # type: ignore[attr-defined]
    names = {each.name for each in fields(cls)}
    found = {}
    for field, line in zip(body[:-1], body[1:], strict=True):
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name) and field.target.id in names:
            text = line.value.value if isinstance(line, ast.Expr) and isinstance(line.value, ast.Constant) else None
            if isinstance(text, str):
                found[field.target.id] = " ".join(text.split())
    return found
