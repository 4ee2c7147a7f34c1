"""The linear law: five matrices, which most of the classical laws here come down to."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from baselines.design.controller import Array, Observes, name_of
from baselines.design.instruments import Instruments, checked_instruments
from baselines.design.law import Law
from baselines.design.matrix import keep_matrices, real_matrix, rows
from baselines.design.verification import verified
from beamenv.configuration import Refused, clause
from beamenv.plant.plant import Plant

if TYPE_CHECKING:
    import control


MATRICES = ("transition", "measurement_input", "voltage_input", "state_gain", "measurement_gain")


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LinearController(Law):
    """A sampled linear controller that knows the drive limits, for one blade or a batch in two matrix products.

    With y_k the measurement (A, or the state when ``observes == "state"``) and ξ_k the memory, zero at the start of an episode,

        u_k = clip(M ξ_k + T y_k),        ξ_{k+1} = F ξ_k + G y_k + H u_k

    so y_k acts on u_k without delay and the memory is driven by the voltage that was really applied.
    """

    transition: Array
    """F (s, s)."""
    measurement_input: Array
    """G (s, p), per A."""
    voltage_input: Array
    """H (s, m), per V."""
    state_gain: Array
    """M (m, s), V."""
    measurement_gain: Array
    """T (m, p), V/A."""
    _fused: Array = field(init=False)
    _feedback: Array = field(init=False)
    _limits: Array = field(init=False)

    def __post_init__(self) -> None:
        """Fuse the law into [ξ, observation] @ fused = [F ξ + G y, action]; ``ValueError`` for matrices that do not fit."""
        Law.__post_init__(self)
        s, p, m = rows(self.transition), *self.instruments.counts
        keep_matrices(self, dict(zip(MATRICES, ((s, s), (s, p), (s, m), (m, s), (m, p)), strict=True)))  # they are fused below
        scale, drive = self.instruments.measurement_scale, self.instruments.voltage_scale[:, None]
        memory = np.hstack([self.transition, self.measurement_input * scale])
        action = np.hstack([self.state_gain, self.measurement_gain * scale]) / drive
        object.__setattr__(self, "_fused", np.ascontiguousarray(np.vstack([memory, action]).T))
        object.__setattr__(self, "_feedback", np.ascontiguousarray(drive * self.voltage_input.T))
        object.__setattr__(self, "_limits", self.instruments.drive(self.instruments.voltage_limits))

    @classmethod
    def from_state_space(
        cls,
        A: Any,
        B: ArrayLike | None = None,
        C: ArrayLike | None = None,
        D: ArrayLike | None = None,
        *,
        plant: Plant | None = None,
        instruments: Instruments | None = None,
        voltage_input: ArrayLike | None = None,
        name: str = "linear law",
        verify: bool = True,
    ) -> LinearController:
        """The controller ξ⁺ = A ξ + B y, u = C ξ + D y from measurements y (p,) in A to voltages u (m,) in V, sampled as the plant.

        ``A`` alone may be a discrete-time ``control.StateSpace``, or another system that ``control.ss`` converts. The controller
        stands behind the instruments of ``plant``, or behind ``instruments``, such as those of the true state.

        ``voltage_input`` H (s, m) is for drives that saturate: the memory then follows the voltage applied instead of the one asked
        for, ξ⁺ = A ξ + B y + H (clip(u) − u). Without it the memory does not know of the limits, and an integrator winds up.

        Given a ``plant``, the controller is ``verified`` to be stable on it unless ``verify=False``; behind ``instruments`` alone
        there is nothing to be stable on. Raises ValueError for matrices whose shapes do not fit or hold no numbers, for a system in
        continuous time, for one sampled otherwise than the plant, and for one that is unstable on it.
        """
        if (plant is None) == (instruments is None):
            raise ValueError("plant and instruments are both given or both left out, but exactly one of them must be given.")
        behind = Instruments.of(plant) if instruments is None else checked_instruments(instruments)  # type: ignore[arg-type]
        matrices = _matrices(A, behind) if B is None and C is None and D is None else (A, B, C, D)
        s, p, m = rows(matrices[0]), *behind.counts
        shapes = {"A": (s, s), "B": (s, p), "C": (m, s), "D": (m, p), "voltage_input": (s, m)}
        given = (*matrices, np.zeros((s, m)) if voltage_input is None else voltage_input)
        F, G, M, T, H = (real_matrix(name, each, shapes[name]) for name, each in zip(shapes, given, strict=True))
        law = cls(name, behind, F - H @ M, G - H @ T, H, M, T)
        return law if plant is None else verified(law, plant, verify=verify)

    def to_control(self) -> control.StateSpace:
        """The controller from measurements (A) to voltages (V) within its limits, a ``control.StateSpace`` with the plant's clock.

        ξ⁺ = (F + HM) ξ + (G + HT) y, u = M ξ + T y. The sign is that of u: ``control.feedback(plant, controller, sign=1)`` closes
        the loop.
        """
        import control

        H, measured = self.voltage_input, "state" if self.observes == "state" else "current"
        return control.ss(
            self.transition + H @ self.state_gain,
            self.measurement_input + H @ self.measurement_gain,
            self.state_gain,
            self.measurement_gain,
            dt=self.instruments.interval,
            inputs=[f"{measured}{i}" for i in range(self.measurement_gain.shape[1])],
            outputs=[f"voltage{i}" for i in range(len(self.measurement_gain))],
        )

    @property
    def order(self) -> int:
        """Numbers in a blade's memory, s."""
        return len(self.transition)

    def decide(self, observation: Array, memory: Array) -> tuple[Array, Array]:
        """Two products, with the scales within the matrices."""
        order = memory.shape[-1]
        product = np.concatenate([memory, observation], axis=-1) @ self._fused
        action = np.minimum(np.maximum(product[..., order:], self._limits[0]), self._limits[1])
        return action, product[..., :order] + action @ self._feedback

    @property
    def matrices(self) -> tuple[Array, Array]:
        """[ξ, observation] @ fused (s + p, s + m) = [F ξ + G y, action], and feedback (m, s): ξ⁺ gains action @ feedback."""
        return self._fused, self._feedback


