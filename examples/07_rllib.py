# %% [markdown]
# # PPO by RLlib
#
# A filter that knows the design turns readings $y_0, \dots, y_k$ into a belief $\hat x_k$ of the slowest modes of the blade. Where
# belief, plant and cost are linear and quadratic, the best policy is a gain and its value a quadratic,
#
# $$
# u_k = -K \hat x_k, \qquad V(\hat x) = \hat x^T P \hat x + c .
# $$
#
# RLlib finds such a gain by proximal policy optimisation on 256 blades in one batch, beginning without voltages. It needs
# `pip install 'ray[rllib]>=2.54'` besides, and takes about a minute.

# %%
import gymnasium as gym
import ray

import beamenv
from beamenv.baselines import evaluate, reference_lqg
from beamenv.train.rllib import policy_of, ppo_config
from beamenv.train.shared.held_out import validation

ray.init(address="local", num_cpus=1, include_dashboard=False, log_to_driver=False)
algorithm = ppo_config(scenario="nominal").debugging(seed=0).build_algo()
untrained = policy_of(algorithm, "untrained")
for _ in range(20):
    algorithm.train()
learnt = policy_of(algorithm)
algorithm.stop()
ray.shutdown()

# %% [markdown]
# What was learnt is a controller like any other, and acts without RLlib. On validation seeds, beside LQG:

# %%
seeds = validation(32)
envs = gym.make_vec(beamenv.ENV_ID, num_envs=32, scenario="nominal")
idle = evaluate(untrained, envs, seeds)
found = [
    idle,
    *(evaluate(law, envs, seeds, reference=idle.reference) for law in (learnt, reference_lqg(envs.unwrapped.design.full_plant))),
]
for result in found:
    cost = result.relative_cost
    print(f"{result.name:>16}: J / J without control = {cost.value:.3f} [{cost.low:.3f}, {cost.high:.3f}]")
assert found[0].relative_cost.value == 1.0
assert found[2].relative_cost.value < found[1].relative_cost.value < 0.8
