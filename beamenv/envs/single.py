"""The Gymnasium environment ``beamenv/RotatingBeam-v0``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.model_blade import PlantArgument
from beamenv.configuration.keywords import known_keywords
from beamenv.envs.of_task import OfTask
from beamenv.envs.seeds import checked_seed
from beamenv.envs.specification import Specified
from beamenv.plant.spread import Spread
from beamenv.scenarios.scenario import Scenario
from beamenv.simulation.blades import Blades
from beamenv.simulation.motion import Motion
from beamenv.task import (
    DesignArgument,
    DType,
    Task,
    checked_action,
    checked_dtype,
    checked_task,
    information,
    reset_options,
    resolve_task,
    steady_information,
)

if TYPE_CHECKING:
    from beamenv.rendering import EpisodeRenderer, Instant

Array = NDArray[np.float64]


class RotatingBeamEnv(Specified, OfTask, gymnasium.Env[Any, Any]):
    """Damp the vibration of a rotating composite blade with piezoelectric patches.

    ## Description

    A rotating thin-walled composite blade, pretwisted and clamped to its hub, is struck or pushed and vibrates in lag and
    flap. Piezoelectric actuators (macro-fibre composites, MFC) in its top wall can bend it; sensors of the same kind in its
    bottom wall give a current in proportion to the rate of their strain. The aim is to damp the vibration with little
    actuator effort.

    The plant is linear; its motion and its cost are exact from one sample to the next. Two effects are not linear: the drive
    saturates, and the sensors clip. The true plant that moves, `plant`, has all modes up to the Nyquist frequency, the static
    response of higher modes, the amplifiers' lag and anti-aliasing filters. The design plant that a controller is built from,
    `design_plant`, has the blade's first 11 modes and no electronics; the argument `design` can make it that of another blade.
    With the thesis' model (`blade={"model": "thesis"}`) the two plants are the same. Otherwise most controllers that are
    designed on 11 modes are unstable on the true plant; `design.full_plant` has all that is known of the design's blade.

    The default blade is the thesis' box (2.023 m, plies at 30°, pretwist 30°) at 200 rad/s with 4 actuators and 4 sensors
    equally spaced over 0 … 0.7 of the span. No real blade could turn like that: steady rotation alone strains its outer face by
    2.8 %, far beyond what its laminate bears, and stretches it by 32 mm. It is the default because the thesis has it;
    `sound-blade` is a blade that could be built.

    | `preset`               | Blade                                                                     | rad/s | Static strain |
    |------------------------|---------------------------------------------------------------------------|-------|---------------|
    | `thesis`               | the default                                                               | 200   | 2.8 %         |
    | `sound-blade`          | the same box, plies at ±75°, no patch at the clamp; fails by total strain | 100   | 0.03 %        |
    | `thesis-untwisted`     | the default without pretwist                                              | 200   | 2.6 %         |
    | `thesis-pretwisted`    | the default with 30° presetting                                           | 200   | 3.1 %         |
    | `chandra-chopra`       | a box of 0.84 m with bending–twist coupling (Chandra and Chopra 1992)     | 104.7 | 0.02 %        |
    | `aluminium-cantilever` | a strip of 300 × 30 × 2 mm with a pair of piezoceramic sheets             | 0     | 0             |
    | `takacs-beam`          | a published strip of 550 × 40 × 3 mm with measurements (Takács 2012)      | 0     | 0             |
    | `airfoil-blade`        | a hollow NACA 0012 with a web, 1.3 m, with MFC along the span             | 72    | 0.01 %        |

    ## Action Space

    `Box(-1, 1, (4,), float32)`: one voltage for each actuator, from root to tip, in units of the drive limit. It is clipped
    to the limits and held over one control interval. With `physical_units=True` it is in volts.

    | Num | Action                       | Min | Max | Unit   |
    |-----|------------------------------|-----|-----|--------|
    | 0   | voltage of actuator 1 (root) | -1  | 1   | 1500 V |
    | 1   | voltage of actuator 2        | -1  | 1   | 1500 V |
    | 2   | voltage of actuator 3        | -1  | 1   | 1500 V |
    | 3   | voltage of actuator 4        | -1  | 1   | 1500 V |

    Limits that are not symmetric, say the −500 … 1500 V of the data sheet, keep the larger one as the unit: −500 V is then an
    action of −1/3, and what lies below has no more effect.

    ## Observation Space

    `Box(-1, 1, (4,), float32)`: one reading of each sensor, from root to tip, in units of its full scale, with noise of 2 %
    of full scale, clipped as a data acquisition clips. Full scale is twice the largest current that a sudden 30 N/m brings
    about, so that clipping is rare (one reading in 10⁵ in the nominal scenario). With `physical_units=True` it is in amperes.

    | Num | Observation                | Min | Max | Unit       |
    |-----|----------------------------|-----|-----|------------|
    | 0   | current of sensor 1 (root) | -1  | 1   | full scale |
    | 1   | current of sensor 2        | -1  | 1   | full scale |
    | 2   | current of sensor 3        | -1  | 1   | full scale |
    | 3   | current of sensor 4        | -1  | 1   | full scale |

    One reading cannot tell the state: an agent needs memory, or the `beamenv.envs.history.SensorHistory` of what it read and did.
    `reset` returns the reading at t₀; the voltages chosen from the reading at t_k act over [t_k, t_k + Δt], and `step`
    returns the reading at t_k + Δt: no delay beyond the sampling itself.

    ## Rewards

    *r = −(1/s) ∫ (x<sup>T</sup>Q x + u<sup>T</sup>R u) dt* over the control interval: vibration energy, in joules, plus the
    energy that the actuators store, exactly integrated. It is the very cost that LQG is designed for. The scale *s* is fixed
    by the plant alone: the energy of the static deflection under 30 N/m in flap, times Δt. Without control the reward is
    therefore about −1 a step.

    ## Starting State

    At rest, or released from a static deflection. Each episode has one load case, drawn from the `scenario`, a uniform line
    load held constant over each control interval. In the nominal scenario it is, with equal chances,

    - a **step** of 15 … 45 N/m that sets in at 0 … 50 ms and stays,
    - a rectangular **pulse** of 15 … 45 N/m that sets in at 0 … 50 ms and lasts 5 … 50 ms,
    - an initial **deflection** as under 15 … 45 N/m, released at t = 0,
    - a **harmonic** load of 1.5 … 4.5 N/m at 0.5 … 2 times the first natural frequency,

    in any direction between lag and flap. White line loads (3 N/m in each direction in every interval) act besides. ±1500 V
    are enough to make a difference at 30 N/m: LQG then saturates now and then, and halves the time to settle.
    `beamenv.scenarios.scenario` gives the reason of each number.

    ## Scenarios

    A scenario says what may happen to a blade in an episode: loads, noises, and faults. Each named scenario is a TOML file and
    has its own environment id, such as `beamenv/RotatingBeam-overload-v0`. What the table does not name is as in `nominal`.

    | Scenario     | What it has                                                                                            |
    |--------------|--------------------------------------------------------------------------------------------------------|
    | `nominal`    | the plant that controllers are designed for, the load cases above                                      |
    | `off-speed`  | rotor speed 0.7 … 1.3 times the design's, one of 128 plants drawn for each episode                     |
    | `off-model`  | ply angles, moduli and mass within 10 %, damping ratio 0.003 … 0.02: one of 128 plants                 |
    | `spin-up`    | 100 to 300 rad/s within the episode, on a cycloid, with Euler's force; no need of a load to vibrate    |
    | `spillover`  | the design plant has 5 modes                                                                           |
    | `hysteresis` | free strain of the actuators with a loop of 20 % of the stroke; drive −500 … 1500 V                    |
    | `delay`      | voltages 1 … 3 control intervals late; 5 % of the readings lost: the last one is shown again           |
    | `failure`    | one actuator dead; one sensor dead (noise alone), or biased by 5 … 20 % of full scale                  |
    | `rotor`      | 6, 4, 2, 1 N/m, times 0.5 … 1.5, at 1 … 4 per revolution; turbulence of 5 N/m and 20 ms; pulses, releases |
    | `overload`   | steps of 500 N/m: the actuators saturate, the sensors clip                                             |
    | `solid`      | the blade is a three-dimensional finite-element model with 11 modes, the design plant is the beam's    |
    | `solid-20`   | the same solid with 20 modes                                                                           |
    | `mid-failure` | an actuator or a sensor dies, 0.05 … 0.3 s into the episode                                         |
    | `gust-speed` | rotor speed wanders by 5 % (one standard deviation), up to 2 Hz; `rotor_speed` does not show it          |
    | `drift`      | up to 15 % heavier and 20 % softer within the episode, from a drawn instant on                         |
    | `unknown-everything` | speed, plies, mass, hysteresis, delay, lost readings, a weak actuator, a bias, rotor loads: all mild |
    | `off-speed-failure`, `delay-off-model`, `delay-failure`, `hysteresis-rotor` | both faults that the name says           |
    | `long-delay`, `two-dead-actuators`, `biased-sensor` | voltages 4 control intervals late; two dead; by 30 % of full scale |

    Your own file (`scenario="gusts.toml"`) or dictionary may start from any of them, named as its `preset`, and change it table
    by table:

    ```python
    >>> import gymnasium, beamenv
    >>> env = gymnasium.make("beamenv/RotatingBeam-v0", scenario={"preset": "rotor", "drive": {"delay": 1}})

    ```

    Two attributes are for controllers that are told more than the readings: `rotor_speed`, rad/s, is what a tachometer shows now;
    `design_state` is the true state in the coordinates of the design plant, found from displacements and velocities. (In `solid`
    and `solid-20` it is found mode by mode, as far as the beam has a mode like it.)

    ## Episode End

    1. Termination: the blade fails, that is its spanwise strain exceeds what its patches bear, 0.45 % of MFC and less of ceramics,
       or its state is no longer finite. In the nominal scenario strains stay tens of times smaller. `blade={"strain_limit": ...}`
       says which strain counts: that of `"vibration"` alone, or the `"total"` with that of steady rotation, as on the preset
       `sound-blade`. A blade that would fail by steady rotation alone, at any speed of the scenario, is refused.
    2. Truncation: `duration` is over.

    ## Arguments

    ```python
    >>> import gymnasium, beamenv
    >>> env = gymnasium.make("beamenv/RotatingBeam-v0", scenario="pulse", blade={"damping_ratio": 0.02})
    >>> observation, info = env.reset(seed=7, options={"load": {"case": "step", "magnitude": 30.0, "direction_deg": 90.0}})
    >>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())

    ```

    - `preset`: the configuration to begin with, one of `beamenv.PRESETS`; default `"thesis"`.
    - `speed`: rotor speed in rad/s, in place of the preset's (200).
    - `blade`: the true blade: changes to the preset as a (nested) dictionary, or a whole `BladeConfig`.
    - `design`: the blade that controllers are designed for: the name of a preset, changes to `preset` (at `speed`, without
      the changes in `blade`), or a whole `BladeConfig`; default: the true one.
    - `scenario`: a name in `beamenv.SCENARIOS`, the path of a `.toml` file, a dictionary of fields (with "preset" to depart from
      a named one), or a `Scenario`.
    - `duration`: of an episode in s, default 0.5: some 14 periods of the slowest mode, after which 1 % of damping alone leaves
      40 % of its amplitude. An environment's spec holds its number of steps; for longer episodes use
      `gym.make(env.spec, duration=1.0, max_episode_steps=-1)`.
    - `physical_units`: volts and amperes in place of normalised numbers; default False.
    - `dtype`: of both spaces and the observations, `"float32"` or `"float64"`; default `"float32"`, which agents' networks
      have. What is stepped, and info, has 64 bits always.
    - `plant`: your own model instead of a blade: a `Plant`, the path of a `.npz`, `.mat` or `.json` file, a table of matrices, or a
      list of several, one of which moves in each episode. Episodes are longer in the ratio by which its first mode is slower than
      the blade's, and loads and drive are scaled to it; pictures show only its time histories. `design` is a model then too.
    - `spread`: how much a `plant` varies: a table of relative half widths, "frequency", "damping", "actuator" and "sensor". Each
      episode has one of the plants within it, of which `scenario`'s bank holds a number. Agents are trained on other plants than
      those they are judged on.
    - `render_mode`: None, `"rgb_array"` (pictures 540 × 960 from `render`) or `"human"` (a window that shows every step); both
      need `pip install "beamenv[render]"`. There is one picture for each step; at 50 pictures a second they run 40 times slower
      than real time. Deflections are magnified so that the largest without control, in this scenario, fits. The title names
      scenario and seed, and before them the controller if the attribute `controller` is set.

    The control interval is 0.5 ms, a field of the configuration: more than four samples a period of the 11th mode
    (2.7 krad/s), the last one retained.

    `reset(options={"load": {...}})` fixes the load case of one episode: "case", and as a number or a range any of "magnitude"
    (N/m), "direction_deg" (0: lag, 90: flap), "onset" (s), "duration" (s), "frequency_ratio" and "phase_deg". What is left
    out is drawn as ever. `reset(options={"initial_state": x})` starts in the state x (n,), in energy coordinates, or in the
    blade's own states (the first of them) with the electronics at rest.

    A bad argument, option or action raises ValueError with one sentence, and changes nothing.

    ## Info

    | Key                | Unit | What                                                       |
    |--------------------|------|------------------------------------------------------------|
    | `volts`            | V    | (4,) voltages asked for, after saturation                  |
    | `tip_displacement` | m    | (2,) lag and flap of the tip now                           |
    | `energy`           | J    | vibration energy now                                       |
    | `effort`           | J s  | the actuators' share of `cost_increment`                   |
    | `cost_increment`   | J s  | the cost of this step; the reward is minus it over *s*     |

    `reset` also tells the effect of steady rotation on the blade of this episode (all 0 with `model="thesis"`, which has no
    steady state; in a spin-up the effect of the first speed):

    | Key                | Unit | What                                                                     |
    |--------------------|------|--------------------------------------------------------------------------|
    | `static_stretch`   | m    | how far the tip has moved along the span                                 |
    | `static_untwist`   | °    | turn of the tip section against the pretwist                             |
    | `static_strain`    |      | the outer face's largest spanwise strain, with its sign                  |
    | `static_strain_at` | m    | where that is, from the root                                             |
    | `note`             |      | which patches begin nearer to the clamp than the section is deep, or ""  |
    | `assumed`          |      | of a model of one's own, in words, what was taken to be so; else ()      |

    Near the clamp, where a section cannot deform, beam theory is least accurate: the forces and readings of the default blade's
    first patches, mode by mode, differ from those of a solid of finite elements by up to 7 % (in the thesis' model 110 %).

    ## Version History

    * v0: Initial version.
    """

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 50}
    controller = ""
    """Who acts, for the title line of pictures; set it before ``reset``."""
    _renderer: EpisodeRenderer | None = None
    _episode = 0
    """How many have begun since the last seed."""

    @known_keywords("the environment")
    def __init__(
        self,
        preset: str = "thesis",
        speed: float | None = None,
        blade: BladeConfig | Mapping[str, Any] | None = None,
        design: DesignArgument = None,
        scenario: Scenario | Mapping[str, Any] | str | None = None,
        duration: float | None = None,
        physical_units: bool = False,
        dtype: Any = None,
        render_mode: str | None = None,
        plant: PlantArgument | None = None,
        spread: Spread | Mapping[str, Any] | None = None,
    ) -> None:
        if render_mode is not None and render_mode not in self.metadata["render_modes"]:
            raise ValueError(f"render_mode is {render_mode!r}, but must be None or one of {self.metadata['render_modes']}.")
        self.render_mode = render_mode
        self._dtype: DType = "float32" if dtype is None else checked_dtype(dtype)
        self.set_task(resolve_task(preset, speed, blade, design, scenario, duration, physical_units, plant, spread))

    def set_task(self, task: Task) -> None:
        """Take on a task, and with it a blade, in place of the one before; what comes next must be ``reset``.

        Raises ``ValueError`` for what is no task and for one whose plants cannot be built; nothing has changed then.
        """
        blade = Blades(checked_task(task).bank, task.scenario, None, task.physical_units)
        self.task, self._blade = task, blade
        self.action_space = task.action_space(self._dtype)
        self.observation_space = task.observation_space(self._dtype)
        self._action_shape = (self.plant.B.shape[1],)
        self._steps = task.steps
        self._elapsed = 0
        self._generators: list[np.random.Generator] | None = None
        self.close()
        self._renderer = None if self.render_mode is None else self._make_renderer()

    @property
    def state(self) -> Array:
        """(n,) the true state, hidden from an agent: the blade's in energy coordinates, ½ xᵀx in joules, then the electronics'."""
        return self._blade.state

    @property
    def coming_loads(self) -> Array:
        """(2,) N/m, lag and flap: the line loads of the interval to come, hidden from an agent."""
        return self._blade.coming_loads

    @property
    def design_state(self) -> Array:
        """(d) the true state as the design plant has its own, by displacements and velocities: for a controller that sees it."""
        return self._blade.design_state

    @property
    def rotor_speed(self) -> Any:
        """() rad/s: what a tachometer shows now."""
        return self._blade.speed

    @property
    def episode_truth(self) -> Array:
        """(2 + m + 2 p): which plant of the bank moves, and what is wrong now: see ``Blades.truth``."""
        return self._blade.truth

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[NDArray[Any], dict[str, Any]]:
        """Begin an episode; ``options`` may fix its "load" or give its "initial_state" (see the class)."""
        scenario, initial_state = reset_options(self.task, options, rows=1)
        super().reset(seed=checked_seed(seed))
        self._generators = [self.np_random]
        self._elapsed = 0
        self._episode = 1 if seed is not None else self._episode + 1
        motion = self._blade.begin(self._generators, scenario=scenario, initial_state=initial_state)
        if self._renderer is not None:
            self._renderer.begin(self._instant(motion), self._whose())
        info = {**information(motion), **steady_information(self._blade.steady(), self.task.note, self.plant.assumed)}
        return motion.observation.astype(self._dtype), info

    def step(self, action: Array) -> tuple[NDArray[Any], float, bool, bool, dict[str, Any]]:
        """Hold the voltages over one control interval."""
        if self._generators is None:
            raise gymnasium.error.ResetNeeded("Call reset before step.")
        motion = self._blade.step(checked_action(action, self._action_shape), self._generators)
        self._elapsed += 1
        if self._renderer is not None:
            self._renderer.record(self._instant(motion))
        observation, ended = motion.observation.astype(self._dtype), self._elapsed >= self._steps
        return observation, float(motion.reward), bool(motion.failed), ended, information(motion)

    def render(self) -> NDArray[np.uint8] | None:
        """A picture (540, 960, 3) of the blade, deflection magnified, with its patches and the last 0.2 s of the episode.

        None with `"human"`, whose window shows every step by itself.
        """
        if self._renderer is None:
            gymnasium.logger.warn('render was called without a render_mode: make the environment with render_mode="rgb_array".')
            return None
        if self._generators is None:
            raise gymnasium.error.ResetNeeded("Call reset before render.")
        return None if self.render_mode == "human" else self._renderer.draw()

    def close(self) -> None:
        """Close the window, if there is one."""
        if self._renderer is not None:
            self._renderer.close()

    def _make_renderer(self) -> EpisodeRenderer:
        from beamenv.rendering import renderer_of

        return renderer_of(self.task, self.metadata["render_fps"] if self.render_mode == "human" else None)

    def _whose(self) -> str:
        from beamenv.rendering import of_episode

        return of_episode(self.controller, int(self.np_random_seed), self._episode)

    def _instant(self, motion: Motion) -> Instant:
        from beamenv.rendering import Instant, gains

        actuators, sensors = gains(self.episode_truth, len(motion.volts), len(motion.observation))
        reading = motion.observation / self.plant.sensor_full_scale if self.task.physical_units else motion.observation
        return Instant(
            state=self.state,
            plant=int(self._blade.index[0]),
            speed=float(self.rotor_speed),
            tip_displacement=motion.tip_displacement,
            volts=motion.volts,
            reading=reading,
            cost_increment=float(motion.cost_increment),
            load=self.coming_loads,
            actuator_gain=actuators,
            sensor_gain=sensors,
        )
