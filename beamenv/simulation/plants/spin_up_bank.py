"""The bank of a spin-up: a plant for every control interval, and the vibration that the spin-up itself excites.

x is the state of the blade about its moving equilibrium (``spin_up``), in energy coordinates at every instant: x = [Uᵀη; η̇] with
K = U Uᵀ and M = 1. J, sensors (patches' amplifiers do not pass so slow a drift; what others show of the moving equilibrium is taken
off) and strain mean x, as at constant speed. The plant of an interval is that of the speed at its middle, held over the interval.
The static share of modes that are left out is that of the configured speed.

Speed follows a cycloid, Ω = Ω₀ + ΔΩ (τ − sin(2πτ)/2π) with τ = t/T: Ω̇ and Ω̈ are zero at both ends, but the moving equilibrium
is not at rest at t = 0⁺, where the blade still stands in the steady state of Ω₀. The difference is the vibration that the start
excites.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields, replace

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.configuration import Refused
from beamenv.configuration.memory import check_room
from beamenv.configuration.read_only import sealed
from beamenv.plant.plant import Plant
from beamenv.plant.reduction import acting_on_velocities, on_velocities
from beamenv.sensors.readings import outputs, static_feedthrough
from beamenv.simulation.plants.bank import BY_PLANT, Bank
from beamenv.simulation.plants.coordinates import coordinates, widened
from beamenv.simulation.plants.spin_up import SpinUp
from beamenv.structure.geometrically_exact.sections_along import between

Array = NDArray[np.float64]


SHORT_COURSE = 48
"""Plants of a spin-up that are all worked out; of more, as many as the others can be told from."""

AGREED = 1e-10
"""Largest difference, over the largest number, between a plant that is told from others and the same worked out."""

AT_ONCE = 256
"""Plants whose coordinates are turned together: as many more than the bank's own as are held in memory at a time."""


def spin_up_bank(blade: Blade, design: Blade, spin_up: SpinUp, steps: int) -> Bank:
    """One plant for each of ``steps`` control intervals.

    What a step needs is a smooth function of time. It is worked out for few intervals, at Chebyshev points of the episode: as many
    as it takes for the polynomial through them to give others within ``AGREED``.
    """
    check_room("duration", steps, _bytes_each(blade, design), "control intervals of a spin-up")
    times: Array = blade.config.control_interval * (np.arange(steps, dtype=np.float64) + 0.5)
    told = _told_from_few(lambda at: _worked_out(blade, design, spin_up, at), times)
    whole: Bank | None = None
    for first in range(0, steps, AT_ONCE):
        rows = times[first : first + AT_ONCE + 1]  # the axes of the one after are those that the last leads to
        part = told(rows)
        if whole is None:
            root = _root(spin_up.stiffness(np.zeros(1)))[0]
            part = replace(part, start=_initial_state(spin_up, root, len(blade.truth.A))[None])
        part = replace(part, speeds=spin_up.course.speed(rows), runs=True).in_cost_axes()
        whole = _room_for(part, steps) if whole is None else whole
        _put(whole, part, first, min(AT_ONCE, steps - first))
    assert whole is not None
    for values in _parts(whole).values():
        sealed(values)
    return replace(whole)


def _bytes_each(blade: Blade, design: Blade) -> int:
    """Of one plant of a spin-up."""
    n, (k, m) = len(blade.truth.A), (len(blade.truth.strain), blade.truth.B.shape[1])
    return 8 * n * (3 * n + k + 2 * m + len(design.plant.A))


def _worked_out(blade: Blade, design: Blade, spin_up: SpinUp, middles: Array) -> Bank:
    """The bank of intervals around times (K,), s, from the energy coordinates at the beginning of each to those at its end."""
    reference, half = blade.truth, 0.5 * blade.config.control_interval
    try:
        before, mid, after = (_root(spin_up.stiffness(middles + shift)) for shift in (-half, 0.0, half))  # K = U Uᵀ, x = [Uᵀη; η̇]
    except np.linalg.LinAlgError:
        course = [spin_up.course.first, spin_up.course.last]
        raise Refused("scenario.plants.spin_up", course, "speeds between which the blade keeps its stiffness (rad/s)") from None
    n = len(reference.A)
    plants = [plant_at(blade, spin_up, time, mid[k]) for k, time in enumerate(middles.tolist())]
    bank = Bank.gather(reference, plants, spin_up.course.speed(middles), None)
    incoming, outgoing = _changes(before, mid, n), _changes(mid, after, n)
    back = incoming.swapaxes(1, 2)
    return replace(
        bank,
        operators=replace(bank.operators, fused=sealed(_at_instants(bank.operators.fused, incoming, outgoing))),
        readout=sealed(back @ bank.readout),
        tip=sealed(back @ bank.tip),
        strain=sealed(bank.strain @ incoming),
        release=np.asarray(np.linalg.solve(incoming, bank.release.swapaxes(1, 2)), dtype=np.float64).swapaxes(1, 2),
        to_design=_views(blade, design, spin_up.shapes(middles - half), before, n),
    )


