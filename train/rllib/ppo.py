"""PPO of RLlib's new API stack with settings that were found to learn, and what it has learnt as a controller."""

from __future__ import annotations

from typing import Any

import numpy as np
from ray.rllib.algorithms.algorithm import Algorithm
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.core.rl_module.rl_module import RLModuleSpec

from train.controllers.belief_policy import BeliefPolicy
from train.learning.sb3.belief_vec_env import BeliefVecEnv
from train.rllib.blades import register
from train.rllib.network import LinearOnBelief

BLADES = 256
ROLLOUT = 64


def ppo_config(**environment: Any) -> PPOConfig:
    seen = {"held": 2, "modes": 2, "approach": 0.3, "discount": 0.995, **environment}
    return (
        PPOConfig()
        .environment(register(), env_config=seen, clip_actions=True, normalize_actions=False)
        .env_runners(
            num_env_runners=0, num_envs_per_env_runner=BLADES, gym_env_vectorize_mode="vector_entry_point",
            rollout_fragment_length=ROLLOUT,
        )
        .training(
            train_batch_size=BLADES * ROLLOUT,
            minibatch_size=8192,
            num_epochs=3,
            lr=7e-3,
            gamma=seen["discount"],
            lambda_=0.97,
            use_kl_loss=False,
            entropy_coeff=0.0,
            vf_loss_coeff=1.0,
            vf_clip_param=float("inf"),
            clip_param=0.2,
            grad_clip=None,
        )
        .rl_module(rl_module_spec=RLModuleSpec(module_class=LinearOnBelief, model_config={"exploration": -1.4, "input_gain": 4.0}))
        .debugging(seed=0)
    )


def policy_of(algorithm: Algorithm, name: str = "PPO by RLlib") -> BeliefPolicy:
    """What it has learnt, as ``baselines.evaluate`` and ``save_policy`` take it: it acts without RLlib and torch."""
    config: Any = algorithm.config
    envs = BeliefVecEnv(1, **config.env_config)
    network: Any = algorithm.get_module()
    gain = network.gain.weight.detach().cpu().numpy().astype(np.float32)
    weights = {"weight0": gain.copy(), "bias0": np.zeros(len(gain), np.float32)}
    controller = envs.controller(None)
    return BeliefPolicy(name, {**controller.weights, **weights}, {**controller.settings, "input_gain": network.model_config["input_gain"]}, controller.lowest, controller.highest)
