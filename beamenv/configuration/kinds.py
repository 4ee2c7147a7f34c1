"""What an argument may be: annotations of fields that say it once, for validation, for the sentence and for the schema.

Here is what they have in common, and those of flags, names and tables; ``numbers`` has those of numbers.
"""

from __future__ import annotations

import os
import re
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, dataclass, fields
from typing import Any, get_args

import numpy as np
from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
from pydantic_core import CoreSchema, core_schema

from beamenv.configuration.sentence import METRES, NAMES, an

JsonSchema = dict[str, Any]


def plain(value: Any) -> Any:
    """NumPy's scalars and arrays, and lists, as Python's numbers and tuples; anything else as it is."""
    if isinstance(value, np.ndarray):
        value = value.tolist()
    elif isinstance(value, np.floating):
        value = float(value)
    elif isinstance(value, np.generic):
        value = value.item()
    return tuple(map(plain, value)) if isinstance(value, (list, tuple)) else value


def whole(value: Any) -> Any:
    """As ``plain``, and a float without a fraction as an integer."""
    value = plain(value)
    return int(value) if isinstance(value, float) and value.is_integer() else value


def wholes(value: Any) -> Any:
    """As ``whole``, each of a sequence."""
    value = plain(value)
    return tuple(map(whole, value)) if isinstance(value, tuple) else value


class Kind(ABC):
    """What a value may be: ``Annotated[float, Number(gt=0)]``; None too where the type allows it."""

    @property
    @abstractmethod
    def allowed(self) -> str:
        """What completes "but must be"."""

    @abstractmethod
    def core(self) -> CoreSchema:
        """The validation."""

    @abstractmethod
    def json(self) -> JsonSchema:
        """The same, for an editor."""

    def schema(self, optional: bool = False) -> CoreSchema:
        """The validation with one sentence for all that it refuses."""
        inner = core_schema.nullable_schema(self.core()) if optional else self.core()
        allowed = f"None or {self.allowed}" if optional else self.allowed
        most = getattr(self, "le", None) if getattr(self, "unit", "") == "m" else None
        context = {NAMES: list(getattr(self, "names", ())), METRES: most}
        return core_schema.custom_error_schema(inner, "allowed", custom_error_message=allowed, custom_error_context=context)

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return self.schema(type(None) in get_args(source))

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        optional = schema["type"] == "custom-error" and schema["schema"]["type"] == "nullable"
        return {"anyOf": [self.json(), {"type": "null"}]} if optional else self.json()


@dataclass(frozen=True, slots=True)
class Flag(Kind):
    """True or false."""

    @property
    def allowed(self) -> str:
        """True or False."""
        return "True or False"

    def core(self) -> CoreSchema:
        """A bool."""
        return core_schema.no_info_before_validator_function(plain, core_schema.bool_schema(strict=True))

    def json(self) -> JsonSchema:
        """A boolean."""
        return {"type": "boolean"}


@dataclass(frozen=True, slots=True)
class Text(Kind):
    """Any text; with ``line``, one that a table or a legend can show: not blank, and on one line."""

    line: bool = False

    @property
    def allowed(self) -> str:
        """Text."""
        return "a string that is not blank, on one line" if self.line else "a string"

    def core(self) -> CoreSchema:
        """A string."""
        text = core_schema.str_schema(strict=True)
        return core_schema.no_info_after_validator_function(_on_one_line, text) if self.line else text

    def json(self) -> JsonSchema:
        """A string."""
        return {"type": "string"}


@dataclass(frozen=True, slots=True)
class FileName(Kind):
    """A name that becomes that of a file or folder, the same on every system: never a path, nor an option."""

    @property
    def allowed(self) -> str:
        """What they may be made of."""
        return (
            "names that files can have, of at most 100 characters: a letter, a digit or _ first, no slash, no colon and none of "
            '\\*?"<>|, no line break, and no dot or space last'
        )

    def core(self) -> CoreSchema:
        """A string."""
        return core_schema.no_info_after_validator_function(_for_a_file, core_schema.str_schema(strict=True, max_length=100))

    def json(self) -> JsonSchema:
        """A string."""
        return {"type": "string", "maxLength": 100}


