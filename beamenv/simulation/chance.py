"""What chance has a say in when episodes begin."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from beamenv.scenarios.drawing import draw_uniforms, draws
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.signals.own_loads import DRAWS

Array = NDArray[np.float64]
Rows = NDArray[np.int64]
Generators = Any
"""One generator of NumPy for all blades, a sequence of one for each, or torch's, on the device of the blades."""


class Numbers(NamedTuple):
    """Random numbers that k beginning episodes take, in the order in which they are drawn."""

    faults: Any
    """(k, f) uniform: plant and faults."""
    course: Any
    """(k, w) uniform: on what course a blade changes within the episode."""
    load: Any
    """(k, l) uniform: load case."""
    turns: Any
    """(k, 3 H) uniform: the rotor's harmonics."""
    own: Any
    """(k, d) uniform: loads of one's own."""
    noise: Any
    """(k, c) standard normal: disturbances at the first instant; empty where each blade has its own generator."""


def draw(
    scenario: Scenario, generators: Generators, rows: Any, group: Rows, columns: int, faults: int, course: int, loads: int
) -> Numbers:
    """The numbers of the episodes of ``rows``: one generator for all serves one group of blades after the other.

    ``group`` (N,) is each blade's, ``columns`` is c and ``faults`` f, 0 where nothing is drawn for plants and faults, ``course`` w;
    load cases are made of ``loads`` disturbances.
    """
    widths = faults, course, draws(loads), 3 * len(scenario.rotor.harmonics), DRAWS * len(scenario.loads)
    if isinstance(generators, Sequence):
        own = [generators[row] for row in rows]
        faulty, way, load, turns, further = (draw_uniforms(own, len(rows), width) for width in widths)
        return Numbers(faulty, way, load, turns, further, np.empty(0))
    if not isinstance(generators, np.random.Generator):
        return _of_torch(generators, len(group[rows]), widths, columns)
    drawn = []
    for count in np.bincount(group[rows]).tolist():
        if count:
            uniforms = [draw_uniforms(generators, count, width) for width in widths]
            drawn.append((*uniforms, generators.standard_normal((count, columns))))
    return Numbers(*drawn[0]) if len(drawn) == 1 else Numbers(*map(np.concatenate, zip(*drawn, strict=True)))


def _of_torch(generator: Any, count: int, widths: Sequence[int], columns: int) -> Numbers:
    """With 64 bits, for whole numbers are made of them."""
    import torch

    told: Any = {"generator": generator, "device": generator.device, "dtype": torch.float64}
    uniforms, ends = torch.rand((count, sum(widths)), **told), np.cumsum(widths).tolist()
    parts = [uniforms[:, end - width : end] for end, width in zip(ends, widths, strict=True)]
    return Numbers(*parts, torch.randn((count, columns), **told))  # type: ignore[call-arg]
