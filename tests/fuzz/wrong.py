"""Wrong values, and arguments with some of them in place of right ones."""

import copy
import math
import threading
from collections import OrderedDict, UserDict
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from types import MappingProxyType, SimpleNamespace

import numpy as np
from hypothesis import strategies as st


class Unshowable:
    """An object whose own ``repr`` fails."""

    def __repr__(self):
        raise RuntimeError("no")

    def __deepcopy__(self, memo):
        return self


def _fixed(array):
    array.setflags(write=False)
    return array


MAKERS = {
    "none": lambda: None,
    "true": lambda: True,
    "false": lambda: False,
    "numpy true": lambda: np.True_,
    "bool array": lambda: np.array([True, False]),
    "nan": lambda: math.nan,
    "inf": lambda: math.inf,
    "-inf": lambda: -math.inf,
    "-0": lambda: -0.0,
    "huge": lambda: 10**400,
    "large": lambda: 2**70,
    "minus": lambda: -1,
    "half": lambda: 0.5,
    "tiny": lambda: 5e-324,
    "complex": lambda: 1 + 2j,
    "numpy complex": lambda: np.complex64(3),
    "decimal": lambda: Decimal("1.5"),
    "fraction": lambda: Fraction(1, 2),
    "float16": lambda: np.float16(0.5),
    "float32 nan": lambda: np.float32("nan"),
    "longdouble": lambda: np.longdouble(2),
    "uint64": lambda: np.uint64(2),
    "0-d": lambda: np.array(2.0),
    "0-d text": lambda: np.array("2"),
    "0-d object": lambda: np.array(None, dtype=object),
    "datetime": lambda: np.datetime64("2020-01-01"),
    "timedelta": lambda: np.timedelta64(3, "s"),
    "masked": lambda: np.ma.masked_array([1.0, 2.0], [True, False]),
    "text no": lambda: "no",
    "text false": lambda: "false",
    "text number": lambda: "1.0",
    "text none": lambda: "None",
    "text empty": lambda: "",
    "text two lines": lambda: "a\nb",
    "text nul": lambda: "a\0b",
    "text long": lambda: "x" * 5000,
    "surrogate": lambda: "\ud800",
    "bytes": lambda: b"12",
    "bytearray": lambda: bytearray(b"12"),
    "empty list": list,
    "empty tuple": tuple,
    "empty dict": dict,
    "empty set": set,
    "list of none": lambda: [None],
    "list of nan": lambda: [1.0, math.nan],
    "list of text": lambda: ["1", "2"],
    "list of bools": lambda: [True, False],
    "list of lists": lambda: [[1.0], [2.0, 3.0]],
    "list of one": lambda: [1.0],
    "list of five": lambda: [0.1, 0.2, 0.3, 0.4, 0.5],
    "set": lambda: {1.0, 2.0},
    "range": lambda: range(3),
    "generator": lambda: (each for each in (1.0, 2.0)),
    "iterator": lambda: iter([1.0, 2.0]),
    "zip": lambda: zip([1], [2], strict=True),
    "dict": lambda: {"a": 1},
    "nested dict": lambda: {"a": {"b": {"c": [1, {"d": None}]}}},
    "number keys": lambda: {1: 2.0},
    "none key": lambda: {None: 1},
    "tuple keys": lambda: {("a", "b"): 1.0},
    "proxy": lambda: MappingProxyType({"a": 1}),
    "user dict": lambda: UserDict(a=1),
    "ordered": lambda: OrderedDict(a=1),
    "matrix": lambda: np.eye(2),
    "complex array": lambda: np.array([1.0, 2j]),
    "object array": lambda: np.array([1, "a", None], dtype=object),
    "ragged": lambda: np.array([[1], [1, 2]], dtype=object),
    "text array": lambda: np.array(["1", "2"]),
    "structured": lambda: np.zeros(2, dtype=[("a", float)]),
    "nan array": lambda: np.array([np.nan, 1.0]),
    "empty array": lambda: np.zeros(0),
    "empty matrix": lambda: np.zeros((0, 3)),
    "large array": lambda: np.zeros((60, 60)),
    "read-only": lambda: _fixed(np.array([0.2, 0.4])),
    "strided": lambda: np.linspace(0.0, 1.0, 8)[::4],
    "reversed": lambda: np.array([2.0, 1.0])[::-1],
    "big-endian": lambda: np.array([0.2, 0.4], dtype=">f8"),
    "fortran": lambda: np.asfortranarray(np.eye(3)[:, :2]),
    "class": lambda: int,
    "function": lambda: len,
    "lambda": lambda: lambda *given: 1.0,
    "module": lambda: math,
    "object": object,
    "namespace": lambda: SimpleNamespace(task=None, plant=None),
    "unshowable": Unshowable,
    "ellipsis": lambda: ...,
    "slice": lambda: slice(1),
    "error": lambda: ValueError("x"),
    "path": lambda: Path("nobody/there"),
    "lock": threading.Lock,
    "memory": lambda: memoryview(b"12"),
}
UNCOPIABLE = {"generator", "iterator", "zip", "module", "lock", "memory"}
"""What ``copy.deepcopy`` does not take, or empties; Gymnasium copies what it is given."""