@dataclass(frozen=True, slots=True, eq=False)
class Choice(Kind):
    """One of several names; where they are those of a mapping's objects, a table in its place departs from the object named.

    ``own`` is the class of objects that may be given instead of a name, or several: a table with fields that the object named does
    not have is of the class that has them. ``least`` is what an editor is told of the first one's fields here: the least values,
    which the table that has the field sees to.
    """

    names: Sequence[str] | Mapping[str, Any]
    own: type[Any] | tuple[type[Any], ...] = ()
    least: Mapping[str, float] | None = None

    @property
    def classes(self) -> tuple[type[Any], ...]:
        """Of objects that may be given."""
        return self.own if isinstance(self.own, tuple) else (self.own,)

    @property
    def allowed(self) -> str:
        """The names."""
        return f"one of {', '.join(self.names)}" + "".join(f", or {an(each.__name__)}" for each in self.classes)

    def core(self) -> CoreSchema:
        """A string, or an object."""
        name = core_schema.literal_schema(list(self.names))
        return core_schema.union_schema([*map(core_schema.is_instance_schema, self.classes), name]) if self.classes else name

    def json(self) -> JsonSchema:
        """An enumeration."""
        return {"enum": list(self.names)}

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> JsonSchema:
        if not self.classes:
            return Kind.__get_pydantic_json_schema__(self, schema, handler)
        first, *others = (handler(each.__pydantic_core_schema__) for each in self.classes)
        others = [{"allOf": [other, {"required": needed(each)}]} for other, each in zip(others, self.classes[1:], strict=True)]
        if self.least:
            first = {"allOf": [first, {"properties": {name: {"minimum": value} for name, value in self.least.items()}}]}
        return {"anyOf": [self.json(), first, *others]}


@dataclass(frozen=True, slots=True)
class Instance(Kind):
    """An object of a class."""

    of: type[Any]

    @property
    def allowed(self) -> str:
        """Its name."""
        return an(self.of.__name__)

    def core(self) -> CoreSchema:
        """The object itself."""
        return core_schema.is_instance_schema(self.of)

    def json(self) -> JsonSchema:
        """Nothing that a file can hold."""
        return {"not": {}}


@dataclass(frozen=True, slots=True)
class NameOrFile(Kind):
    """One of several names, or the path of a file with a certain ending; kept as a string."""

    names: tuple[str, ...]
    ending: str

    @property
    def allowed(self) -> str:
        """Both."""
        return f"one of {', '.join(self.names)}, or the path of a {self.ending} file"

    def core(self) -> CoreSchema:
        """A string."""
        return core_schema.no_info_before_validator_function(
            _as_text, core_schema.no_info_after_validator_function(self._known, core_schema.str_schema(strict=True))
        )

    def json(self) -> JsonSchema:
        """A string."""
        return {"anyOf": [{"enum": list(self.names)}, {"type": "string", "pattern": f"{re.escape(self.ending)}$"}]}

    def _known(self, value: str) -> str:
        if value not in self.names and not value.lower().endswith(self.ending):
            raise ValueError
        return value


@dataclass(frozen=True, slots=True)
class Texts(Kind):
    """A sequence of strings; paths are taken for their names."""

    @property
    def allowed(self) -> str:
        """A list of them."""
        return "a list of strings"

    def core(self) -> CoreSchema:
        """A tuple of strings."""
        texts = core_schema.tuple_variable_schema(core_schema.str_schema(strict=True), strict=True)
        return core_schema.no_info_before_validator_function(_as_texts, texts)

    def json(self) -> JsonSchema:
        """An array."""
        return {"type": "array", "items": {"type": "string"}}


@dataclass(frozen=True, slots=True)
class Table(Kind):
    """A mapping of names to anything."""

    @property
    def allowed(self) -> str:
        """A mapping."""
        return "a mapping of names to values"

    def core(self) -> CoreSchema:
        """A dictionary with strings for keys."""
        return core_schema.no_info_before_validator_function(_as_dict, core_schema.dict_schema(core_schema.str_schema(strict=True)))

    def json(self) -> JsonSchema:
        """An object."""
        return {"type": "object"}


def needed(cls: type[Any]) -> list[str]:
    """Fields without a default."""
    return [each.name for each in fields(cls) if each.default is MISSING and each.default_factory is MISSING]


_DEVICES = {"con", "prn", "aux", "nul", *(f"{port}{number}" for port in ("com", "lpt") for number in range(10))}


def _for_a_file(value: str) -> str:
    begins = value[:1].isalnum() or value[:1] == "_"
    if not begins or not value.isprintable() or set(value) & set('/\\:*?"<>|') or value[-1] in ". " or _stem(value) in _DEVICES:
        raise ValueError
    return value


def _on_one_line(value: str) -> str:
    if not value.isprintable() or not value.strip():
        raise ValueError
    return value


def _stem(value: str) -> str:
    return value.partition(".")[0].rstrip().lower()


def _as_text(value: Any) -> Any:
    return os.fspath(value) if isinstance(value, os.PathLike) else value


def _as_texts(value: Any) -> Any:
    value = plain(value)
    return tuple(map(_as_text, value)) if isinstance(value, tuple) else value


def _as_dict(value: Any) -> Any:
    return dict(value) if isinstance(value, Mapping) else value