def static_law(plant: Plant, name: str, gain: Array, observes: Observes = "observation") -> LinearController:
    """The controller u = gain @ y without memory: ``gain`` (m, p) in V/A, or (m, n) in V/√J when it observes the state."""
    m, p = gain.shape
    nothing = (np.zeros((0, 0)), np.zeros((0, p)), np.zeros((0, m)), np.zeros((m, 0)))
    return LinearController(name, Instruments.of(plant, observes), *nothing, gain)


def linear(controller: object) -> LinearController:
    """The controller, if what is said of linear loops can be said of it; ValueError names it if not."""
    if isinstance(controller, LinearController):
        return controller
    raise ValueError(
        f"controller = {name_of(controller)} ({type(controller).__name__}) is not linear, so its loop has no poles, margins, "
        "frequency response or stationary cost: allowed is a LinearController."
    )


def _matrices(system: Any, instruments: Instruments) -> tuple[Any, Any, Any, Any]:
    """Of a system of python-control, or one like it."""
    if not hasattr(system, "dt"):
        allowed = "a discrete-time control.StateSpace where it is given alone, or else one of four arguments A, B, C, D"
        raise Refused("A", system, allowed)
    if not hasattr(system, "A"):
        import control

        try:
            system = control.ss(system)
        except (TypeError, ValueError) as error:
            raise ValueError(f"A is a system that control.ss does not convert: {clause(error)}.") from None
    if system.dt is not True and not (system.dt and np.isclose(system.dt, instruments.interval, rtol=1e-6)):
        raise ValueError(
            f"A is a system with dt = {system.dt!r}, but must be in discrete time and sampled as the plant is, "
            f"every {instruments.interval:g} s."
        )
    return system.A, system.B, system.C, system.D
