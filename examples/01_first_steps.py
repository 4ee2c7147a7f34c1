# %% [markdown]
# # First steps
#
# A blade whose hoop fibres ($\theta = 0$) give it no coupling between stretch and shear, untwisted, clamped at its root. In
# extension it is a rod, and spin softening eats the stiffness of a rod:
#
# $$
# m\,\ddot s - E_2 A\, s'' - \Omega^2 m\, s = 0
# \qquad\Longrightarrow\qquad
# \omega_1 = \frac{\pi}{2L}\sqrt{\frac{E_2}{\varrho}},
# \qquad
# \Omega^* = \omega_1 ,
# $$
#
# whatever the hub radius. At $\Omega^*$ the blade has no equilibrium left. For the thesis' blade that is 1428.2 rad/s, in the
# thesis' model: it vibrates about its shape at rest, however fast it turns.

# %%
import gymnasium as gym
import numpy as np

import beamenv
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, RotatingBeam

section = BoxSection(width=0.254, depth=0.0508, thickness=0.01016)  # m, of the mid-line
layup = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[0] * 6)
beam = RotatingBeam(section=section, layup=layup, length=2.023, hub_radius=0.2023, model="thesis")

by_hand = np.pi / (2 * beam.length) * np.sqrt(GRAPHITE_EPOXY.E2 / GRAPHITE_EPOXY.density)
print(f"critical speed: {beam.critical_speed:.2f} rad/s, by hand {by_hand:.2f} rad/s")
assert abs(beam.critical_speed / by_hand - 1) < 1e-6

# %% [markdown]
# Without rotation the extension mode has that very frequency, and the section has the stiffness of a strip:
# $EA = E_2 \cdot$ perimeter $\cdot$ thickness.

# %%
at_rest = beam.natural_frequencies(speed=0.0, count=1, motions=("extension",))[0]
perimeter = 2 * (section.width + section.depth)
stiffness = section.stiffness(layup, model="thesis")
print(f"extension at rest: {at_rest:.2f} rad/s;  EA = {stiffness[0, 0]:.4g} N")
assert abs(at_rest / by_hand - 1) < 1e-6
assert abs(stiffness[0, 0] / (GRAPHITE_EPOXY.E2 * perimeter * section.thickness) - 1) < 1e-9

# %% [markdown]
# Rotation stiffens flap by the tension, and lag less, for the load that bends it turns with it. Beyond $\Omega^*$ the first lag
# frequency is zero.

# %%
for speed in (0.0, 200.0, 1000.0, 1400.0, 1428.0):
    modes = beam.modes(speed, count=3)
    listed = ", ".join(f"{w:7.1f} {family}" for w, family in zip(modes.natural_frequencies, modes.families, strict=True))
    print(f"{speed:6.0f} rad/s: {listed}")
assert beam.natural_frequencies(1.001 * by_hand, count=1, motions=("lag", "extension"))[0] == 0.0

# %% [markdown]
# The environment has a blade of the same size with plies at 30°, pretwist and patches. One episode without control:

# %%
env = gym.make(beamenv.ENV_ID, scenario="deflection")
observation, info = env.reset(seed=0)
cost, truncated = 0.0, False
while not truncated:
    observation, reward, terminated, truncated, info = env.step(np.zeros(env.action_space.shape))
    cost += info["cost_increment"]
print(f"J = {1e3 * cost:.3f} mJ s after {env.unwrapped.task.steps} steps; {1e6 * info['energy']:.1f} µJ are left")