JUNK = st.sampled_from(sorted(MAKERS)).map(lambda name: MAKERS[name]())
COPIABLE = st.sampled_from(sorted(set(MAKERS) - UNCOPIABLE)).map(lambda name: MAKERS[name]())


def _likened(junk, value):
    """Junk that begins with what is right: a list with one wrong member, another length, another type of container."""
    if isinstance(value, np.ndarray) and value.size and value.dtype.kind == "f":
        return st.one_of(
            st.sampled_from([math.nan, math.inf, -math.inf, 1e300, -1.0]).map(lambda wrong: _with_member(value, wrong)),
            st.sampled_from(
                [
                    lambda: value.astype(complex),
                    lambda: value.astype(str),
                    lambda: value.astype(object),
                    lambda: value.astype(np.float32),
                    lambda: value.astype(bool),
                    lambda: value[..., :-1],
                    lambda: value[None],
                    lambda: np.concatenate([value, value], axis=-1),
                    lambda: value.T,
                    lambda: np.asfortranarray(value),
                    lambda: value.tolist(),
                    lambda: _fixed(value.copy()),
                    lambda: np.repeat(value, 2, axis=-1)[..., ::2],
                ]
            ).map(lambda make: make()),
        )
    if isinstance(value, (list, tuple)) and value:
        member = st.tuples(st.integers(0, len(value) - 1), junk).map(
            lambda drawn: type(value)([*value[: drawn[0]], drawn[1], *value[drawn[0] + 1 :]])
        )
        return st.one_of(member, st.sampled_from([value[:-1], value + value, str(value), [value], set(map(str, value))]))
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return st.sampled_from([str(value), [value], {"value": value}, value + 0j, -value, np.array([value]), np.float64(value)])
    if isinstance(value, str):
        return st.sampled_from([value.upper(), f"{value} ", value.encode(), [value], np.array(value), np.str_(value), value[:-1]])
    return st.nothing()


def _with_member(value, wrong):
    changed = value.copy()
    changed.flat[-1] = wrong
    return changed


def places(kinds, path=()):
    """Every path that a value can stand at: arguments, and fields of tables within."""
    found = []
    for name, kind in kinds.items():
        found.append((*path, name))
        if kind.parts is not None:
            found += places(kind.parts, (*path, name))
    return found


def kind_at(kinds, path):
    """The kind at a path."""
    kind = kinds[path[0]]
    return kind if len(path) == 1 else kind_at(kind.parts, path[1:])


def value_at(values, path):
    """What stands at a path of right arguments, or None."""
    for name in path:
        values = values.get(name) if isinstance(values, dict) else None
    return values


def with_value(values, path, value):
    """Arguments with another value at a path; tables on the way are copies."""
    name, *rest = path
    if not rest:
        return {**values, name: value}
    stood = values.get(name)
    return {**values, name: with_value(stood if isinstance(stood, dict) else {}, rest, value)}


@st.composite
def arguments(draw, kinds, valid, junk=JUNK, most=2):
    """Right arguments with one wrong value, seldom two; and where these stand."""
    paths = draw(st.lists(st.sampled_from(places(kinds)), min_size=1, max_size=most, unique=True))
    given = dict(valid)
    for path in paths:
        right = value_at(valid, path)
        kind = kind_at(kinds, path)
        values = [kind.near] if junk.is_empty else [junk, kind.near, _likened(junk, right)]
        if kind.parts is not None and not junk.is_empty:
            values.append(_mistaken_tables(right, junk))
        given = with_value(given, path, draw(st.one_of(*(each for each in values if not each.is_empty))))
    return given, tuple(paths)


def _mistaken_tables(right, junk):
    """A table with a key too many."""
    keys = st.sampled_from(["colour", "", 3, None, ("a",), "\ud800", 2.5, b"beam", "self", "cls", "__class__", "a\nb", True])
    return st.tuples(keys, junk).map(lambda pair: {**(right if isinstance(right, dict) else {}), pair[0]: pair[1]})


def copied(valid):
    """Right arguments that an example may spoil: tables, lists and arrays are copies, objects are the same."""
    if isinstance(valid, dict):
        return {name: copied(value) for name, value in valid.items()}
    return copy.deepcopy(valid) if isinstance(valid, (list, np.ndarray)) else valid
