"""The arguments and the spaces that the single and the batched environment share."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any, Literal, TypeVar
from weakref import WeakValueDictionary

import numpy as np
from gymnasium.spaces import Box
from numpy.typing import NDArray

from beamenv.blade.build import Blade
from beamenv.blade.clamp import clamp_note
from beamenv.blade.config import BladeConfig
from beamenv.blade.design import Design
from beamenv.blade.files import load_config
from beamenv.blade.given import given_blade
from beamenv.blade.held_load import under_reference
from beamenv.blade.instruments import in_range
from beamenv.blade.model_blade import DRIVE, ModelBlade, PlantArgument
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.configuration import Choice, Count, Flag, Number, Refused, checked, checked_table, read
from beamenv.configuration.arrays import real_numbers
from beamenv.configuration.files import ENDINGS
from beamenv.configuration.numbers import UNBOUNDED
from beamenv.knowledge import TIERS, TRUTH, Prior, Truth, kept_for_judging, on_training_bank, without_faults
from beamenv.plant.files import load_plant
from beamenv.plant.plant import Plant
from beamenv.plant.spread import Spread
from beamenv.scenarios.of_models import check_scenario, design_model, true_model
from beamenv.scenarios.own_loads import of_blade
from beamenv.scenarios.sampling import check_frequencies, largest_speed
from beamenv.scenarios.scenario import Scenario, with_load
from beamenv.scenarios.scenario import scenario as as_scenario
from beamenv.simulation.motion import Motion
from beamenv.simulation.plants.bank import Bank
from beamenv.simulation.plants.banks import build_bank
from beamenv.simulation.strain_limit import FAILURE_STRAIN

Array = NDArray[np.float64]

BladeArgument = BladeConfig | Mapping[str, Any] | str | Path | None
DesignArgument = BladeConfig | Mapping[str, Any] | str | Path | Plant | None
ScenarioArgument = Scenario | Mapping[str, Any] | str | Path | None

DType = Literal["float32", "float64"]
"""Numbers of the spaces, and of what is in them; what is stepped has 64 bits always."""

DURATION = 0.5
"""s of an episode, of a model as much longer as its first mode is slower than the default blade's."""

INFO = ("volts", "tip_displacement", "energy", "effort", "cost_increment")
"""What info holds of a ``Motion``."""

STEADY_INFO = ("static_stretch", "static_untwist", "static_strain", "static_strain_at")
"""What a reset's info holds besides, of the blade as it turns and nothing vibrates."""


@dataclass(frozen=True)
class Task:
    """What an environment is made of, its arguments checked and resolved.

    It owns its blades, with their plants, and its bank: each is built when it is first asked for. ``dataclasses.replace`` gives a
    task that shares the blades that are not replaced.
    """

    blade: Blade
    """The true blade: what moves."""
    design_blade: Blade
    """The blade that controllers are designed for; the true one unless said otherwise."""
    scenario: Scenario
    steps: int
    """Control intervals in an episode."""
    physical_units: bool
    told_scenario: Scenario | None = None
    """What controllers are told of where plants are of another bank than that of the scenario they are for; None: ``scenario``."""

    @property
    def config(self) -> BladeConfig:
        """Of the true blade."""
        return self.blade.config

    @property
    def design_config(self) -> BladeConfig:
        """Of the blade that controllers are designed for."""
        return self.design_blade.config

    @property
    def plant(self) -> Plant:
        """The true plant: what moves."""
        return self.blade.truth

    @property
    def design_plant(self) -> Plant:
        """The plant that controllers are designed for: the design blade's, of its ``modes`` modes and without electronics."""
        return self.design_blade.plant

    @property
    def design(self) -> Design:
        """What a controller of tier 0 may be built from (``beamenv.knowledge``)."""
        return Design.of(self.design_blade)

    @cached_property
    def prior(self) -> Prior:
        """What a controller of tier 1 may be built from."""
        known = self.scenario if self.told_scenario is None else self.told_scenario
        if kept_for_judging(known):
            own = self._as_designed
            return Prior(own, own, on_training_bank(without_faults(known)), self.steps)
        return Prior(self.blade, self.design_blade, on_training_bank(known), self.steps)

    @property
    def _as_designed(self) -> Blade:
        """The design blade alone, which may have a plant file's modes."""
        if isinstance(self.design_blade, ModelBlade):
            return replace(self.design_blade, spread=Spread(), others=())
        return _alive(_BLADES, Blade(self.design_config))

    @property
    def truth(self) -> Truth:
        """What a controller of tier 3 may be built from."""
        return Truth(self.design, self.config, self.bank, self.scenario, self.steps)

    def told(self, tier: int) -> Design | Prior | Truth:
        """What a controller of that tier may be built from, and no more; ``ValueError`` for a tier that is not in ``TIERS``."""
        tier = checked("tier", tier, Count(0, max(TIERS)))
        return self.design if tier == 0 else self.truth if tier == TRUTH else self.prior

    @cached_property
    def bank(self) -> Bank:
        """The true plants that episodes draw from."""
        return build_bank(self.blade, self.design_blade, self.scenario.plants, self.steps)

    def on_other_plants(self, scenario: Scenario) -> Task:
        """The task in the same scenario on another bank of plants, with controllers told no more and nothing else than here."""
        return replace(self, scenario=scenario, told_scenario=self.told_scenario or self.scenario)

    @property
    def note(self) -> str:
        """What is to be said of where the true blade's patches are; empty if nothing is."""
        return "" if isinstance(self.blade, ModelBlade) else clamp_note(self.config)

    @property
    def identity(self) -> BladeConfig | str:
        """What the true blade is, for comparisons: its configuration, or the fingerprints of a model of one's own."""
        return self.blade.identity if isinstance(self.blade, ModelBlade) else self.config

    def action_space(self, dtype: DType = "float32") -> Box:
        """Voltages, normalised or in V."""
        lowest, highest = self.plant.voltage_limits
        one = np.ones_like(lowest)
        return _box(lowest, highest, dtype) if self.physical_units else _box(-one, one, dtype)

    def observation_space(self, dtype: DType = "float32") -> Box:
        """Sensor readings, normalised or in A."""
        high = self.plant.sensor_full_scale if self.physical_units else np.ones_like(self.plant.sensor_full_scale)
        return _box(-high, high, dtype)


