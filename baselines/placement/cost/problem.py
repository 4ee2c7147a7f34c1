"""The placement problem: which trace to make least, by moving which patches, within which bounds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from baselines.design.matrix import definite_matrix
from baselines.placement.cost.riccati import solve_riccati
from baselines.placement.model.charge_readings import charge_slopes, reading_charges
from baselines.placement.model.contributions import Contributions, contributions
from baselines.placement.model.equations import (
    Equation,
    filter_equation,
    filter_slopes,
    regulator_equation,
    regulator_slopes,
    trace_slopes,
)
from baselines.placement.model.intervals import Intervals, PatchEdges
from baselines.placement.model.layout_model import Matrices, ganged, layout_matrices, matrix_slopes
from baselines.placement.model.reduced_layouts import Reduction, reduce_layouts
from baselines.placement.model.reduced_slopes import ReducedSlopes, reduce_with_slopes
from beamenv.blade.bounds import Bounds
from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, Side, with_positions
from beamenv.configuration import Choice, Instance, Number, Refused, checked
from beamenv.configuration.read_only import sealed
from beamenv.patches.group import Positions
from beamenv.patches.layout import PatchLayout
from beamenv.plant.reduction import ReducedBlades

Array = NDArray[np.float64]

READS = ("current", "charge")

NOISE: Mapping[Side, Number] = MappingProxyType({"actuators": Number(ge=0.0), "sensors": Number(gt=0.0)})
"""What V may be: of sensors to be placed it is divided by."""


@dataclass(frozen=True, slots=True, eq=False)
class PlacementProblem:
    """Where to put the actuators, or the sensors, of a blade whose other patches stay in place.

    Actuators minimise tr(P), s, with P from PA + AᵀP + Q − PBR⁻¹BᵀP = 0. Since ½xᵀx is the vibration energy, tr(P)/r is the cost
    (J s per J) of bringing the blade to rest, averaged over initial states of 1 J in every direction of its 2r states.
    Sensors minimise tr(S), J, with S from AS + SAᵀ + W − SCᵀV⁻¹CS = 0 and the environment's noise; ½tr(S) is the mean energy of
    the filter's error. The data acquisition, and with it V, stays the same when sensors move.

    Make a problem by ``of``; the constructor raises ``ValueError`` for parts of another kind, and for bounds beyond the blade.
    """

    config: BladeConfig
    """The blade, with its moving patches equally spaced and the range of its data acquisition held."""
    side: Side
    bounds: Bounds
    load_noise: Array
    """W (2, 2), (N/m)² s."""
    sensor_noise: float
    """V, A² s, of every sensor; C² s where charges are read."""
    parts: Contributions
    reads: str = "current"
    """What is read of the sensor patches: "current" or "charge"."""

    def __post_init__(self) -> None:
        for name, kind in (("config", BladeConfig), ("bounds", Bounds), ("parts", Contributions)):
            checked(name, getattr(self, name), Instance(kind))
        checked("side", self.side, Choice(SIDES))
        checked("reads", self.reads, Choice(READS))
        given = self.bounds
        room = Bounds.of(self.config.patches, self.config.beam.length, given.count, (given.low, given.high), self.side)
        if given != room:
            raise Refused("bounds", given, f"{room}, for the {self.side} of this blade")
        object.__setattr__(self, "load_noise", sealed(definite_matrix("load_noise", self.load_noise, 2, "semidefinite")))
        object.__setattr__(self, "sensor_noise", checked("sensor_noise", self.sensor_noise, NOISE[self.side]))

    @classmethod
    def of(
        cls, config: BladeConfig, side: Side = "actuators", count: int | None = None, bounds: Sequence[float] | None = None
    ) -> PlacementProblem:
        """The problem of a configuration; ``count`` defaults to its own number of patches, ``bounds`` (m) to 0 … 0.7 L.

        Raises ``ValueError`` for an unknown side, bounds without room, more patches than fit, or sensors without noise.
        """
        checked("config", config, Instance(BladeConfig))
        checked("side", side, Choice(SIDES))
        if side == "sensors":
            check_noise(config)
        reads = read_of_patches(config) if side == "sensors" else "current"
        number = config.patches.only(side).count if count is None else count
        room = Bounds.of(config.patches, config.beam.length, number, bounds, name=side)
        uniform = with_positions(config, {side: tuple(room.uniform().tolist())})
        held = Blade(uniform).with_fixed_range()
        plant = held.plant
        return cls(held.config, side, room, plant.process_noise, float(plant.sensor_noise[0, 0]), parts_of(config), reads)

    def configuration(self, positions: ArrayLike) -> BladeConfig:
        """The blade with its moving patches at ``positions`` (count,), m: what ``build_plant`` takes."""
        return with_positions(self.config, {self.side: tuple(self.bounds.checked(positions).tolist())})

    def cost(self, positions: Array) -> Array:
        """The trace (N,) of feasible layouts (N, count), m from the root; ``ValueError`` for another shape, or NaN."""
        reduced = self.reduced(positions)
        return np.asarray(np.trace(solve_riccati(*self.equation(reduced)), axis1=1, axis2=2))

    def cost_and_slopes(self, positions: Array) -> tuple[float, Array]:
        """The trace of one layout (count,) and its exact derivatives (count,) by the positions, per m."""
        cut = self._cut(self._numbers(positions, 1)[None])
        passive = self.config.patches.only("actuators").passive
        matrices = self._ganged(layout_matrices(self.parts, cut, passive))
        moved = self._ganged(matrix_slopes(self.parts, cut, passive, self._moved(cut)))
        reduced, slopes = reduce_with_slopes(self.parts, matrices, moved, Reduction.of(self.config))
        if self.reads == "charge":
            reduced, slopes = reading_charges(reduced), charge_slopes(reduced, slopes)
        equation = self.equation(reduced)
        solution = solve_riccati(*equation)[0]
        return float(np.trace(solution)), trace_slopes(equation, self._equation_slopes(reduced, slopes), solution)

    def reduced(self, positions: Array) -> ReducedBlades:
        """Layouts (N, count), m from the root, as reduced blades."""
        passive = self.config.patches.only("actuators").passive
        matrices = layout_matrices(self.parts, self._cut(self._numbers(positions, 2)), passive)
        reduced = reduce_layouts(self.parts, self._ganged(matrices), Reduction.of(self.config))
        return reading_charges(reduced) if self.reads == "charge" else reduced

    def at(self, positions: ArrayLike) -> ReducedBlades:
        """One layout (count,), m; ``ValueError`` unless it is feasible."""
        return self.reduced(self.bounds.checked(positions)[None])

    def _numbers(self, positions: Array, axes: int) -> Array:
        """Layouts of an array of so many axes."""
        shape = f"({'N, ' * (axes - 1)}{self.bounds.count}{',' if axes == 1 else ''})"
        plain = isinstance(positions, np.ndarray) and positions.dtype.kind in "fi" and not np.ma.is_masked(positions)
        if not plain or positions.ndim != axes or positions.shape[-1] != self.bounds.count or not np.isfinite(positions).all():
            raise Refused("positions", positions, f"an array {shape} of finite numbers (m)")
        return positions

    def equation(self, reduced: ReducedBlades) -> Equation:
        """The regulator's or the filter's equation of reduced layouts."""
        if self.side == "actuators":
            return regulator_equation(reduced)
        return filter_equation(reduced, self.load_noise, self.sensor_noise)

    def _equation_slopes(self, reduced: ReducedBlades, slopes: ReducedSlopes) -> Equation:
        if self.side == "actuators":
            return regulator_slopes(reduced, slopes)
        return filter_slopes(reduced, slopes, self.load_noise, self.sensor_noise)

    def _cut(self, positions: Array) -> Intervals:
        """Layouts (N, count), m, with the patches of the other side where those are."""
        still = np.tile(_still(self.config.patches, self.side, self.config.beam.length), (len(positions), 1))
        actuators, sensors = (positions, still) if self.side == "actuators" else (still, positions)
        return Intervals.of(PatchEdges.of(actuators, sensors, self.bounds.length, self.parts.span))

    def _moved(self, cut: Intervals) -> slice:
        """Which of all patches, actuators first, are to be placed."""
        actuators = cut.patches.actuators.shape[1]
        return slice(actuators) if self.side == "actuators" else slice(actuators, None)

    def _ganged(self, matrices: Matrices) -> Matrices:
        return ganged(matrices) if self.config.patches.only("actuators").ganged else matrices


@lru_cache(maxsize=64)
def _still(patches: PatchLayout, moved: Side, span: float) -> Positions:
    """Where the other side's patches are, m."""
    return patches.positions("sensors" if moved == "actuators" else "actuators", span)


