"""Multiple-model adaptive estimation: a filter and a regulator for each thing that may be the case, weighed by what is read.

Magill, IEEE Trans. Automatic Control 10, 1965; with faults in mid-episode Blom and Bar-Shalom, ibid. 33, 1988.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike
from scipy.special import chdtri  # scipy.stats would look for torch

from baselines.design.controller import Array
from baselines.design.filter_bank import Filter, FilterBank
from baselines.design.hypothesis import Hypothesis, with_voltages_before
from baselines.design.instruments import Instruments
from baselines.design.linear import LinearController
from baselines.design.loop import sampled
from baselines.design.matrix import real_matrix
from baselines.design.rate_penalty import with_rate_penalty
from baselines.design.riccati import Solution
from baselines.design.verification import verified
from baselines.design.weighing import MultipleModel
from baselines.laws.lqg import compensator, known_sensor_noise, optimal_filter, optimal_regulator
from baselines.laws.reference_lqg import RATE_WEIGHT
from beamenv.configuration import Count, Flag, Number, Refused, checked
from beamenv.plant.plant import Plant, SampledPlant

FLOOR = 1e-6
"""Least weight of a hypothesis: one that has been ruled out can be right later."""

WINDOW = 40
"""Instants over which the test of fit remembers: the default blade's first mode has a period of some 70."""

CONFIDENCE = 1.0 - 1e-9
"""Of the test of fit in Gaussian noise."""

ALLOWANCE = 36.0
"""Times χ²'s quantile: the loads of episodes are no Gaussian noise. The rule: at most one of 64 episodes of tuning on the training
bank, in any scenario whose truth is among the hypotheses, is taken for one where none fits. The second largest of 64 episodes'
largest ratios to the quantile, without a fallback: nominal 2.1, rotor 1.5, off-speed 4.3, off-model 8.3, failure 9.7, delay 11.9,
spin-up 21.3, and mid-failure 35.6, where it takes some instants until a failure is found. On blades outside the bank the loop of
a wrong hypothesis runs away so fast that limits from 3 to 60 cost the same."""


def multiple_model(
    hypotheses: Sequence[Hypothesis],
    fallback: LinearController | None = None,
    *,
    transition: ArrayLike | None = None,
    rate_weight: float = RATE_WEIGHT,
    floor: float = FLOOR,
    window: int = WINDOW,
    confidence: float = CONFIDENCE,
    allowance: float = ALLOWANCE,
    verify: bool = True,
) -> MultipleModel:
    """Magill's estimator over ``hypotheses``, with a Kalman filter of time-varying gains and a regulator for each.

    Each regulator is the optimum for its faulty plant with the price ``rate_weight`` on quick changes, as in ``full_order_lqg``;
    where voltages come late it answers the state that is predicted for when they act. Each filter starts from the hypothesis' own
    covariance; when its gain has settled, that of the steady state is used.

    ``transition`` Π (H, H) makes it the switching estimator: Π_ij is the probability that i is followed by j from one instant to
    the next. Estimates are mixed then, so all hypotheses must be of one plant and one load. ``floor`` is the least weight of a
    hypothesis.

    No hypothesis fits where the mean normalised innovation squared per reading over a fading ``window`` of instants, averaged with
    the weights, is more than ``allowance`` times the quantile of χ²/ν at ``confidence``, ν = (2 window − 1) p (Bar-Shalom, Li and
    Kirubarajan 2001, section 5.4). From then on, until the episode ends, ``fallback`` acts; its filter has followed the readings
    from the start. With None there is no such test.

    Each hypothesis' own loop is ``verified`` on its own plant, faults, delay and all, unless ``verify=False``; of their mixture
    nothing is promised. Raises ``ValueError`` for hypotheses that differ in their instruments, for a ``transition`` that holds no
    probabilities, and as ``lqg`` does.
    """
    those = _checked(hypotheses)
    first = those[0].plant
    markov = None if transition is None else _markov(transition, those)
    if fallback is not None:
        _check_fallback(fallback, first)
    misfit = _misfit(window, confidence, allowance, len(first.C))
    floor = checked("floor", floor, Number(ge=0.0, lt=1.0))
    rate_weight, verify = checked("rate_weight", rate_weight, Number(ge=0.0)), checked("verify", verify, Flag())
    depth = max(int(rate_weight > 0.0), *(each.delay for each in those))
    biased = any(each.sensor_bias.any() for each in those)
    parts = _parts(those, depth, rate_weight, biased, verify)
    size = max(len(each.filter.A) for each in parts)
    prior = np.array([each.prior for each in those])
    return MultipleModel(
        name="multiple-model LQG" if markov is None else "switching multiple-model LQG",
        instruments=Instruments.of(first),
        bank=FilterBank.of(
            [each.filter for each in parts],
            [each.delay for each in those],
            depth,
            first.sensor_full_scale,
            [each.holds_lost_readings for each in those],
        ),
        state_gain=np.stack([np.pad(each.state_gain, ((0, 0), (0, size - each.state_gain.shape[1]))) for each in parts]),
        voltage_gain=np.stack([each.voltage_gain for each in parts]),
        prior=prior / prior.sum(),
        transition=markov,
        floor=floor,
        fallback=fallback,
        window=window,
        misfit=misfit,
    )


def _misfit(window: int, confidence: float, allowance: float, sensors: int) -> float:
    """Mean normalised innovation squared per reading from which on no hypothesis fits."""
    degrees = (2 * checked("window", window, Count(1, 10**6)) - 1) * sensors
    quantile = float(chdtri(degrees, 1.0 - checked("confidence", confidence, Number(gt=0.0, lt=1.0)))) / degrees
    return checked("allowance", allowance, Number(gt=0.0)) * quantile


