"""A bank of discretised plants: what an episode's true plant is drawn from. Built once; a blade in a batch has an index into it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from beamenv.arrays import REFERENCE, Arrays
from beamenv.configuration.read_only import ReadOnly, read_only, sealed
from beamenv.patches.material import MFC_STRAIN
from beamenv.plant.energy import energy_coordinates, in_energy_coordinates
from beamenv.plant.plant import Plant, normalised
from beamenv.scenarios.load_cases import static_deflection
from beamenv.simulation.kernel import Operators
from beamenv.simulation.plants.cost_axes import cost_axes, in_axes, lean
from beamenv.simulation.plants.walks import Walk

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Bank(ReadOnly):
    """K plants of n states with the same drive and data acquisition; voltages and readings normalised to these.

    A bank may hold those of several blades, in ``groups`` of equal size, one after the other.

    Every plant has energy coordinates of its own: ½ xᵀx of the blade's states is the energy, in joules, whichever it is; and in a
    bank that moves blades they are turned into ``axes`` (``cost_axes``). What is said of states below holds in these.
    """

    plant: Plant
    """The one all others depart from, in energy coordinates; the first blade's."""
    operators: Operators
    """``fused`` (K, …), or of one plant."""
    axes: Array
    """T (K, n, n), orthogonal: states are T x, with x as the plant has it, in energy coordinates."""
    readout: Array
    """(K, n, p): state to noise-free readings, in full scales."""
    feedthrough: Array
    """(K, p, m): normalised voltages of the interval before to readings, in full scales."""
    tip: Array
    """(K, n, q), m per √J."""
    strain: Array
    """(K, s, n) per √J."""
    release: Array
    """(K, k, n): static deflection per N/m of line load, lag and flap."""
    speeds: Array
    """(K,), rad/s."""
    effort_weight: Array
    """(K, m, m), J s: uᵀRu Δt of normalised voltages."""
    to_design: Array | None
    """(K, n, d): state to the design plant's coordinates; None where the two blades' displacements cannot be compared."""
    standing: Array
    """(K, k): strains without vibration that count towards failure."""
    failure_strain: Array
    """(K,): at which each plant's blade fails."""
    steady: Array
    """(K, 4): stretch, untwist, largest strain and its place, as ``SteadyDeformation`` has them; of plants that follow one another
    those of the first."""
    start: Array | None = None
    """(groups, n): what a blade's state at the start of an episode is increased by."""
    runs: bool = False
    """Whether a group's plants follow one another, one each control interval, instead of being drawn."""
    walk: Walk | None = None
    """How blades go from plant to plant within an episode, each on its own course; None: they do not."""
    to_common: Array | None = None
    """(K, n, n) where they do: a plant's states to coordinates that all have in common."""
    from_common: Array | None = None
    """(K, n, n): back."""
    pyroelectric: Array | None = None
    """(K, 2, p): what sensors show, in full scales, per K and control interval by which a plant warms, and per K; None: nothing."""
    others: tuple[Plant, ...] = ()
    """What ``plant`` is to the first group, for each further one."""
    own: tuple[Array, Array] | None = None
    """(K, n, n) twice: what makes energy coordinates of a plant's own, and back, for columns; None where these are its own."""

    def __post_init__(self) -> None:
        ReadOnly.__post_init__(self)
        whole = {name: read_only(getattr(self.operators, name)) for name in ("fused", "weights")}
        object.__setattr__(self, "operators", replace(self.operators, **whole))

    def __repr__(self) -> str:
        plants = "1 plant" if len(self) == 1 else f"{len(self)} plants"
        return f"Bank({plants} at {self.speeds.min():.4g} … {self.speeds.max():.4g} rad/s; {self.plant.sizes})"

    def __len__(self) -> int:
        return len(self.speeds)

    @property
    def groups(self) -> int:
        """How many blades' plants these are."""
        return 1 + len(self.others)

    def is_like(self, other: Bank) -> bool:
        """Whether another blade's bank has equally many plants, of as many states, behind the same electronics."""
        sizes = [
            (len(bank), bank.runs, bank.walk, bank.operators.fused.shape, bank.plant.control_interval, bank.own is None)
            for bank in (self, other)
        ]
        return sizes[0] == sizes[1] and all(
            np.array_equal(getattr(self.plant, name), getattr(other.plant, name)) for name in _ELECTRONICS
        )

    def convert(self, arrays: Arrays) -> Bank:
        """The same bank of other arrays, for those who step with them."""
        if arrays == REFERENCE:
            return self
        floats = arrays.floats
        parts = {name: getattr(self, name) for name in (*BY_PLANT, *NOT_ALWAYS)}
        own = None if self.own is None else (floats(self.own[0]), floats(self.own[1]))
        converted: dict[str, Any] = {name: None if part is None else floats(part) for name, part in parts.items()}
        return replace(self, operators=lean(self.operators, normalised(self.plant)).convert(floats), own=own, **converted)

    @classmethod
    def single(cls, plant: Plant, speed: float = 0.0, to_design: Array | None = None) -> Bank:
        """The bank of one plant."""
        bank = cls.gather(plant, [plant], np.array([speed]), None if to_design is None else to_design[None]).in_cost_axes()
        return replace(bank, operators=bank.operators.pick(0))

    @classmethod
    def gather(cls, plant: Plant, plants: Sequence[Plant], speeds: Array, to_design: Array | None) -> Bank:
        """The bank of several plants; ``to_design`` (K, n, d) is from their energy coordinates."""
        own = [energy_coordinates(each) for each in plants]
        there = [each for each in own if each is not None]
        turned = (np.stack([each.there for each in there]), np.stack([each.back for each in there])) if there else None
        plant, plants = in_energy_coordinates(plant), [in_energy_coordinates(each) for each in plants]
        units = [normalised(each) for each in plants]
        operators = Operators.from_plants(units)
        return cls(
            plant=plant,
            operators=replace(operators, fused=sealed(operators.fused), weights=sealed(operators.weights)),
            axes=sealed(np.tile(np.eye(len(plant.A)), (len(plants), 1, 1))),
            readout=sealed(np.stack([unit.C.T for unit in units])),
            feedthrough=sealed(np.stack([unit.D for unit in units])),
            tip=sealed(np.stack([each.tip_displacement.T for each in plants])),
            strain=sealed(np.stack([each.strain for each in plants])),
            release=sealed(np.stack([static_deflection(each, np.eye(each.disturbance_input.shape[1])) for each in plants])),
            speeds=speeds,
            effort_weight=sealed(np.stack([unit.input_weight * unit.control_interval for unit in units])),
            to_design=to_design,
            standing=sealed(np.zeros((len(plants), len(plant.strain)))),
            failure_strain=sealed(np.full(len(plants), MFC_STRAIN)),
            steady=sealed(np.zeros((len(plants), 4))),
            own=turned,
        )

    def in_cost_axes(self) -> Bank:
        """This bank, as ``gather`` made it, in the axes in which its steps are cheap."""
        fused, plant = self.operators.fused, self.plant
        axes = cost_axes(fused[..., self.operators.costs :], len(plant.A), plant.blade_states)
        following = np.concatenate([axes[1:], axes[-1:]]) if self.runs else axes
        back = axes.swapaxes(-1, -2)
        return replace(
            self,
            operators=in_axes(self.operators, axes, following, normalised(plant)),
            axes=sealed(axes),
            readout=sealed(axes @ self.readout),
            tip=sealed(axes @ self.tip),
            strain=sealed(self.strain @ back),
            release=sealed(self.release @ back),
            to_design=None if self.to_design is None else sealed(axes @ self.to_design),
            to_common=None if self.to_common is None else sealed(axes @ self.to_common),
            from_common=None if self.from_common is None else sealed(self.from_common @ back),
            start=None if self.start is None else sealed(np.einsum("gn,gmn->gm", self.start, axes[:: len(axes) // self.groups])),
        )

    @classmethod
    def joined(cls, banks: Sequence[Bank]) -> Bank:
        """One bank of several blades' banks, each like the first."""
        first = banks[0]
        if len(banks) == 1:
            return first
        starts = [bank.start for bank in banks]
        fused = [bank.operators.fused.reshape(len(bank), *bank.operators.fused.shape[-2:]) for bank in banks]
        weights = [bank.operators.weights.reshape(len(bank), -1) for bank in banks]
        whole = {name: sealed(np.concatenate([getattr(bank, name) for bank in banks])) for name in BY_PLANT}
        return cls(
            plant=first.plant,
            others=tuple(bank.plant for bank in banks[1:]),
            operators=replace(first.operators, fused=sealed(np.concatenate(fused)), weights=sealed(np.concatenate(weights))),
            to_design=_one_after_the_other([bank.to_design for bank in banks]),
            to_common=_one_after_the_other([bank.to_common for bank in banks]),
            from_common=_one_after_the_other([bank.from_common for bank in banks]),
            start=None if first.start is None else np.concatenate(starts),  # type: ignore[arg-type]
            pyroelectric=_one_after_the_other([bank.pyroelectric for bank in banks]),
            own=None if first.own is None else _both_after_each_other([bank.own for bank in banks]),
            runs=first.runs,
            walk=first.walk,
            **whole,
        )


def _both_after_each_other(pairs: Sequence[tuple[Array, Array] | None]) -> tuple[Array, Array]:
    forth, back = zip(*(pair for pair in pairs if pair is not None), strict=True)
    return np.concatenate(forth), np.concatenate(back)


def _one_after_the_other(parts: Sequence[Array | None]) -> Array | None:
    """None where one is."""
    there = [part for part in parts if part is not None]
    return np.concatenate(there) if len(there) == len(parts) else None


BY_PLANT = (
    "axes",
    "readout",
    "feedthrough",
    "tip",
    "strain",
    "release",
    "speeds",
    "effort_weight",
    "standing",
    "failure_strain",
    "steady",
)
"""Its arrays that have a row for each plant, the operators' aside."""
NOT_ALWAYS = ("to_design", "to_common", "from_common", "start", "pyroelectric")
"""Further arrays of numbers, which not every bank has."""
_ELECTRONICS = ("process_noise", "sensor_noise", "voltage_limits", "sensor_full_scale", "reference_load")
