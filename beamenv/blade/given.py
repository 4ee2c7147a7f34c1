"""A blade that moves as the modes of a plant file say, in place of the beam's.

Damping (unless the file has its own), noise, amplifiers and filters, drive limits, the sensors' range and the control interval are
the configuration's. So is the weight of effort R: it is the energy that the patches store in the beam of the configuration, for a
file has no stiffness to compute it from, and costs on both compare. Charges that modes beyond the file take up at once are those of
the beam's patches, less the share of the file's modes; they hardly displace the blade, and how is not known.

Loads of one's own and sensors that are listed are those that the file has (``given_signals``); every file has its patches' charges.

A file has no mode shapes along the span either. What needs them is told by the beam's: pictures, the strain where the file has no
rows for it, and the state in the coordinates of a design. Each mode of the file is taken for the one mode of the beam that answers
like it (``counterparts``); one without such a counterpart is not seen in pictures, strains nothing, and no design has it.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linear_sum_assignment

from beamenv.blade.build import Blade
from beamenv.blade.config import BladeConfig
from beamenv.blade.given_signals import check_listed, loads_of, rows_of
from beamenv.blade.presets import THESIS
from beamenv.configuration import Refused, read
from beamenv.configuration.files import of_file
from beamenv.configuration.read_only import sealed, sealed_property
from beamenv.configuration.sentence import shown
from beamenv.plant.electronics import static_residual
from beamenv.plant.further_loads import with_further_loads
from beamenv.plant.modal_plant import ModalPlant
from beamenv.plant.plant import Plant
from beamenv.plant.reduction import FullModel, ModalModel, acting_on_velocities, on_velocities, reduced_plant
from beamenv.sensors.readings import with_readings
from beamenv.sensors.rows import SensorRows

Array = NDArray[np.float64]

ALIKE = 0.8
"""Least modal assurance criterion of a mode and its counterpart."""

NEAR = 0.25
"""Largest difference between their frequencies, relative to the beam's."""


