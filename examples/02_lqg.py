# %% [markdown]
# # LQG, and the proof that it is the optimum
#
# LQG is told here the very plant that moves, with all its modes, amplifiers and filters. It obeys $x^+ = Ax + Bu + Ed$,
# $y = Cx + v$ exactly between samples, with white loads $d \sim N(0, W)$ and readings' noise $v \sim N(0, V)$, and costs
# $z^T \Phi z$ an interval, $z = [x; u; d]$. The least mean cost that any law can have which sees only $y$ is
#
# $$
# J^* = \frac{1}{\Delta t}\Bigl\{ \mathrm{tr}\,(E^T P E + \Phi_{dd}) W + \mathrm{tr}\,(\Phi_{uu} + B^T P B)\, K \Sigma K^T \Bigr\}
# $$
#
# with $P$, $K$ of the regulator's Riccati equation and $\Sigma$ the covariance of the filtered estimate's error: what control
# costs when the state is known, and what not knowing it adds.

# %%
import gymnasium as gym
import numpy as np
from scipy.linalg import solve_discrete_are

import beamenv
from beamenv import sample
from beamenv.baselines import lqg, stationary_cost

BLADES, DURATION, SETTLE = 64, 2.5, 0.5
envs = gym.make_vec(
    beamenv.ENV_ID, num_envs=BLADES, scenario="white", duration=DURATION, blade={"voltage_limits": (-1e6, 1e6)}
)  # white noise only, and a drive that never saturates
plant = envs.unwrapped.plant

# %% [markdown]
# The analytic optimum, from SciPy's Riccati solver alone:

# %%
held = sample(plant)
A, B, C, E, W, V = held.A, held.B, held.C, held.disturbance_input, held.process_noise, held.sensor_noise
volt = 1500.0  # the unit of voltage, and full scale that of current: well scaled equations
unit = plant.sensor_full_scale
P = solve_discrete_are(A, B * volt, held.state_weight, held.input_weight * volt**2, s=held.cross_weight * volt)
K = np.linalg.solve(held.input_weight + B.T @ P @ B, B.T @ P @ A + held.cross_weight.T)
predicted = solve_discrete_are(A.T, (C / unit[:, None]).T, E @ W @ E.T, V / np.outer(unit, unit))
filtered = predicted - predicted @ C.T @ np.linalg.solve(C @ predicted @ C.T + V, C @ predicted)
loads = held.cost[-2:, -2:]
known = np.trace((E.T @ P @ E + loads) @ W) / held.interval
unknown = np.trace((held.input_weight + B.T @ P @ B) @ K @ filtered @ K.T) / held.interval
optimum = known + unknown
print(f"J* = {1e6 * known:.2f} + {1e6 * unknown:.2f} = {1e6 * optimum:.2f} µJ")

# %% [markdown]
# `lqg` builds the controller, `stationary_cost` works out the mean cost of any linear law from its closed loop.

# %%
controller = lqg(plant)
print(f"LQG, by its closed loop: {1e6 * stationary_cost(plant, controller):.2f} µJ")
assert abs(stationary_cost(plant, controller) / optimum - 1) < 1e-6

# %% [markdown]
# And measured in the environment, whose noise and cost the controller was never shown:

# %%
observation, _ = envs.reset(seed=0)
memory, cost = None, np.zeros(BLADES)
for step in range(round(DURATION / plant.control_interval)):
    action, memory = controller.predict(observation, memory)
    observation, _, _, _, info = envs.step(action)
    cost += info["cost_increment"] * (step * plant.control_interval >= SETTLE)
cost /= DURATION - SETTLE
error = cost.std(ddof=1) / np.sqrt(BLADES)
print(f"LQG, measured: {1e6 * cost.mean():.2f} ± {1e6 * 1.96 * error:.2f} µJ (95 %)")
assert abs(cost.mean() - optimum) < 3 * error
