"""How long the default beam and its plant take to be built."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

REPEATED = 7


def structure_times() -> dict[str, float]:
    """Milliseconds for the default beam: its matrices, with its sections and with these known, its steady state and frequencies at
    one more speed, and its reduced plant.
    """
    from beamenv.blade.build import build_plant
    from beamenv.blade.presets import blade_config

    config = blade_config()
    speeds = iter(range(100, 200))
    cold = {
        "assembly_ms": _best_ms(lambda: config.beam.build(model=config.model).matrices),
        "plant_ms": _best_ms(lambda: build_plant(config)),
    }
    beam = config.beam.build(model=config.model)
    _ = beam.matrices

    return cold | {
        "assembly_of_known_sections_ms": _best_ms(lambda: config.beam.build(model=config.model).matrices),
        "further_speed_ms": _best_ms(lambda: beam.at(float(next(speeds)))),
        "frequencies_ms": _best_ms(lambda: beam.natural_frequencies(speed=float(next(speeds)), count=6, gyroscopic=True)),
    }


def _best_ms(call: Callable[[], Any]) -> float:
    best = float("inf")
    for _ in range(REPEATED):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return 1e3 * best
