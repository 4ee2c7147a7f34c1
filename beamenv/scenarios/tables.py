"""What may be wrong with a blade in a scenario: other plants than the design's, drive, data acquisition, failures, rotor loads.

Each is a frozen dataclass whose defaults mean "nothing". A range is [low, high], drawn uniformly for each episode.
"""

from __future__ import annotations

from typing import Annotated

from beamenv.configuration import Count, Flag, NameOrFile, Natural, Number, Numbers, Range, Refused, Share, configuration
from beamenv.plant.limits import VOLTAGES
from beamenv.plant.named import ENDING, NAMES

Pair = tuple[float, float]

SAME: Pair = (1.0, 1.0)

STRONGEST = 1e6
"""N/m: a line load beyond this is a mistake."""

MOST_PLANTS = 4096
"""In a bank: some hundred megabytes, and a minute to build."""

MOST_HARMONICS = 100

Ratio = Annotated[Pair, Range(0.01, 10.0)]
Load = Number(ge=0.0, le=STRONGEST, unit="N/m")


@configuration("scenario.plants")
class PlantVariation:
    """The true plant of an episode beside the design's. Plants are built once, as a bank that episodes draw from."""

    speed_ratio: Ratio = SAME
    """Ω over the configured speed."""
    ply_angle_ratio: Ratio = SAME
    """Of every ply angle."""
    modulus_ratio: Ratio = SAME
    """Of every modulus of the laminate."""
    mass_ratio: Ratio = SAME
    """Of the laminate's density."""
    damping_ratio: Annotated[Pair | None, Range(1e-6, 0.9)] = None
    """Of every mode, drawn on a logarithmic scale; None: the configured one."""
    truth: Annotated[str | None, NameOrFile(NAMES, ENDING)] = None
    """What moves instead of the beam: a plant file (``beamenv.plant.files``), or the name of one that comes with the package.
    Nothing else varies then."""
    modes: Annotated[int | None, Count()] = None
    """Modes of the true plant; None: the configured number, all up to the Nyquist frequency unless said otherwise, or all that a
    plant file has."""
    design_modes: Annotated[int | None, Count()] = None
    """Modes of the plant that controllers are designed for; None: the configured number, 11 unless said otherwise."""
    spin_up: Annotated[Pair | None, Range(0.0, 1e6, unit="rad/s", falls=True)] = None
    """rad/s: Ω(t) spins up or down from the first to the second over the episode (``spin_up`` of the simulation); nothing else
    varies then."""
    speed_wander: Annotated[float, Number(ge=0.0, le=0.1)] = 0.0
    """σ over the configured speed: Ω(t) wanders about that speed within the episode (``Wander`` of the simulation). A tachometer
    does not show it. Nothing else varies then."""
    wander_frequency: Annotated[float, Number(ge=1e-3, le=20.0, unit="Hz")] = 2.0
    """Up to which the speed wanders: far below the first mode, so that the steady state follows and sensors do not show it."""
    modulus_drift: Ratio = SAME
    """Every modulus of the laminate at the end of its change, over its value at the start. Nothing else varies then."""
    mass_drift: Ratio = SAME
    """The laminate's density at the end of its change, over its value at the start."""
    temperature: Annotated[Pair | None, Range(100.0, 2000.0, unit="K")] = None
    """K, of blade and patches when the episode begins. None: that of the configuration, for which controllers are designed. Nothing
    else varies then."""
    temperature_change: Annotated[Pair, Range(-500.0, 500.0, unit="K")] = (0.0, 0.0)
    """K: rise of the temperature by the end of the drift (``Warming`` of the simulation)."""
    pyroelectric: Annotated[bool, Flag()] = False
    """Whether sensor patches show that their temperature changes."""
    drift_onset: Annotated[Pair, Range(0.0, 1e6, unit="s")] = (0.0, 0.0)
    """s: when modulus and mass, or the temperature, begin to change, evenly in time (``Drift`` of the simulation)."""
    drift_duration: Annotated[Pair, Range(0.0, 1e6, unit="s")] = (0.4, 0.4)
    """s: for how long they do."""
    bank: Annotated[int, Count(1, MOST_PLANTS)] = 128
    """Plants in the bank: a Latin hypercube of what varies, or the stations of what changes within an episode: of speeds and of
    temperatures all of them, of modulus and mass 16 on each of as many courses."""
    seed: Natural = 0
    """Of the bank. Agents train on a bank of another seed than the one they are judged on, and are chosen on one of a third."""

    def __post_init__(self) -> None:
        drawn = self._drawn
        if self.speed_wander and (drawn or self.drifts):
            raise Refused("speed_wander", self.speed_wander, "0 where other plants are drawn or drift")
        if self.drifts and drawn:
            named = "modulus_drift" if self.modulus_drift != SAME else "mass_drift"
            raise Refused(named, list(getattr(self, named)), "1 where other plants are drawn")
        self._check_heat()
        if self.walks and self.bank < 2:
            raise Refused("bank", self.bank, "at least 2 where the blade changes within an episode")
        if self.spin_up is not None and not max(self.spin_up):
            raise Refused("spin_up", self.spin_up, "two speeds of which one is above 0 rad/s: from 0 to 0 no rotor spins up")
        if self.spin_up is not None and self.varies:
            raise Refused("spin_up", self.spin_up, "None where other plants are drawn")
        if self.truth is not None and (self.varies or self.spin_up is not None):
            raise Refused("truth", self.truth, "None where other plants are drawn or the rotor spins up")

    def _check_heat(self) -> None:
        if self.temperature is None:
            if self.temperature_change != (0.0, 0.0):
                raise Refused("temperature_change", list(self.temperature_change), "0 where no temperature is drawn (K)")
            if self.pyroelectric:
                raise Refused("pyroelectric", True, "False where no temperature is drawn")
        elif self._drawn or self.drifts or self.speed_wander:
            raise Refused("temperature", list(self.temperature), "None where other plants are drawn, drift or wander")
        elif self.temperature[0] + self.temperature_change[0] <= 0.0:
            raise Refused("temperature_change", list(self.temperature_change), "one that leaves temperatures above 0 K")

    @property
    def varies(self) -> bool:
        """Whether there are other plants than the configured one, drawn or on the way."""
        return self._drawn or self.walks

    @property
    def walks(self) -> bool:
        """Whether the blade changes within the episode."""
        return self.drifts or self.speed_wander > 0.0 or self.temperature is not None

    @property
    def drifts(self) -> bool:
        """Whether modulus or mass change within the episode."""
        return (self.modulus_drift, self.mass_drift) != (SAME, SAME)

    @property
    def _drawn(self) -> bool:
        ratios = (self.speed_ratio, self.ply_angle_ratio, self.modulus_ratio, self.mass_ratio)
        return any(ratio != SAME for ratio in ratios) or self.damping_ratio is not None


