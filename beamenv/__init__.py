"""Vibration control of rotating thin-walled composite blades: structure, patches, plant and Gymnasium environments.

Importing this package registers ``beamenv/RotatingBeam-v0``, single and batched, and for each scenario with a file, say
"overload", ``beamenv/RotatingBeam-overload-v0``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import gymnasium

from beamenv import wings
from beamenv.scenarios.named import BENCHMARK as BENCHMARK_SCENARIOS
from beamenv.scenarios.named import NAMES
from beamenv.scenarios.named import OPEN as OPEN_SCENARIOS
from beamenv.scenarios.named import UNSEEN as UNSEEN_SCENARIOS

if TYPE_CHECKING:
    from beamenv.blade.build import build_plant
    from beamenv.blade.config import BeamConfig, BladeConfig
    from beamenv.blade.design import Design
    from beamenv.blade.modal_plant_of import modal_plant_of
    from beamenv.blade.presets import PRESETS, blade_config
    from beamenv.envs.batch import RotatingBeamVectorEnv
    from beamenv.envs.history import SensorHistory, VectorSensorHistory
    from beamenv.envs.placement import PlacementWrapper, VectorPlacementWrapper
    from beamenv.envs.single import RotatingBeamEnv
    from beamenv.envs.stable_baselines import BladeVecEnv
    from beamenv.envs.torch_batch import TorchRotatingBeamVectorEnv, torch_vec
    from beamenv.envs.torch_history import TorchSensorHistory
    from beamenv.knowledge import Prior
    from beamenv.patches import PatchLayout
    from beamenv.plant.files import load_plant, save_plant
    from beamenv.plant.modal_plant import ModalPlant
    from beamenv.plant.plant import Plant, SampledPlant, sample
    from beamenv.scenarios.scenario import SCENARIOS, Scenario, scenario
    from beamenv.structure import BoxSection, FunctionallyGraded, Lamina, Layup, RotatingBeam

__version__ = "0.1.0"

ENV_ID = "beamenv/RotatingBeam-v0"

_HOMES = {
    "BeamConfig": "blade.config",
    "PatchLayout": "patches",
    "RotatingBeam": "structure",
    "FunctionallyGraded": "structure",
    "Lamina": "structure",
    "Layup": "structure",
    "BoxSection": "structure",
    "BladeVecEnv": "envs.stable_baselines",
    "PRESETS": "blade.presets",
    "BladeConfig": "blade.config",
    "Design": "blade.design",
    "Prior": "knowledge",
    "blade_config": "blade.presets",
    "build_plant": "blade.build",
    "RotatingBeamEnv": "envs.single",
    "PlacementWrapper": "envs.placement",
    "VectorPlacementWrapper": "envs.placement",
    "ModalPlant": "plant.modal_plant",
    "load_plant": "plant.files",
    "modal_plant_of": "blade.modal_plant_of",
    "save_plant": "plant.files",
    "Plant": "plant.plant",
    "SampledPlant": "plant.plant",
    "sample": "plant.plant",
    "SCENARIOS": "scenarios.scenario",
    "Scenario": "scenarios.scenario",
    "scenario": "scenarios.scenario",
    "RotatingBeamVectorEnv": "envs.batch",
    "TorchRotatingBeamVectorEnv": "envs.torch_batch",
    "torch_vec": "envs.torch_batch",
    "SensorHistory": "envs.history",
    "VectorSensorHistory": "envs.history",
    "TorchSensorHistory": "envs.torch_history",
}

__all__ = [
    "BENCHMARK_SCENARIOS",
    "ENV_ID",
    "OPEN_SCENARIOS",
    "PRESETS",
    "SCENARIOS",
    "BeamConfig",
    "BladeConfig",
    "BladeVecEnv",
    "BoxSection",
    "Design",
    "FunctionallyGraded",
    "Lamina",
    "Layup",
    "ModalPlant",
    "PatchLayout",
    "PlacementWrapper",
    "Plant",
    "Prior",
    "RotatingBeam",
    "RotatingBeamEnv",
    "RotatingBeamVectorEnv",
    "SampledPlant",
    "Scenario",
    "SensorHistory",
    "TorchRotatingBeamVectorEnv",
    "TorchSensorHistory",
    "UNSEEN_SCENARIOS",
    "VectorPlacementWrapper",
    "VectorSensorHistory",
    "blade_config",
    "build_plant",
    "load_plant",
    "modal_plant_of",
    "sample",
    "save_plant",
    "scenario",
    "torch_vec",
]


def __getattr__(name: str) -> Any:
    """Public names are imported when they are first asked for: ``import beamenv`` stays quick."""
    if name in wings.WINGS:
        return import_module(f"{__name__}.{name}")
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})


def _register(env_id: str, **arguments: str) -> None:
    if env_id not in gymnasium.registry:
        gymnasium.register(
            id=env_id,
            entry_point="beamenv.envs.single:RotatingBeamEnv",
            vector_entry_point="beamenv.envs.batch:RotatingBeamVectorEnv",
            kwargs=arguments,
        )


wings.install()
_register(ENV_ID)
for _name in NAMES:
    _register(f"beamenv/RotatingBeam-{_name}-v0", scenario=_name)
