"""What RLlib trains: a gain on the belief, which begins without voltages, and a critic that is a quadratic of it.

The plant is linear and its cost quadratic: the best law on a right belief is a gain (Bertsekas, *Dynamic Programming and Optimal
Control*, section 4.1), and its value a quadratic.
"""

from __future__ import annotations

from typing import Any, cast

import torch
from ray.rllib.core.columns import Columns
from ray.rllib.core.distribution.torch.torch_distribution import TorchDiagGaussian
from ray.rllib.core.rl_module.apis import ValueFunctionAPI
from ray.rllib.core.rl_module.torch import TorchRLModule
from torch import nn


class LinearOnBelief(TorchRLModule, ValueFunctionAPI):
    """A gain and a quadratic.

    Of its ``model_config``: ``exploration`` is the logarithm of the standard deviation of the actions, which stays as it is, and
    ``input_gain`` multiplies what the gain sees, and with it the rate at which it learns.
    """

    def setup(self) -> None:
        """The gain, zero at first, and the critic's weights."""
        spaces: Any = (self.observation_space, self.action_space)
        seen, voltages = (space.shape[0] for space in spaces)
        self.settings = cast("dict[str, Any]", self.model_config)
        self.action_dist_cls = TorchDiagGaussian
        self.gain = nn.Linear(seen, voltages, bias=False)
        self.value = nn.Linear(seen * (seen + 1) // 2, 1)
        for layer in (self.gain, self.value):
            nn.init.zeros_(layer.weight)
        nn.init.zeros_(self.value.bias)
        self.register_buffer("log_std", torch.full((voltages,), float(self.settings["exploration"])))
        self.register_buffer("pairs", torch.triu_indices(seen, seen))

    def _forward(self, batch: dict[str, Any], **kwargs: Any) -> dict[str, Any]:
        """Means and logarithms of standard deviations."""
        mean = self.gain(batch[Columns.OBS] * self.settings["input_gain"])
        return {Columns.ACTION_DIST_INPUTS: torch.cat([mean, self.log_std.expand_as(mean)], dim=-1)}

    def compute_values(self, batch: dict[str, Any], embeddings: Any = None) -> torch.Tensor:
        """Of products of what is seen."""
        seen = batch[Columns.OBS]
        rows, columns = self.pairs
        return self.value(seen[..., rows] * seen[..., columns]).squeeze(-1)
