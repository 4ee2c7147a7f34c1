"""What a value means by the rules of the house, read anew: a reader beside the one under test.

``means`` of a kind gives the plain value that a given one stands for, or ``NOTHING`` where it must be refused. Bounds are not
looked at: what is out of bounds may be refused, and what is accepted must mean this. ``near`` are values like right ones.
"""

import math
import os
import types
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields, is_dataclass
from typing import Any, Union, get_args, get_origin

import numpy as np
from hypothesis import strategies as st

from beamenv.structure.walls.curves import Curve, Touloukian

NOTHING = type("Nothing", (), {"__repr__": lambda self: "NOTHING"})()


@dataclass(frozen=True)
class Kind:
    name: str
    means: Callable[[Any], Any]
    near: st.SearchStrategy[Any]
    parts: Mapping[str, "Kind"] | None = None
    """Of a table."""


def _number(value):
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        return NOTHING
    try:
        plain = float(value)
    except OverflowError:
        return NOTHING
    return plain if math.isfinite(plain) else NOTHING


def _count(value):
    if type(value) is int:
        return value
    plain = _number(value)
    if plain is NOTHING or not plain.is_integer():
        return NOTHING
    return int(value[()] if isinstance(value, np.ndarray) else value)


def _flag(value):
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    return bool(value) if isinstance(value, (bool, np.bool_)) else NOTHING


def _text(value):
    return str(value) if isinstance(value, str) else NOTHING


def _path(value):
    return os.fspath(value) if isinstance(value, (str, os.PathLike)) and isinstance(os.fspath(value), str) else NOTHING


def _items(value):
    if isinstance(value, np.ndarray) and value.ndim == 1:
        return list(value)
    return list(value) if isinstance(value, (list, tuple, range)) else NOTHING


def _sequence(each, length=None):
    def means(value):
        items = _items(value)
        if items is NOTHING or (length is not None and len(items) != length):
            return NOTHING
        read = tuple(map(each, items))
        return NOTHING if any(item is NOTHING for item in read) else read

    return means


def _array(value):
    """Numbers, nested in lists or an array: never strings, bools or complex ones."""
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiu" and not np.ma.is_masked(value):
        plain = value.astype(float)
        return plain if np.isfinite(plain).all() else NOTHING
    if isinstance(value, (list, tuple, range, np.ndarray)) and not np.ma.is_masked(value):
        items = list(value) if np.ndim(value) or not isinstance(value, np.ndarray) else [value[()]]
        read = [_array(item) for item in items]
        if any(item is NOTHING for item in read) or len({np.shape(item) for item in read}) > 1:
            return NOTHING
        return np.array(read, dtype=float)
    plain = _number(value)
    return plain if plain is NOTHING else np.array(plain)


def _matrix(value):
    """As ``_array``, finite or not, of one or two dimensions."""
    given = value if isinstance(value, np.ndarray) else None
    if given is not None and given.dtype.kind in "fiu":
        return given.astype(float)
    return _array(value)


SCALES = [0.0, -0.0, 1e-300, 1e-12, 0.1, 0.5, 0.999999, 1.0, 1.5, 2.0, 7.0, 100.0, 1e6, 1e12, 1e200, 1.7e308, -1e-9, -1.0, -3.0]
_numbers_near = st.one_of(
    st.sampled_from(SCALES),
    st.integers(-3, 40),
    st.floats(0.0, 2.0),
    st.sampled_from([lambda: np.float32(0.5), lambda: np.array(0.5), lambda: np.int16(3), lambda: np.float64(2.0)]).map(
        lambda f: f()
    ),
)
_counts_near = st.one_of(
    st.integers(-2, 6), st.sampled_from([1.0, 2.0, 2.5, 10**9, 10**12, 10**30, np.int64(2), np.uint8(3), np.float32(2.0)])
)
_lists_near = st.one_of(
    st.lists(_numbers_near, max_size=4),
    st.lists(st.floats(0.0, 1.0), max_size=4).map(np.array),
    st.lists(st.floats(0.0, 1.0), max_size=4).map(tuple),
)

NUMBER = Kind("number", _number, _numbers_near)
COUNT = Kind("count", _count, _counts_near)
FLAG = Kind("flag", _flag, st.sampled_from([True, False, np.True_, 1, 0, "no", "false", -1, math.nan]))
TEXT = Kind("text", _text, st.text(max_size=6))
PATH = Kind("path", _path, st.sampled_from(["no.toml", "no.json", "no.npz", "", ".", "/", "a\0b", "../x", "nobody/there.toml"]))
NUMBERS = Kind("numbers", _sequence(_number), _lists_near)
COUNTS = Kind("counts", _sequence(_count), st.lists(_counts_near, max_size=4))
ARRAY = Kind("array", _array, st.one_of(_lists_near, _numbers_near))
MATRIX = Kind("matrix", _matrix, st.one_of(_lists_near, _numbers_near))
ANYTHING = Kind("anything", lambda value: value, st.nothing())


def _range(each):
    both = _sequence(each, 2)

    def means(value):
        return both(value) if _items(value) is not NOTHING else both((value, value))

    return means


RANGE = Kind("range", _range(_number), st.one_of(_numbers_near, st.lists(_numbers_near, min_size=2, max_size=2)))
COUNT_RANGE = Kind("range of counts", _range(_count), st.one_of(_counts_near, st.lists(_counts_near, min_size=2, max_size=2)))


def maybe(kind):
    """The kind, or None."""
    return Kind(f"{kind.name} or None", lambda value: None if value is None else kind.means(value), kind.near, kind.parts)


