"""The model as the thesis' own equations have it."""

from __future__ import annotations

from dataclasses import fields, replace

from beamenv.blade.config import BeamConfig
from beamenv.structure.walls.materials import Lamina
from beamenv.structure.walls.named import MATERIALS
from train.reproduce.thesis.as_printed import UniformTensionBlade
from train.reproduce.thesis.configurations import Model
from train.reproduce.thesis.equations import SHEAR_FLOW, SIX_TERMS, UNIFORM_TENSION, Reading
from train.reproduce.thesis.sheets import ply


def read_by(model: Model, reading: Reading) -> Model:
    """The model with some equations as the thesis has them."""
    return replace(model, reading=reading, box=box_by(model.box, reading), validation_box=box_by(model.validation_box, reading))


def box_by(box: BeamConfig, reading: Reading) -> BeamConfig:
    """A blade likewise."""
    if UNIFORM_TENSION in reading:
        box = UniformTensionBlade(**{each.name: getattr(box, each.name) for each in fields(BeamConfig)})
    material = MATERIALS[box.material] if isinstance(box.material, str) else box.material
    read = ply(material, reading) if isinstance(material, Lamina) else material
    return replace(
        box,
        material=box.material if read is material else read,
        shear_flow="thesis" if SHEAR_FLOW in reading else box.shear_flow,
        terms=6 if SIX_TERMS in reading else box.terms,
    )
