"""Model-predictive control: LQG that knows, over a horizon, what the drive can give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.box_qp import BoxQP
from baselines.design.controller import Array
from baselines.design.delay import checked_delay, with_delay
from baselines.design.instruments import Instruments
from baselines.design.law import Law
from baselines.design.loop import sampled
from baselines.design.matrix import keep_matrices, rows
from baselines.design.objects import instance
from baselines.design.persistent_load import PersistentLoad, checked_persistent_load
from baselines.design.riccati import Solution
from baselines.design.verification import verified
from baselines.design.weights import weighted
from baselines.laws.lqg import compensator, sampled_design
from beamenv.configuration import Count, Numbers, Refused, checked
from beamenv.plant.plant import Plant, SampledPlant

LONGEST = 1000
"""Control intervals of a horizon that is given: half a second at 0.5 ms, an episode as it is by default."""

MOVES = 200
"""Of one plan: the time that a program takes grows as the cube of their number."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PredictiveController(Law):
    """A filter and a plan within the drive limits, for one blade or a batch.

    With y_k the measurement (A) and the memory ξ_k the state predicted for it, zero at the start of an episode,

        x̂ = ξ_k + L (y_k − clip(C ξ_k)),        ξ_{k+1} = A x̂ + B u_k,

    where C ξ is clipped at the sensors' full scale as the reading itself is. Where LQG's plan u = −K x̂, −K (A − BK) x̂, … stays
    within the limits over the whole horizon, u_k is its first move; elsewhere u_k is the first of the moves that ``program`` finds.
    """

    transition: Array
    """A (s, s)."""
    voltage_input: Array
    """B (s, m), per V."""
    output: Array
    """C (p, s), A."""
    filter_gain: Array
    """L (s, p), per A."""
    unconstrained_plan: Array
    """(m × horizon, s), V: LQG's voltages over the horizon from x̂, those of one instant together."""
    program: BoxQP
    """For the moves (V), those of one instant together."""
    program_gradient: Array
    """(m × moves, s): the program's linear term from x̂."""
    sensor_full_scale: Array
    """(p,), A: where readings clip."""

    def __post_init__(self) -> None:
        """``ValueError`` for matrices that do not fit, or a program that is none."""
        Law.__post_init__(self)
        s, p, m = rows(self.transition), *self.instruments.counts
        planned, moves = rows(self.unconstrained_plan), rows(self.program_gradient)
        keep_matrices(self, {"transition": (s, s), "voltage_input": (s, m), "output": (p, s), "filter_gain": (s, p)})
        keep_matrices(self, {"unconstrained_plan": (planned, s), "program_gradient": (moves, s), "sensor_full_scale": (p,)})
        instance("program", self.program, BoxQP, "a BoxQP of the moves")

    @property
    def solver_failures(self) -> int:
        """Decisions so far for which the solver gave up, and LQG's clipped voltage was applied instead."""
        return self.program.failures

    @property
    def order(self) -> int:
        """Numbers in a blade's memory, s."""
        return len(self.transition)

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Correct, plan, predict."""
        reading = self.instruments.read(observation)
        expected = np.clip(memory @ self.output.T, -self.sensor_full_scale, self.sensor_full_scale)
        estimate = memory + (reading - expected) @ self.filter_gain.T
        voltage = self._voltage(np.atleast_2d(estimate)).reshape(*reading.shape[:-1], -1)
        return self.instruments.drive(voltage), estimate @ self.transition.T + voltage @ self.voltage_input.T

    def _voltage(self, estimate: Array) -> Array:
        """(N, m), V, from x̂ (N, s)."""
        lowest, highest = self.instruments.voltage_limits
        plan = (estimate @ self.unconstrained_plan.T).reshape(len(estimate), -1, len(lowest))
        voltage = self.instruments.limit(plan[:, 0])
        limited = ((plan < lowest) | (plan > highest)).any(axis=(1, 2))
        if limited.any():
            move = self.program.minimise(estimate[limited] @ self.program_gradient.T)[:, : len(lowest)]
            voltage[limited] = np.where(np.isnan(move), voltage[limited], move)
        return voltage


def mpc(
    plant: Plant,
    persistent_load: PersistentLoad | None = None,
    move_blocks: Sequence[int] | None = None,
    *,
    rate_weight: float = 0.0,
    delay: int = 0,
    Q: ArrayLike | None = None,
    R: ArrayLike | None = None,
    verify: bool = True,
) -> PredictiveController:
    """Constrained model-predictive control of a design plant, with the Kalman filter of the sampled ``lqg``.

    It minimises Σ (xᵀQx + 2xᵀNu + uᵀRu) + x_hᵀPx_h over the next h intervals within the drive limits: the environment's own cost,
    sampled exactly, and beyond the horizon the cost of LQG (Scokaert and Rawlings, IEEE Trans. Automatic Control 43, 1998). As
    long as the plan meets no limit the controller is therefore LQG itself.

    The voltages are held over ``move_blocks``, in control intervals, whose sum is the horizon h, at most 1000; by default they are
    ``doubling_blocks`` of the plant. ``persistent_load`` adds a sustained load to the state, for filter and prediction alike;
    ``rate_weight`` is a price on quick changes, as in ``full_order_lqg``; voltages act ``delay`` control intervals after they are
    asked for; ``Q`` and ``R`` replace the plant's weights, as in ``lqg``. The loop without limits, LQG, is ``verified`` on
    ``plant`` unless ``verify=False``. One controller may serve several threads at once. Raises ValueError for blocks that are not
    positive whole numbers, for a delay outside 0 to 20, and as ``lqg`` does; ModuleNotFoundError without DAQP.
    """
    load = checked_persistent_load(persistent_load)
    name = "MPC" if load is None else "MPC with load estimate"
    blocks = None if move_blocks is None else _checked(move_blocks)
    delay = checked_delay(delay)
    design = sampled_design(weighted(plant, Q, R), load, rate_weight=rate_weight, delay=delay)
    return predictive(plant, name, design, delay, blocks, verify=verify)


def predictive(
    plant: Plant,
    name: str,
    design: tuple[SampledPlant, Solution, Solution],
    delay: int,
    blocks: Sequence[int] | None = None,
    *,
    verify: bool = True,
) -> PredictiveController:
    """The controller of a ``sampled_design`` of ``plant`` within the drive limits, ``verified`` with its ``delay`` unless
    ``verify=False``; its blocks are ``doubling_blocks`` unless given.
    """
    blocks = doubling_blocks(plant) if blocks is None else blocks
    held, regulated, filtered = design
    (P, K), L = regulated, filtered.gain
    verified(compensator(plant, name, held, K, L), with_delay(sampled(plant), delay), regulated, filtered, verify=verify)
    deviation, moves = _deviation(held, P, K, blocks), len(blocks)
    by_state, by_move = np.split(deviation, [len(held.A)], axis=1)
    lowest, highest = (np.tile(limit, moves) for limit in plant.voltage_limits)
    return PredictiveController(
        name=name,
        instruments=Instruments.of(plant),
        transition=held.A,
        voltage_input=held.B,
        output=held.C,
        filter_gain=L,
        unconstrained_plan=_unconstrained_plan(held, K, sum(blocks)),
        program=BoxQP(by_move.T @ by_move, lowest, highest),
        program_gradient=by_move.T @ by_state,
        sensor_full_scale=plant.sensor_full_scale,
    )


def doubling_blocks(plant: Plant) -> list[int]:
    """Control intervals that each move is held: 1, 1, 2, 2, 4, 4, 8, 8, … up to one period of the plant's slowest mode.

    The last block ends with the period. Moves soon to be made are as fine as the clock, those far off, which will be decided
    anew many times before they are made, as coarse as they are far.
    """
    left = max(1, round(2.0 * np.pi / (plant.natural_frequencies[0] * plant.control_interval)))
    blocks: list[int] = []
    while left > 0:
        blocks.append(min(2 ** (len(blocks) // 2), left))
        left -= blocks[-1]
    return blocks


def _checked(blocks: Sequence[int]) -> list[int]:
    counts = checked("move_blocks", blocks, Numbers(Count(le=LONGEST), least=1, of="counts"))
    if len(counts) > MOVES or sum(counts) > LONGEST:
        allowed = f"at most {MOVES} counts of control intervals whose sum, the horizon, is at most {LONGEST}"
        raise Refused("move_blocks", blocks, allowed)
    return list(counts)


def _deviation(held: SampledPlant, P: Array, K: Array, blocks: Sequence[int]) -> Array:
    """M (m h, s + m b) with cost over the horizon = |M [x; u]|² + xᵀPx, u the moves of b blocks.

    The square completed at every instant: xᵀQx + 2xᵀNu + uᵀRu + x⁺ᵀPx⁺ = xᵀPx + (u + Kx)ᵀ (R + BᵀPB) (u + Kx).
    """
    s, m = held.B.shape
    root = np.linalg.cholesky(held.input_weight + held.B.T @ P @ held.B).T
    state = np.eye(s, s + m * len(blocks))  # from [x; u]
    rows = []
    for block, length in enumerate(blocks):
        voltage = np.eye(m, state.shape[1], k=s + m * block)
        for _ in range(length):
            rows.append(root @ (voltage + K @ state))
            state = held.A @ state + held.B @ voltage
    return np.vstack(rows)


def _unconstrained_plan(held: SampledPlant, K: Array, horizon: int) -> Array:
    """(m horizon, s): −K, −K (A − BK), −K (A − BK)², and so on."""
    rows = [-K]
    while len(rows) < horizon:
        rows.append(rows[-1] @ (held.A - held.B @ K))
    return np.vstack(rows)
