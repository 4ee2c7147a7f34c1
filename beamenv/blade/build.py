"""What is built from a configuration: the blade, its plant, and where its stations move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from beamenv.blade.config import BladeConfig
from beamenv.blade.held_load import own_reference, reference_of, under_reference
from beamenv.blade.instruments import in_range
from beamenv.blade.load_shapes import shape_force
from beamenv.configuration import Count, Instance, Refused, checked
from beamenv.configuration.read_only import sealed_property
from beamenv.patches import PatchResponse, actuation, local_response
from beamenv.plant.electronics import behind_electronics, static_residual
from beamenv.plant.further_loads import with_further_loads
from beamenv.plant.plant import Plant, drive_limit
from beamenv.plant.reduction import FullModel, ModalModel, acting_on_velocities, full_model, reduced_plant, truncate
from beamenv.plant.signals import REFERENCE_LOAD
from beamenv.sensors.points import along
from beamenv.sensors.readings import load_feedthrough, rate_residual, with_readings
from beamenv.sensors.rows import OnBlade, SensorRows, sensor_rows
from beamenv.structure import RotatingBeam
from beamenv.structure.scale import OUT_OF_SCALE

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Blade:
    """A configuration and what is built of it: each part once, when it is first asked for, and kept as long as the blade is.

    Blades are equal if their configurations are. Parts raise ``ValueError`` for a blade that cannot be.
    """

    config: BladeConfig

    def __post_init__(self) -> None:
        checked("config", self.config, Instance(BladeConfig))

    @property
    def as_beam(self) -> Blade:
        """The blade that the configuration describes: this one, unless it moves as a plant file says."""
        return self

    @sealed_property
    def beam(self) -> RotatingBeam:
        """The blade with its patches' passive effect."""
        return build_beam(self.config)

    @sealed_property
    def modal(self) -> ModalModel:
        """The modes of its design plant."""
        if _is_thesis(self.config) or self.config.modes > self.beam.space.size:
            return truncate(self.beam, self.config.speed, self.config.modes, self.config.gyroscopic)
        return self._every_mode.first(self.config.modes)

    @sealed_property
    def _every_mode(self) -> ModalModel:
        return truncate(self.beam, self.config.speed, self.beam.space.size, self.config.gyroscopic)

    @sealed_property
    def at_rest(self) -> PatchResponse | None:
        """What voltages on its patches do to it at rest; None in the thesis' model."""
        return None if _is_thesis(self.config) else local_response(self.beam, self.config.patches)

    @sealed_property
    def full(self) -> FullModel:
        """What acts on it and what is seen of it."""
        return full_model(self.beam, self.config.patches, self.config.speed, self.at_rest)

    @cached_property
    def reference_load(self) -> float:
        """N/m: what stands for 30 N/m of a scenario."""
        known = own_reference(self.config)
        return reference_of(self._currents(self.modal, 1.0, REFERENCE_LOAD)) if known is None else known

    @sealed_property
    def plant(self) -> Plant:
        """Its reduced plant, that controllers are designed for: ``modes`` modes, voltages and currents as they are."""
        return self._reduced(self.modal)

    @sealed_property
    def true_modal(self) -> ModalModel:
        """The modes of its true plant."""
        config, size = self.config, self.beam.space.size
        wanted = config.modes if config.truth_modes is None and _is_thesis(config) else config.truth_modes
        if wanted == config.modes:
            return self.modal
        every = self._every_mode
        if wanted is not None:
            return every.first(checked("blade.truth_modes", wanted, Count(1, size)))
        below = int(np.count_nonzero(every.natural_frequencies <= np.pi / config.control_interval))
        return every.first(max(below, config.modes))

    @sealed_property
    def truth(self) -> Plant:
        """Its true plant, that moves: all modes up to the Nyquist frequency, the others' static share, and the electronics.

        In the thesis' model, unless ``truth_modes`` are others, it is ``plant``.
        """
        return self.behind_electronics(self.bare_truth)

    @sealed_property
    def bare_truth(self) -> Plant:
        """Its true plant without the electronics."""
        config, plant = self.config, self.plant
        whole = _is_thesis(config) and config.truth_modes in (None, config.modes)
        return self._loaded(plant if whole else self._reduced(self.true_modal, plant.sensor_full_scale))

    @sealed_property
    def further_loads(self) -> Array:
        """(N, l): the generalised forces of loads besides the uniform ones, per unit of each."""
        each = [shape_force(self.beam, shape, f"scenario.loads[{k}]") for k, shape in enumerate(self.config.loads)]
        return np.column_stack([np.zeros((self.beam.space.size, 0)), *each])

    def _loaded(self, bare: Plant) -> Plant:
        """The plant with its further loads among the disturbances, of which load cases and noise make nothing."""
        shapes, further = self.config.loads, acting_on_velocities(self.true_modal.mode_shapes.T @ self.further_loads)
        return bare if not shapes else with_further_loads(bare, further, tuple(shape.signal for shape in shapes))

    @property
    def all_loads(self) -> Array:
        """(N, 2 + l): the generalised forces of the uniform loads and of the further ones."""
        return np.hstack([self.full.line_load, self.further_loads])

    def with_base(self, rows: SensorRows) -> Array:
        """(p, 2 + l): what accelerometers feel of the acceleration of the base itself."""
        felt = np.zeros((len(rows.item), 2 + len(self.config.loads)))
        for k, shape in enumerate(self.config.loads):
            if shape.shape == "base":
                felt[:, 2 + k] = rows.with_base @ along(shape.direction)
        return felt

    def behind_electronics(self, bare: Plant, load_through: Array | None = None) -> Plant:
        """The plant behind amplifiers and filters, with the static share of modes that it leaves out; none of it in the thesis.

        ``load_through`` (p, k) is what readings show of loads at once; None: by the modes of the configured speed.
        """
        config = self.config
        if _is_thesis(config):
            return bare
        electronics, rate = config.electronics, 2.0 * np.pi / config.control_interval
        bandwidth, cutoff, rows = electronics.amplifier_bandwidth, electronics.filter_cutoff, self.sensor_rows
        if rows is not None and load_through is None:
            load_through = load_feedthrough(rows, self.true_modal, self.all_loads) + self.with_base(rows)
        return behind_electronics(
            bare,
            charge_residual=self._charge_residual(),
            tip_residual=self._residual(self.full.tip),
            amplifier=None if bandwidth is None else 2.0 * np.pi * bandwidth,
            filter_order=electronics.filter_order,
            filter_cutoff=None if cutoff is None else cutoff * rate,
            load_feedthrough=load_through,
        )

    @sealed_property
    def _static(self) -> Array:
        """K⁻¹F (N, m): the coefficients of the trial functions under each volt, at its speed."""
        return np.asarray(np.linalg.solve(self.beam.at(self.config.speed).stiffness, self.full.forces))

    def _static_charges(self) -> Array:
        """(p, m), C per V: exactly at rest, where patches so short raise strains beneath them alone, and by the trial functions
        what the rotation changes, which they can follow.
        """
        response = self.full.response
        return np.asarray(response.charges + self.full.charges @ self._static - response.smooth_charges)

    def _charge_residual(self) -> Array:
        """(p, m), C per V: static charges that the modes of the true plant do not show, or what of other readings is a rate."""
        rows = self.sensor_rows
        if rows is not None:
            return rate_residual(rows, self.true_modal, self.full.forces)
        return self._less_modes(self._static_charges(), self.full.charges)

    def _residual(self, rows: Array) -> Array:
        """(k, m) per V: what rows (k, N) show of the static displacement, and not of the modes of the true plant."""
        return self._less_modes(rows @ self._static, rows)

    def _less_modes(self, static: Array, rows: Array) -> Array:
        modal = self.true_modal
        shapes = modal.mode_shapes
        return static_residual(static, rows @ shapes, shapes.T @ self.full.forces, modal.natural_frequencies)

    @sealed_property
    def sensor_rows(self) -> SensorRows | None:
        """What the sensors that are listed feel; None where the currents of all patches are read."""
        config, beam = self.config, self.beam
        if not config.sensors:
            return None
        share: Array = np.linalg.solve(beam.at(0.0).stiffness, actuation(beam, config.patches)).astype(np.float64)
        charges = self.full.charges, self._static_charges()
        return sensor_rows(OnBlade(beam, config.patches, config.speed, *charges, self._static, share), config.sensors)

    def _reduced(self, modal: ModalModel, full_scale: Array | None = None) -> Plant:
        """With what is read; ``full_scale`` (p,) where it is known already, as that of the design plant."""
        config, rows = self.config, self.sensor_rows
        if rows is None:
            return self._currents(modal, config.sensor_full_scale if full_scale is None else full_scale, self.reference_load)
        return with_readings(
            self._currents(modal, 1.0, self.reference_load),
            rows,
            modal,
            sensors=config.sensors,
            forces=self.full.forces,
            line_load=self.full.line_load,
            noise=config.sensor_noise_fraction,
            current_range=config.sensor_full_scale,
            full_scale=full_scale,
            filtered=full_scale is not None,
        )

    def _currents(self, modal: ModalModel, sensor_full_scale: float | Array | None, reference_load: float) -> Plant:
        config, full = self.config, self.full
        if not len(full.charges):  # a plant shows something, which sensors that are listed replace
            full = replace(full, charges=np.zeros((1, full.charges.shape[1])))
        try:
            plant = reduced_plant(
                modal,
                full,
                damping_ratio=config.damping_ratio,
                effort_weight=config.effort_weight,
                white_load=config.white_load,
                sensor_noise_fraction=config.sensor_noise_fraction,
                sensor_full_scale=sensor_full_scale,
                voltage_limits=config.voltage_limits,
                control_interval=config.control_interval,
                reference_load=reference_load,
            )
        except OverflowError:
            raise ValueError(f"blade cannot be computed: {OUT_OF_SCALE}") from None
        parts = (getattr(plant, each.name) for each in fields(plant))
        finite = all(np.isfinite(part).all() for part in parts if isinstance(part, np.ndarray))
        if not finite or np.any(plant.sensor_full_scale**2 == 0.0):  # squares of readings must be numbers
            raise ValueError(f"blade cannot be computed: {OUT_OF_SCALE}")
        return plant

    @property
    def standing_strain(self) -> Array:
        """(k,): what counts towards failure of the strain without vibration, where that of vibration is watched."""
        return self.full.steady_strain if self.config.strain_limit == "total" else np.zeros(len(self.truth.strain))

    def changed(self, config: BladeConfig) -> Blade:
        """The blade of another configuration, with the parts of this one that do not depend on the difference."""
        other = Blade(config)
        for part, depends_on in _MADE_OF.items():
            if all(getattr(config, name) == getattr(self.config, name) for name in depends_on):
                vars(other)[part] = getattr(self, part)
        return other

    def with_fixed_range(self) -> Blade:
        """The blade behind the data acquisition and under the loads that fit it now: one made of its configuration keeps them."""
        config = in_range(self.config, self.plant.sensor_full_scale)
        return self.changed(under_reference(config, self.reference_load))

    def with_fixed_order(self) -> Blade:
        """The blade with as many modes in its true plant as it has now, whatever becomes of their frequencies."""
        return self.changed(replace(self.config, truth_modes=len(self.true_modal.natural_frequencies)))

    def displacement_operator(self, stations: Sequence[float] | Array) -> Array:
        """(3, k, n): lag, flap (m) and twist (rad) at k stations (m from the root) per unit of each state of the true plant."""
        rows = self.beam.displacements(stations)
        lag_flap_twist, truth = np.stack([rows["u"], rows["v"], rows["phi"]]), self.truth
        displaced = lag_flap_twist @ (self.true_modal.mode_shapes / self.true_modal.natural_frequencies)
        still = np.zeros((*displaced.shape[:-1], len(truth.A) - displaced.shape[-1]))
        operator = np.concatenate([displaced, still], axis=-1)
        if truth.electronic_states and self.config.electronics.amplifier_bandwidth is not None:
            m = truth.B.shape[1]
            flat = lag_flap_twist.reshape(-1, lag_flap_twist.shape[-1])
            operator[..., -m:] = (self._residual(flat) * drive_limit(truth)).reshape(*operator.shape[:-1], m)
        return operator


