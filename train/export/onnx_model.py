"""A block diagram as an ONNX model: one step, with what it remembers as inputs and outputs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import singledispatchmethod
from typing import Any

import numpy as np
from numpy.typing import NDArray
from onnx import ModelProto, NodeProto, TensorProto, ValueInfoProto, checker, helper, numpy_helper

from train.export.blocks import Affine, Block, Blocks, Choose, Constant, Delay, Function, Input, Join, Pair, Pick, Reduce
from train.export.diagram import Diagram, called
from train.export.exported import Exported

OPERATORS, IR = 18, 9
"""Versions of ONNX's operators and files: those of runtimes from 2023 on."""

NEXT = "_next"
"""Behind the name of what is remembered: the output that is the input of the next step."""

_FUNCTIONS = {"tanh": "Tanh", "sigmoid": "Sigmoid", "exp": "Exp", "log": "Log", "absolute": "Abs"}
_PAIRS = {"add": "Add", "subtract": "Sub", "multiply": "Mul", "divide": "Div", "maximum": "Max", "minimum": "Min"}
_TESTS = {"greater": "Greater", "equal": "Equal"}
_REDUCTIONS = {"sum": "ReduceSum", "maximum": "ReduceMax", "minimum": "ReduceMin"}


@dataclass(slots=True, eq=False)
class _Graph:
    """Nodes and tables of one step."""

    diagram: Diagram
    kind: type[np.floating[Any]]
    names: dict[Block, str] = field(default_factory=dict)
    nodes: list[NodeProto] = field(default_factory=list)
    tables: list[TensorProto] = field(default_factory=list)
    _taken: set[str] = field(default_factory=set)

    def __post_init__(self) -> None:
        """Write all blocks in their order, then the outputs under their names."""
        for block in self.diagram.order:
            self.write(block)
        self._call("Identity", [self.names[self.diagram.output]], "volts")
        for delay, block in self.diagram.following.items():
            self._call("Identity", [self.names[block]], self.names[delay] + NEXT)

    @property
    def precision(self) -> int:
        """ONNX's number for it."""
        return int(helper.np_dtype_to_tensor_dtype(np.dtype(self.kind)))

    def described(self, name: str, size: int) -> ValueInfoProto:
        """What an input or output is."""
        return helper.make_tensor_value_info(name, self.precision, [size])

    def _new(self, wanted: str) -> str:
        name, count = wanted, 1
        while name in self._taken or name == "volts":
            count += 1
            name = f"{wanted}_{count}"
        self._taken.add(name)
        return name

    def _table(self, name: str, values: NDArray[Any]) -> str:
        numbers = values if values.dtype.kind == "i" else values.astype(self.kind)
        own = self._new(name)
        self.tables.append(numpy_helper.from_array(np.ascontiguousarray(numbers), own))
        return own

    def _call(self, operator: str, inputs: list[str], output: str, **attributes: Any) -> str:
        self.nodes.append(helper.make_node(operator, inputs, [output], name=f"{output}: {operator}", **attributes))
        return output

    def _between(self, operator: str, *inputs: str, **attributes: Any) -> str:
        return self._call(operator, list(inputs), self._new(operator.lower()), **attributes)

    def _fill(self, block: Block, operator: str, *inputs: str, **attributes: Any) -> None:
        self.names[block] = self._call(operator, list(inputs), self._new(called(block)), **attributes)

    def _shaped(self, x: str, *shape: int) -> str:
        return self._between("Reshape", x, self._table("shape", np.array(shape, np.int64)))

    @singledispatchmethod
    def write(self, block: Block) -> None:
        """Nodes for a block."""
        raise TypeError(f"{type(block).__name__} is not written as ONNX.")

    @write.register
    def _(self, block: Input) -> None:
        self.names[block] = self._new(called(block))

    @write.register
    def _(self, block: Delay) -> None:
        self.names[block] = self._new(called(block))

    @write.register
    def _(self, block: Constant) -> None:
        self.names[block] = self._table(called(block), block.value)

    @write.register
    def _(self, block: Affine) -> None:
        inputs = self._table("matrix", block.matrix), self.names[block.of]
        if block.bias is None:
            self._fill(block, "MatMul", *inputs)
        else:
            self._fill(block, "Add", self._between("MatMul", *inputs), self._table("bias", block.bias))

    @write.register
    def _(self, block: Blocks) -> None:
        entries, kept, rows, columns = block.matrices.shape
        parts = len(block.which)
        if block.step is None:
            matrices = self._table("matrices", block.matrices[0])
        else:
            entry = self._between("Min", self.names[block.step], self._table("last", np.array([entries - 1.0])))
            entry = self._between("Cast", entry, to=TensorProto.INT64)
            found = self._between("Gather", self._table("matrices", block.matrices), entry, axis=0)
            matrices = self._shaped(found, kept, rows, columns)
        own = self._between("Gather", matrices, self._table("which", block.which), axis=0)
        product = self._between("MatMul", own, self._shaped(self.names[block.of], parts, columns, 1))
        self._fill(block, "Reshape", product, self._table("shape", np.array([parts * rows])))

    @write.register
    def _(self, block: Function) -> None:
        self._fill(block, _FUNCTIONS[block.name], self.names[block.of])

    @write.register
    def _(self, block: Pair) -> None:
        inputs = self.names[block.left], self.names[block.right]
        if block.name in _PAIRS:
            self._fill(block, _PAIRS[block.name], *inputs)
        else:
            self._fill(block, "Cast", self._between(_TESTS[block.name], *inputs), to=self.precision)

    @write.register
    def _(self, block: Choose) -> None:
        test = self._between("Greater", self.names[block.condition], self._table("zero", np.zeros(1)))
        self._fill(block, "Where", test, self.names[block.where], self.names[block.otherwise])

    @write.register
    def _(self, block: Pick) -> None:
        self._fill(block, "Gather", self.names[block.of], self._table("picked", block.indices), axis=0)

    @write.register
    def _(self, block: Join) -> None:
        self._fill(block, "Concat", *(self.names[part] for part in block.parts), axis=0)

    @write.register
    def _(self, block: Reduce) -> None:
        axis = self._table("axis", np.array([1]))
        self._fill(block, _REDUCTIONS[block.name], self._shaped(self.names[block.of], block.size, -1), axis, keepdims=0)


def onnx_model(exported: Exported) -> bytes:
    """The file's bytes; ``ValueError`` for numbers that its precision cannot hold."""
    exported.check_range()
    diagram = exported.diagram
    graph = _Graph(diagram, np.float64 if exported.precision == "double" else np.float32)
    inputs = [graph.described(graph.names[each], each.size) for each in (*diagram.inputs, *diagram.following)]
    outputs = [graph.described(graph.names[each] + NEXT, each.size) for each in diagram.following]
    whole = helper.make_graph(
        graph.nodes, exported.name, inputs, [graph.described("volts", diagram.output.size), *outputs], graph.tables
    )
    model = helper.make_model(whole, opset_imports=[helper.make_opsetid("", OPERATORS)], ir_version=IR, producer_name="beamenv")
    return _told(model, exported).SerializeToString()


def _told(model: ModelProto, exported: Exported) -> ModelProto:
    """The model with what a reader must know of it."""
    helper.set_model_props(model, exported.facts)
    model.doc_string = (
        f"{exported.controller}: one step from what the sensors show to voltages. What is remembered goes from each output "
        f"*{NEXT} to the input of its name, and is zero at first. Readings must be finite."
    )
    checker.check_model(model, full_check=True)
    return model
