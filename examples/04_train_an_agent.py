# %% [markdown]
# # Train an agent
#
# The blade's step is linear in state, voltages and loads and quadratic in cost, and it is written once for NumPy and torch. So the
# gradient of the cost by the weights $w$ of a policy $u_k = \pi_w(y_0, u_0, \dots, y_k)$ is exact:
#
# $$
# \frac{\mathrm{d}}{\mathrm{d}w} \sum_k z_k^T \Phi z_k, \qquad z_k = [x_k; u_k; d_k], \qquad x_{k+1} = A x_k + B u_k + E d_k .
# $$
#
# Here a gated recurrent unit is trained by it, for 40 updates only. The shipped recipe makes 3000.

# %%
import gymnasium as gym

import beamenv
from beamenv.baselines import evaluate, reference_lqg
from beamenv.task import resolve_task
from beamenv.train.learning.through_plant.gradient import GradientSettings, train_gradient

task = resolve_task(scenario="deflection")
learning = []
policy = train_gradient(task, 0, learning.append, GradientSettings(episodes=64), updates=40)[0]
print(f"J / J without control while training: {learning[0].cost:.2f} at first, {learning[-1].cost:.2f} at last")

# %% [markdown]
# Judged as every controller is: on episodes that it has not met, beside LQG, which knows the plant.

# %%
envs = gym.make_vec(beamenv.ENV_ID, num_envs=32, scenario="deflection")
learnt = evaluate(policy, envs, seeds=range(32))
optimal = evaluate(reference_lqg(envs.unwrapped.design.full_plant), envs, seeds=range(32), reference=learnt.reference)
for result in (learnt, optimal):
    cost = result.relative_cost
    print(f"{result.name:>16}: J / J without control = {cost.value:.3f} [{cost.low:.3f}, {cost.high:.3f}]")
assert learnt.relative_cost.high < 1.0
assert optimal.relative_cost.value < learnt.relative_cost.value
