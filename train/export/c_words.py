"""Words of C: types, literals, and the few functions that blocks call."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from string import Template
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

LINE = 118
"""Characters of a line of a table."""

_KEYWORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int long register restrict return
short signed sizeof static struct switch typedef union unsigned void volatile while
"""

C_WORDS = frozenset(_KEYWORDS.split())
"""Keywords of C99."""


class Words(NamedTuple):
    """How a file of one name and precision says things."""

    name: str
    precision: str

    @property
    def real(self) -> str:
        """Its type of numbers."""
        return "double" if self.precision == "double" else "float"

    @property
    def bytes(self) -> int:
        """Of one of them."""
        return 8 if self.precision == "double" else 4

    @property
    def suffix(self) -> str:
        """What stands behind literals of this type, and behind the names of math.h."""
        return "" if self.precision == "double" else "f"


_HELPERS: Mapping[str, str] = {
    "affine": """\
/* y = A x + b, or A x without b; A by rows */
static void ${name}_affine(const $real *A, const $real *x, const $real *b, $real *y, int rows, int columns)
{
    for (int i = 0; i < rows; ++i) {
        const $real *row = A + (long)i * columns;
        $real sum = b ? b[i] : 0;
        for (int j = 0; j < columns; ++j) sum += row[j] * x[j];
        y[i] = sum;
    }
}
""",
    "products": """\
/* every part of x through a matrix of its own */
static void ${name}_products(const $real *A, const int *which, const $real *x, $real *y, int parts, int rows, int columns)
{
    for (int part = 0; part < parts; ++part) {
        const $real *own = A + (long)which[part] * rows * columns;
        ${name}_affine(own, x + (long)part * columns, 0, y + (long)part * rows, rows, columns);
    }
}
""",
    "entry": """\
/* which entry of a table an instant has: all that follow the last have the last */
static long ${name}_entry($real instant, int entries)
{
    return instant < ($real)entries ? (long)instant : (long)entries - 1;
}
""",
}

HELPERS = tuple(_HELPERS)
"""Functions that blocks call, each behind those that it calls itself."""

CALLS = {"products": ("affine",)}


def helper(name: str, words: Words) -> str:
    """A function's text."""
    return Template(_HELPERS[name]).substitute(name=words.name, real=words.real)


def literals(values: NDArray[Any], words: Words) -> str:
    """The numbers, as many on a line as there is room for: the fewest digits that give each of them back."""
    return "\n".join(_lines(_each(values.ravel(), words.suffix)))


def _each(values: NDArray[Any], suffix: str) -> Iterable[str]:
    if values.dtype.kind == "i":
        return map(str, values.tolist())
    if not suffix:
        return map(repr, values.tolist())
    return (f"{each}{suffix}" for each in map(str, values.astype(np.float32)))


def _lines(each: Iterable[str]) -> Iterator[str]:
    line = "   "
    for word in each:
        if len(line) + len(word) + 2 > LINE:
            yield line
            line = "   "
        line += f" {word},"
    yield line.removesuffix(",")