def _box(low: Array, high: Array, dtype: DType) -> Box:
    return Box(low.astype(dtype), high.astype(dtype), dtype=np.dtype(dtype).type)


def resolve_task(
    preset: str = "thesis",
    speed: float | None = None,
    blade: BladeArgument = None,
    design: DesignArgument = None,
    scenario: ScenarioArgument = None,
    duration: float | None = None,
    physical_units: bool = False,
    plant: PlantArgument | None = None,
    spread: Spread | Mapping[str, Any] | None = None,
) -> Task:
    """The task meant by the arguments of an environment; ValueError names the one that is wrong.

    A task that some environment has already is shared with it, and so is a blade. ``plant``, a model of one's own, is in the place
    of ``preset``, ``speed`` and ``blade``, and ``design`` is a model then, too.
    """
    if plant is not None:
        return _of_model(plant, preset, speed, blade, design, scenario, duration, physical_units, spread)
    if spread is not None:
        raise Refused("spread", spread, "None without a plant: what varies of a blade is in the scenario's plants")
    duration = DURATION if duration is None else duration
    config = blade_config(preset, _of_file(blade), speed)
    interval = config.control_interval
    duration = checked("duration", duration, Number(gt=interval / 2, le=UNBOUNDED * interval, unit="s"))
    physical_units = checked("physical_units", physical_units, Flag())
    chosen = as_scenario(scenario)
    truth, modes = chosen.plants.truth, chosen.plants.modes
    config = replace(config, loads=tuple(load.place for load in chosen.loads)) if chosen.loads else config
    own = _driven(config if design is None else _design_config(preset, speed, design), chosen)
    config = _with(_driven(config, chosen), truth_modes=modes if truth is None else None)
    known = chosen.plants.design_modes
    designed = _with(own if design is not None else config, modes=known, truth_modes=known)  # designers know no further mode
    true = Blade(config) if truth is None else given_blade(config, load_plant(truth), truth, modes)
    true = _alive(_BLADES, true)
    _check_failures(chosen, true.plant)
    _check_loads(chosen, true)
    _check_sensors(chosen, config)
    chosen = _with_own_loads(chosen, true)
    task = Task(
        blade=true,
        design_blade=true if designed == config else _alive(_BLADES, _same_electronics(designed, true)),
        scenario=chosen,
        steps=round(duration / interval),
        physical_units=physical_units,
    )
    return _alive(_TASKS, task)


