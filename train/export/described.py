"""Which controllers can be drawn as block diagrams, and why the others cannot."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from baselines import (
    AdaptiveNeural,
    ClippedLQG,
    InverseHysteresis,
    Law,
    LinearController,
    MultipleModel,
    PredictiveController,
    ScheduledLQG,
)
from baselines.design.controller import name_of
from baselines.design.instruments import Instruments, checked_plant
from baselines.laws.time_varying_lqg import TimeVaryingLQG
from beamenv.plant.plant import Plant
from train.controllers.models_policy import ModelsPolicy
from train.export.agents import AGENTS, weighing_models
from train.export.blocks import Block, Misfit
from train.export.diagram import Diagram
from train.export.hysteresis import inverse_hysteresis
from train.export.laws import clipped_lqg, linear_law, scheduled_law
from train.export.many_models import multiple_model
from train.export.scales import Drawn, Scales, behind_instruments, sensors_of

LAWS: Mapping[type[Law], Callable[[Any, Block, Scales], Drawn]] = {
    LinearController: linear_law,
    ClippedLQG: clipped_lqg,
    ScheduledLQG: scheduled_law,
    InverseHysteresis: inverse_hysteresis,
    MultipleModel: multiple_model,
}

HIDDEN = {"state": "the blade's true state", "observation and truth": "what the truth of the episode is"}
"""What no sensor measures."""

REASONS: Mapping[type[Any], str] = {
    PredictiveController: "it solves a quadratic program at every instant, for which it needs a solver",
    AdaptiveNeural: "its network learns at every instant, with a memory of some thousand numbers, which blocks have no words for",
    TimeVaryingLQG: "its gains are those of a spin-up that is known beforehand, worked out on the way",
}


def diagram_of(controller: Any, plant: Plant) -> Diagram:
    """The controller from what the plant's sensors show, A in general, to its voltages, V.

    Raises ``ValueError`` of one sentence for what cannot be drawn, and for a law of other instruments than the plant's.
    """
    sensors, readings = sensors_of(checked_plant(plant))
    for law in (controller, getattr(controller, "law", None)):
        if isinstance(law, Law):
            _check_instruments(law, plant)
    try:
        return behind_instruments(sensors, _drawn(controller, readings, Scales.of(plant)), plant)
    except Misfit:
        counts = f"{len(plant.C)} sensors and {plant.B.shape[1]} voltages"
        raise ValueError(f"plant has {counts}, which are not those that {name_of(controller)} was made for.") from None


def _drawn(controller: Any, readings: Block, scales: Scales) -> Drawn:
    kind = type(controller)
    if isinstance(controller, Law) and controller.observes in HIDDEN:
        raise _cannot(controller, f"it observes {HIDDEN[controller.observes]}, which no sensor measures")
    if kind in LAWS:
        return LAWS[kind](controller, readings, scales)
    if isinstance(controller, ModelsPolicy):
        return weighing_models(controller, readings, scales)
    if kind in AGENTS:
        return AGENTS[kind](controller, readings)
    for known, reason in REASONS.items():
        if isinstance(controller, known):
            raise _cannot(controller, reason)
    what = "agents that ship or are trained here, and laws of this package"
    raise _cannot(controller, f"what it does cannot be read from it, as it can from {what}")


def _cannot(controller: Any, reason: str) -> ValueError:
    return ValueError(f"controller = {name_of(controller)} ({type(controller).__name__}) cannot be exported: {reason}.")


def _check_instruments(law: Law, plant: Plant) -> None:
    """``ValueError`` for a law of another clock or other limits, or of as many sensors and voltages as the plant does not have."""
    own, others = law.instruments, Instruments.of(plant, law.observes)
    for name, one, other in (
        ("measurements and voltages", own.counts, others.counts),
        ("interval", own.interval, others.interval),
        ("voltage limits", own.voltage_limits, others.voltage_limits),
    ):
        if not np.array_equal(one, other):
            raise ValueError(
                f"plant has another {name} than {law.name} was designed for: {_shown(other)} in place of {_shown(one)}."
            )


def _shown(value: Any) -> str:
    return " ".join(str(np.asarray(value).tolist()).split())