@dataclass(frozen=True)
class GivenBlade(Blade):
    """A blade of the configuration that moves as the plant ``given`` says; its design plant is the beam's."""

    given: ModalPlant

    @sealed_property
    def as_beam(self) -> Blade:
        """The blade that the configuration describes."""
        beam = Blade(self.config)
        vars(beam).update(beam=self.beam, modal=self.modal, full=self.full)
        return beam

    @sealed_property
    def true_modal(self) -> ModalModel:
        """The modes of the file; the shapes, by the beam's trial functions, are those of their counterparts."""
        gyroscopic = self.given.gyroscopic if self.config.gyroscopic else np.zeros_like(self.given.gyroscopic)
        return ModalModel(self.given.natural_frequencies, self._shapes(), gyroscopic)

    @sealed_property
    def given_rows(self) -> SensorRows | None:
        """What the sensors that are listed show of the file's modes; None where the currents of all patches are read."""
        rows = self.sensor_rows
        return None if rows is None else rows_of(self.given, self.config, rows)

    @sealed_property
    def bare_truth(self) -> Plant:
        """The plant that moves, without the electronics."""
        config, model, omega = self.config, self.given, self.given.natural_frequencies
        strain = self.full.strain @ self.true_modal.mode_shapes if model.strain is None else model.strain
        modal = ModalModel(omega, np.eye(len(omega)), self.true_modal.gyroscopic)  # its trial functions are its modes
        rows, full_scale = self.given_rows, self.plant.sensor_full_scale
        plant = reduced_plant(
            modal,
            FullModel(
                forces=model.actuation,
                charges=model.charges if len(model.charges) else np.zeros((1, len(omega))),
                line_load=model.line_load,
                tip=model.tip,
                strain=strain,
                steady_strain=self.full.steady_strain,
                steady=self.full.steady,
                response=self.full.response,
            ),
            damping_ratio=config.damping_ratio if model.damping_ratio is None else model.damping_ratio,
            effort_weight=config.effort_weight,
            white_load=config.white_load,
            sensor_noise_fraction=config.sensor_noise_fraction,
            sensor_full_scale=float(full_scale[0]) if rows is None else 1.0,
            voltage_limits=config.voltage_limits,
            control_interval=config.control_interval,
            reference_load=self.reference_load,
        )
        plant = replace(plant, input_weight=self.plant.input_weight)
        if rows is None:
            return self._loaded(plant)
        read = with_readings(
            plant,
            rows,
            modal,
            sensors=config.sensors,
            forces=model.actuation,
            line_load=model.line_load,
            noise=config.sensor_noise_fraction,
            current_range=config.sensor_full_scale,
            full_scale=full_scale,
            filtered=True,
        )
        return self._loaded(read)

    @sealed_property
    def truth(self) -> Plant:
        """The plant that moves."""
        rows, bare = self.given_rows, self.bare_truth
        if rows is None:
            return self.behind_electronics(bare)
        accelerated = on_velocities(rows.acceleration)
        return self.behind_electronics(bare, accelerated @ bare.disturbance_input + self.with_base(rows))

    def _loaded(self, bare: Plant) -> Plant:
        """The plant under further loads as the file has them."""
        shapes = self.config.loads
        if not shapes:
            return bare
        further = acting_on_velocities(loads_of(self.given, self.config))
        return with_further_loads(bare, further, tuple(shape.signal for shape in shapes))

    def _charge_residual(self) -> Array:
        """(p, m), C per V: the beam's static charges, strains beneath the patches above all, less what the file's modes show."""
        model, rows = self.given, self.given_rows
        if rows is not None:
            return static_residual(rows.static_rate, rows.rate, model.actuation, model.natural_frequencies)
        return static_residual(self._static_charges(), model.charges, model.actuation, model.natural_frequencies)

    def _residual(self, rows: Array) -> Array:
        """(k, m) per V: nothing, for a file does not tell how its further modes would displace the blade."""
        return np.zeros((len(rows), self.given.actuation.shape[1]))

    def changed(self, config: BladeConfig) -> GivenBlade:
        """The same modes behind other electronics; ``ValueError`` for another beam, model, speed or other patches."""
        for name in ("beam", "patches", "model", "speed"):
            if getattr(config, name) != getattr(self.config, name):
                raise ValueError(f"blade.{name} cannot be changed where a plant file says how the blade moves.")
        beam, other = self.as_beam.changed(config), GivenBlade(config, self.given)
        vars(other).update(beam=beam.beam, modal=beam.modal, full=beam.full)
        return other

    def _shapes(self) -> Array:
        """(N, r)."""
        modes = min(self.beam.space.size, max(self.config.modes, len(self.given.natural_frequencies)))
        beam, full, model = self.as_beam.changed(replace(self.config, modes=modes)).modal, self.full, self.given
        shapes = beam.mode_shapes
        own = shapes.T @ full.forces, (full.charges @ shapes).T, shapes.T @ full.line_load, (full.tip @ shapes).T
        given = model.actuation, model.charges.T, model.line_load, model.tip.T
        signs = counterparts(_answers(given, own), model.natural_frequencies, _answers(own, own), beam.natural_frequencies)
        return sealed(shapes @ signs)


def given_blade(config: BladeConfig, model: ModalPlant, source: str, modes: int | None) -> GivenBlade:
    """The blade of a configuration that moves as the first modes of a model do.

    Raises ``ValueError`` of one sentence, which names the ``source``, where they have not equally many patches, not the same
    speed or other values of the fields that the model's ``blade`` tells, and for more modes than the model has.
    """
    there = len(model.natural_frequencies)
    if modes is not None and modes > there:
        raise Refused("scenario.plants.modes", modes, f"None or at most the {there} that the plant {source!r} has")
    patches = config.patches
    wanted = patches.channels("actuators"), patches.channels("sensors")
    has = model.actuation.shape[1], len(model.charges)
    if has != wanted:
        raise ValueError(
            f"scenario.plants.truth is {source!r}, of {has[0]} voltages and {has[1]} sensors, but must have as many as the blade, "
            f"{wanted[0]} and {wanted[1]}."
        )
    if model.speed is not None and model.speed != config.speed:
        raise Refused("blade.speed", config.speed, f"that of the plant {source!r}, {model.speed:g} rad/s")
    _check_alike(config, model, source)
    if model.strain is not None and config.strain_limit == "total":
        raise Refused(
            "blade.strain_limit", config.strain_limit, f"'vibration', for the plant {source!r} has strains of vibration alone"
        )
    with of_file(source):
        loads_of(model, config)
        check_listed(model, config)
    return GivenBlade(config, model.first(modes))


