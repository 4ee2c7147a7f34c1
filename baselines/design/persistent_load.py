"""A persistent load as part of the plant, so that a filter can estimate it and a regulator can answer it."""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np

from baselines.design.load_model import DURATION, MAGNITUDE, LoadModel
from baselines.design.objects import optional_instance
from beamenv.configuration import configuration


@configuration("persistent_load")
class PersistentLoad:
    """Sustained line loads in lag and flap: independent first-order Gauss–Markov processes.

    The rule for both numbers: root mean square and length of the loads to be expected. A quarter of the nominal scenario's load
    cases are steps of 30 N/m in any direction, which is 10 N/m root mean square over all episodes, and they stay for most of 0.5 s.
    Neither number is critical: on the default blade, from 5 to 20 N/m and from 0.2 to 0.5 s, J changes by less than 2 %.
    """

    magnitude: Annotated[float, MAGNITUDE] = 10.0
    """N/m, root mean square."""
    duration: Annotated[float, DURATION] = 0.25
    """s, correlation time."""

    def model(self, interval: float, disturbances: int = 2) -> LoadModel:
        """A state for each of the ``disturbances``, the loads themselves in N/m, over a control interval in s."""
        decay, forgotten = np.exp(-interval / self.duration), -np.expm1(-2.0 * interval / self.duration)
        each = np.eye(disturbances)
        return LoadModel(decay * each, each, forgotten * self.magnitude**2 * each)


def checked_persistent_load(load: Any) -> PersistentLoad | None:
    """The lasting load or None; ``ValueError`` for anything else."""
    return optional_instance("persistent_load", load, PersistentLoad, "a PersistentLoad, such as PersistentLoad()")
