"""Actuators and sensors to be placed together, by what the closed loop costs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.placement.cost.loop import Loop, loop_cost, loop_cost_and_slopes
from baselines.placement.cost.problem import PlacementProblem
from baselines.placement.model.charge_readings import charge_slopes, reading_charges
from baselines.placement.model.intervals import Intervals, PatchEdges
from baselines.placement.model.layout_model import Matrices, ganged, layout_matrices, matrix_slopes
from baselines.placement.model.reduced_layouts import Reduction, reduce_layouts
from baselines.placement.model.reduced_slopes import reduce_with_slopes
from beamenv.blade.bounds import Bounds
from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import with_positions
from beamenv.configuration import Instance, Numbers, Refused, checked

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class JointProblem:
    """Where to put a blade's actuators and its sensors.

    The cost, J, is the long-run mean of ½xᵀx + uᵀRu under LQG: tr(PW̄) + tr(S KᵀRK). A layout (a + s,), m, lists the positions of
    the actuators and then those of the sensors. Make a problem by ``of``; the constructor raises ``ValueError`` for sides of
    different blades.
    """

    actuators: PlacementProblem
    sensors: PlacementProblem

    def __post_init__(self) -> None:
        for name in ("actuators", "sensors"):
            problem = checked(name, getattr(self, name), Instance(PlacementProblem))
            if problem.side != name:
                raise Refused(f"{name}.side", problem.side, repr(name))
        if self.actuators.config != self.sensors.config:
            raise Refused("sensors.config", self.sensors.config, "that of actuators, whose blade it is")

    @classmethod
    def of(cls, config: BladeConfig, actuators: int | None = None, sensors: int | None = None) -> JointProblem:
        """That of a configuration, with so many patches, or its own; ``ValueError`` as ``PlacementProblem.of`` raises it."""
        checked("config", config, Instance(BladeConfig))
        for side, count in (("actuators", actuators), ("sensors", sensors)):
            own = config.patches.only(side).count if count is None else count  # type: ignore[arg-type]
            room = Bounds.of(config.patches, config.beam.length, own, None, side)  # type: ignore[arg-type]
            config = with_positions(config, {side: tuple(room.uniform().tolist())})  # type: ignore[dict-item]
        reading = PlacementProblem.of(config, "sensors")
        return cls(PlacementProblem.of(reading.config, "actuators"), reading)

    @property
    def config(self) -> BladeConfig:
        """The blade, with its patches equally spaced and the range of its data acquisition held."""
        return self.sensors.config

    @property
    def bounds(self) -> tuple[Bounds, Bounds]:
        """The actuators' and the sensors'."""
        return self.actuators.bounds, self.sensors.bounds

    def configuration(self, positions: ArrayLike) -> BladeConfig:
        """The blade with its patches at ``positions`` (a + s,), m; ``ValueError`` unless they are feasible."""
        above, below = self._sides(self.checked(positions))
        return with_positions(self.config, {"actuators": tuple(above.tolist()), "sensors": tuple(below.tolist())})

    def checked(self, positions: ArrayLike) -> Array:
        """Positions (a + s,), each side's in ascending order; ``ValueError`` unless they are finite, in bounds and apart."""
        count = sum(each.count for each in self.bounds)
        given = np.array(checked("positions", positions, Numbers(least=count, most=count)))
        return np.concatenate([each.checked(side) for each, side in zip(self.bounds, self._sides(given), strict=True)])

    def cost(self, positions: Array) -> Array:
        """The cost (N,), J, of feasible layouts (N, a + s)."""
        matrices = self._ganged(layout_matrices(self.sensors.parts, self._cut(positions), self._passive))
        reduced = reduce_layouts(self.sensors.parts, matrices, Reduction.of(self.config))
        reduced = reading_charges(reduced) if self.sensors.reads == "charge" else reduced
        return loop_cost(Loop.of(reduced, *self._noise))

    def cost_and_slopes(self, positions: Array) -> tuple[float, Array]:
        """The cost of one layout (a + s,) and its exact derivatives by the positions, J/m."""
        parts, cut = self.sensors.parts, self._cut(positions[None])
        matrices = self._ganged(layout_matrices(parts, cut, self._passive))
        moved = self._ganged(matrix_slopes(parts, cut, self._passive))
        reduced, slopes = reduce_with_slopes(parts, matrices, moved, Reduction.of(self.config))
        if self.sensors.reads == "charge":
            reduced, slopes = reading_charges(reduced), charge_slopes(reduced, slopes)
        return loop_cost_and_slopes(Loop.of(reduced, *self._noise), Loop.slopes(reduced, slopes, *self._noise))

    @property
    def _noise(self) -> tuple[Array, float]:
        return self.sensors.load_noise, self.sensors.sensor_noise

    @property
    def _passive(self) -> bool:
        return self.config.patches.only("actuators").passive

    def _sides(self, positions: Array) -> tuple[Array, Array]:
        above, below = np.split(positions, [self.actuators.bounds.count], axis=-1)
        return above, below

    def _cut(self, positions: Array) -> Intervals:
        return Intervals.of(PatchEdges.of(*self._sides(positions), self.sensors.bounds.length, self.sensors.parts.span))

    def _ganged(self, matrices: Matrices) -> Matrices:
        return ganged(matrices) if self.config.patches.only("actuators").ganged else matrices