def _of_model(
    plant: PlantArgument,
    preset: str,
    speed: float | None,
    blade: BladeArgument,
    design: Any,
    scenario: ScenarioArgument,
    duration: float | None,
    physical_units: bool,
    spread: Any,
) -> Task:
    for name, value, usual in (("preset", preset, "thesis"), ("speed", speed, None), ("blade", blade, None)):
        if value != usual:
            raise Refused(name, value, "left out with a plant of one's own, which is in the place of a blade")
    chosen = as_scenario(scenario)
    check_scenario(chosen)
    true = true_model(plant, spread, chosen)
    model = true.model
    interval = model.control_interval
    seconds = DURATION * model.time_scale if duration is None else duration
    seconds = checked("duration", seconds, Number(gt=interval / 2, le=UNBOUNDED * interval, unit="s"))
    _check_failures(chosen, model)
    _check_loads(chosen, true)
    task = Task(
        blade=true,
        design_blade=true if design is None else design_model(design, true, chosen),
        scenario=chosen,
        steps=round(seconds / interval),
        physical_units=checked("physical_units", physical_units, Flag()),
    )
    return _alive(_TASKS, task)


def _of_file(blade: BladeArgument) -> BladeConfig | Mapping[str, Any] | None:
    """What a path stands for; anything else as it is."""
    if isinstance(blade, Path) or (isinstance(blade, str) and blade.lower().endswith(ENDINGS)):
        return load_config(blade)
    return blade  # type: ignore[return-value] # other strings are refused where it is read


_Made = TypeVar("_Made")
_BLADES: WeakValueDictionary[Blade, Blade] = WeakValueDictionary()
_TASKS: WeakValueDictionary[Task, Task] = WeakValueDictionary()
"""Those that some environment has: an equal one shares what it has built, for none of it can be changed."""


def _alive(those: WeakValueDictionary[_Made, _Made], made: _Made) -> _Made:
    return those.setdefault(made, made)


def _check_failures(chosen: Scenario, plant: Plant) -> None:
    """``ValueError`` for more broken actuators or sensors than the blade has."""
    failures = chosen.failures
    for name, broken, there in (
        ("dead_actuators", failures.dead_actuators, plant.B.shape[1]),
        ("faulty_sensors", failures.faulty_sensors, len(plant.C)),
    ):
        if broken > there:
            raise Refused(f"scenario.failures.{name}", broken, f"at most the {there} that the blade has")


def _with_own_loads(chosen: Scenario, true: Blade) -> Scenario:
    """The scenario with what its own loads leave to the blade; ``ValueError`` where none can act."""
    if not chosen.loads:
        return chosen
    if chosen.plants.spin_up is not None or chosen.plants.truth is not None:
        shapes = [load.shape for load in chosen.loads]
        raise Refused("scenario.loads", shapes, "empty where the rotor runs up or a plant file says what moves")
    return replace(chosen, loads=of_blade(chosen.loads, true.beam, true.reference_load))


def _check_sensors(chosen: Scenario, config: BladeConfig) -> None:
    """``ValueError`` for a run-up of a blade with sensors that are listed."""
    if chosen.plants.spin_up is not None and config.sensors:
        kinds = [each.kind for each in config.sensors]
        raise Refused("blade.sensors", kinds, "empty, the currents of patches, where the rotor runs up")


def _check_loads(chosen: Scenario, true: Blade, path: str = "scenario") -> None:
    """``ValueError`` for loads that cannot be shown at the blade's control interval."""
    interval, lowest = true.config.control_interval, float(true.plant.natural_frequencies[0])
    check_frequencies(chosen, interval, lowest, largest_speed(chosen, true.config.speed), path)


def _driven(config: BladeConfig, chosen: Scenario) -> BladeConfig:
    """The blade with the drive that a scenario gives the default blade, of ±1500 V, as shares of its own."""
    limits = chosen.drive.voltage_limits
    if limits is None:
        return config
    share = max(map(abs, config.voltage_limits)) / DRIVE
    return replace(config, voltage_limits=(share * limits[0], share * limits[1]))


def _with(config: BladeConfig, **modes: int | None) -> BladeConfig:
    """The blade with those numbers of modes that a scenario gives."""
    given = {name: number for name, number in modes.items() if number is not None}
    return replace(config, **given) if given else config  # type: ignore[arg-type]


def _design_config(preset: str, speed: float | None, design: Any) -> BladeConfig:
    """A name is a preset; a dictionary changes ``preset`` at ``speed``, not the true blade's own changes to it."""
    if not isinstance(design, (BladeConfig, Mapping)):
        return blade_config(checked("design", design, Choice(PRESETS, BladeConfig)), None, speed)
    return read(blade_config(preset, None, speed), design, "design")


