"""A controller as a block diagram: what every format is written from.

It leads from what is measured, and from delays of one interval, which are zero at first, through blocks without memory to the
voltages and to what the delays hold next.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from train.export.blocks import Block, Delay, Input


@dataclass(frozen=True, slots=True, eq=False)
class Diagram:
    """From measurements to voltages, and what the delays hold next."""

    inputs: tuple[Input, ...]
    """The sensors first."""
    output: Block
    following: Mapping[Delay, Block]

    @property
    def order(self) -> tuple[Block, ...]:
        """All blocks that are needed, each behind its sources."""
        found: dict[Block, None] = {}
        for end in (*self.inputs, *self.following, *self.following.values(), self.output):
            found.update(dict.fromkeys(_behind(end, found)))
        return tuple(found)


NOUNS: Mapping[str, str] = {
    **{"add": "sum", "subtract": "difference", "multiply": "product", "divide": "quotient"},
    **{"maximum": "limited", "minimum": "limited", "greater": "test", "equal": "test"},
    **{"Affine": "image", "Blocks": "images", "Choose": "chosen", "Pick": "picked", "Join": "joined", "Reduce": "reduced"},
    **{"tanh": "squashed", "sigmoid": "gate", "exp": "power", "log": "logarithm", "absolute": "size", "Constant": "constant"},
}


def called(block: Block) -> str:
    """A signal's label, or else a noun for what it is."""
    kind = type(block).__name__
    return block.label or NOUNS.get(kind, "") or NOUNS[getattr(block, "name", kind)]


def _behind(end: Block, known: Mapping[Block, None]) -> Iterator[Block]:
    """What ``end`` needs and is not ``known``, sources first."""
    done: set[Block] = set()
    waiting = [(end, False)]
    while waiting:
        block, ready = waiting.pop()
        if block in known or block in done:
            continue
        if ready:
            done.add(block)
            yield block
        else:
            waiting.append((block, True))
            waiting.extend((source, False) for source in reversed(block.sources))
