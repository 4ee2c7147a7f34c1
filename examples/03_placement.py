# %% [markdown]
# # Where the patches belong
#
# $x^T P x$ is the least cost of bringing the blade to rest from the state $x$, where
#
# $$
# A^T P + P A + Q - P B R^{-1} B^T P = 0 .
# $$
#
# Averaged over initial states of unit energy, it is $\mathrm{tr}(P)/r$ for $r$ modes. The actuators belong where $\mathrm{tr}(P)$
# is least. $B$, $R$ and, through the patches' mass and stiffness, $A$ depend on the positions.

# %%
import matplotlib.pyplot as plt
import numpy as np
from scipy.linalg import solve_continuous_are

from beamenv.baselines.placement import PlacementProblem, place
from beamenv.blade import blade_config, build_plant

problem = PlacementProblem.of(blade_config("thesis"), side="actuators", count=1)

# %% [markdown]
# The index of one layout, and the same from the plant that the environment would have, by SciPy's solver:

# %%
layout = problem.bounds.uniform()
plant = build_plant(problem.configuration(layout))
volt = 1500.0  # in units of the drive the equation is well scaled
P = solve_continuous_are(plant.A, plant.B * volt, plant.state_weight, plant.input_weight * volt**2)
index = problem.cost(layout[None])[0]
print(f"tr(P) = {index:.4f} s, by SciPy {np.trace(P):.4f} s")
assert abs(index / np.trace(P) - 1) < 0.01  # patches are put onto the bare blade's steady state

# %% [markdown]
# Every place for one actuator, and what the search finds. The best place is a minimum: the exact slope of the index is zero there,
# or the patch touches the end of its room.

# %%
everywhere = np.linspace(problem.bounds.low, problem.bounds.high, 200)
indices = problem.cost(everywhere[:, None])
found = place(problem, method="multistart", seed=0)
cost, slope = problem.cost_and_slopes(np.array(found.positions))
best = everywhere[indices.argmin()]
print(f"least of 200 places {indices.min():.5f} s at {best:.3f} m, found {found.cost:.5f} s at {found.positions[0]:.3f} m")
print(f"slope there: {slope[0]:.1e} s/m")
assert found.cost <= indices.min() * (1 + 1e-6)
assert abs(found.positions[0] - best) < everywhere[1] - everywhere[0]

# %% [markdown]
# A picture of it:

# %%
figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
axes.semilogy(everywhere, indices)
axes.plot(found.positions, [found.cost], "o")
axes.set(xlabel="root-side edge of the actuator, m", ylabel="tr(P), s")
plt.show()
