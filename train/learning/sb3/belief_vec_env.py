"""The door for users of Stable-Baselines3: a ``VecEnv`` of blades whose agent sees a belief, and its models as controllers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.configuration import Count, Number, checked
from beamenv.plant.plant import normalised
from beamenv.task import resolve_task
from train.controllers.belief_policy import BeliefPolicy
from train.learning.sb3.belief import design_belief
from train.learning.sb3.vec_env import TrainingVecEnv
from train.learning.training import on_training_bank, uncontrolled_cost

Array = NDArray[Any]

ENERGY_HORIZON = 0.03
"""s, of the shaping of rewards, see ``TrainingVecEnv``."""


class BeliefVecEnv(TrainingVecEnv):
    """``num_envs`` blades for any algorithm of Stable-Baselines3, ``environment`` being the arguments of ``RotatingBeamEnv``.

    An agent sees the belief of a filter that knows the design (tier 0), the ``modes`` slowest modes of it and the lasting load, and
    the voltages held before; it is trained on plants of the scenario's training bank (tier 1). An action is ``held`` for so many
    control intervals, and the voltages go a share ``approach`` of the way to it. Rewards are costs relative to no control, shaped
    by the vibration energy as a potential for learning with the ``discount`` γ. ``controller`` makes a model one that
    ``baselines.evaluate`` takes.
    """

    def __init__(
        self,
        num_envs: int = 256,
        seed: int = 0,
        *,
        held: int = 2,
        modes: int = 5,
        approach: float = 1.0,
        discount: float = 0.995,
        **environment: Any,
    ) -> None:
        task = on_training_bank(resolve_task(**environment))
        super().__init__(
            num_envs,
            task,
            seed,
            history=1,
            energy_horizon=ENERGY_HORIZON,
            discount=checked("discount", discount, Number(gt=0.0, le=1.0)),
            held=checked("held", held, Count(1, task.steps)),
            reference=uncontrolled_cost(task),
            approach=checked("approach", approach, Number(gt=0.0, le=1.0)),
            belief=design_belief(task.design, checked("modes", modes, Count())),
        )

    def controller(self, model: Any, name: str = "agent on the belief") -> ModelOnBelief:
        """A model trained here, or anything with its ``predict``, as a controller of readings."""
        lowest, highest = normalised(self.blades.task.design_plant).voltage_limits.astype(np.float32)
        assert self.belief is not None
        settings = {"held": self.held, "approach": self.approach, "input_gain": 1.0}
        return ModelOnBelief(name, self.belief._asdict(), settings, lowest, highest, model)


@dataclass(frozen=True, slots=True, eq=False)
class ModelOnBelief(BeliefPolicy):
    """A model of Stable-Baselines3 in the place of the layers."""

    model: Any

    def asked(self, shown: Array) -> Array:
        """The model's most likely action."""
        action, _ = self.model.predict(shown.astype(np.float32), deterministic=True)
        return np.asarray(action, np.float32)