@configuration("scenario.drive")
class Drive:
    """The amplifiers and actuators."""

    voltage_limits: Annotated[Pair | None, VOLTAGES] = None
    """V, of a blade that is driven by up to 1500 V, and in proportion to the drive of another; None: the blade's own."""
    hysteresis: Annotated[float, Number(ge=0.0, le=0.5)] = 0.0
    """Width of the free-strain loop over its stroke, both at full drive (``beamenv.simulation.signals.hysteresis``)."""
    delay: Annotated[tuple[int, int], Range(0, 100, whole=True)] = (0, 0)
    """Control intervals, a whole number drawn for each episode, by which voltages come late."""


@configuration("scenario.acquisition")
class Acquisition:
    """The data acquisition."""

    dropout: Annotated[float, Number(ge=0.0, le=0.99)] = 0.0
    """Share of readings, sensor by sensor, that are lost: the last one is then shown again."""


@configuration("scenario.failures")
class Failures:
    """What is broken in an episode, from its start or from a drawn instant on; which one is drawn, every one equally likely."""

    dead_actuators: Natural = 0
    """Actuators that do nothing and store nothing, or less than they should."""
    remaining: Annotated[Pair, Range(0.0, 1.0)] = (0.0, 0.0)
    """The share of its voltage that still acts in an actuator that is not quite dead."""
    faulty_sensors: Natural = 0
    """Sensors that are dead (noise alone) or biased."""
    biased_share: Share = 0.5
    """Share of faulty sensors that are biased instead of dead."""
    bias: Annotated[Pair, Range(0.0, 1.0)] = (0.05, 0.2)
    """Of full scale, of either sign."""
    onset: Annotated[Pair, Range(0.0, unit="s")] = (0.0, 0.0)
    """s: the instant at which patches break, drawn separately for actuators and for sensors; before it they are sound."""
    either: Annotated[bool, Flag()] = False
    """Whether either actuators or sensors break in an episode, with equal chances, instead of both."""

    @property
    def drawn_instants(self) -> bool:
        """Whether what breaks is not just broken from the start."""
        return self.either or self.onset != (0.0, 0.0)


@configuration("scenario.rotor")
class Rotor:
    """Loads that come with the revolution of the rotor, and turbulence."""

    harmonics: Annotated[tuple[float, ...], Numbers(Load, most=MOST_HARMONICS, of="amplitudes")] = ()
    """N/m: mean amplitude of the line load at 1, 2, … per revolution. Each is drawn between half and one and a half of it, with
    a phase and a direction of its own."""
    turbulence: Annotated[float, Load] = 0.0
    """σ, N/m, in lag and in flap each."""
    turbulence_time: Annotated[float, Number(ge=1e-6, le=1e6, unit="s")] = 0.02
    """τ, s. The spectrum is Dryden's longitudinal one, S(ω) = 2σ²τ/(1 + (ωτ)²), two-sided with ∫S dω/2π = σ²; held and
    sampled exactly."""