def check_noise(config: BladeConfig) -> None:
    """``ValueError`` for a blade on which every layout of sensors is as good as any other."""
    for name in ("white_load", "sensor_noise_fraction"):
        if getattr(config, name) == 0.0:
            raise ValueError(f"{name} = {getattr(config, name)!r} must be positive: without noise all sensors serve alike.")


def read_of_patches(config: BladeConfig) -> str:
    """What a blade reads of its sensor patches, which placement must know; ``ValueError`` where anything else is read besides."""
    if not config.sensors:
        return "current"
    kinds = [each.kind for each in config.sensors]
    if len(kinds) > 1 or kinds[0] not in READS:
        raise Refused("config.sensors", kinds, "empty, or one 'current' or 'charge' of the patches, where these are to be placed")
    return kinds[0]


def parts_of(config: BladeConfig) -> Contributions:
    """The contributions of a blade, kept from one problem to the next: they depend on neither side nor positions.

    On a blade without sensor patches, which is read by other sensors, those of a patch on the actuators' other face stand for them
    and are not used.
    """
    layout = config.patches.placed("actuators", 1)
    if layout.groups("sensors"):
        layout.only("sensors")
        layout = layout.placed("sensors", 1)
    else:
        group = layout.only("actuators")
        layout = replace(layout, sensors=(replace(group, face="inner" if group.face == "outer" else "outer", ganged=False),))
    patches = replace(layout, ganged=False)
    return _parts(BladeConfig(beam=config.beam, patches=patches, model=config.model, speed=config.speed, modes=config.modes))


_parts = lru_cache(maxsize=16)(contributions)
