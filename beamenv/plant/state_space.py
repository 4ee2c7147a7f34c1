"""A plant from a state-space model of any origin, with what a model does not tell taken from it by stated rules."""

from __future__ import annotations

import inspect
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from beamenv.configuration import Number, Refused, checked
from beamenv.configuration.sentence import unknown_field
from beamenv.plant.continuous import continuous
from beamenv.plant.hold import hold
from beamenv.plant.matrices import PlantMatrices
from beamenv.plant.model_arguments import checked_inputs, checked_limits, checked_matrices, checked_rows, named_signals, root_of
from beamenv.plant.model_rules import (
    slowest_mode,
    turning_frequencies,
    usual_interval,
    with_cost,
    with_noise,
    with_price,
    with_scales,
)
from beamenv.plant.reachable import check_modes
from beamenv.plant.signals import Signal

Array = NDArray[np.float64]

FIRST_PERIOD = 0.035
"""s, of the default blade, for which the times of scenarios are made."""


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """What was given, as arrays in continuous time."""

    A: Array
    B: Array
    C: Array
    D: Array
    loads: Array | None
    """(n, k) of the disturbances; None: not given."""
    noise: Array
    """(n, r) of noise on the states of unit variance in an interval."""
    interval: float
    further: int = 0
    """States, the last, that the model itself has not."""
    assumed: tuple[str, ...] = ()


def plant_of_model(
    A: ArrayLike,
    B: ArrayLike,
    C: ArrayLike,
    D: ArrayLike | None = None,
    *,
    dt: float | None = None,
    interval: float | None = None,
    energy: ArrayLike | None = None,
    output_weight: ArrayLike | None = None,
    input_weight: ArrayLike | None = None,
    disturbance_input: ArrayLike | None = None,
    disturbance_names: Sequence[str] | None = None,
    disturbance_units: Sequence[str] | None = None,
    reference_load: ArrayLike | None = None,
    process_noise: ArrayLike | None = None,
    state_noise: ArrayLike | None = None,
    sensor_noise: ArrayLike | None = None,
    sensor_names: Sequence[str] | None = None,
    sensor_units: Sequence[str] | None = None,
    full_scale: ArrayLike | None = None,
    actuator_limits: ArrayLike | None = None,
    tip_displacement: ArrayLike | None = None,
) -> PlantMatrices:
    """The plant of a model with n states in any coordinates, m voltages u (V) and p sensors.

        ẋ = A x + B u + E d,        y = C x + D u,        or with ``dt`` (s) x⁺ = A x + B u + E d.

    A sampled model's ``dt`` is the control interval; it is the very model at the samples, and in continuous time between
    (``beamenv.plant.continuous``). ``D`` is what sensors feel of the voltage that is on while they are read
    (``beamenv.plant.matrices``).

    What may be said besides, and what is taken to be so where it is not, which ``Plant.assumed`` tells in words:

    - ``interval`` (s): of control, for a model in continuous time; 1.4 rad of its fastest mode.
    - ``energy`` H (n, n): xᵀHx in J. The cost is the energy then. Without it the cost is of outputs, yᵀWy with ``output_weight`` W,
      (p, p) or (p,), of each output over the most that full voltages make of it. With both, it is of outputs.
    - ``input_weight`` R (m, m) or (m,), 1/V² times what the cost is counted in: a full voltage of one actuator costs a fifth of the
      most that the reference load does, as on the default blade.
    - ``disturbance_input`` E (n, k), with ``disturbance_names`` and ``disturbance_units``: at the actuators, in V.
    - ``reference_load`` (k,), what actuators can about hold, by which scenarios scale their loads: disturbances whose impulse costs
      as much as one of full voltages; at the actuators full voltage.
    - ``process_noise``: standard deviations (k,) of the white disturbances held over an interval, or their covariance (k, k); a
      tenth of the reference load. ``state_noise`` (n, n): covariance of what else is added to the state in an interval.
    - ``sensor_noise``: standard deviations (p,) of one reading, or their covariance (p, p); 0.02 of full scale.
    - ``sensor_names``, ``sensor_units``.
    - ``full_scale`` (p,), beyond which readings are clipped: twice the most that one full voltage or reference load makes of them.
    - ``actuator_limits`` (V): a number, two, or (2, m); ±10 V.
    - ``tip_displacement`` (q, n), m: of points whose displacement is to be shown; none.

    Scenarios, whose times are made for a first period of 35 ms, are as much slower or faster as the model's first mode is. Raises
    ``ValueError`` of one sentence for shapes that do not fit, for what is no number, and for a model with a mode that is unstable,
    that no voltage reaches or that no sensor sees, which it names.
    """
    given = {"disturbance_input": disturbance_input, "state_noise": state_noise}
    with _within_numbers():
        model = _in_continuous_time(checked_matrices(A, B, C, D), given, dt, interval)
        m, p, k = model.B.shape[1], len(model.C), len(model.B[0] if model.loads is None else model.loads[0])
        assumed = list(model.assumed)
        disturbances = _disturbances(model, disturbance_names, disturbance_units, k, assumed)
        bare = replace(
            _without_rules(model, tip_displacement),
            voltage_limits=checked_limits(actuator_limits, m, assumed),
            disturbances=disturbances,
            sensors=named_signals("sensor", sensor_names, sensor_units, p),
        )
        costly = with_cost(bare, energy, output_weight, model.further, assumed)
        scaled = with_scales(costly, reference_load, full_scale, model.loads is None, k, assumed)
        priced = with_price(scaled, input_weight, assumed)
        plant = with_noise(priced, process_noise, sensor_noise, k, assumed)
        _check_finite(plant)
    return replace(plant, assumed=tuple(assumed))


