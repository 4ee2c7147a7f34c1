"""The bank of a run-up: a plant for every control interval, and the vibration that the run-up itself excites.

x is the state of the blade about its moving equilibrium (``run_up``), in energy coordinates at every instant: x = [Uᵀη; η̇] with
K = U Uᵀ and M = 1. J, sensors (whose amplifiers do not pass so slow a drift) and strain mean x, as at constant speed. The plant of
an interval is that of the speed at its middle, held over the interval. The static share of modes that are left out is that of the
configured speed.

Speed follows a cycloid, Ω = Ω₀ + ΔΩ (τ − sin(2πτ)/2π) with τ = t/T: Ω̇ and Ω̈ are zero at both ends, but the moving equilibrium
is not at rest at t = 0⁺, where the blade still stands in the steady state of Ω₀. The difference is the vibration that the start
excites.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.configuration.read_only import sealed
from beamenv.plant.plant import Plant
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.coordinates import coordinates, widened
from beamenv.simulation.plants.run_up import RunUp

Array = NDArray[np.float64]


def spin_up_bank(blade: Blade, design: Blade, run_up: RunUp, steps: int) -> Bank:
    """One plant for each of ``steps`` control intervals."""
    reference, interval = blade.truth, blade.config.control_interval
    edges: Array = interval * np.arange(steps + 1, dtype=np.float64)
    middles: Array = edges[:-1] + 0.5 * interval
    roots, mid_roots = _root(run_up.stiffness(edges)), _root(run_up.stiffness(middles))  # K = U Uᵀ, x = [Uᵀη; η̇]
    inverses = _inverses(blade)
    plants = [plant_at(blade, run_up, time, mid_roots[k], inverses) for k, time in enumerate(middles.tolist())]
    bank = Bank.gather(reference, plants, run_up.course.speed(middles), None)
    n = len(reference.A)
    incoming, outgoing = _changes(roots[:-1], mid_roots, n), _changes(mid_roots, roots[1:], n)
    back = incoming.swapaxes(1, 2)
    return replace(
        bank,
        operators=replace(bank.operators, fused=sealed(_at_instants(bank.operators.fused, incoming, outgoing))),
        readout=sealed(back @ bank.readout),
        tip=sealed(back @ bank.tip),
        strain=sealed(bank.strain @ incoming),
        release=np.asarray(np.linalg.solve(incoming, bank.release.swapaxes(1, 2)), dtype=np.float64).swapaxes(1, 2),
        start=_initial_state(run_up, roots[0], n)[None],
        runs=True,
        to_design=_views(blade, design, run_up.shapes(edges[:-1]), roots[:-1], n),
    ).in_cost_axes()


def _root(stiffness: Array) -> Array:
    return np.asarray(np.linalg.cholesky(stiffness), dtype=np.float64)


def _inverses(blade: Blade) -> tuple[Array, Array]:
    """(m, r) and (r, p): of the modal forces and charges at the configured speed."""
    shapes = blade.true_modal.mode_shapes
    forces, charges = shapes.T @ blade.full.forces, blade.full.charges @ shapes
    return np.asarray(np.linalg.pinv(forces), dtype=np.float64), np.asarray(np.linalg.pinv(charges), dtype=np.float64)


def plant_at(blade: Blade, run_up: RunUp, time: float, root: Array, inverses: tuple[Array, Array]) -> Plant:
    """The plant at one time in energy coordinates [Uᵀη; η̇], U = ``root``; the electronics are those of any time.

    ``inverses`` say what of the plant at the configured speed reaches amplifiers and filters.
    """
    reference, at = blade.truth, np.asarray(time)
    r, b = len(root), 2 * len(root)
    inverse = np.linalg.inv(root)
    to_reference = np.eye(len(reference.A))  # energy coordinates of the configured speed from those of this one
    to_reference[:r, :r] = reference.natural_frequencies[:, None] * inverse.T
    A, B, C = (np.array(each) for each in (reference.A @ to_reference, reference.B, reference.C @ to_reference))
    tip, strain = (np.array(rows @ to_reference) for rows in (reference.tip_displacement, reference.strain))
    loads = np.array(reference.disturbance_input)
    patches = run_up.patches(at)
    if patches is not None:
        (forces, charges, strained), (drive, sense) = patches, inverses
        A[r:b, b:], B[r:b] = (forces @ (drive @ each) for each in (reference.A[r:b, b:], reference.B[r:b]))
        A[b:, r:b], C[:, r:b] = (each @ sense @ charges for each in (reference.A[b:, r:b], reference.C[:, r:b]))
        shapes = run_up.shapes(at)
        strain[:, :r], tip[:, :r] = strained @ inverse.T, blade.full.tip @ shapes @ inverse.T
        loads[r:b] = shapes.T @ blade.full.line_load
    A[:b, :b] = 0.0
    A[:r, r:b] = root.T
    A[r:b, :r], A[r:b, r:b] = -run_up.restoring(at) @ inverse.T, -run_up.rate_matrix(at)
    return replace(
        reference,
        A=sealed(A),
        B=sealed(B),
        C=sealed(C),
        disturbance_input=sealed(loads),
        tip_displacement=sealed(tip),
        strain=sealed(strain),
    )


def _changes(before: Array, after: Array, states: int) -> Array:
    """(K, n, n): energy coordinates of one root from those of another, x' = T x."""
    r = before.shape[-1]
    change = np.tile(np.eye(states), (len(before), 1, 1))
    change[:, :r, :r] = after.swapaxes(1, 2) @ np.linalg.inv(before).swapaxes(1, 2)
    return change


def _at_instants(fused: Array, incoming: Array, outgoing: Array) -> Array:
    """Operators (K, s, …) from the energy coordinates at each interval's begin to those at its end, from those in its middle."""
    n, size = incoming.shape[-1], fused.shape[1]
    joined = np.tile(np.eye(size), (len(fused), 1, 1))
    joined[:, :n, :n] = incoming
    moved = joined.swapaxes(1, 2) @ fused
    moved[..., :n] = moved[..., :n] @ outgoing.swapaxes(1, 2)
    moved[..., -size:] = moved[..., -size:] @ joined  # the cost
    return np.asarray(moved)


def _initial_state(run_up: RunUp, root: Array, states: int) -> Array:
    displaced, moving = run_up.initial_vibration()
    return np.concatenate([root.T @ displaced, moving, np.zeros(states - 2 * len(root))])


def _views(blade: Blade, design: Blade, shapes: Array, roots: Array, states: int) -> Array | None:
    """(K, n, d): states at the begin of each interval, of ``shapes`` (K, N, r), in the design blade's coordinates."""
    if blade.beam.space != design.beam.space:
        return None
    views = [coordinates(now @ np.linalg.inv(root).T, now, design) for now, root in zip(shapes, roots, strict=True)]
    return widened(np.stack(views), states)
