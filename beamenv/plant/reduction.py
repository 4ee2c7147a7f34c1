"""From a blade with patches to the reduced plant (thesis §5.3, corrected): modal truncation in energy coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from beamenv.patches import PatchLayout, actuation, sensing
from beamenv.plant.plant import Plant
from beamenv.plant.read_only import ReadOnly
from beamenv.structure import RotatingBeam
from beamenv.structure.modes import normal_modes

Array = NDArray[np.float64]

REFERENCE_LOAD = 30.0
"""N/m of uniform line load: with it LQG saturates now and then, and damps what follows within half an episode."""

FULL_SCALE_MARGIN = 2.0
"""Sensor full scale over the undriven blade's largest current after a sudden reference load: resonance exceeds a step."""

SAME_PATCH_REGULARISATION = 1e-6
"""Share of the mean diagonal added to R, so that it stays positive definite where actuators coincide."""


@dataclass(frozen=True, slots=True, eq=False)
class ModalModel(ReadOnly):
    """The first r undamped modes without gyroscopic coupling, at one speed."""

    natural_frequencies: Array
    """(r,), rad/s."""
    mode_shapes: Array
    """Ψ (N, r), ΨᵀMΨ = I."""
    gyroscopic: Array
    """ΨᵀGΨ (r, r), 1/s."""


@lru_cache(maxsize=16)
def truncate(beam: RotatingBeam, speed: float, modes: int, gyroscopic: bool = True) -> ModalModel:
    """The modal model of a blade; ``ValueError`` at or beyond the critical speed or for more modes than trial functions."""
    if not (np.isfinite(speed) and 0.0 <= speed < beam.critical_speed):
        raise ValueError(
            f"speed = {float(speed)!r} rad/s must be at least 0 and below the critical speed, {beam.critical_speed:.6g} rad/s."
        )
    if not (isinstance(modes, (int, np.integer)) and 1 <= modes <= beam.space.size):
        raise ValueError(f"modes = {modes!r} must be an integer from 1 to {beam.space.size}, the number of trial functions.")
    matrices = beam.matrices
    frequencies, shapes = normal_modes(matrices.mass, matrices.stiffness(speed), modes)
    coupling = speed * shapes.T @ matrices.gyroscopic @ shapes if gyroscopic else np.zeros((modes, modes))
    return ModalModel(frequencies, shapes, coupling)


def stored_energy_weight(beam: RotatingBeam, speed: float, forces: Array) -> Array:
    """Fᵀ K⁻¹ F (m, m), J/V²: twice the energy the actuators store in the blade at rest (in place of Eq. 5.9)."""
    weight = forces.T @ np.linalg.solve(beam.matrices.stiffness(speed), forces)
    regularised = weight + SAME_PATCH_REGULARISATION * np.trace(weight) / len(weight) * np.eye(len(weight))
    return 0.5 * (regularised + regularised.T)


def surface_strain(beam: RotatingBeam) -> Array:
    """(k, N): spanwise strain at the outer face of every wall point, at the root and at each quarter of the span."""
    rows = beam.surface_strain(beam.length * np.array([1e-6, 0.25, 0.5, 0.75]))
    return rows.reshape(-1, rows.shape[-1])


@dataclass(frozen=True, slots=True, eq=False)
class FullModel(ReadOnly):
    """What acts on a blade and what is seen of it, by its N trial functions: the same at any speed."""

    forces: Array
    """F (N, m), per V."""
    charges: Array
    """C_s (p, N), C."""
    line_load: Array
    """P (N, 2), per N/m: lag, flap."""
    tip: Array
    """(2, N), m: lag, flap."""
    strain: Array
    """(k, N)."""


@lru_cache(maxsize=8)
def full_model(beam: RotatingBeam, layout: PatchLayout) -> FullModel:
    """That of a blade which carries the inlays of passive patches."""
    tip = beam.displacements(np.array([beam.length]))
    return FullModel(
        forces=actuation(beam, layout),
        charges=sensing(beam, layout),
        line_load=beam.line_load(),
        tip=np.vstack([tip["u"], tip["v"]]),
        strain=surface_strain(beam),
    )


def reduced_plant(
    beam: RotatingBeam,
    layout: PatchLayout,
    *,
    speed: float,
    modes: int,
    damping_ratio: float,
    gyroscopic: bool,
    effort_weight: float,
    white_load: float,
    sensor_noise_fraction: float,
    sensor_full_scale: float | None,
    voltage_limits: tuple[float, float],
    control_interval: float,
) -> Plant:
    """The plant of a blade, which carries the inlays of passive patches; arguments as in the blade's configuration."""
    modal, full = truncate(beam, speed, modes, gyroscopic), full_model(beam, layout)
    omega, shapes, forces = modal.natural_frequencies, modal.mode_shapes, full.forces
    still = np.zeros((modes, modes))
    damping = modal.gyroscopic + np.diag(2.0 * damping_ratio * omega)
    dynamics = np.block([[still, np.diag(omega)], [-np.diag(omega), -damping]])
    currents = on_velocities(full.charges @ shapes)
    disturbance = acting_on_velocities(shapes.T @ full.line_load)
    if sensor_full_scale is None:
        sensor_full_scale = largest_current(dynamics, disturbance, currents, omega[0], control_interval)
    full_scale = np.full(len(currents), sensor_full_scale)
    return Plant(
        A=dynamics,
        B=acting_on_velocities(shapes.T @ forces),
        C=currents,
        D=np.zeros((len(currents), forces.shape[1])),
        disturbance_input=disturbance,
        tip_displacement=on_displacements(full.tip @ shapes, omega),
        strain=on_displacements(full.strain @ shapes, omega),
        natural_frequencies=omega,
        state_weight=0.5 * np.eye(2 * modes),
        input_weight=effort_weight * stored_energy_weight(beam, speed, forces),
        process_noise=white_load**2 * control_interval * np.eye(2),
        sensor_noise=np.diag((sensor_noise_fraction * full_scale) ** 2) * control_interval,
        voltage_limits=np.repeat(np.asarray(voltage_limits, dtype=float)[:, None], forces.shape[1], axis=1),
        sensor_full_scale=full_scale,
        control_interval=control_interval,
    )


def acting_on_velocities(modal_force: Array) -> Array:
    """[0; ΨᵀF] (2r, m): a force enters the velocity half of the state."""
    return np.vstack([np.zeros_like(modal_force), modal_force])


def on_velocities(modal_rows: Array) -> Array:
    """[0, CΨ] (p, 2r): rows that read the modal velocities."""
    return np.hstack([np.zeros_like(modal_rows), modal_rows])


def on_displacements(modal_rows: Array, omega: Array) -> Array:
    """[CΨ/ω, 0] (p, 2r): rows that read the modal displacements from ωη."""
    return np.hstack([modal_rows / omega, np.zeros_like(modal_rows)])


def largest_current(dynamics: Array, disturbance: Array, currents: Array, lowest_frequency: float, interval: float) -> float:
    """Sensor full scale (A): margin times the largest current in five periods after a sudden reference load in lag or in flap."""
    steps = int(np.ceil(5 * 2.0 * np.pi / lowest_frequency / interval))
    transition = expm(dynamics * interval)
    displaced = -np.linalg.solve(dynamics, REFERENCE_LOAD * disturbance)
    offset, largest = -displaced, 0.0
    for _ in range(steps):
        offset = transition @ offset
        largest = max(largest, float(np.abs(currents @ offset).max()))
    return FULL_SCALE_MARGIN * largest
