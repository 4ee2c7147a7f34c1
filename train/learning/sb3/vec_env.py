"""What agents of Stable-Baselines3 are trained in: ``beamenv.BladeVecEnv`` with memory, and with rewards that teach sooner."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from beamenv import BladeVecEnv, VectorSensorHistory
from beamenv.plant.plant import normalised
from beamenv.simulation.blades import reward_scale
from beamenv.task import Task
from train.learning.checkpoint import as_arrays
from train.learning.sb3.belief import Belief, VectorBelief
from train.learning.sb3.fitted import Regression
from train.learning.sb3.twins import Twins
from train.learning.sb3.typical import load_unit, typical_state

Array = NDArray[Any]


REWARD_UNIT = 0.01
"""What the environment's reward is multiplied by if not said otherwise: its values, hundreds, would take a critic long to reach."""


class TrainingVecEnv(BladeVecEnv):
    """Blades whose agent sees the last ``history`` readings and own voltages, or a ``belief``; infos for finished episodes only.

    With ``energy_horizon`` τ > 0 the reward is shaped by the vibration energy E as a potential: r + τ (E − γ E⁺)/scale. For an
    agent that learns with the ``discount`` γ this changes no policy's rank (Ng, Harada and Russell 1999), but what a voltage takes
    out of the blade shows at once.

    An action is ``held`` for so many control intervals: a step of this environment is as many of the blades'. The voltages go a
    share ``approach`` of the way from those held before to it: exploration that wanders tells more of the slow modes, and disturbs
    the readings, which are currents, less than jumps do.

    With ``shows_state`` the true state follows in each observation, in units of what is typical, for a critic; with ``shows_loads``
    the loads (k) of the coming interval after it, in units of ``load_unit``.

    ``reference``, J s, is the cost of an episode without control. If it is given, rewards are in its units, so that those of
    scenarios of very different loads have one size, and ``relative_cost`` is known.

    With ``fitted`` slow modes what the belief shows is an estimate that ``refit`` makes of the true states met since it was last
    called, see ``train.learning.sb3.fitted``.

    Of ``twins`` the second half of the blades meets what the first half does, see ``train.learning.sb3.twins``.
    """

    def __init__(
        self,
        count: int,
        environment: Mapping[str, Any] | Task,
        seed: int,
        *,
        history: int = 12,
        energy_horizon: float = 0.0,
        discount: float = 1.0,
        shows_state: bool = False,
        held: int = 1,
        reference: float | None = None,
        reward_unit: float = REWARD_UNIT,
        approach: float = 1.0,
        shows_loads: bool = False,
        belief: Belief | None = None,
        twins: bool = False,
        fitted: int = 0,
    ) -> None:
        task = environment if isinstance(environment, Task) else None
        super().__init__(count, seed, **{"dtype": "float64", **({} if isinstance(environment, Task) else environment)})
        self.blades: Any = self.envs.unwrapped
        if task is not None:
            self.blades.set_task([task])
        self.envs = VectorSensorHistory(self.envs, length=history) if belief is None else VectorBelief(self.envs, belief)
        actions = self.blades.single_action_space
        self.seen = int(np.prod(self.envs.single_observation_space.shape or ()))
        """How many numbers of an observation sensors show; what follows is the state."""
        self._state_gain = 1.0 / typical_state(self.blades.task, reference) if shows_state else None
        self._shows_loads, self.approach, self.belief, self._twins = shows_loads, approach, belief, twins
        self._regression = Regression(self.blades.task, fitted) if fitted else None
        self._limits = normalised(self.blades.plant).voltage_limits
        self._voltages: Array = np.zeros((count, *(actions.shape or ())))
        self._load_unit = load_unit(self.blades.plant)
        width = self.seen + (0 if self._state_gain is None else len(self._state_gain) + len(self._load_unit) * shows_loads)
        self.observation_space = Box(-np.inf, np.inf, (width,), np.float32)
        self.action_space = Box(-1.0, 1.0, actions.shape, np.float32)
        self._scale = reward_scale(self.blades.plant)
        self._per_step = self.blades.task.steps / reference if reference else np.nan
        self._unit = reward_unit * (self._scale * self._per_step if reference else 1.0)
        self.held = held
        self._discount = discount ** (1.0 / held)
        self._potential = energy_horizon / self._scale
        self._states: Array = np.zeros((count, 0), np.float32)
        self._energy = np.zeros(count)
        self.last_cost = 0.0
        """J s: mean increment of J over the batch in the last step, unshaped."""
        self._unfinished: list[dict[str, Any]] = [{} for _ in range(count)]

    @property
    def relative_cost(self) -> float:
        """``last_cost`` relative to no control; NaN without a ``reference``."""
        return self.last_cost * self._per_step

    def reset(self) -> Array:
        """Begin episodes, out of step with one another unless the options say how much is ``elapsed``."""
        steps, apart = self.blades.task.steps, self.num_envs // (1 + self._twins)
        elapsed = np.arange(self.num_envs) % apart * steps // apart // self.held * self.held
        if self._twins:
            seeded = np.random.default_rng(self._seed) if self._seed is not None else self.blades.np_random
            self.blades.np_random, self._seed = Twins(seeded.bit_generator), None
        observations, info = self._begin({"elapsed": elapsed})
        self._energy, self._voltages[...] = info["energy"], 0.0
        return self._with_state(observations)

    def state_dict(self) -> dict[str, Any]:
        """Where the episodes are: an equally made batch continues from it bit for bit."""
        own = {"states": self._states.copy(), "energy": self._energy.copy(), "last_cost": self.last_cost}
        own["voltages"] = self._voltages.copy()
        if self._regression is not None:
            assert self.belief is not None
            own["estimate"] = {**self._regression.state_dict(), "shown": self.belief.shown.copy()}
        return {"blades": self.blades.state_dict(), "history": self.envs.state_dict(), **own}

    def load_state_dict(self, state: Mapping[str, Any]) -> None:
        """Go back to the ``state_dict`` of an equally made batch."""
        self.reset()
        self.blades.load_state_dict(as_arrays(state["blades"]))
        self.envs.load_state_dict(state["history"])
        self._states, self._energy, self._voltages = (np.asarray(state[name]).copy() for name in ("states", "energy", "voltages"))
        self.last_cost = state["last_cost"]
        if self._regression is not None:
            self._regression.load_state_dict(state["estimate"])
            self._show(np.asarray(state["estimate"]["shown"], np.float32))

    def refit(self) -> None:
        """Show the estimate by what was met."""
        assert self._regression is not None
        self._show(self._regression.fit())

    def _show(self, shown: Array) -> None:
        assert self.belief is not None
        self.belief = self.belief._replace(shown=shown)
        self.envs.show(self.belief)

    def _with_state(self, windows: Array) -> Array:
        if self._state_gain is None:
            return windows
        self._states = (self.blades.state * self._state_gain).astype(np.float32)
        if self._shows_loads:
            self._states = np.hstack([self._states, self.blades.coming_loads.astype(np.float32) / self._load_unit])
        return np.concatenate([windows, self._states], axis=1)

    def step_wait(self) -> tuple[Array, Array, Array, list[dict[str, Any]]]:
        """Observations, rewards, ends and infos; where an episode ended the observation is the next one's first."""
        total, ended = np.zeros(self.num_envs), np.zeros(self.num_envs, dtype=np.bool_)
        infos, self.last_cost = self._unfinished, 0.0
        voltages = self._actions
        if self.approach < 1.0:
            self._voltages += self.approach * (voltages - self._voltages)
            voltages = np.clip(self._voltages, *self._limits, out=self._voltages)
        for _ in range(self.held):
            windows, rewards, terminated, truncated, info = self.envs.step(voltages)
            ends, reached = terminated | truncated, info["energy"]
            if ends.any():
                reached = np.where(ends, info["final_info"]["energy"], reached)
                infos = self._infos(infos, np.flatnonzero(ends), info["final_obs"], terminated)
            gained = rewards + self._potential * (self._energy - self._discount * reached)
            total += np.where(ended, 0.0, gained)  # what follows a finished episode is not its action's doing
            ended |= ends
            self._energy = info["energy"]
            self.last_cost -= float(rewards.mean()) * self._scale / self.held
        self._voltages[ended] = 0.0
        if self._regression is not None:
            self._regression.add(self.envs.estimate, self.blades.state, self.blades.coming_loads)
        return self._with_state(windows), (self._unit * total).astype(np.float32), ended, infos

    def _infos(self, before: list[dict[str, Any]], rows: Array, final: Array, terminated: Array) -> list[dict[str, Any]]:
        infos = list(before)
        for row in rows.tolist():
            last = np.append(final[row], self._states[row])  # the last state shown stands for that at the end
            infos[row] = {"terminal_observation": last, "TimeLimit.truncated": not terminated[row]}
        return infos
