# %% [markdown]
# # Clone a controller from data
#
# Behaviour cloning: a policy $\pi_w$ learns what LQG asked for, $u_k$, from recorded readings $y$ alone, and never meets the blade
# while it learns,
#
# $$
# \min_w \; \sum_{k} \bigl\lVert \pi_w(y_{k-h+1}, \dots, y_k) - u_k \bigr\rVert^2 .
# $$
#
# LQG has a memory, its filter's; the clone has the last $h$ readings in its place.

# %%
from tempfile import TemporaryDirectory

import gymnasium as gym
import numpy as np
import torch

import beamenv
from beamenv.baselines import evaluate, reference_lqg
from beamenv.train.datasets import record
from beamenv.train.shared.held_out import held_out

HISTORY = 64
with TemporaryDirectory() as folder:  # to keep a data set: `beamenv record lqg --scenario nominal`
    episodes = list(record("lqg", "nominal", episodes=64, folder=folder).iterate_episodes())


def windows(readings):
    """The last ``HISTORY`` readings at each instant, zero before the first: (T, 4) to (T, 4 HISTORY)."""
    padded = np.concatenate([np.zeros((HISTORY - 1, readings.shape[1]), np.float32), readings])
    return torch.as_tensor(np.lib.stride_tricks.sliding_window_view(padded, HISTORY, axis=0).reshape(len(readings), -1).copy())


seen = torch.cat([windows(each.observations[:-1]) for each in episodes])
asked = torch.cat([torch.as_tensor(each.actions) for each in episodes])

torch.manual_seed(0)
policy = torch.nn.Sequential(torch.nn.Linear(seen.shape[1], 64), torch.nn.Tanh(), torch.nn.Linear(64, 4), torch.nn.Tanh())
optimiser = torch.optim.Adam(policy.parameters(), lr=1e-3)
for _ in range(8):
    for batch in torch.randperm(len(seen)).split(1024):
        loss = (policy(seen[batch]) - asked[batch]).square().mean()
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
print(f"of the voltages' mean square {100 * loss.item() / asked.square().mean().item():.1f} % is missed on the data")

# %% [markdown]
# Small errors on the data may add up in the loop, so the clone is judged there: on held-out seeds, beside its teacher.


# %%
class Clone:
    """The policy as a controller: its memory (N, 4, HISTORY) is the readings that it has seen."""

    name = "clone"

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        """Voltages and memory."""
        state = np.zeros((*observation.shape, HISTORY), np.float32) if state is None else state
        state = np.concatenate([state[:, :, 1:], observation[:, :, None]], axis=2, dtype=np.float32)
        with torch.no_grad():
            return policy(torch.as_tensor(state).flatten(1)).numpy(), state


envs = gym.make_vec(beamenv.ENV_ID, num_envs=32, scenario="nominal")
clone = evaluate(Clone(), envs, held_out(32))
teacher = evaluate(reference_lqg(envs.unwrapped.design.full_plant), envs, held_out(32), reference=clone.reference)
for result in (clone, teacher):
    cost = result.relative_cost
    print(f"{result.name:>6}: J / J without control = {cost.value:.3f} [{cost.low:.3f}, {cost.high:.3f}]")
assert teacher.relative_cost.value < clone.relative_cost.value < 1.05 * teacher.relative_cost.value
