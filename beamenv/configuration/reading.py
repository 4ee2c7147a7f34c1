"""Frozen dataclasses whose fields are checked, single arguments that are, and tables that change some fields of them."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, field, fields, is_dataclass
from typing import Any, TypeVar

from pydantic import ConfigDict
from pydantic.dataclasses import dataclass
from pydantic_core import ArgsKwargs, SchemaValidator, ValidationError
from typing_extensions import dataclass_transform

from beamenv.configuration.composite import Items, Variant, Variants
from beamenv.configuration.instead import settled
from beamenv.configuration.kinds import Choice, Kind, Table
from beamenv.configuration.sentence import Refused, an, sentence, unknown_field, unknown_name

T = TypeVar("T")

STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False, arbitrary_types_allowed=True)


@dataclass_transform(frozen_default=True, field_specifiers=(field,))
def configuration(path: str, slots: bool = True, eq: bool = True) -> Callable[[type[T]], type[T]]:
    """Make a class a frozen dataclass whose constructor checks every field, and refuses in one sentence that begins with ``path``.

    Fields are annotated with their kind, ``Annotated[float, Number(gt=0)]``. What ties fields together is checked in
    ``__post_init__``, which raises ``Refused``.
    """

    def checked_class(cls: type[T]) -> type[T]:
        made: Any = dataclass(frozen=True, slots=slots, eq=eq, config=STRICT)(cls)
        given = made.__init__

        @functools.wraps(given)
        def __init__(self: Any, *args: Any, **kwargs: Any) -> None:  # noqa: N807 - it becomes the constructor
            _construct(self, args, settled(made, kwargs, path, usual=True), path)

        __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined] # a nested table needs no constructor of its own
        made.__init__ = __init__
        made._path = path
        return made

    return checked_class


def _construct(instance: Any, args: tuple[Any, ...], values: Mapping[str, Any], path: str) -> None:
    """Fill in an instance; ``ValueError`` of one sentence about ``path`` for what is refused."""
    cls = type(instance)
    try:
        cls.__pydantic_validator__.validate_python(ArgsKwargs(args, dict(values)), self_instance=instance)
    except ValidationError as error:
        raise sentence(error, path, [each.name for each in fields(cls)]) from None


def read(base: T, given: Any, path: str | None = None) -> T:
    """``base`` with the fields changed that a table names; an object of its class takes its place.

    A table within the table changes what stood there field by field, be it a configuration or a named object such as a material.
    Raises ``ValueError`` of one sentence about ``path``.
    """
    cls: Any = type(base)
    path = path or str(cls._path)
    if isinstance(given, cls):
        return given
    if not isinstance(given, Mapping):
        raise Refused(path, given, f"a table of fields or {an(cls.__name__)}")
    values = {each.name: getattr(base, each.name) for each in fields(cls)}
    for name, value in settled(cls, given, path).items():
        if name not in values:
            raise unknown_field(path, name, list(values))
        values[name] = _read_field(cls, name, values[name], value, f"{path}.{name}")
    instance: T = object.__new__(cls)
    _construct(instance, (), values, path)
    return instance


def made(cls: type[T], given: Any, path: str) -> T:
    """An object of a class from a table of its fields, which may leave out those with a default; ``ValueError`` as ``read``."""
    if isinstance(given, cls):
        return given
    if not isinstance(given, Mapping):
        raise Refused(path, given, f"a table of fields or {an(cls.__name__)}")
    known = [each.name for each in fields(cls)]  # type: ignore[arg-type]
    for name in given:
        if name not in known:
            raise unknown_field(path, name, known)
    usual = {each.name: each.default for each in fields(cls) if each.default is not MISSING}  # type: ignore[arg-type]
    values = {name: _read_field(cls, name, usual.get(name), value, f"{path}.{name}") for name, value in given.items()}
    instance: T = object.__new__(cls)
    _construct(instance, (), values, path)
    return instance


def _read_field(cls: Any, name: str, before: Any, value: Any, path: str) -> Any:
    """What a field is to be, given a value or a table in its place."""
    kind = next((kind for kind in cls.__pydantic_fields__[name].metadata if isinstance(kind, (Variant, Items))), None)
    if isinstance(kind, (Items, Variants)):
        return _items(kind, value, path)
    if isinstance(kind, Variant):
        return _variant(kind, before, value, path) if isinstance(value, Mapping) else value
    choice, stood = _choice(cls, name), _stood(cls, name, before)
    if choice is not None and isinstance(value, Mapping) and (other := _told_by(choice, stood, value)):
        return made(other, value, path)
    table = isinstance(value, Mapping) or choice is None
    return read(stood, value, path) if table and is_dataclass(stood) else value


def _told_by(choice: Choice, stood: Any, table: Mapping[str, Any]) -> type[Any] | None:
    """The class that a table of fields is of, where that is not the one of what stood there: of most of its fields."""
    of_it = len(_fields_of(type(stood), table)) if isinstance(stood, choice.classes) else -1
    others = [each for each in choice.classes if not isinstance(stood, each)]
    likest = max(others, key=lambda each: len(_fields_of(each, table)), default=None)
    return likest if likest is not None and len(_fields_of(likest, table)) > of_it else None


def _fields_of(cls: type[Any], table: Mapping[str, Any]) -> set[str]:
    return {each.name for each in fields(cls)} & set(table)


def _items(kind: Items | Variants, value: Any, path: str) -> Any:
    """A list with objects in place of tables; one table is a list of it."""
    listed = [value] if isinstance(value, Mapping) else value
    if not isinstance(listed, (list, tuple)) or not any(isinstance(each, Mapping) for each in listed):
        return value
    return [_item(kind, each, f"{path}[{k}]") for k, each in enumerate(listed)]


def _item(kind: Items | Variants, value: Any, path: str) -> Any:
    if isinstance(kind, Items):
        return made(kind.of, value, path)
    return _variant(kind, None, value, path) if isinstance(value, Mapping) else value


def _variant(kind: Variant, before: Any, table: Mapping[str, Any], path: str) -> Any:
    """An object of the class that a table's key names; one that stood there completes it if it is of that class."""
    name = table.get(kind.key, getattr(before, kind.key, None))
    if not isinstance(name, str) or name not in kind.classes:
        raise unknown_name(f"{path}.{kind.key}", name, kind.classes)
    cls = kind.classes[name]
    return read(before, table, path) if isinstance(before, cls) else made(cls, table, path)


def _stood(cls: Any, name: str, value: Any) -> Any:
    """What a table given for a field completes from: the field's value, or the object that it names."""
    choice = _choice(cls, name)
    named = choice is not None and isinstance(choice.names, Mapping) and isinstance(value, str)
    return choice.names[value] if named else value  # type: ignore[union-attr]


def _choice(cls: Any, name: str) -> Choice | None:
    return next((kind for kind in cls.__pydantic_fields__[name].metadata if isinstance(kind, Choice)), None)


def checked_table(name: str, value: Any, known: Sequence[str]) -> dict[str, Any]:
    """A single argument that is a table with keys among those known, copied; ``ValueError`` of one sentence about ``name``."""
    table: dict[str, Any] = checked(name, value, Table())
    for key in table:
        if key not in known:
            raise unknown_field(name, key, known)
    return table


def checked(name: str, value: Any, kind: Kind) -> Any:
    """A single argument as its kind has it; ``ValueError`` of one sentence about ``name``."""
    try:
        return _validator(kind).validate_python(value)
    except ValidationError as error:
        raise sentence(error, name, ()) from None


@functools.lru_cache(maxsize=256)
def _validator(kind: Kind) -> SchemaValidator:
    return SchemaValidator(kind.schema())
