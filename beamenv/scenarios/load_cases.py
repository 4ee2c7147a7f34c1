"""Load cases: the uniform line loads that act on a batch of blades besides white noise."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.arrays import Those, copied, namespace
from beamenv.plant.plant import Plant

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

CASES = ("step", "pulse", "deflection", "harmonic", "none")
"""Names of the load cases; ``LoadCases.case`` holds positions in this tuple."""

NEVER = np.iinfo(np.int64).max
"""The step at which a load that does not end, ends."""


@dataclass(frozen=True, slots=True, eq=False)
class LoadCases:
    """One load case for each of N blades, held constant over every control interval; arrays of NumPy or of torch.

    In interval k = 0, 1, … the line load of a blade is

        d(k) = amplitude · [onset ≤ k < end] · (sin(rate k + phase) if rate > 0 else 1)

    and besides, with h = 1, 2, … per revolution of the rotor, Σ cosine_h cos(h revolution k) + sine_h sin(h revolution k). The
    blade starts from rest in the static deflection under the uniform line load ``deflection``.
    """

    case: Integers
    """(N,) positions in ``CASES``."""
    amplitude: Array
    """(N, k), N/m: lag, flap."""
    deflection: Array
    """(N, k), N/m: the load the blade is released from, zero but for the case "deflection"."""
    onset: Integers
    """(N,) first control interval in which the load acts."""
    end: Integers
    """(N,) first control interval in which it no longer does."""
    rate: Array
    """(N,) rad per control interval; 0 for a load that does not oscillate."""
    phase: Array
    """(N,) rad."""
    cosine: Array
    """(N, H, k), N/m: lag, flap."""
    sine: Array
    """(N, H, k), N/m: lag, flap."""
    revolution: Array
    """(N,) rad per control interval: the rotor's."""
    oscillating: tuple[Integers, Array, Array] | None = field(init=False, repr=False)
    """Rows with ``rate`` > 0, with rates and phases, kept so that sines are evaluated for them alone; None of tensors."""

    def __post_init__(self) -> None:
        of_numpy = isinstance(self.rate, np.ndarray)
        rows = np.flatnonzero(self.rate > 0.0) if of_numpy else None
        object.__setattr__(self, "oscillating", None if rows is None else (rows, self.rate[rows], self.phase[rows]))
        for each in fields(self) if of_numpy else ():
            if each.init:
                getattr(self, each.name).setflags(write=False)

    def __len__(self) -> int:
        return len(self.case)

    def gain(self, step: int | Integers) -> Array:
        """Share of the amplitude that acts in interval ``step``, an integer or an array that broadcasts against (N,): (…, N)."""
        acts = (self.onset <= step) & (step < self.end)
        if self.oscillating is None:
            torch = namespace(self.rate)
            return acts * torch.where(self.rate > 0.0, torch.sin(self.rate * step + self.phase), 1.0)
        gain, (rows, rate, phase) = acts.astype(np.float64), self.oscillating
        if len(rows):
            steps = step[..., rows] if isinstance(step, np.ndarray) and step.shape[-1] > 1 else step
            gain[..., rows] *= np.sin(rate * steps + phase)
        return gain

    def at(self, step: int | Integers) -> Array:
        """Line loads (…, N, k) in N/m in interval ``step``, an integer or an array that broadcasts against (N,)."""
        load = self.amplitude * self.gain(step)[..., None]
        return load + self.of_rotor(step) if self.has_harmonics else load

    @property
    def has_harmonics(self) -> bool:
        """Whether the rotor's harmonics act."""
        return self.cosine.shape[1] > 0

    def of_rotor(self, step: int | Integers) -> Array:
        """The rotor's harmonics (…, N, k) in N/m in interval ``step``."""
        array = namespace(self.cosine)
        turned = (self.revolution * step)[..., None]
        angle = array.concatenate([order * turned for order in range(1, self.cosine.shape[1] + 1)], -1)
        waves = (array.cos, self.cosine), (array.sin, self.sine)
        return sum(array.einsum("...nh,nhk->...nk", wave(angle), part) for wave, part in waves)

    def rows(self, rows: Integers) -> LoadCases:
        """The load cases of some of the blades, in the order given."""
        return LoadCases(**{each.name: getattr(self, each.name)[rows] for each in fields(self) if each.init})

    def replace(self, those: Those, others: LoadCases) -> LoadCases:
        """These load cases with those of some blades exchanged for ``others``, one for each."""
        names = [each.name for each in fields(self) if each.init]
        return LoadCases(**{name: those.put(getattr(self, name), getattr(others, name)) for name in names})

    def convert(self, floats: Callable[[Any], Any]) -> LoadCases:
        """The same load cases with all numbers that are not whole passed through ``floats``."""
        whole = "case", "onset", "end"
        parts = {each.name: getattr(self, each.name) for each in fields(self) if each.init}
        return LoadCases(**{name: part if name in whole else floats(part) for name, part in parts.items()})

    def state_dict(self) -> dict[str, Array | Integers]:
        """A copy of each array by its name: ``LoadCases.from_state_dict`` makes equal load cases of them."""
        return {each.name: copied(getattr(self, each.name)) for each in fields(self) if each.init}

    @classmethod
    def from_state_dict(cls, state: Mapping[str, ArrayLike]) -> LoadCases:
        """The load cases of a ``state_dict``."""
        return cls(**{name: copied(values) for name, values in state.items()})


def static_deflection(plant: Plant, line_load: ArrayLike) -> Array:
    """State (…, n) at rest under constant disturbances (…, k), of a blade uniform line loads in N/m: x = −A⁻¹ E d."""
    compliance = -np.linalg.solve(plant.A, plant.disturbance_input)
    return np.asarray(line_load, dtype=np.float64) @ compliance.T
