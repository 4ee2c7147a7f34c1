"""The sizing problem: what a closed loop costs with patches of any size and number anywhere, and what they weigh and draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from baselines.placement.cost.loop import Loop, loop_cost, loop_cost_and_slopes
from baselines.placement.cost.problem import check_noise, read_of_patches
from baselines.placement.model.charge_readings import charge_slopes, reading_charges
from baselines.placement.model.intervals import Intervals, PatchEdges
from baselines.placement.model.reduced_layouts import Reduction, reduce_layouts
from baselines.placement.model.reduced_slopes import reduce_with_slopes
from baselines.placement.sizing.designs import Designs
from baselines.placement.sizing.limits import Budget, Limits, Sizes
from baselines.placement.sizing.sized_contributions import SizedContributions, sized_contributions
from baselines.placement.sizing.sized_layouts import sized_matrices, sized_slopes, weight_slopes, weights_of
from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.layouts import SIDES, positions_of, with_positions
from beamenv.configuration import Instance, Refused, checked
from beamenv.plant.reduction import ReducedBlades

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False)
class SizingProblem:
    """How many patches to use, how large, and where.

    The cost, J, is the long-run mean of ½xᵀx + r uᵀu under LQG. In it u are the voltages that make the same field in sheets as
    thick as the blade's own, and r is the mean weight of the blade's own patches, equally spaced. (With the weight ρFᵀK⁻¹F of the
    patches themselves, weak patches would be as good as strong ones, since their voltages would cost less in the same measure.)
    Loads and the noise of the data acquisition stay the same. Make a problem by ``of``.
    """

    config: BladeConfig
    """The blade with its own patches equally spaced, and the range of its data acquisition held."""
    limits: Limits
    budget: Budget
    parts: SizedContributions
    drive_weight: float
    """r, J/V²."""
    load_noise: Array
    """W (2, 2), (N/m)² s."""
    sensor_noise: float
    """V, A² s; C² s where charges are read."""
    reads: str

    @classmethod
    def of(cls, config: BladeConfig, sizes: Sizes | None = None, budget: Budget | None = None) -> SizingProblem:
        """That of a configuration.

        Raises ``ValueError`` for sizes that do not fit, a budget that buys no pair of patches, ganged actuators, a blade that reads
        anything but its patches, and one without noise.
        """
        checked("config", config, Instance(BladeConfig))
        sizes = Sizes() if sizes is None else checked("sizes", sizes, Instance(Sizes))
        budget = Budget() if budget is None else checked("budget", budget, Instance(Budget))
        check_noise(config)
        reads, (actuators, _) = read_of_patches(config), config.patches.pair()
        if actuators.ganged:
            raise Refused("blade.patches.ganged", True, "False where patches are sized, each with a voltage of its own")
        limits = Limits.of(config, sizes, budget.channels)
        spaced = with_positions(config, {side: len(positions_of(config, side)) for side in SIDES})
        held = Blade(spaced).with_fixed_range()
        plant, parts = held.plant, sized_contributions(config, limits.grids(config))
        weight = float(np.diag(plant.input_weight).mean())
        noise = plant.process_noise, float(plant.sensor_noise[0, 0])
        problem = cls(held.config, limits, budget, parts, weight, *noise, reads)
        problem.check_budget()
        return problem

    def check_budget(self) -> None:
        """``ValueError`` for one that does not buy the smallest actuator and sensor, or that asks for an unknown capacitance."""
        least = self.least()
        mass, power = float(self.mass(least)[0]), self.power(least)
        if self.budget.mass is not None and self.budget.mass < mass:
            raise Refused("budget.mass", self.budget.mass, f"at least {mass:.4g} kg, the smallest actuator and sensor")
        if self.budget.power is None:
            return
        if power is None:
            raise Refused("budget.power", self.budget.power, "None where the actuators' permittivity is unknown")
        if self.budget.power < power[0]:
            raise Refused("budget.power", self.budget.power, f"at least {power[0]:.4g} W, what the smallest actuator draws")

    def least(self) -> Designs:
        """The smallest actuator and the smallest sensor, at the root."""
        lengths = np.zeros((1, len(self.limits.side_of)))
        lengths[0, [0, self.limits.counts[0]]] = self.limits.length[0]
        return Designs(np.zeros_like(lengths), lengths, self.limits.least_sizes[None])

    def mass(self, designs: Designs) -> Array:
        """(N,), kg of piezo sheet."""
        return designs.volumes(self.limits) @ self.densities

    def most_mass(self) -> float:
        """kg: of as many patches as there may be of the largest sizes, as far as they fit, or what the budget allows."""
        limits = self.limits
        lengths = np.concatenate([np.full(n, min(limits.length[1], limits.end / n)) for n in limits.counts])
        whole = float(self.mass(Designs(np.zeros((1, len(lengths))), lengths[None], limits.largest_sizes[None]))[0])
        return whole if self.budget.mass is None else min(whole, self.budget.mass)

    @property
    def densities(self) -> Array:
        """(2,), kg/m³ of the actuators' and of the sensors' sheet."""
        return np.array([group.patch.lamina.density for group in self.config.patches.pair()])

    def power(self, designs: Designs) -> Array | None:
        """(N,), W: Σ ½CV²f of the actuators at their voltage limit, which goes with the field; None where it is unknown."""
        per_volume = self.power_per_volume
        return None if per_volume is None else designs.volumes(self.limits)[:, 0] * per_volume

    @property
    def power_per_volume(self) -> float | None:
        """W/m³: ½εE²f, whatever the sheet's size."""
        patch = self.config.patches.only("actuators").patch
        if patch.permittivity is None:
            return None
        field = max(map(abs, self.config.voltage_limits)) / patch.electrode_spacing
        return 0.5 * patch.permittivity * field**2 * self.frequency

    @property
    def frequency(self) -> float:
        """Hz at which power is drawn."""
        own = self.budget.frequency
        return float(self.parts.middle.bare_frequencies[0] / (2.0 * np.pi)) if own is None else own

    def within(self, designs: Designs) -> NDArray[np.bool_]:
        """(N,): which keep to the budget."""
        allowed = np.ones(len(designs), dtype=bool)
        for limit, spent in ((self.budget.mass, self.mass(designs)), (self.budget.power, self.power(designs))):
            if limit is not None and spent is not None:
                allowed &= spent <= limit * (1.0 + 1e-9)
        return allowed

    def cost(self, designs: Designs) -> Array:
        """J (N,) of feasible designs."""
        return loop_cost(self.loop(self.reduced(designs)))

    def cost_and_slopes(self, design: Designs) -> tuple[float, Array]:
        """J of one design and its exact derivatives by starts, lengths and sizes (2 E + 4,), per m."""
        cut, weights = self._cut(design), weights_of(self.parts, design.sizes)
        matrices = sized_matrices(self.parts, cut, weights, self._passive, self._stored)
        of_sizes = weight_slopes(self.parts, design.sizes[0])
        moved = sized_slopes(self.parts, cut, weights, of_sizes, self._passive)
        reduced, slopes = reduce_with_slopes(self.parts.middle, matrices, moved, Reduction.of(self.config))
        if self.reads == "charge":
            reduced, slopes = reading_charges(reduced), charge_slopes(reduced, slopes)
        cost, by_edges = loop_cost_and_slopes(self.loop(reduced), Loop.slopes(reduced, slopes, self.load_noise, self.sensor_noise))
        patches = design.starts.shape[1]
        by_start, by_end = by_edges[:patches], by_edges[patches : 2 * patches]
        return cost, np.concatenate([by_start + by_end, by_end, by_edges[2 * patches :]])

    def reduced(self, designs: Designs) -> ReducedBlades:
        """Designs as reduced blades, whose inputs are voltages over what makes the same field in the blade's own sheet."""
        weights = weights_of(self.parts, designs.sizes)
        matrices = sized_matrices(self.parts, self._cut(designs), weights, self._passive, self._stored)
        reduced = reduce_layouts(self.parts.middle, matrices, Reduction.of(self.config))
        return reading_charges(reduced) if self.reads == "charge" else reduced

    def loop(self, reduced: ReducedBlades) -> Loop:
        """Their regulators and filters."""
        return Loop.of(reduced, self.load_noise, self.sensor_noise)

    @property
    def _passive(self) -> bool:
        return self.config.patches.only("actuators").passive

    @property
    def _stored(self) -> float:
        return self.drive_weight / self.config.effort_weight

    def _cut(self, designs: Designs) -> Intervals:
        actuators = self.limits.counts[0]
        above, below = designs.starts[:, :actuators], designs.starts[:, actuators:]
        return Intervals.of(PatchEdges.of(above, below, designs.lengths, self.parts.span))

    def own(self) -> Designs | None:
        """The blade's own patches, equally spaced; None where they are more than may be."""
        return self.with_own_sizes([positions_of(self.config, side) for side in SIDES])

    def with_own_sizes(self, positions: list[tuple[float, ...]]) -> Designs | None:
        """Patches of the blade's own sizes at positions (m) of both sides; None where they are more than may be."""
        groups, counts = self.config.patches.pair(), self.limits.counts
        if any(len(each) > count for each, count in zip(positions, counts, strict=True)):
            return None
        starts, lengths = np.full((1, sum(counts)), self.limits.end), np.zeros((1, sum(counts)))
        for first, each, group in zip((0, counts[0]), positions, groups, strict=True):
            starts[0, first : first + len(each)] = each
            lengths[0, first : first + len(each)] = group.length
        return Designs(starts, lengths, self.own_sizes[None])

    @property
    def own_sizes(self) -> Array:
        """(4,), m: width and thickness of the blade's own sheets."""
        return np.array([size for group in self.config.patches.pair() for size in (group.width, group.patch.thickness)])
