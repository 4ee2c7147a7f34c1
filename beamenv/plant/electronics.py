"""A plant behind its amplifiers and its data acquisition: what stands between a controller's numbers and the blade.

    v̇ = a (u − v),        ẋ = A x + B v + E d,        i = C x + C_r v̇,        ẇ = F w + G i,        y = (first state of each filter)

Each voltage u passes an amplifier of one pole a; each current i passes an anti-aliasing filter. C_r is the charge per volt that the
modes left out take up, C_s K⁻¹ F less the share of those retained: they follow the voltage at once, and their current is its rate.
The tip is displaced by T_r v likewise. Where the amplifier is switched off the voltage jumps, its rate is no function, and the
charge would pass in no time: there is then no residual at all. Where the filter is switched off the residual current, over after
some 1/a, is not shown: a reading at the end of an interval has e^{−aΔt} of it, 6·10⁻¹¹ at the default. Loads are left without a
residual: the modes beyond the retained ones follow them as well, but uniform loads hardly reach these.

States are [blade; filters, sensor by sensor; amplifiers], filters in units of the sensors' full scale, amplifiers in units of the
drive limit.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration.read_only import sealed
from beamenv.plant.plant import Plant, drive_limit

Array = NDArray[np.float64]


def static_residual(static: Array, seen: Array, forces: Array, natural_frequencies: Array) -> Array:
    """(k, m) of what m voltages bring about at k places: ``static``, all of it, less the share of the r retained modes.

    ``seen`` (k, r) is what unit modal coordinates bring about, ``forces`` (r, m) the modal forces ΨᵀF per volt; frequencies (r,) in
    rad/s.
    """
    return np.asarray(static - seen @ (forces / natural_frequencies[:, None] ** 2))


def butterworth(order: int, cutoff: float) -> tuple[Array, Array]:
    """F (order, order) and G (order,) of Butterworth's filter with the −3 dB frequency ``cutoff`` (rad/s); its output is state 1.

    The poles lie on a half circle of radius ``cutoff`` (Butterworth, Experimental Wireless 7, 1930); observer form.
    """
    angles = 0.5 * np.pi * (1.0 + (2.0 * np.arange(order) + 1.0) / order)
    coefficients = np.real(np.poly(np.exp(1j * angles)))[1:]
    dynamics = np.diag(np.ones(order - 1), 1)
    dynamics[:, 0] = -coefficients
    return cutoff * dynamics, cutoff * np.eye(order)[-1]


def behind_electronics(
    plant: Plant,
    charge_residual: Array,
    tip_residual: Array,
    amplifier: float | None,
    filter_order: int,
    filter_cutoff: float | None,
    load_feedthrough: Array | None = None,
) -> Plant:
    """The plant of a blade alone with its amplifiers of the pole ``amplifier`` (rad/s) and its anti-aliasing filters, −3 dB at
    ``filter_cutoff`` (rad/s); None leaves either out. Residuals (p, m), C per V, and (2, m), m per V. ``load_feedthrough`` (p, k)
    is what enters the filters of loads at once, of accelerometers; without filters it is not shown.
    """
    through = np.zeros((len(plant.C), plant.disturbance_input.shape[1])) if load_feedthrough is None else load_feedthrough
    residual = np.zeros_like(charge_residual) if filter_cutoff is None or amplifier is None else amplifier * charge_residual
    if amplifier is not None:
        plant = _behind_amplifiers(plant, residual, tip_residual, amplifier)
    return plant if filter_cutoff is None else _behind_filters(plant, residual, through, *butterworth(filter_order, filter_cutoff))


def _behind_amplifiers(plant: Plant, residual: Array, tip_residual: Array, pole: float) -> Plant:
    """Currents are C x + C_r a (u − v): the output here is without its part of u, which an output that is sampled must not have."""
    m, drive = plant.B.shape[1], drive_limit(plant)
    return _enlarged(
        plant,
        len(plant.A),
        dynamics=np.block([[plant.A, plant.B * drive], [np.zeros((m, len(plant.A))), -pole * np.eye(m)]]),
        inputs=np.vstack([np.zeros_like(plant.B), pole * np.diag(1.0 / drive)]),
        outputs=np.hstack([plant.C, (plant.D - residual) * drive]),
        tip=tip_residual * drive,
        loads=np.zeros((m, plant.disturbance_input.shape[1])),
    )


def _behind_filters(plant: Plant, residual: Array, through: Array, dynamics: Array, gain: Array) -> Plant:
    n, p, order, b = len(plant.A), len(plant.C), len(gain), plant.blade_states
    full_scale = plant.sensor_full_scale
    entered = np.kron(np.diag(1.0 / full_scale), gain[:, None])
    whole = np.block([[plant.A, np.zeros((n, p * order))], [entered @ plant.C, np.kron(np.eye(p), dynamics)]])
    shown = np.kron(np.diag(full_scale), np.eye(order)[:1])
    lying = np.concatenate([np.arange(b), np.arange(n, n + p * order), np.arange(b, n)])
    return _enlarged(
        plant,
        b,
        dynamics=whole[np.ix_(lying, lying)],
        inputs=np.vstack([plant.B, entered @ (plant.D + residual)])[lying],
        outputs=np.hstack([np.zeros_like(plant.C), shown])[:, lying],
        tip=np.zeros((len(plant.tip_displacement), p * order)),
        loads=entered @ through,
    )


def _enlarged(plant: Plant, at: int, *, dynamics: Array, inputs: Array, outputs: Array, tip: Array, loads: Array) -> Plant:
    """The plant with further states, put before its own state ``at``, that ``tip`` (2, k) is displaced by, that ``loads``
    drive and that have no cost.
    """
    more, b = len(dynamics) - len(plant.A), plant.blade_states
    weight = np.zeros_like(dynamics)
    weight[:b, :b] = plant.state_weight[:b, :b]

    def widened(rows: Array, by: Array) -> Array:
        return sealed(np.hstack([rows[:, :at], by, rows[:, at:]]))

    own = plant.disturbance_input
    return replace(
        plant,
        A=sealed(dynamics),
        B=sealed(inputs),
        C=sealed(outputs),
        D=sealed(np.zeros_like(plant.D)),
        disturbance_input=sealed(np.vstack([own[:at], loads, own[at:]])),
        tip_displacement=widened(plant.tip_displacement, tip),
        strain=widened(plant.strain, np.zeros((len(plant.strain), more))),
        state_weight=sealed(weight),
        electronic_states=plant.electronic_states + more,
    )
