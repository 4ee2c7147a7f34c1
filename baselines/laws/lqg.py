"""LQG: Kalman filter and regulator, as the sampled-data optimum or as the thesis' continuous design."""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.delay import checked_delay, with_delay
from baselines.design.instruments import Instruments
from baselines.design.linear import LinearController
from baselines.design.load_model import Load, model_of, with_load
from baselines.design.loop import sampled
from baselines.design.persistent_load import PersistentLoad, checked_persistent_load
from baselines.design.rate_penalty import with_rate_penalty
from baselines.design.riccati import Array, Solution, kalman_filter, regulator, sampled_kalman_filter, sampled_regulator
from baselines.design.verification import solvable, verified
from baselines.design.weights import weighted
from beamenv.configuration import Choice, Number, checked
from beamenv.plant.hold import hold
from beamenv.plant.plant import Plant, SampledPlant

_CONVERTER_STEP = 2.0**-15
"""Of full scale: a 16-bit converter's."""


def lqg(
    plant: Plant,
    design: Literal["sampled", "continuous"] = "sampled",
    persistent_load: PersistentLoad | None = None,
    *,
    Q: ArrayLike | None = None,
    R: ArrayLike | None = None,
    verify: bool = True,
) -> LinearController:
    """The LQG controller of a design plant, ``verified`` on that plant; the estimate of its filter starts at zero.

    ``design="sampled"`` is the optimum for the cost and the noise of the environment, both sampled exactly; reading y_k already
    acts on voltage u_k: x̂ ← x̂ + L (y − C x̂), u = −K x̂, x̂⁺ = A x̂ + B u.

    ``design="continuous"`` is the thesis' compensator, Eqs. 5.11 and 5.18–5.21,

        x̂̇ = (A − BK − LC) x̂ + L y + B (clip(u) − u),        u = −K x̂,

    whose last term, zero unless the drive saturates, keeps it from winding up (B less LD where sensors feel the voltages). It is
    integrated exactly from sample to sample, with the newest reading held over the interval that ends with it, so that y_k acts on
    u_k. (With y_k held over the interval that begins with it, as is more usual, the loop through the blade's upper modes, up to
    1.4 rad per sample, is unstable.) The filter must still be slower than the sampling: with nearly noiseless sensors, or with
    loads that reach fast modes, this controller is unstable too.

    ``persistent_load`` (sampled design only) adds a sustained load to the state, for filter and regulator alike. ``Q`` (n, n) and
    ``R`` (m, m) are your own weights in ∫(xᵀQx + uᵀRu)dt, in the plant's coordinates. They replace the plant's weights: the
    vibration energy ½ xᵀx in J, and the energy stored by the actuators, J/V². With ``verify=False`` the controller is returned
    unchecked, even an unstable one. Raises ValueError for another ``design``, for a persistent load with the continuous design,
    for weights that are not symmetric or not positive, for a controller that is not stable on ``plant``, and for a plant with an
    undamped mode that no voltage reaches or no sensor sees; the sentence names the mode.
    """
    plant, load = weighted(plant, Q, R), checked_persistent_load(persistent_load)
    if checked("design", design, Choice(("sampled", "continuous"))) == "sampled":
        return sampled_lqg(plant, "LQG" if load is None else "LQG with load estimate", load, verify=verify)
    if load is not None:
        raise ValueError(f'persistent_load = {load} needs design="sampled": the thesis\' design has no load state.')
    return _continuous(plant, verify)


def sampled_lqg(plant: Plant, name: str = "LQG", *loads: Load | None, verify: bool = True) -> LinearController:
    """The sampled optimum, ``verified``, with the states of the ``loads`` behind those of the blade in its memory."""
    held, regulated, filtered = sampled_design(plant, *loads)
    law = compensator(plant, name, held, regulated.gain, filtered.gain)
    return verified(law, plant, regulated, filtered, verify=verify)


def compensator(plant: Plant, name: str, held: SampledPlant, K: Array, L: Array) -> LinearController:
    """x̂ ← x̂ + L (y − C x̂), u = clip(−K x̂), x̂⁺ = A x̂ + B u with gains K (m, s) and L (s, p), behind the plant's instruments."""
    correct = np.eye(len(held.A)) - L @ held.C
    return observer(plant, name, held.A @ correct, held.A @ L, held.B, -K @ correct, -K @ L)


def sampled_with_loads(plant: Plant, *loads: Load | None) -> SampledPlant:
    """The sampled plant, with what readings show of voltages as states, and with those of whatever ``loads`` are given."""
    models = [model_of(load, plant) for load in loads if load is not None]
    return with_load(sampled(plant), reduce(add, models)) if models else sampled(plant)


def sampled_design(
    plant: Plant, *loads: Load | None, rate_weight: float = 0.0, delay: int = 0
) -> tuple[SampledPlant, Solution, Solution]:
    """The sampled plant with its loads, with the voltages before where quick changes have a price, and with those that come late;
    its regulator, P and K, and its filter, S and L. Raises ValueError where one of them has none.
    """
    held = sampled_with_loads(plant, *loads)
    if checked("rate_weight", rate_weight, Number(ge=0.0)) > 0.0:
        held = with_rate_penalty(held, rate_weight)
    held = with_delay(held, checked_delay(delay))
    return held, optimal_regulator(plant, held), optimal_filter(plant, held)


def optimal_regulator(plant: Plant, held: SampledPlant) -> Solution:
    """P and K for the sampled plant's cost; ``ValueError`` where there is none, which names the mode of ``plant`` in the way."""
    with solvable(plant):
        return sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)


def optimal_filter(plant: Plant, held: SampledPlant) -> Solution:
    """S and L for the sampled plant's loads and the noise of ``plant``'s sensors; ``ValueError`` as ``optimal_regulator``."""
    E = held.disturbance_input
    with solvable(plant):
        return sampled_kalman_filter(held.A, held.C, E @ held.process_noise @ E.T, known_sensor_noise(plant) / held.interval)


def _continuous(plant: Plant, verify: bool) -> LinearController:
    E, p = plant.disturbance_input, len(plant.C)
    with solvable(plant):
        regulated = regulator(plant.A, plant.B, plant.state_weight, plant.input_weight, np.asarray(plant.cross_weight))
        filtered = kalman_filter(plant.A, plant.C, E @ plant.process_noise @ E.T, known_sensor_noise(plant))
    K, L = regulated.gain, filtered.gain
    B = plant.B - L @ plant.D  # a reading and the voltage that it shows belong to one interval
    F, inputs = hold(plant.A - B @ K - L @ plant.C, np.hstack([L, B]), plant.control_interval)
    G, H = inputs[:, :p], inputs[:, p:]
    onward = F + H @ K
    law = observer(plant, "LQG (thesis)", onward, onward @ G, H, -K, -K @ G)
    return verified(law, plant, regulated, filtered, instead='design="sampled"', verify=verify)


def known_sensor_noise(plant: Plant) -> Array:
    """V (p, p), A² s. Without any noise the filter's equation has no solution, so at least the converter's steps count."""
    converter = np.diag((_CONVERTER_STEP * plant.sensor_full_scale) ** 2 / 12.0) * plant.control_interval
    silent = np.diag(plant.sensor_noise) < np.diag(converter)
    return plant.sensor_noise + np.where(silent, converter, 0.0)


def observer(plant: Plant, name: str, F: Array, G: Array, H: Array, M: Array, T: Array) -> LinearController:
    """The controller ξ⁺ = F ξ + G y + H u, u = clip(M ξ + T y) behind the plant's own instruments and drive."""
    return LinearController(name, Instruments.of(plant), F, G, H, M, T)
