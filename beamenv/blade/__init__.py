"""A blade as a user describes it: configuration, presets, files, layouts of its patches; and what is built from it."""

from beamenv.blade.build import Blade, build_beam, build_plant, displacement_operator, plant_of
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.blade.design import Design
from beamenv.blade.files import from_dict, load_config, to_dict
from beamenv.blade.presets import PRESETS, blade_config
from beamenv.structure.walls.named import MATERIALS

__all__ = [
    "MATERIALS",
    "PRESETS",
    "BeamConfig",
    "Blade",
    "BladeConfig",
    "Design",
    "blade_config",
    "build_beam",
    "build_plant",
    "displacement_operator",
    "from_dict",
    "load_config",
    "plant_of",
    "to_dict",
]
