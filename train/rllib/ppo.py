"""PPO of RLlib with settings that were found to learn, and what it has learnt as a controller."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from ray.rllib.algorithms.algorithm import Algorithm
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.rl_module import RLModuleSpec

from train.controllers.belief_policy import BeliefPolicy
from train.learning.sb3.belief_vec_env import BeliefVecEnv
from train.rllib.blades import register
from train.rllib.network import LinearOnBelief
from train.shared.held_models import held_models, scenario_of_file

SEEN = {"held": 2, "modes": 2, "approach": 0.3, "discount": 0.995}
"""What an agent sees and how it acts, as ``BeliefVecEnv`` takes it: as the recipe `ppo-belief-idle` has it."""

EPOCHS = 3

MINIBATCHES = 2


def ppo_config(blades: int = 256, rollout: int = 64, batched: bool = True, **environment: Any) -> PPOConfig:
    """Of RLlib's new API stack: so many blades of each env runner, in one batch or one by one, that act so often between updates.

    The ``environment`` is as ``Blade`` has it, ``SEEN`` where it says nothing. One env runner, in the process of the algorithm:
    ``env_runners(num_env_runners=…)`` has others, each with as many blades, and ``training`` whatever else is to be otherwise.
    Files of blades, models and scenarios are read here; measured loads that a scenario names must be on every machine.
    """
    seen = {**SEEN, **held(environment)}
    network = RLModuleSpec(module_class=LinearOnBelief, model_config={"exploration": -0.5, "input_gain": 4.0})
    config: Any = PPOConfig
    made: PPOConfig = (
        config()
        .environment(register(), env_config=seen, clip_actions=True, normalize_actions=False)
        .env_runners(
            num_env_runners=0,
            num_envs_per_env_runner=blades,
            gym_env_vectorize_mode="vector_entry_point" if batched else "sync",
            rollout_fragment_length=rollout,
        )
        .training(
            train_batch_size=blades * rollout,
            minibatch_size=max(1, blades * rollout // MINIBATCHES),
            num_epochs=EPOCHS,
            lr=1.5e-3,
            gamma=seen["discount"],
            lambda_=0.97,
            use_kl_loss=False,
            entropy_coeff=0.0,
            vf_loss_coeff=1.0,
            vf_clip_param=float("inf"),
            clip_param=0.2,
        )
        .rl_module(rl_module_spec=network)
    )
    return made


def held(environment: Mapping[str, Any]) -> dict[str, Any]:
    """The same environment where none of the files may be."""
    content = scenario_of_file(environment.get("scenario"))
    return {**held_models(environment), **({} if content is None else {"scenario": content})}


def policy_of(algorithm: Algorithm, name: str = "PPO by RLlib") -> BeliefPolicy:
    """What an algorithm of a ``ppo_config`` has learnt, without exploration, as ``baselines.evaluate`` takes it.

    It acts by NumPy alone; ``train.controllers.policy_files.save_policy`` writes it.
    """
    config: Any = algorithm.config
    network: Any = algorithm.get_module()
    controller = BeliefVecEnv(1, **config.env_config).controller(None)
    gain = network.gain.weight.detach().cpu().numpy().astype(np.float32)
    weights = {**controller.weights, "weight0": gain, "bias0": np.zeros(len(gain), np.float32)}
    settings = {**controller.settings, "input_gain": network.model_config["input_gain"]}
    return BeliefPolicy(name, weights, settings, controller.lowest, controller.highest)
