"""Plants that are wrong in the way that beam theory is: in the frequencies, the damping and the shapes of the upper modes.

On a solid of the thesis' blade the first modes of a beam are right within a per cent; the upper ones, in which shear, warping and
the walls take part, are off by up to some twelve, and so is what a patch sees of their shapes. No scenario says so: training does.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.given import GivenBlade
from beamenv.blade.modal_plant_of import further_signals
from beamenv.plant.modal_plant import ModalPlant
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.banks import varied_blades
from beamenv.simulation.plants.standing import about_steady_states
from beamenv.task import Task

Array = NDArray[np.float64]

KNOWN, FREQUENCY, SHAPE, DAMPING = 0.01, 0.12, 0.15, 1.6
"""Largest error of the first mode's frequency, of upper ones', standard deviation of what a patch does to and sees of these, and
the factor within which the damping of each mode lies."""

UPPER = 7
"""From this mode on, counted from 0, errors are whole; before they grow evenly."""


@dataclass(frozen=True)
class MistakenTask(Task):
    """A task whose plants are wrong so, besides what its scenario varies."""

    errors: int = 0
    """Seed."""

    @cached_property
    def bank(self) -> Bank:
        """Of as many plants as the scenario says."""
        blades = list(mistaken(list(varied_blades(self.blade, self.scenario.plants)), self.errors))
        speeds = np.array([blade.config.speed for blade in blades])
        bank = Bank.gather(self.blade.truth, [blade.truth for blade in blades], speeds, None)
        return about_steady_states(bank.in_cost_axes(), blades)


def mistaken(blades: Sequence[Blade], seed: int) -> Iterator[Blade]:
    """The blades with errors, each its own, in their true plants' modes."""
    generator = np.random.default_rng(seed)
    for blade in blades:
        modes = len(blade.true_modal.natural_frequencies)
        share = np.minimum(np.arange(modes) / UPPER, 1.0)
        frequency = 1.0 + (KNOWN + (FREQUENCY - KNOWN) * share) * generator.uniform(-1.0, 1.0, modes)
        seen = 1.0 + SHAPE * share[:, None] * generator.standard_normal((modes, blade.full.forces.shape[1]))
        damping = blade.config.damping_ratio * DAMPING ** generator.uniform(-1.0, 1.0, modes)
        given = GivenBlade(blade.config, changed(blade, frequency, seen, np.minimum(damping, 0.9)))
        vars(given).update(beam=blade.beam, modal=blade.modal, full=blade.full)
        yield given


def changed(blade: Blade, frequency: Array, seen: Array, damping: Array) -> ModalPlant:
    """The true plant's modes with frequencies times (r,), what each patch does to and sees of them times (r, m), damping (r,).

    A patch that both drives and senses errs alike in both, so that it still takes energy out of every mode.
    """
    modal, full = blade.true_modal, blade.full
    omega, shapes = modal.natural_frequencies * frequency, modal.mode_shapes
    order = np.argsort(omega)
    charges = full.charges @ shapes
    sensed = seen.T if seen.shape[1] == len(charges) else np.ones_like(charges)
    return ModalPlant(
        natural_frequencies=omega[order],
        gyroscopic=modal.gyroscopic[np.ix_(order, order)],
        actuation=((shapes.T @ full.forces) * seen)[order],
        charges=(charges * sensed)[:, order],
        line_load=(shapes.T @ full.line_load)[order],
        tip=(full.tip @ shapes)[:, order],
        strain=(full.strain @ shapes)[:, order],
        damping_ratio=damping[order],
        **further_signals(blade, shapes[:, order]),
    )
