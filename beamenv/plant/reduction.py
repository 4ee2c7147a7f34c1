"""From blades with patches to reduced plants (thesis §5.3, corrected): modal truncation in energy coordinates.

What reduces is written for any number of blades at once, with leading axes "…"; one blade has none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

from beamenv.configuration import Count, Refused, checked
from beamenv.configuration.read_only import ReadOnly
from beamenv.patches import PatchLayout, PatchResponse, actuation, local_response, sensing
from beamenv.plant.plant import Plant
from beamenv.plant.signals import REFERENCE_LOAD
from beamenv.structure import RotatingBeam
from beamenv.structure.modes import normal_modes
from beamenv.structure.steady_deformation import AT_CLAMP, INTERVALS, STILL, SteadyDeformation, deformed, face_strain

Array = NDArray[np.float64]

FULL_SCALE_MARGIN = 2.0
"""Sensor full scale over the undriven blade's largest current after a sudden reference load: resonance exceeds a step."""

MOST_SAMPLES = 20_000
"""Instants at which the largest current is looked for; 337 on the default blade. Slower blades are looked at less often."""

DIGITS = 1e3
"""A first mode's squared frequency over what rounding may have made of it, at least: near the critical speed nothing is left."""

SAME_PATCH_REGULARISATION = 1e-6
"""Share of the mean diagonal added to R, so that it stays positive definite where actuators coincide."""


@dataclass(frozen=True, slots=True, eq=False)
class ModalModel(ReadOnly):
    """The first r undamped modes without gyroscopic coupling, at one speed."""

    natural_frequencies: Array
    """(…, r), rad/s."""
    mode_shapes: Array
    """Ψ (…, N, r), ΨᵀMΨ = I."""
    gyroscopic: Array
    """ΨᵀGΨ (…, r, r), 1/s."""

    def first(self, count: int) -> ModalModel:
        """Its first modes alone."""
        return ModalModel(
            self.natural_frequencies[..., :count], self.mode_shapes[..., :count], self.gyroscopic[..., :count, :count]
        )


def truncate(beam: RotatingBeam, speed: float, modes: int, gyroscopic: bool = True) -> ModalModel:
    """The modal model of a blade; ``ValueError`` at or beyond the critical speed, where the steady
    state is unstable, or for more modes than trial functions.
    """
    if not (np.isfinite(speed) and 0.0 <= speed < beam.critical_speed):
        raise Refused("speed", float(speed), f"at least 0 and below the critical speed, {beam.critical_speed:.6g} rad/s")
    modes = checked("blade.modes", modes, Count(1, beam.space.size))  # so many trial functions
    point = beam.at(speed)
    frequencies, shapes = normal_modes(point.mass, point.stiffness, modes)
    if not frequencies[0] ** 2 > DIGITS * _rounding(point.stiffness, shapes[:, 0]):
        raise Refused("speed", float(speed), "one at which the blade's steady state is stable by more than rounding (rad/s)")
    coupling = shapes.T @ point.gyroscopic @ shapes if gyroscopic else np.zeros((modes, modes))
    return ModalModel(frequencies, shapes, coupling)


def _rounding(stiffness: Array, shape: Array) -> float:
    """What rounding may have made of a mode's squared frequency, (rad/s)²."""
    return float(np.finfo(np.float64).eps * (np.abs(shape) @ np.abs(stiffness) @ np.abs(shape)))


