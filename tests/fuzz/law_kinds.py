"""Kinds of arguments that the doors of laws share, and the small laws that they try."""

from functools import cache

import numpy as np
from hypothesis import strategies as st

import baselines
from beamenv.plant.plant import Plant
from tests.fuzz import small
from tests.fuzz.meaning import NOTHING, Kind, instance, maybe

PLANT = instance(Plant)
ONE_LOAD = instance(baselines.PersistentLoad, baselines.RotorHarmonics)
LOADS = Kind(
    "loads",
    lambda value: (
        value
        if ONE_LOAD.means(value) is not NOTHING or (isinstance(value, (list, tuple)) and NOTHING not in map(ONE_LOAD.means, value))
        else NOTHING
    ),
    st.nothing(),
)
LOAD = maybe(instance(baselines.PersistentLoad))
LINEAR = Kind(
    "linear law",
    lambda value: value if isinstance(value, baselines.LinearController) else NOTHING,
    st.sampled_from(["clipped", "true"]).map(lambda name: clipped() if name == "clipped" else small.law().__class__),
)
ABOUT = ("plant", "gain", "Riccati")
"""What a law says of its numbers together."""


@cache
def clipped():
    return baselines.clipped_lqg(small.plant())


def finite(answer):
    """Within the drive limits."""
    action = np.asarray(answer[0])
    assert not np.abs(action).max(initial=0.0) > 1.0 + 1e-6, "an action outside its space"  # what is not finite stays so
