"""Blades as they may turn out where a beam's theory says otherwise: what a designer expects of any model.

Shear, the distortion of sections, pretwist and the patches' own stiffness tell the more, the shorter the waves are. So the errors
of a mode grow with its natural frequency ω over the first, ω₁, until next to nothing is known of it; and where a model ends the
blade does not.
"""

from __future__ import annotations

import numpy as np

from baselines.design.controller import Array
from beamenv.blade.build import Blade
from beamenv.blade.given import GivenBlade
from beamenv.blade.modal_plant_of import further_signals
from beamenv.plant.modal_plant import ModalPlant
from beamenv.plant.plant import Plant

FREQUENCY = (0.02, 0.12)
"""Largest error of a natural frequency, uniform: of the first mode, growing as ω/ω₁ up to that of high ones."""

SHAPE = (0.05, 0.4)
"""Error of what a mode feels of each actuator and shows to each sensor, standard deviation over the root mean square of all of
them, likewise."""

MOST = 40
"""Modes of a mistaken blade, further ones included."""


def modelling_errors(blade: Blade, count: int, seed: int = 0) -> list[Plant]:
    """``count`` plants like the true one of a blade, with errors in each mode, and further modes from its last known one up to the
    Nyquist frequency, spaced as known ones are in the mean; behind the same electronics.
    """
    generator, plants = np.random.default_rng(seed), []
    for _ in range(count):
        mistaken = GivenBlade(blade.config, _mistaken(blade, generator))
        vars(mistaken).update(beam=blade.beam, modal=blade.modal, full=blade.full, plant=blade.plant)
        plants.append(mistaken.truth)
    return plants


def _mistaken(blade: Blade, generator: np.random.Generator) -> ModalPlant:
    modal, full = blade.true_modal, blade.full
    omega, shapes = modal.natural_frequencies, modal.mode_shapes
    growth, r = omega / omega[0], len(omega)
    of_frequency, of_shape = (np.minimum(first * growth, most) for first, most in (FREQUENCY, SHAPE))
    parts = [shapes.T @ full.forces, (full.charges @ shapes).T, shapes.T @ full.line_load, (full.tip @ shapes).T]
    parts.append((full.strain @ shapes).T)
    parts[:2] = (_shifted(part, of_shape, generator) for part in parts[:2])
    rows = np.hstack(parts)
    mistaken = omega * (1.0 + of_frequency * generator.uniform(-1.0, 1.0, r))
    further = _further(omega, np.pi / blade.config.control_interval, generator)
    alike = generator.integers(r // 2, r, len(further))  # of a further mode: one of the known upper half, with other signs
    like = rows[alike]
    rows = np.vstack([rows, like * generator.choice([-1.0, 1.0], like.shape)])
    every = np.append(mistaken, further)
    gyroscopic = np.zeros((len(every), len(every)))
    gyroscopic[:r, :r] = modal.gyroscopic
    order = np.argsort(every)
    actuation, charges, line_load, tip, strain = np.split(rows[order], np.cumsum([part.shape[1] for part in parts])[:-1], axis=1)
    return ModalPlant(
        natural_frequencies=every[order],
        gyroscopic=gyroscopic[np.ix_(order, order)],
        actuation=actuation,
        charges=charges.T,
        line_load=line_load,
        tip=tip.T,
        strain=strain.T,
        **further_signals(blade, np.hstack([shapes, shapes[:, alike]])[:, order]),
    )


def _further(omega: Array, nyquist: float, generator: np.random.Generator) -> Array:
    """Natural frequencies beyond the last, rad/s."""
    last, spacing = float(omega[-1]), float(omega[-1]) / len(omega)
    count = min(int(max(nyquist - last, 0.0) / spacing), max(MOST - len(omega), 0))
    return np.sort(generator.uniform(last, last + count * spacing, count))


def _shifted(rows: Array, error: Array, generator: np.random.Generator) -> Array:
    """(r, k) with errors relative to the root mean square of each row."""
    size = np.sqrt(np.mean(rows**2, axis=1))
    return np.asarray(rows + (error * size)[:, None] * generator.standard_normal(rows.shape))
