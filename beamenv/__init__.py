"""Vibration control of rotating thin-walled composite blades: structure, patches, plant and Gymnasium environments.

Importing this package registers ``beamenv/RotatingBeam-v0``, single and batched, and for each scenario of the benchmark, say
"overload", ``beamenv/RotatingBeam-overload-v0``.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

import gymnasium

from beamenv.named_scenarios import NAMES as BENCHMARK_SCENARIOS

if TYPE_CHECKING:
    from beamenv.configuration import PRESETS, BladeConfig, blade_config, build_plant
    from beamenv.env import RotatingBeamEnv
    from beamenv.placement_wrapper import PlacementWrapper, VectorPlacementWrapper
    from beamenv.plant import Plant, SampledPlant, sample
    from beamenv.scenarios import SCENARIOS, Scenario, scenario
    from beamenv.vector_env import RotatingBeamVectorEnv
    from beamenv.wrappers import SensorHistory, VectorSensorHistory

__version__ = "0.1.0"

ENV_ID = "beamenv/RotatingBeam-v0"

_HOMES = {
    "PRESETS": "configuration",
    "BladeConfig": "configuration",
    "blade_config": "configuration",
    "build_plant": "configuration",
    "RotatingBeamEnv": "env",
    "PlacementWrapper": "placement_wrapper",
    "VectorPlacementWrapper": "placement_wrapper",
    "Plant": "plant",
    "SampledPlant": "plant",
    "sample": "plant",
    "SCENARIOS": "scenarios",
    "Scenario": "scenarios",
    "scenario": "scenarios",
    "RotatingBeamVectorEnv": "vector_env",
    "SensorHistory": "wrappers",
    "VectorSensorHistory": "wrappers",
}

__all__ = [
    "BENCHMARK_SCENARIOS",
    "ENV_ID",
    "PRESETS",
    "SCENARIOS",
    "BladeConfig",
    "PlacementWrapper",
    "Plant",
    "RotatingBeamEnv",
    "RotatingBeamVectorEnv",
    "SampledPlant",
    "Scenario",
    "SensorHistory",
    "VectorPlacementWrapper",
    "VectorSensorHistory",
    "blade_config",
    "build_plant",
    "sample",
    "scenario",
]


def __getattr__(name: str) -> Any:
    """Public names are imported when they are first asked for: ``import beamenv`` stays quick."""
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
            entry_point="beamenv.env:RotatingBeamEnv",
            vector_entry_point="beamenv.vector_env:RotatingBeamVectorEnv",
            kwargs=arguments,
        )


_register(ENV_ID)
for _name in BENCHMARK_SCENARIOS:
    _register(f"beamenv/RotatingBeam-{_name}-v0", scenario=_name)