def _same_electronics(design: BladeConfig, true: Blade) -> Blade:
    """The design blade behind the very sensors' range, drive and clock that the true one has."""
    for name in ("control_interval", "voltage_limits"):
        if getattr(design, name) != getattr(true.config, name):
            raise Refused(f"design.{name}", getattr(design, name), f"the true blade's, {getattr(true.config, name)!r}")
    if design.sensors == true.config.sensors and (design.sensors or design.sensor_full_scale is None):
        design = in_range(design, true.plant.sensor_full_scale)
    if design.reference_load is None:
        design = under_reference(design, true.reference_load)
    designed = true.as_beam.changed(design)
    shapes = [(plant.B.shape[1], len(plant.C)) for plant in (designed.plant, true.plant)]
    if shapes[0] != shapes[1]:
        raise ValueError(f"design has {shapes[0]} voltages and sensors, but must have as many as the true blade, {shapes[1]}.")
    return designed


def checked_dtype(dtype: Any) -> DType:
    """One of the two, also from NumPy's types of these names; ``ValueError`` for any other."""
    try:
        name = np.dtype(dtype).name if dtype is not None else ""
    except (TypeError, ValueError):
        name = ""
    if name == "float32":
        return "float32"
    if name == "float64":
        return "float64"
    raise Refused("dtype", dtype, "'float32' or 'float64'")


_DOUBLE = np.dtype(np.float64)


def checked_task(task: Any) -> Task:
    """The task; ``ValueError`` for anything else."""
    if isinstance(task, Task):
        return task
    raise Refused("task", task, "a Task, such as resolve_task makes")


def checked_action(action: Any, shape: tuple[int, ...]) -> Array:
    """The action as float64; ValueError unless it has the shape and all its numbers are finite."""
    if type(action) is not np.ndarray or action.dtype is not _DOUBLE:  # a blade alone has no time to look closer
        action = real_numbers("action", action)
    if action.shape != shape:
        raise ValueError(f"action has shape {action.shape}, but must have shape {shape}.")
    finite = np.isfinite(action)
    if b"\0" in finite.tobytes():  # a blade alone has no time for ``all``
        wrong = np.argwhere(~finite)[0].tolist()
        raise ValueError(f"action{wrong} is {action[tuple(wrong)]}, but every number must be finite.")
    return action


def reset_options(task: Task, options: Mapping[str, Any] | None, rows: int) -> tuple[Scenario, Array | None]:
    """Scenario and initial states ((n,) or (rows, n), or None) of one reset, as its options say."""
    options = {} if options is None else checked_table("options", options, ("load", "initial_state"))
    chosen = task.scenario
    if "load" in options:
        chosen = with_load(chosen, options["load"])
        _check_loads(chosen, task.blade, "options.load")
    return chosen, _initial_state(task, options["initial_state"], rows) if "initial_state" in options else None


def _initial_state(task: Task, value: Any, rows: int) -> Array:
    plant, state = task.plant, real_numbers("options.initial_state", value)
    n, b = len(plant.A), plant.blade_states
    if state.shape not in ((n,), (rows, n), (b,), (rows, b)):
        alone = f", or ({b},) or ({rows}, {b}), the blade's own states" if b < n else ""
        raise ValueError(f"options.initial_state has shape {state.shape}, but must have shape ({n},) or ({rows}, {n}){alone}.")
    if state.shape[-1] < n:
        state = np.concatenate([state, np.zeros((*state.shape[:-1], n - b))], axis=-1)
    strain = np.abs(task.blade.standing_strain + state @ plant.strain.T).max(initial=0.0)
    if not (np.isfinite(state).all() and strain <= FAILURE_STRAIN):
        raise ValueError(
            f"options.initial_state strains the blade by {strain:.3g}, but must be finite and stay below {FAILURE_STRAIN:g}."
        )
    return state


def steady_information(steady: Array, note: Any, assumed: Any) -> dict[str, Any]:
    """What a reset's info holds beside ``information``: of steady states (…, 4), as ``Bank`` has them, a note (…) and what was
    ``assumed`` (…) of a model of one's own.
    """
    return {**dict(zip(STEADY_INFO, np.moveaxis(steady, -1, 0), strict=True)), "note": note, "assumed": assumed}


def information(motion: Motion) -> dict[str, Any]:
    """The info arrays of a motion, by the names in ``INFO``."""
    return {
        "volts": motion.volts,
        "tip_displacement": motion.tip_displacement,
        "energy": motion.energy,
        "effort": motion.effort,
        "cost_increment": motion.cost_increment,
    }