def _disturbances(
    model: Model, names: Sequence[str] | None, units: Sequence[str] | None, count: int, assumed: list[str]
) -> tuple[Signal, ...]:
    """What they are called; at the actuators after these, where nobody says otherwise."""
    if model.loads is None:
        assumed.append("disturbances act where the actuators do, in their volts")
        names = [f"at voltage {j}" for j in range(count)] if names is None else names
        units = ["V"] * count if units is None else units
    noises = (Signal(f"noise of states {j}", "") for j in range(model.noise.shape[1]))
    return (*named_signals("disturbance", names, units, count), *noises)


def _check_finite(plant: PlantMatrices) -> None:
    """``LinAlgError`` for numbers that are none."""
    parts = (getattr(plant, each.name) for each in fields(plant))
    if not all(np.isfinite(part).all() for part in parts if isinstance(part, np.ndarray)):
        raise np.linalg.LinAlgError


FIELDS = tuple(inspect.signature(plant_of_model).parameters)
"""What may be said of a model."""


def plant_of_arguments(given: Mapping[str, Any]) -> PlantMatrices:
    """The plant of the arguments of ``plant_of_model`` by their names; ``ValueError`` for one that it does not have."""
    for name in given:
        if name not in FIELDS:
            raise unknown_field("the model", name, FIELDS)
    return plant_of_model(**given)


@contextmanager
def _within_numbers() -> Iterator[None]:
    """Where numbers leave what a computer counts with, one sentence."""
    try:
        with np.errstate(all="ignore"):
            yield
    except (np.linalg.LinAlgError, OverflowError):
        raise ValueError("the model cannot be computed: its numbers, or those said of it, are out of scale.") from None


def _without_rules(model: Model, tip_displacement: ArrayLike | None) -> PlantMatrices:
    """The dynamics alone."""
    (n, m), p, r = model.B.shape, len(model.C), model.noise.shape[1]
    loads = model.B if model.loads is None else model.loads
    k, own = loads.shape[1], n - model.further
    tip = np.zeros((0, n)) if tip_displacement is None else checked_rows("tip_displacement", tip_displacement, own, model.further)
    return PlantMatrices(
        A=model.A,
        B=model.B,
        C=model.C,
        D=model.D,
        disturbance_input=np.hstack([loads, model.noise]),
        tip_displacement=tip,
        strain=np.zeros((0, n)),
        natural_frequencies=turning_frequencies(model.A),
        state_weight=np.zeros((n, n)),
        input_weight=np.eye(m),
        process_noise=np.eye(k + r),
        sensor_noise=np.eye(p),
        voltage_limits=np.tile([[-1.0], [1.0]], m),
        sensor_full_scale=np.ones(p),
        control_interval=model.interval,
        energy=np.zeros((n, n)),
        reference_load=np.append(np.ones(k), np.zeros(r)),
        time_scale=2.0 * np.pi / slowest_mode(model.A) / FIRST_PERIOD,
    )


def _in_continuous_time(
    matrices: tuple[Array, Array, Array, Array], given: dict[str, Any], dt: float | None, interval: float | None
) -> Model:
    A, B, C, D = matrices
    n, m = B.shape
    clock = None if dt is None else checked("dt", dt, Number(gt=0.0, unit="s"))
    interval = None if interval is None else checked("interval", interval, Number(gt=0.0, unit="s"))
    if clock is not None and interval is not None and not np.isclose(clock, interval, rtol=1e-9):
        raise Refused("interval", interval, f"None or dt, {clock:g} s: voltages are held as long as the model's are")
    check_modes(A, B, C, clock)
    loads = checked_inputs("disturbance_input", given["disturbance_input"], n)
    noise = root_of("state_noise", given["state_noise"], n)
    k = 0 if loads is None else loads.shape[1]
    if clock is None:
        held, assumed = usual_interval(A, interval)
        return Model(A, B, C, D, loads, _held_noise(A, noise, held), held, 0, assumed)
    whole = continuous(A, np.hstack([B, *([] if loads is None else [loads]), noise]), C, clock)
    said = f"{whole.alternating} of the model's poles alternate from sample to sample: each is a pair at the Nyquist frequency"
    inputs, disturbances, states = np.split(whole.B, [m, m + k], axis=1)
    known = None if loads is None else disturbances
    q = whole.alternating
    return Model(whole.A, inputs, whole.C, D, known, states, clock, q, (said,) if q else ())


def _held_noise(A: Array, noise: Array, interval: float) -> Array:
    """(n, r): what held over an interval adds ``noise`` to the state."""
    if not noise.shape[1]:
        return noise
    return np.asarray(np.linalg.solve(hold(A, np.eye(len(A)), interval)[1], noise))