def _told_from_few(worked_out: Callable[[Array], Bank], times: Array) -> Callable[[Array], Bank]:
    """What gives the bank at any of the ascending times as ``worked_out`` does."""
    middle, half, nodes = 0.5 * (times[-1] + times[0]), 0.5 * (times[-1] - times[0]), SHORT_COURSE
    while nodes < len(times):
        places = chebyshev.chebpts1(nodes)
        few = worked_out(middle + half * places)

        def told(at: Array, places: Array = places, few: Bank = few) -> Bank:
            return _mixed(few, between(places, (at - middle) / half))

        shown = times[[1, len(times) // 3, -2]]  # where a polynomial is worst, and where it is good
        if _differ(worked_out(shown), told(shown)) <= AGREED:
            return told
        nodes *= 2
    return worked_out


def _mixed(few: Bank, weights: Array) -> Bank:
    """(K) plants that are sums of few, with weights (K, n)."""

    def sums(values: Array) -> Array:
        return sealed((weights @ values.reshape(len(values), -1)).reshape(len(weights), *values.shape[1:]))

    return replace(
        few,
        operators=replace(few.operators, fused=sums(few.operators.fused), weights=sums(few.operators.weights)),
        to_design=None if few.to_design is None else sums(few.to_design),
        **{name: sums(getattr(few, name)) for name in BY_PLANT},  # type: ignore[arg-type]
    )


def _parts(bank: Bank) -> dict[str, Array]:
    """Its arrays that have a row for each plant."""
    view = {} if bank.to_design is None else {"to_design": bank.to_design}
    own = {name: getattr(bank, name) for name in BY_PLANT}
    return {**own, **view, "fused": bank.operators.fused, "weights": bank.operators.weights}


def _differ(one: Bank, other: Bank) -> float:
    """The largest difference of two banks, part by part over the largest number."""
    pairs = zip(_parts(one).values(), _parts(other).values(), strict=True)
    return max(float(np.abs(a - b).max(initial=0.0) / max(np.abs(a).max(initial=0.0), 1e-300)) for a, b in pairs)


def _room_for(part: Bank, steps: int) -> Bank:
    """A bank of as many plants, like a part of it, that are still to be put in."""
    whole = {name: np.empty((steps, *values.shape[1:])) for name, values in _parts(part).items()}
    operators = replace(part.operators, fused=whole.pop("fused"), weights=whole.pop("weights"))
    empty = object.__new__(Bank)
    for each in fields(Bank):  # made without its constructor, which would seal it
        object.__setattr__(empty, each.name, {**whole, "operators": operators}.get(each.name, getattr(part, each.name)))
    return empty


def _put(whole: Bank, part: Bank, first: int, count: int) -> None:
    for name, values in _parts(part).items():
        _parts(whole)[name][first : first + count] = values[:count]


def _root(stiffness: Array) -> Array:
    return np.asarray(np.linalg.cholesky(stiffness), dtype=np.float64)


def plant_at(blade: Blade, spin_up: SpinUp, time: float, root: Array) -> Plant:
    """The plant at one time in energy coordinates [Uᵀη; η̇], U = ``root``; the electronics are those of any time."""
    at, full, none = np.asarray(time), blade.full, np.zeros_like(root)
    inverse: Array = np.linalg.inv(root).astype(np.float64)
    shapes, patches = spin_up.shapes(at), spin_up.patches(at)
    forces, charges, strained = (
        (shapes.T @ full.forces, full.charges @ shapes, full.strain @ shapes) if patches is None else patches
    )
    moves = {
        "A": np.block([[none, root.T], [-spin_up.restoring(at) @ inverse.T, -spin_up.rate_matrix(at)]]),
        "B": acting_on_velocities(forces),
        "disturbance_input": acting_on_velocities(shapes.T @ blade.all_loads),
        "tip_displacement": _on_displacements(full.tip @ shapes, inverse),
        "strain": _on_displacements(strained, inverse),
    }
    readings = spin_up.readings(at)
    if readings is None:
        shows, through = {"C": on_velocities(charges)}, None
    else:
        shows, through = _shown(blade, (readings[0] @ inverse.T, *readings[1:]), moves)
    plant = replace(blade.bare_truth, **{name: sealed(part) for name, part in (moves | shows).items()})  # type: ignore[arg-type]
    return blade.behind_electronics(plant, through)


def _on_displacements(rows: Array, inverse: Array) -> Array:
    return np.asarray(np.hstack([rows @ inverse.T, np.zeros_like(rows)]))


def _shown(blade: Blade, readings: tuple[Array, Array, Array], moves: dict[str, Array]) -> tuple[dict[str, Array], Array]:
    """C and D of sensors that are listed, and F (p, k), what they show of loads at once."""
    (displaced, rate, acceleration), rows = readings, blade.sensor_rows
    assert rows is not None
    accelerated = on_velocities(acceleration)
    static = static_feedthrough(rows, blade.true_modal, blade.full.forces)
    shows = {"C": outputs(displaced, rate, accelerated, moves["A"]), "D": accelerated @ moves["B"] + static}
    return shows, accelerated @ moves["disturbance_input"] + blade.with_base(rows)


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


def _initial_state(spin_up: SpinUp, root: Array, states: int) -> Array:
    displaced, moving = spin_up.initial_vibration()
    return np.concatenate([root.T @ displaced, moving, np.zeros(states - 2 * len(root))])


def _views(blade: Blade, design: Blade, shapes: Array, roots: Array, states: int) -> Array | None:
    """(K, n, d): states at the begin of each interval, of ``shapes`` (K, N, r), in the design blade's coordinates."""
    if blade.beam.space != design.beam.space:
        return None
    views = [coordinates(now @ np.linalg.inv(root).T, now, design) for now, root in zip(shapes, roots, strict=True)]
    return widened(np.stack(views), states)
