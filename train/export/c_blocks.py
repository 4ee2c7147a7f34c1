"""What each block is in C: statements that fill its signal, and the tables and functions that they call for."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import singledispatchmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.export.blocks import Affine, Block, Blocks, Choose, Constant, Delay, Function, Input, Join, Pair, Pick, Reduce
from train.export.c_words import C_WORDS, CALLS, Words, literals
from train.export.diagram import Diagram, called

_FUNCTIONS = {
    "tanh": "tanh{f}({x})",
    "sigmoid": "0.5{f} * (1.0{f} + tanh{f}(0.5{f} * {x}))",
    "exp": "exp{f}({x})",
    "log": "log{f}({x})",
    "absolute": "fabs{f}({x})",
}

_PAIRS = {
    "add": "{x} + {y}",
    "subtract": "{x} - {y}",
    "multiply": "{x} * {y}",
    "divide": "{x} / {y}",
    "maximum": "{x} > {y} ? {x} : {y}",
    "minimum": "{x} < {y} ? {x} : {y}",
    "greater": "{x} > {y} ? 1.0{f} : 0.0{f}",
    "equal": "{x} == {y} ? 1.0{f} : 0.0{f}",
}

_REDUCTIONS = {"sum": "found += {x}", "maximum": "if ({x} > found) found = {x}", "minimum": "if ({x} < found) found = {x}"}

RESERVED = C_WORDS | {"state", "volts_out", "found", "work", "i", "j"}
"""Names that no signal may have."""


@dataclass(slots=True, eq=False)
class Body:
    """The statements of one step, the tables that they read and the functions that they call."""

    diagram: Diagram
    words: Words
    where: str = ""
    """What stands before the names of signals: nothing on the stack, or where in the state they lie."""
    names: dict[Block, str] = field(default_factory=dict)
    statements: list[str] = field(default_factory=list)
    signals: dict[str, int] = field(default_factory=dict)
    """Names and sizes of those that are filled."""
    tables: list[str] = field(default_factory=list)
    table_bytes: int = 0
    """Of them all, where int has four."""
    helpers: set[str] = field(default_factory=set)
    _taken: set[str] = field(default_factory=set)
    _kept: dict[bytes, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Write all blocks in their order."""
        for block in self.diagram.order:
            self.write(block)

    def following(self, delay: Delay) -> str:
        """The name of what a delay holds next, copied if that is what some delay holds now."""
        block = self.diagram.following[delay]
        name = self.name(block)
        if name.lstrip("(").startswith("state->") and not name.startswith(self.where or " "):
            self.loop(block, f"{name}[i]")
        return self.name(block)

    def _new(self, block: Block) -> str:
        wanted, count = called(block), 1
        name = wanted
        while name in self._taken or name in RESERVED:
            count += 1
            name = f"{wanted}_{count}"
        self._taken.add(name)
        return name

    def _signal(self, block: Block) -> str:
        """The name of a block's own signal."""
        name = self._new(block)
        self.signals[name] = block.size
        self.names[block] = self.where + name
        return self.names[block]

    def name(self, block: Block) -> str:
        """The name of a block's signal; constant ones get a table where they are asked for."""
        if isinstance(block, Constant) and block not in self.names:
            self.names[block] = self._table("constant", block.value)
        return self.names[block]

    def _at(self, block: Block) -> str:
        """The i-th number of a signal: a single one goes with every i."""
        if isinstance(block, Constant) and np.all(block.value == block.value[0]):
            return literals(block.value[:1], self.words).strip()
        return f"{self.name(block)}[{0 if block.size == 1 else 'i'}]"

    def _table(self, name: str, values: NDArray[Any]) -> str:
        """The name of a table of these numbers, one for all that are equal."""
        key = f"{values.dtype.kind}{values.size}".encode() + np.ascontiguousarray(values).tobytes()
        if key not in self._kept:
            kind = "int" if values.dtype.kind == "i" else self.words.real
            own = f"{self.words.name}_{name}_{len(self._kept) + 1}"
            self.tables.append(f"static const {kind} {own}[{values.size}] = {{\n{literals(values, self.words)}\n}};\n")
            self.table_bytes += values.size * (4 if kind == "int" else self.words.bytes)
            self._kept[key] = own
        return self._kept[key]

    def _call(self, helper: str) -> str:
        self.helpers.update((helper, *CALLS.get(helper, ())))
        return f"{self.words.name}_{helper}"

    def loop(self, block: Block, value: str) -> None:
        """A statement for each number of a signal."""
        self.statements.append(f"for (int i = 0; i < {block.size}; ++i) {self._signal(block)}[i] = {value};")

    @singledispatchmethod
    def write(self, block: Block) -> None:
        """Statements for a block."""
        raise TypeError(f"{type(block).__name__} is not written in C.")

    @write.register
    def _(self, block: Input) -> None:
        self.names[block] = self._new(block)

    @write.register
    def _(self, block: Delay) -> None:
        self.names[block] = f"state->{self._new(block)}"

    @write.register
    def _(self, block: Constant) -> None:
        """Nothing, until it is asked for."""

    @write.register
    def _(self, block: Affine) -> None:
        matrix, x, (rows, columns) = self._table("matrix", block.matrix), self.name(block.of), block.matrix.shape
        bias = "0" if block.bias is None else self._table("bias", block.bias)
        self.statements.append(f"{self._call('affine')}({matrix}, {x}, {bias}, {self._signal(block)}, {rows}, {columns});")

    @write.register
    def _(self, block: Blocks) -> None:
        entries, kept, rows, columns = block.matrices.shape
        matrix, which = self._table("matrices", block.matrices), self._table("which", block.which)
        if block.step is not None:
            matrix += f" + {self._call('entry')}({self.name(block.step)}[0], {entries}) * {kept * rows * columns}"
        sizes = f"{len(block.which)}, {rows}, {columns}"
        self.statements.append(
            f"{self._call('products')}({matrix}, {which}, {self.name(block.of)}, {self._signal(block)}, {sizes});"
        )

    @write.register
    def _(self, block: Function) -> None:
        self.loop(block, _FUNCTIONS[block.name].format(x=self._at(block.of), f=self.words.suffix))

    @write.register
    def _(self, block: Pair) -> None:
        self.loop(block, _PAIRS[block.name].format(x=self._at(block.left), y=self._at(block.right), f=self.words.suffix))

    @write.register
    def _(self, block: Choose) -> None:
        self.loop(block, f"{self._at(block.condition)} > 0 ? {self._at(block.where)} : {self._at(block.otherwise)}")

    @write.register
    def _(self, block: Pick) -> None:
        x, first = self.name(block.of), int(block.indices[0])
        if np.array_equal(block.indices, np.arange(first, first + block.size)):
            self.names[block] = f"({x} + {first})" if first else x  # a view: no signal is filled twice
        else:
            self.loop(block, f"{x}[{self._table('picked', block.indices)}[i]]")

    @write.register
    def _(self, block: Join) -> None:
        name, first = self._signal(block), 0
        for part in block.parts:
            at = f"{first} + i" if first else "i"
            self.statements.append(f"for (int i = 0; i < {part.size}; ++i) {name}[{at}] = {self.name(part)}[i];")
            first += part.size

    @write.register
    def _(self, block: Reduce) -> None:
        x, each = self.name(block.of), block.of.size // block.size
        step = _REDUCTIONS[block.name].format(x=f"{x}[i * {each} + j]")
        self.statements.append(
            f"for (int i = 0; i < {block.size}; ++i) {{\n"
            f"        {self.words.real} found = {x}[i * {each}];\n"
            f"        for (int j = 1; j < {each}; ++j) {step};\n"
            f"        {self._signal(block)}[i] = found;\n    }}"
        )
