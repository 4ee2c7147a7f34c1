"""Arguments made of objects: one of several kinds of object, told apart by a field, and lists of objects."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, get_args

from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from beamenv.configuration.kinds import JsonSchema, Kind, needed
from beamenv.configuration.sentence import an


@dataclass(frozen=True, slots=True, eq=False)
class Variant(Kind):
    """An object of one of several classes; a table in its place says of which by the field ``key``, whose values name them."""

    key: str
    classes: Mapping[str, type[Any]]

    @property
    def allowed(self) -> str:
        """Both forms."""
        return f"a table whose {self.key} is one of {', '.join(self.classes)}, or such an object"

    def core(self) -> CoreSchema:
        """The object itself."""
        return core_schema.union_schema([core_schema.is_instance_schema(each) for each in self.classes.values()])

    def json(self) -> JsonSchema:
        """An object with the key."""
        return {"type": "object", "properties": {self.key: {"enum": list(self.classes)}}, "required": [self.key]}

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        tables = [_whole(name, each, self.key, handler) for name, each in self.classes.items()]
        optional = schema["type"] == "custom-error" and schema["schema"]["type"] == "nullable"
        return {"anyOf": [*tables, {"type": "null"}] if optional else tables}


@dataclass(frozen=True, slots=True, eq=False)
class Variants(Variant):
    """A list of objects, each of one of several classes; tables may stand for them, told apart by ``key``."""

    @property
    def allowed(self) -> str:
        """A list."""
        return f"a list, each of it {Variant.allowed.fget(self)}"  # type: ignore[attr-defined]

    def core(self) -> CoreSchema:
        """A tuple of them."""
        each = core_schema.union_schema([core_schema.is_instance_schema(each) for each in self.classes.values()])
        several = core_schema.tuple_variable_schema(each, strict=True)
        return core_schema.no_info_before_validator_function(_as_tuple, several)

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        tables = [_whole(name, each, self.key, handler) for name, each in self.classes.items()]
        return _listed({"anyOf": tables})


@dataclass(frozen=True, slots=True, eq=False)
class Items(Kind):
    """A list of objects of one class; tables may stand for them."""

    of: type[Any]

    @property
    def allowed(self) -> str:
        """A list."""
        return f"a list, each of it {an(self.of.__name__)} or a table of its fields"

    def core(self) -> CoreSchema:
        """A tuple of them."""
        several = core_schema.tuple_variable_schema(core_schema.is_instance_schema(self.of), strict=True)
        return core_schema.no_info_before_validator_function(_as_tuple, several)

    def json(self) -> JsonSchema:
        """An array of objects."""
        return {"type": "array", "items": {"type": "object"}}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return self.schema(type(None) in get_args(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        return _listed(_items(self.of, handler))


def _whole(name: str, cls: type[Any], key: str, handler: GetJsonSchemaHandler) -> JsonSchema:
    """The table of one class, whose fields without a default are needed, as is the key."""
    # apart from the table itself, of which ``json_schema`` makes every field optional
    return {
        "allOf": [handler(cls.__pydantic_core_schema__), {"required": [key, *needed(cls)]}, {"properties": {key: {"const": name}}}]
    }


def _listed(item: JsonSchema) -> JsonSchema:
    """A list of such items, or one alone."""
    return {"anyOf": [{"type": "array", "items": item}, item]}


def _items(cls: type[Any], handler: GetJsonSchemaHandler) -> JsonSchema:
    return {"allOf": [handler(cls.__pydantic_core_schema__), {"required": needed(cls)}]}


def _as_tuple(value: Any) -> Any:
    return tuple(value) if isinstance(value, list) else value