def _is_thesis(config: BladeConfig) -> bool:
    return config.model == "thesis"


_BEAM = ("beam", "patches", "model")
_MADE_OF = {
    "beam": _BEAM,
    "at_rest": _BEAM,
    "modal": (*_BEAM, "speed", "modes", "gyroscopic"),
    "true_modal": (*_BEAM, "speed", "modes", "truth_modes", "gyroscopic", "control_interval"),
    "full": (*_BEAM, "speed"),
    "sensor_rows": (*_BEAM, "speed", "sensors"),
    "further_loads": (*_BEAM, "speed", "loads"),
}
"""The fields of a configuration that each part depends on."""


def build_beam(config: BladeConfig) -> RotatingBeam:
    """The blade with its patches' passive effect."""
    return config.beam.build(config.patches, config.model)


def build_plant(config: BladeConfig) -> Plant:
    """The reduced plant of a configuration, built anew, in some hundredths of a second; ``ValueError`` as the parts raise it."""
    return Blade(config).plant


def plant_of(config: BladeConfig, beam: RotatingBeam) -> Plant:
    """The plant of a beam that ``config.beam`` does not describe, of any section, say; it carries the inlays of passive patches.

    Raises ``ValueError`` for a beam of another model than the configuration's.
    """
    if beam.model != config.model:
        raise Refused("beam.model", beam.model, f"the blade's, {config.model!r}")
    blade = Blade(config)
    vars(blade)["beam"] = beam
    return blade.plant


def displacement_operator(config: BladeConfig, stations: Sequence[float] | Array) -> Array:
    """(3, k, n): lag, flap (m) and twist (rad) at k stations (m from the root) per unit of each state of the true plant."""
    return Blade(config).displacement_operator(stations)