def either(*kinds):
    """The first kind that the value means something of."""

    def means(value):
        return next((read for kind in kinds if (read := kind.means(value)) is not NOTHING), NOTHING)

    return Kind(" or ".join(kind.name for kind in kinds), means, st.one_of(*(kind.near for kind in kinds)))


def choice(*names):
    """One of several names."""
    return Kind(
        "choice", lambda value: str(value) if isinstance(value, str) and value in names else NOTHING, st.sampled_from(names)
    )


def instance(*classes):
    """An object of a class, itself."""
    return Kind(classes[0].__name__, lambda value: value if isinstance(value, classes) else NOTHING, st.nothing())


def _objects(value):
    listed = isinstance(value, (list, tuple)) and all(map(is_dataclass, value))
    return tuple(value) if listed else NOTHING


OBJECTS = Kind("objects", _objects, st.nothing())
"""A list of objects, which may be empty."""


def table(parts, *classes):
    """A mapping of some fields, or an object of its class."""

    def means(value):
        if isinstance(value, classes):
            return value
        if not isinstance(value, Mapping) or any(not isinstance(key, str) or key not in parts for key in value):
            return NOTHING
        read = {str(key): parts[key].means(each) for key, each in value.items()}
        return NOTHING if any(each is NOTHING for each in read.values()) else read

    return Kind("table", means, st.nothing(), parts)


def _by_wall(value):
    plain = NUMBERS.means(value)
    if plain is not NOTHING:
        return (("all", plain),)
    pairs = list(value.items()) if isinstance(value, Mapping) else _items(value)
    if pairs is NOTHING or not all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs):
        return NOTHING
    read = tuple((_text(wall), NUMBERS.means(angles)) for wall, angles in pairs)
    return NOTHING if any(NOTHING in pair for pair in read) or len({wall for wall, _ in read}) < len(read) else read


BY_WALL = Kind("ply angles", _by_wall, st.sampled_from([[30.0], {"top": [1.0]}, {"all": "30"}, [["all", [3]]], {"all": []}, {}]))

_POLYNOMIAL = ("least_K", "most_K", "P_minus1", "P1", "P2", "P3")


def _curve(value):
    if isinstance(value, Touloukian):
        return value
    if isinstance(value, Mapping):
        read = {str(name): _number(each) for name, each in value.items()}
        if NOTHING in read.values() or not {"least_K", "most_K"} <= set(read) <= set(_POLYNOMIAL):
            return NOTHING
        return Touloukian(**read) if 0.0 < read["least_K"] < read["most_K"] <= 1e4 else NOTHING
    return _pairs(value)


def _pairs(value):
    return _sequence(_sequence(_number, 2))(list(value) if isinstance(value, np.ndarray) and value.ndim == 2 else value)


def _by_property(value):
    pairs = list(value.items()) if isinstance(value, Mapping) else _items(value)
    if pairs is NOTHING or not all(isinstance(pair, (list, tuple)) and len(pair) == 2 for pair in pairs):
        return NOTHING
    read = tuple((_text(name), _curve(curve)) for name, curve in pairs)
    return NOTHING if any(each is NOTHING for pair in read for each in pair) or len({n for n, _ in read}) < len(read) else read


_LINE = [[250.0, 1.0], [350, 0.9]]
CURVES = Kind(
    "curves",
    _by_property,
    st.sampled_from(
        [{}, {"E1": _LINE}, {"E2": _LINE[::-1]}, {"G12": [[250.0, "1"], [300.0, 1.0]]}, {"rho": _LINE}, [["nu12", _LINE]] * 2]
        + [{"E2": {"least_K": 200.0, "most_K": 400.0, "P1": -1e-4}}, {"E1": {"least_K": True, "most_K": 9}}]
        + [{"alpha1": np.array(_LINE)}]
    ),
)

_PLAIN = {
    float: NUMBER,
    int: COUNT,
    bool: FLAG,
    str: TEXT,
    tuple[float, float]: RANGE,
    tuple[int, int]: COUNT_RANGE,
    tuple[float, ...]: NUMBERS,
    tuple[int, ...]: COUNTS,
    tuple[str, ...]: Kind("texts", _sequence(_path), st.lists(st.text(max_size=3), max_size=2)),
    tuple[tuple[str, tuple[float, ...]], ...]: BY_WALL,
    tuple[tuple[float, float], ...]: Kind("pairs", _pairs, st.sampled_from([[[0, 1], [1, 0.5]], [[0, "1"]], [[1.0]], [], 0.5])),
    tuple[tuple[str, Curve], ...]: CURVES,
    Any: ANYTHING,
}


def of_hint(hint, tables):
    """The kind that a field's type says; a dataclass as a ``table`` where tables are taken, or as its objects alone."""
    if hint in _PLAIN:
        return _PLAIN[hint]
    if get_origin(hint) in (Union, types.UnionType):
        kinds = [of_hint(each, tables) for each in get_args(hint) if each is not type(None)]
        kind = kinds[0] if len(kinds) == 1 else either(*kinds)
        return maybe(kind) if type(None) in get_args(hint) else kind
    if is_dataclass(hint):
        return table(of_fields(hint), hint) if tables else instance(hint)
    return OBJECTS if get_origin(hint) is tuple else instance(hint)


def of_fields(cls, tables=True):
    """The kinds of a dataclass' fields, as its type hints say."""
    hints = typing.get_type_hints(cls)
    return {each.name: of_hint(hints[each.name], tables) for each in fields(cls) if each.init}
