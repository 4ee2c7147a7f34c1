"""What is verified of every linear law before it is handed out."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TypeVar

from baselines.design.loop import LinearLaw, closed_loop, sampled, spectral_radius
from baselines.design.out_of_reach import undamped_out_of_reach
from baselines.design.riccati import RESIDUAL, Solution, Unsolved
from beamenv.configuration import Flag, checked
from beamenv.plant.plant import Plant, SampledPlant

L = TypeVar("L", bound=LinearLaw)

DECAYS = 1.0 - 1e-12
"""The spectral radius below which a loop counts as stable."""


def verified(
    law: L,
    plant: Plant | SampledPlant,
    *solutions: Solution,
    norm: Callable[[SampledPlant, L], float] | None = None,
    norm_below: float = math.inf,
    instead: str = "another plant or gain",
    verify: bool = True,
) -> L:
    """The law, once it has been seen that it keeps what is promised of it on ``plant``, sampled, while no limit acts.

    These are: its Riccati ``solutions`` leave no more than 1e-9 of their terms; its loop is stable; its ``norm``, such as
    ``h_infinity_norm`` in √(J s), stays below ``norm_below``. Every builder of a law calls this; ``verify=False`` asks by name for
    the law as it is. Raises ``ValueError`` of one sentence, which ends with what to do ``instead``.
    """
    if not checked("verify", verify, Flag()):
        return law
    held = sampled(plant, law)
    for missed in (each.residual for each in solutions if not each.residual <= RESIDUAL):
        raise _broken(law, held, f"a Riccati equation left with {missed:.1e} of its terms, more than {RESIDUAL:g}", instead)
    if not (radius := spectral_radius(closed_loop(held, law)[0])) < DECAYS:
        raise _broken(law, held, f"a sampled loop that is unstable, of spectral radius {radius:.9g}", instead)
    if norm is not None and not (found := norm(held, law)) < norm_below:
        raise _broken(law, held, f"a norm of {found:.6g}, where {norm_below:.6g} is promised", instead)
    return law


@contextmanager
def solvable(plant: Plant) -> Iterator[None]:
    """Where an equation within has no stabilising solution, ``ValueError`` says which of the plant's modes is in the way."""
    try:
        yield
    except Unsolved as error:
        mode = undamped_out_of_reach(sampled(plant))
        cause = str(error) if mode is None else f"plant has {mode}"
        raise ValueError(f"{cause}: no law is the optimum then, allowed are plants in which every such mode is damped.") from None


def _broken(law: LinearLaw, held: SampledPlant, what: str, instead: str) -> ValueError:
    mode = undamped_out_of_reach(held)
    gives = "gives" if mode is None else f"has {mode}: it gives"
    return ValueError(f"plant {gives} {law.name} {what}; allowed is {instead}, or verify=False for the law as it is.")
