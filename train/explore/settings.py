"""What the controls of the page say, and the blade and the weights that they stand for."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, with_positions
from beamenv.blade.presets import THESIS
from beamenv.configuration import Choice, Count, Number, Numbers, Points, Positive, configuration
from beamenv.plant.plant import Plant
from beamenv.structure.planform import Steps

Array = NDArray[np.float64]
Direction = Literal["lag", "flap"]
INSTEAD = {"twist_table": ("pretwist_deg", 0.0), "chord_table": ("taper", 1.0)}
"""What tables stand for, and what that is where there is one."""
OF_BLADE = ("speed", "white_load", "sensor_noise_fraction")


@configuration("settings")
class Settings:
    """What the controls say; the rest, and what is None, is that of the blade which the page began with.

    Raises ``ValueError`` for a value that is no number, or a load that is neither in lag nor in flap.
    """

    ply_angle_deg: Annotated[float | None, Number(unit="degrees")] = None
    """Of all plies of every wall, from the contour tangent; each keeps its sign."""
    speed: Annotated[float | None, Number(unit="rad/s")] = None
    """rad/s."""
    pretwist_deg: Annotated[float | None, Number(unit="degrees")] = None
    taper: Annotated[float | None, Number()] = None
    """Root chord over tip chord."""
    twist_table: Annotated[Steps | None, Points(most=100)] = None
    """Shares of the span and degrees, in place of the pretwist; empty: none."""
    chord_table: Annotated[Steps | None, Points(most=100)] = None
    """Shares of the span and sizes over the root's, in place of the taper; empty: none."""
    actuators: Annotated[tuple[float, ...] | None, Numbers()] = None
    """Root-side edges, m, group after group."""
    sensors: Annotated[tuple[float, ...] | None, Numbers()] = None
    """Root-side edges, m, group after group."""
    white_load: Annotated[float | None, Number(unit="N/m")] = None
    """N/m, of a blade whose reference load is 30 N/m."""
    sensor_noise_fraction: Annotated[float | None, Number()] = None
    """Standard deviation of a sample over the sensors' full scale."""
    strain_energy_weight: Positive = 1.0
    """Times the plant's own Q: that of strain energy, in the design of LQG."""
    kinetic_energy_weight: Positive = 1.0
    """Times the plant's own Q: that of kinetic energy, in the design of LQG."""
    actuator_energy_weight: Positive = 1.0
    """Times the plant's own R, in the design of LQG."""
    load: Annotated[Direction, Choice(("lag", "flap"))] = "flap"
    actuator: Annotated[int, Count(1)] = 1
    """Number of the voltage that the Bode diagram is of."""
    sensor: Annotated[int, Count(1)] = 1
    """Number of the reading that the Bode diagram is of."""
    station: Annotated[float | None, Number(unit="m")] = None
    """m from the root: where the section is drawn; None: the first actuator's middle."""

    def config(self, base: BladeConfig = THESIS) -> BladeConfig:
        """The blade."""
        changes = self._planform(base)
        if (angle := self.ply_angle_deg) is not None:
            walls = base.beam.ply_angles_deg
            changes["ply_angles_deg"] = tuple((wall, tuple(math.copysign(angle, ply) for ply in plies)) for wall, plies in walls)
        beam = replace(base.beam, **changes) if changes else base.beam
        return with_positions(replace(base, beam=beam, **self._given(OF_BLADE)), self._given(SIDES))

    def _planform(self, base: BladeConfig) -> dict[str, Any]:
        """What is not the blade's own of its twist and taper: where there is a table, that alone."""
        changes: dict[str, Any] = {}
        for table, (name, none) in INSTEAD.items():
            given = getattr(self, table)
            steps = getattr(base.beam, table) if given is None else given or None
            if steps is not None:
                changes |= {} if given is None else {table: steps, name: none}
                continue
            changes |= self._given((name,)) | ({} if given is None else {table: None})
        return changes

    def _given(self, names: tuple[str, ...]) -> dict[Any, Any]:
        return {name: value for name in names if (value := getattr(self, name)) is not None}

    def weights(self, plant: Plant) -> tuple[Array | None, Array | None]:
        """Q (n, n) and R (m, m) of LQG, None where they are the plant's own; energy coordinates are half strain, half kinetic."""
        strain, kinetic, actuators = self.strain_energy_weight, self.kinetic_energy_weight, self.actuator_energy_weight
        root = np.sqrt(np.repeat([strain, kinetic], len(plant.A) // 2))
        Q = plant.state_weight * np.outer(root, root) if (strain, kinetic) != (1.0, 1.0) else None
        return Q, actuators * plant.input_weight if actuators != 1.0 else None