@dataclass(frozen=True, slots=True, eq=False)
class _Parts:
    """Of one hypothesis: its filter, and its regulator's gains from filtered estimates and voltages before."""

    filter: Filter
    state_gain: Array
    """(m, s)."""
    voltage_gain: Array
    """(m, m D)."""


def _parts(those: Sequence[Hypothesis], depth: int, rate_weight: float, biased: bool, verify: bool) -> list[_Parts]:
    """Of each; those that differ in delay and sensors alone share a regulator, those in delay and actuators a filter's equation."""
    regulators: dict[Any, Solution] = {}
    filters: dict[Any, Solution] = {}
    parts = []
    for each in those:
        of, held, plant = each.sampled(biased=False), each.sampled(biased), id(each.plant)
        regulated = plant, each.actuator_gain.tobytes(), each.loads
        filtered = plant, each.sensor_gain.tobytes(), each.sensor_bias.tobytes(), each.loads
        if regulated not in regulators:
            regulators[regulated] = optimal_regulator(each.plant, with_rate_penalty(of, rate_weight) if rate_weight else of)
        if filtered not in filters:
            filters[filtered] = optimal_filter(each.plant, held)
        parts.append(_part(each, of, held, regulators[regulated], filters[filtered], depth, verify))
    return parts


def _part(
    hypothesis: Hypothesis, of: SampledPlant, held: SampledPlant, regulated: Solution, filtered: Solution, depth: int, verify: bool
) -> _Parts:
    """Of one, sampled without biases (``of``) and as its filter believes (``held``)."""
    truth, delay = sampled(hypothesis.faulty_plant), hypothesis.delay
    state_gain, voltage_gain = late(of, regulated.gain, delay, depth)
    state_gain = np.pad(state_gain, ((0, 0), (0, len(held.A) - len(of.A))))
    K, L = np.hstack([state_gain, voltage_gain]), np.vstack([filtered.gain, np.zeros((voltage_gain.shape[1], len(held.C)))])
    law = compensator(hypothesis.plant, "LQG of a hypothesis", with_voltages_before(held, delay, depth), K, L)
    verified(law, with_voltages_before(truth, delay, delay), regulated, filtered, instead="another hypothesis", verify=verify)
    E = held.disturbance_input
    return _Parts(
        filter=Filter(
            A=held.A,
            B=held.B,
            C=held.C,
            W=E @ held.process_noise @ E.T,
            V=known_sensor_noise(hypothesis.plant) / held.interval,
            at_start=hypothesis.covariance_at_start(biased=len(held.A) > len(of.A)),
            in_the_long_run=filtered.matrix,
        ),
        state_gain=state_gain,
        voltage_gain=voltage_gain,
    )


def late(held: SampledPlant, gain: Array, delay: int, depth: int) -> tuple[Array, Array]:
    """Gains (m, n) from the state and (m, m depth) from the voltages before, newest first, of voltages that act late.

    ``gain`` (m, n) or (m, n + m) is the best without ``delay``, from the state and, with a price on changes, from u₋₁. What is
    asked for answers the state as it will be when it acts, A^d x + Σ A^(i−1) B u₋ᵢ: all costs come d intervals later and are the
    same (Artstein, IEEE Trans. Automatic Control 27, 1982).
    """
    n, m = held.B.shape
    K, before = gain[:, :n], np.zeros((m, m * depth))
    before[:, : gain.shape[1] - n] = gain[:, n:]
    for block in range(delay):
        before[:, block * m : (block + 1) * m] += K @ held.B
        K = K @ held.A
    return K, before


def _checked(hypotheses: Any) -> tuple[Hypothesis, ...]:
    """One or more, behind the same instruments."""
    those = tuple(hypotheses) if isinstance(hypotheses, (list, tuple)) else ()
    if not those or not all(isinstance(each, Hypothesis) for each in those):
        raise Refused("hypotheses", hypotheses, "a list of one or more Hypothesis")
    for name in ("sensor_full_scale", "voltage_limits", "control_interval"):
        if not all(np.array_equal(getattr(each.plant, name), getattr(those[0].plant, name)) for each in those):
            raise ValueError(f"hypotheses have plants that differ in {name}, but one controller has one set of instruments.")
    return those


def _markov(transition: Any, those: Sequence[Hypothesis]) -> Array:
    """Probabilities (H, H), of hypotheses whose estimates are of the same states."""
    matrix = real_matrix("transition", transition, (len(those), len(those)))
    if matrix.min() < 0.0 or not np.allclose(matrix.sum(axis=1), 1.0, rtol=0.0, atol=1e-9):
        raise Refused("transition", matrix.tolist(), "probabilities, none below 0, of which every row adds up to 1")
    first = those[0]
    for each in those[1:]:
        same = np.array_equal(each.plant.A, first.plant.A) and len(each.loads) == len(first.loads)
        if not same or any(one != other for one, other in zip(each.loads, first.loads, strict=True)):
            raise ValueError("hypotheses have other plants or loads, but with a transition all must be of one plant and one load.")
    return matrix


def _check_fallback(fallback: Any, plant: Plant) -> None:
    """``ValueError`` for what is not linear, or stands behind other instruments."""
    if not isinstance(fallback, LinearController):
        raise Refused("fallback", fallback, "None or a LinearController, such as reference_lqg(plant)")
    own, others = fallback.instruments, Instruments.of(plant)
    for name in ("observes", "interval", "voltage_limits"):
        if not np.array_equal(getattr(own, name), getattr(others, name)):
            raise ValueError(f"fallback has another {name} than the hypotheses: both must stand behind the same instruments.")
    if own.counts != others.counts:
        raise ValueError(f"fallback has {own.counts} measurements and voltages, but the hypotheses have {others.counts}.")