def _check_alike(config: BladeConfig, model: ModalPlant, source: str) -> None:
    """``ValueError`` that names the fields in which a configuration is not the blade that a model says it is of."""
    if not model.blade:
        return
    table = json.loads(model.blade)
    with of_file(source):
        told = dict(_leaves(_told(read(THESIS, table)), table))
    here = dict(_leaves(_told(config), table))
    differ = [name for name, value in told.items() if not _alike(value, here[name])]
    if differ:
        are = ", ".join(f"blade.{name} is {shown(here[name])}" for name in differ)
        must = ", ".join(shown(told[name]) for name in differ)
        raise ValueError(f"{are}, but must be {must}: of such a blade is the plant {source!r}.")


def _told(config: BladeConfig) -> dict[str, Any]:
    """The fields of a configuration, with patches where they are, however that was said."""
    positions, length = {}, config.beam.length
    positions["actuators"] = config.patches.actuator_positions(length)
    positions["sensors"] = config.patches.sensor_positions(length)
    whole = asdict(config)
    return {**whole, "patches": {**whole["patches"], **positions}}


def _leaves(values: Mapping[str, Any], like: Mapping[str, Any], path: str = "") -> Iterator[tuple[str, Any]]:
    """The values of those fields that another table has, by their paths."""
    for name, other in like.items():
        if isinstance(other, Mapping) and isinstance(values[name], Mapping):
            yield from _leaves(values[name], other, f"{path}{name}.")
        else:
            yield f"{path}{name}", values[name]


def _alike(one: Any, other: Any) -> bool:
    """Equal, numbers but for rounding."""
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_alike, one, other))
    if isinstance(one, (int, float)) and isinstance(other, (int, float)):
        return math.isclose(one, other, rel_tol=1e-9, abs_tol=1e-12)
    return bool(one == other)


def counterparts(given: Array, given_frequencies: Array, own: Array, own_frequencies: Array) -> Array:
    """(d, r): ±1 where one of d modes is the counterpart of one of r given ones, which answer with the same or the opposite sign.

    ``own`` (k, d) and ``given`` (k, r) are their answers. Pairs are those of the greatest sum of modal assurance criteria
    (aᵀb)²/(aᵀa bᵀb) (Allemang and Brown 1982), each at least ``ALIKE``, of frequencies (d,) and (r,) that are ``NEAR``.
    """
    lengths = np.linalg.norm(own, axis=0)[:, None] * np.linalg.norm(given, axis=0)
    likeness = np.divide(own.T @ given, lengths, out=np.zeros_like(lengths), where=lengths > 0.0)
    near = np.abs(given_frequencies - own_frequencies[:, None]) <= NEAR * own_frequencies[:, None]
    assurance = np.where(near & (likeness**2 >= ALIKE), likeness**2, 0.0)
    pairs = linear_sum_assignment(assurance, maximize=True)
    signs = np.zeros_like(assurance)
    signs[pairs] = np.where(assurance[pairs] > 0.0, np.sign(likeness[pairs]), 0.0)
    return signs


def _answers(parts: tuple[Array, ...], like: tuple[Array, ...]) -> Array:
    """(k, r): what modes do with voltages and loads, and what is seen of them, each over the largest of ``like``."""
    return np.hstack([part / np.abs(other).max() for part, other in zip(parts, like, strict=True) if other.size]).T
