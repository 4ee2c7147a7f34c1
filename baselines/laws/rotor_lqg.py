"""LQG that knows what a rotor does to its blades: loads at whole multiples of the speed, beside turbulence."""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike
from scipy.linalg import block_diag

from baselines.design.linear import LinearController
from baselines.design.load_model import DURATION, MAGNITUDE, LoadModel
from baselines.design.objects import instance, optional_instance
from baselines.design.persistent_load import PersistentLoad
from baselines.design.weights import weighted
from baselines.laws.lqg import sampled_lqg
from beamenv.configuration import Count, Number, Numbers, Refused, configuration
from beamenv.plant.plant import Plant


@configuration("harmonics")
class RotorHarmonics:
    """Line loads in lag and flap at whole multiples of the rotor speed: oscillators that lose their phase only slowly.

    The rule for the numbers: the first four harmonics, each as large as the environment's harmonic loads, whose mean amplitude
    of 3 N/m in any direction is 1.5 N/m root mean square in lag and in flap, and steady over an episode of 0.5 s.
    """

    speed: Annotated[float, Number(gt=0.0, unit="rad/s")]
    """rad/s, of the rotor."""
    orders: Annotated[tuple[int, ...], Numbers(Count(), least=1, of="orders")] = (1, 2, 3, 4)
    """Loads per revolution."""
    magnitude: Annotated[float, MAGNITUDE] = 1.5
    """N/m, root mean square, of each harmonic in each direction."""
    duration: Annotated[float, DURATION] = 0.5
    """s: time in which a harmonic forgets its amplitude and phase."""

    def __post_init__(self) -> None:
        """``ValueError`` for an order that is there twice: no reading tells two such loads apart."""
        if len(set(self.orders)) < len(self.orders):
            raise Refused("orders", self.orders, "orders that differ from each other")

    def model(self, interval: float, disturbances: int = 2) -> LoadModel:
        """For each order an in-phase and a quadrature part (N/m) in lag and in flap, or in each disturbance, over an interval in s.

        Raises ValueError for a harmonic that the sampling cannot tell from a slower one.
        """
        if max(self.orders) * self.speed * interval >= np.pi:
            raise ValueError(
                f"order {max(self.orders)} at {self.speed:g} rad/s is not allowed: sampled every {interval:g} s, a load must "
                f"stay below {np.pi / interval:.6g} rad/s."
            )
        turns = (order * self.speed * interval for order in self.orders)
        return reduce(add, (self._oscillator(each, interval, disturbances) for each in turns))

    def _oscillator(self, angle: float, interval: float, disturbances: int) -> LoadModel:
        decay, forgotten = np.exp(-interval / self.duration), -np.expm1(-2.0 * interval / self.duration)
        turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        noise = forgotten * self.magnitude**2 * np.eye(2 * disturbances)
        shown = block_diag(*[np.eye(1, 2)] * disturbances)
        return LoadModel(decay * block_diag(*[turn] * disturbances), shown, noise)


def rotor_lqg(
    plant: Plant,
    harmonics: RotorHarmonics,
    turbulence: PersistentLoad | None = None,
    *,
    Q: ArrayLike | None = None,
    R: ArrayLike | None = None,
    verify: bool = True,
) -> LinearController:
    """The sampled LQG of a plant under rotor harmonics and, if given, under Gauss–Markov ``turbulence``.

    The loads are part of the state, for filter and regulator alike, so that the compensator holds a model of each harmonic and
    answers it (the internal model principle: Francis and Wonham, Automatica 12, 1976; for helicopter rotors Shaw and Albion, J. Am.
    Helicopter Soc. 26, 1981). ``Q`` and ``R`` are other weights than the plant's, as in ``lqg``. ``verified`` on
    ``plant`` unless ``verify=False``. Raises ValueError for a harmonic beyond half the sampling rate, for loads that are none, and
    as ``lqg`` does.
    """
    harmonics = instance("harmonics", harmonics, RotorHarmonics, "a RotorHarmonics, such as RotorHarmonics(speed)")
    turbulence = optional_instance("turbulence", turbulence, PersistentLoad, "a PersistentLoad, such as PersistentLoad()")
    return sampled_lqg(weighted(plant, Q, R), "LQG with rotor harmonics", harmonics, turbulence, verify=verify)
