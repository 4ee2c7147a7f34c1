"""What a data set tells of itself: who acted, what that knew, in what, how well, and with which code."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import minari
import numpy as np

import beamenv
from baselines import Controller
from beamenv.titles import TIERS
from train.controllers.known import FORMER
from train.controllers.named import discover
from train.controllers.runs import AGENT
from train.controllers.tiers import LEARNT, own_tier, told_tier
from train.datasets.taped import SHOWN
from train.shared.digests import CONTROLLERS, source_digest
from train.shared.versions import versions

BANK = "drawn from a bank of its own, on which controllers are neither compared, tuned nor chosen, and which no law is told"


JUDGES = "The scenario is kept for judging: it cannot judge what learns from these."


def tier_of(controller: Any, law: Controller) -> int:
    """Of information: a named law's own, an agent's as its file tells, that of what it sees of anything else."""
    if not isinstance(controller, str):
        return own_tier(law)
    if (law_id := FORMER.get(controller, controller)) in discover():
        return discover()[law_id].tier
    told = told_tier(Path(controller)) if (Path(controller) / AGENT).is_file() else None
    return LEARNT if told is None else told


def metadata(
    name: str,
    controller: str,
    law: Controller,
    tier: int,
    trained_seed: int | None,
    scenario: str,
    judges: bool,
    eval_spec: str,
    seeds: range,
    costs: Sequence[float],
) -> dict[str, Any]:
    """Minari's own keys, and under "beamenv" what it has no keys for.

    ``judges`` is whether the scenario is kept for judging. ``costs`` are J of each episode in J s, NaN where it ended by failure;
    the mean is of the others, None if there are none.
    """
    observes = getattr(law, "observes", "observation")
    told = [what for level, what in TIERS.items() if level <= tier]
    whole = [each for each in costs if each == each]
    failed, mean, deviation = len(costs) - len(whole), None, None
    if whole:
        mean, deviation = float(np.mean(whole)), float(np.std(whole))
    shown = f", which it is shown too: infos[{SHOWN[observes]!r}]" if observes in SHOWN else ""
    own = {
        "controller": controller,
        "trained_seed": trained_seed,
        "tier": tier,
        "told": "; ".join(told),
        "observes": observes,
        "scenario": scenario,
        "kept_for_judging": judges,
        "plants": BANK,
        "seeds": [seeds[0], seeds[-1]],
        "cost": {"unit": "J s", "mean": mean, "standard_deviation": deviation, "failed_episodes": failed},
        "versions": versions(),
        "code": source_digest(CONTROLLERS),
    }
    return {
        "dataset_id": name,
        "algorithm_name": controller,
        "description": (
            f"{controller} on {len(costs)} episodes of the scenario {scenario} of {beamenv.ENV_ID}; "
            f"tier {tier}, told {' and '.join(told)}; "
            f"it acts on the {observes}{shown}. {failed or 'None'} of the episodes ended by failure"
            + ("." if mean is None else f"; the mean cost J{' of the others' if failed else ''} is {mean:.4g} J s.")
            + (f" {JUDGES}" if judges else "")
        ),
        "eval_env_spec": eval_spec,
        "minari_version": minari.__version__,
        "requirements": [f"beamenv=={beamenv.__version__}"],
        "beamenv": own,
    }
