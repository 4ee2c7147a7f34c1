"""How far a sampled loop is from instability: gain, phase and delay margins loop at a time, and the disk margin of all at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from baselines.analysis.frequency_response import frequency_response, highest, resonant_angles
from baselines.design.controller import Array
from baselines.design.instruments import checked_plant
from baselines.design.linear import LinearController, linear
from baselines.design.loop import closed_loop, sampled, spectral_radius
from beamenv.configuration import Choice, checked
from beamenv.plant.plant import Plant

Complex = NDArray[np.complex128]

_NONE = 1e-12
"""A gain this small is none at all, but for rounding."""


@dataclass(frozen=True, slots=True)
class StabilityMargins:
    """The smallest margins over all loops and frequencies up to half the sampling rate; infinite where no change is too much."""

    gain_margin_db: tuple[float, float]
    """dB, by which the gain of any one loop may fall (negative) and rise, the others unchanged."""
    phase_margin_deg: float
    """Degrees, by which the phase of any one loop may be shifted either way."""
    delay_margin: float
    """s, by which any one loop may be delayed: a lag of ω times as much at each frequency ω where its gain is 1."""
    disk_margin: float
    """α of the symmetric disk margin: all loops at once may be multiplied by any (1 + δ/2)/(1 − δ/2) with |δ| < α ≤ 2, which are
    gains from (2 − α)/(2 + α) to (2 + α)/(2 − α) or phases up to 2 arctan(α/2) (Seiler, Packard and Gahinet, IEEE Control Systems
    Magazine 40, 2020). Largest singular value, so that coupled δ are allowed too: it is no larger than with independent ones."""
    peak_sensitivity: float
    """Largest singular value of S = (I + L)⁻¹ over all frequencies; at least 1 where disturbances are amplified."""


def stability_margins(plant: Plant, controller: LinearController, at: Literal["input", "output"] = "input") -> StabilityMargins:
    """Margins of a controller on a plant, both sampled, with the loops broken at the plant's voltages or at its measurements.

    Singular values depend on units: voltages are in units of the drive limits, readings in units of full scale. Raises ValueError
    for a loop that is unstable, for another ``at``, and for a controller that is not linear.
    """
    checked("at", at, Choice(("input", "output")))
    checked_plant(plant)
    controller = linear(controller)
    held = sampled(plant, controller)
    loop = closed_loop(held, controller)[0]
    if spectral_radius(loop) >= 1.0:
        raise ValueError(f"{controller.name} is unstable on this plant, so it has no stability margins.")
    sensitivity = _sensitivity(plant, controller, at)
    angles = resonant_angles(loop, held.A, controller.transition + controller.voltage_input @ controller.state_gain)
    low, high, phase, delay = _loop_at_a_time(sensitivity, angles)
    half = np.eye(sensitivity(angles[:1]).shape[-1]) / 2.0
    return StabilityMargins(
        gain_margin_db=(20.0 * float(np.log10(low)) if low > 0.0 else -np.inf, 20.0 * float(np.log10(high))),
        phase_margin_deg=float(np.degrees(phase)),
        delay_margin=delay * held.interval,
        disk_margin=1.0 / highest(lambda angle: _norm(sensitivity(angle) - half), angles)[0],
        peak_sensitivity=highest(lambda angle: _norm(sensitivity(angle)), angles)[0],
    )


def _sensitivity(plant: Plant, law: LinearController, at: str) -> Callable[[Array], Complex]:
    """S(θ) = (I + L)⁻¹ (k, l, l) with L = −K P at the voltages and −P K at the measurements, from the closed loop's own states.

    A signal w added where the loop is broken, to the voltages that the plant gets or to the measurements that the law gets, is S w
    once it has gone round.
    """
    held = sampled(plant, law)
    (n, m), s = held.B.shape, len(law.transition)
    C = held.C if law.observes == "observation" else np.eye(n)
    A = closed_loop(held, law)[0]
    if at == "input":
        B = np.vstack([held.B, np.zeros((s, m))])
        rows, size, unit = np.hstack([law.measurement_gain @ C, law.state_gain]), m, law.instruments.voltage_scale
    else:
        B = np.vstack([held.B @ law.measurement_gain, law.measurement_input + law.voltage_input @ law.measurement_gain])
        rows, size, unit = np.hstack([C, np.zeros((len(C), s))]), len(C), law.instruments.measurement_scale
    B, rows = B * unit, rows / unit[:, None]
    return lambda angles: frequency_response(A, B, rows, np.eye(size), angles)


def _norm(response: Complex) -> Array:
    return np.asarray(np.linalg.norm(response, ord=2, axis=(1, 2)))


def _loop_at_a_time(sensitivity: Callable[[Array], Complex], angles: Array) -> tuple[float, float, float, float]:
    """Lowest and highest factor of the gain, phase in rad and delay in samples: the nearest to none of any loop.

    With the other loops closed S_ii = 1/(1 + L): L is real where S_ii is, and |L| = 1 where |1 − S_ii| = |S_ii|.
    """
    on_grid = np.diagonal(sensitivity(angles), axis1=1, axis2=2)
    low, high, phase, delay = 0.0, np.inf, np.inf, np.inf
    for loop in range(on_grid.shape[1]):

        def at(angle: float, loop: int = loop) -> complex:
            return complex(sensitivity(np.array([angle]))[0, loop, loop])

        values = on_grid[:, loop]
        real = [values[0].real, values[-1].real]  # at zero frequency and half the sampling rate
        real += [at(angle).real for angle in _zeros(lambda angle: at(angle).imag, values.imag[1:-1], angles[1:-1])]
        factors = [S / (S - 1.0) for S in real if S != 1.0]  # −1/L
        low = max([low, *(factor for factor in factors if _NONE < factor <= 1.0)])
        high = min([high, *(factor for factor in factors if 1.0 < factor < 1.0 / _NONE)])
        for angle in _zeros(lambda angle: abs(1.0 - at(angle)) - abs(at(angle)), np.abs(1.0 - values) - np.abs(values), angles):
            lag = float(np.angle((at(angle) - 1.0) * np.conj(at(angle)))) % (2.0 * np.pi)  # of −L
            phase, delay = min(phase, lag, 2.0 * np.pi - lag), min(delay, lag / angle)
    return low, high, phase, delay


def _zeros(function: Callable[[float], float], values: Array, angles: Array) -> list[float]:
    """Zeros of a function whose ``values`` at the grid of angles change sign."""
    before = np.flatnonzero(np.sign(values[:-1]) * np.sign(values[1:]) < 0)
    return [float(brentq(function, angles[i], angles[i + 1], xtol=1e-12)) for i in before]