STRAIN_STATIONS = (AT_CLAMP, 0.025, 0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
"""Of the span: where strains are watched, some of the places of ``face_strain``; close together towards the clamp, which puts the
largest strains of balanced plies at a little distance from it. Of boxes of the thesis' proportions the largest strain of each of
the first eleven modes is then watched within 6.5 %, mostly 3 %, and the steady state's, which `info` tells, within 0.2 %. Modes in
which the walls of a shorter box bend may have twice the strain elsewhere."""


def surface_strain(beam: RotatingBeam, speed: float) -> Array:
    """(k, N): spanwise strain at the outer face of every wall point, at each of ``STRAIN_STATIONS``."""
    rows = beam.surface_strain(beam.length * np.array(STRAIN_STATIONS), speed)
    return rows.reshape(-1, rows.shape[-1])


@dataclass(frozen=True, slots=True, eq=False)
class FullModel(ReadOnly):
    """What acts on a blade that turns at one speed and what is seen of it, by its N trial functions."""

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
    steady_strain: Array
    """(k,): what the steady state strains the blade there; zero in the thesis' model."""
    steady: SteadyDeformation
    response: PatchResponse
    """Of the patches on the blade at rest; in the thesis' model FᵀK⁻¹F and C_s K⁻¹F at the speed, by the trial functions."""


def full_model(beam: RotatingBeam, layout: PatchLayout, speed: float, at_rest: PatchResponse | None = None) -> FullModel:
    """That of a blade which carries the inlays of passive patches, at a speed in rad/s; ``at_rest`` is its ``local_response``, if
    that is known already.
    """
    tip = beam.displacements(np.array([beam.length]))
    forces, charges = actuation(beam, layout, speed), sensing(beam, layout, speed)
    if beam.model == "thesis":
        static = np.linalg.solve(beam.at(speed).stiffness, forces)
        response = PatchResponse(forces.T @ static, charges @ static, charges @ static)
    else:
        response = local_response(beam, layout) if at_rest is None else at_rest
    steady, steady_strain = steady_and_strain(beam, speed)
    return FullModel(
        forces=forces,
        charges=charges,
        line_load=beam.line_load(),
        tip=np.vstack([tip["u"], tip["v"]]),
        strain=surface_strain(beam, speed),
        steady_strain=steady_strain,
        steady=steady,
        response=response,
    )


def steady_and_strain(beam: RotatingBeam, speed: float) -> tuple[SteadyDeformation, Array]:
    """What the steady state at a speed in rad/s does to a blade, and its strains (k,) where those of vibration are watched."""
    if beam.model == "thesis":
        return STILL, np.zeros(len(surface_strain(beam, speed)))
    strain = face_strain(beam, speed)
    watched = [round(INTERVALS * share) for share in STRAIN_STATIONS]
    return deformed(beam, speed, strain), strain[watched].ravel()


@dataclass(frozen=True, slots=True, eq=False)
class ReducedBlades:
    """Blades in energy coordinates x = [ω η; η̇]: what ``Plant`` calls A, R, B, C and E."""

    dynamics: Array
    """A (…, 2r, 2r), 1/s."""
    natural_frequencies: Array
    """(…, r), rad/s."""
    input: Array
    """B (…, 2r, m), √J/s per V."""
    input_weight: Array
    """R (…, m, m), J/V²: effort_weight FᵀK⁻¹F."""
    output: Array
    """C (…, p, 2r), A per √J."""
    disturbance_input: Array
    """E (…, 2r, 2), √J/s per N/m."""


def in_modes(
    modal: ModalModel,
    *,
    forces: Array,
    charges: Array,
    line_load: Array,
    stored_energy: Array,
    damping_ratio: float | Array,
    effort_weight: float,
) -> ReducedBlades:
    """Blades in given modes, from forces F (…, N, m), charges (…, p, N), loads (…, N, 2) and FᵀK⁻¹F (…, m, m)."""
    shapes, frequency = modal.mode_shapes, diagonal(modal.natural_frequencies)
    across = shapes.swapaxes(-1, -2)
    return ReducedBlades(
        dynamics=first_order(frequency, modal.gyroscopic + 2.0 * damping_ratio * frequency),
        natural_frequencies=modal.natural_frequencies,
        input=acting_on_velocities(across @ forces),
        input_weight=effort_weight * regularised(stored_energy),
        output=on_velocities(charges @ shapes),
        disturbance_input=acting_on_velocities(across @ line_load),
    )


def reduced_plant(
    modal: ModalModel,
    full: FullModel,
    *,
    damping_ratio: float | Array,
    effort_weight: float,
    white_load: float,
    sensor_noise_fraction: float,
    sensor_full_scale: float | Array | None,
    voltage_limits: tuple[float, float],
    control_interval: float,
    reference_load: float = REFERENCE_LOAD,
) -> Plant:
    """The plant of one blade; arguments as in ``BladeConfig``, and ``reference_load`` in N/m as in ``Plant``.

    The damping ratio may be one of each mode (r,).
    """
    forces, omega, shapes = full.forces, modal.natural_frequencies, modal.mode_shapes
    blade = in_modes(
        modal,
        forces=forces,
        charges=full.charges,
        line_load=full.line_load,
        stored_energy=full.response.energy,
        damping_ratio=damping_ratio,
        effort_weight=effort_weight,
    )
    if sensor_full_scale is None:
        sensor_full_scale = largest_current(blade, control_interval, reference_load)
    full_scale = np.broadcast_to(np.asarray(sensor_full_scale, dtype=np.float64), (len(blade.output),)).copy()
    return Plant(
        A=blade.dynamics,
        B=blade.input,
        C=blade.output,
        D=np.zeros((len(blade.output), forces.shape[1])),
        disturbance_input=blade.disturbance_input,
        tip_displacement=on_displacements(full.tip @ shapes, omega),
        strain=on_displacements(full.strain @ shapes, omega),
        natural_frequencies=omega,
        state_weight=0.5 * np.eye(2 * len(omega)),
        input_weight=blade.input_weight,
        process_noise=(white_load * (reference_load / REFERENCE_LOAD)) ** 2 * control_interval * np.eye(2),
        sensor_noise=np.diag((sensor_noise_fraction * full_scale) ** 2) * control_interval,
        voltage_limits=np.repeat(np.asarray(voltage_limits, dtype=float)[:, None], forces.shape[1], axis=1),
        sensor_full_scale=full_scale,
        control_interval=control_interval,
        reference_load=np.full(2, reference_load),
    )


def first_order(frequency: Array, damping: Array) -> Array:
    """A = [[0, Ω], [−Ω, −D]] (…, 2r, 2r) in energy coordinates."""
    above = np.concatenate([np.zeros_like(frequency), frequency], axis=-1)
    below = np.concatenate([-frequency, -np.broadcast_to(damping, frequency.shape)], axis=-1)
    return np.concatenate([above, below], axis=-2)


def acting_on_velocities(modal_force: Array) -> Array:
    """[0; ΨᵀF] (…, 2r, m): a force enters the velocity half of the state."""
    return np.concatenate([np.zeros_like(modal_force), modal_force], axis=-2)


def on_velocities(modal_rows: Array) -> Array:
    """[0, CΨ] (…, p, 2r): rows that read the modal velocities."""
    return np.concatenate([np.zeros_like(modal_rows), modal_rows], axis=-1)


def on_displacements(modal_rows: Array, omega: Array) -> Array:
    """[CΨ/ω, 0] (p, 2r): rows that read the modal displacements from ωη."""
    return np.hstack([modal_rows / omega, np.zeros_like(modal_rows)])


def diagonal(values: Array) -> Array:
    """Diagonal matrices (…, r, r)."""
    return values[..., None] * np.eye(values.shape[-1])


def regularised(stored_energy: Array) -> Array:
    """FᵀK⁻¹F (…, m, m), J/V², twice the energy that actuators store in the blade at rest (in place of Eq. 5.9), symmetric and
    positive definite even where actuators coincide.
    """
    size = stored_energy.shape[-1]
    share = SAME_PATCH_REGULARISATION * np.trace(stored_energy, axis1=-2, axis2=-1) / size
    return 0.5 * (stored_energy + stored_energy.swapaxes(-1, -2)) + share[..., None, None] * np.eye(size)


def largest_current(blade: ReducedBlades, interval: float, reference_load: float = REFERENCE_LOAD) -> float:
    """Sensor full scale (A): margin times the largest current in five periods after a sudden reference load in lag or in flap."""
    steps = int(np.ceil(5 * 2.0 * np.pi / blade.natural_frequencies[0] / interval))
    every = -(-steps // MOST_SAMPLES)
    transition = expm(blade.dynamics * (every * interval))
    displaced = -np.linalg.solve(blade.dynamics, reference_load * blade.disturbance_input)
    offset, largest = -displaced, 0.0
    for _ in range(-(-steps // every)):
        offset = transition @ offset
        largest = max(largest, float(np.abs(blade.output @ offset).max()))
    return FULL_SCALE_MARGIN * largest
