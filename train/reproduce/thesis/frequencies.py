"""Tables 3.1 to 3.4: natural frequencies in the configurations that were found to lie behind them."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from beamenv.structure.sweep import frequency_sweep
from train.reproduce.thesis.configurations import Model, built
from train.reproduce.thesis.equations import SHEAR_FLOW
from train.reproduce.thesis.printed import numbers, printed_table

Array = NDArray[np.float64]

BENDING = ("lag", "flap")
CHORD_TO_WALL = (10, 20, 30, 40, 50)
PRESETTINGS_DEG = (0.0, 30.0, 60.0, 90.0)
SPEEDS = (100.0, 200.0, 300.0, 400.0)
REV_PER_MIN = 2.0 * np.pi / 60.0
"""rad/s."""


def convergence(model: Model, **changes: float | str) -> Array:
    """(10, 3), rad/s: the first three frequencies of θ = 30°, 30° pretwist with one to ten terms (Table 3.1)."""
    beams = [model.beam(30.0, **{"pretwist_deg": 30.0, "terms": terms, **changes}) for terms in range(1, 11)]
    return np.stack([frequency_sweep(beam, [model.speed], 3)[0] for beam in beams])


def convergence_best_fit(model: Model) -> Array:
    """(3,), rad/s: of all configurations tried, the frequencies that come closest to Table 3.1 with ten terms."""
    printed = np.array([numbers("table-3.1", name)[-1] for name in ("omega1", "omega2", "omega3")])
    flows = ("thesis",) if SHEAR_FLOW in model.reading else ("consistent", "thesis")
    theories = product(("higher_order", "first_order", "rigid"), flows, (model.box.hub_radius, 0.1))
    blades = [
        model.blade(30.0, pretwist_deg=30.0, shear=shear, shear_flow=flow, hub_radius=hub) for shear, flow, hub in theories
    ] + [model.blade(angle, pretwist_deg=30.0) for angle in (0.0, 45.0, 60.0, 75.0, 90.0)]
    beams = [built(blade) for blade in blades]
    tried = np.concatenate([frequency_sweep(beam, [model.speed], 3, gyroscopic=g) for beam in beams for g in (True, False)])
    return np.asarray(tried[np.abs(tried / printed - 1.0).max(axis=1).argmin()])


def chandra_chopra(model: Model, rev_per_min: Sequence[float] | Array = (0.0, 1000.0)) -> Array:
    """(3 S,), Hz: flap 1, lag 1 and flap 2, each at S speeds (Table 3.2 has two), distinguished by their kinetic energy."""
    beam = built(model.validation_box)
    columns = []
    for speed in rev_per_min:
        modes = beam.modes(speed * REV_PER_MIN, count=5)
        flap = [f for f, family in zip(modes.natural_frequencies, modes.families, strict=True) if family == "flap"]
        lag = [f for f, family in zip(modes.natural_frequencies, modes.families, strict=True) if family == "lag"]
        columns.append([flap[0], lag[0], flap[1]])
    return np.array(columns).T.ravel() / (2.0 * np.pi)


def presetting_and_speed(model: Model, terms: int, speeds: Sequence[float] | Array = SPEEDS) -> Array:
    """(4 S, 3), rad/s: Table 3.3, four presettings at S speeds; 30° pretwist, θ = 0, rigid in shear, bending without gyroscopic
    coupling.
    """
    beams = [model.beam(0.0, pretwist_deg=30.0, presetting_deg=angle, shear="rigid", terms=terms) for angle in PRESETTINGS_DEG]
    sweep = frequency_sweep(beams, speeds, 3, BENDING, gyroscopic=False)
    return sweep.transpose(1, 0, 2).reshape(-1, 3)


def wall_thickness(model: Model) -> Array:
    """(15,), rad/s: Table 3.4, untwisted, θ = 0, 100 rad/s, bending without gyroscopic coupling, three modes for each c/h."""
    half_chord = 0.5 * model.box.width
    beams = [model.beam(0.0, thickness=half_chord / ratio) for ratio in CHORD_TO_WALL]
    return frequency_sweep(beams, [100.0], 3, BENDING, gyroscopic=False)[:, 0].ravel()


def printed_presettings(columns: tuple[str, str, str] = ("omega1", "omega2", "omega3")) -> Array:
    """(16, 3): Table 3.3 as printed, or with ("oh1", "oh2", "oh3") the column of Oh et al."""
    return np.array([[float(row[name]) for name in columns] for row in printed_table("table-3.3")])
