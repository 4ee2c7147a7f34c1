"""How the filters' states of a multiple-model law go on, as blocks: by their matrices, or mode by mode."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from baselines import MultipleModel
from baselines.design.motion import DenseMotion, ModalMotion, motion_of
from train.export.blocks import Array, Block, Delay, affine, function, join, pair, pick, products

TINY = 1e-30
"""A share of nothing, where nothing leads to a hypothesis: single precision can hold it."""


@dataclass(frozen=True, slots=True, eq=False)
class Moving:
    """Predicted states of all hypotheses, what they show, and what follows them."""

    states: Delay
    seen: list[Block]
    """p readings to be expected, A, and m products K x̂, V, each (H,)."""
    answers: Callable[[Block, Block], Block]
    """(H · m,), V: what whitened innovations (H · p,) at a step add to −K x̂."""
    onward: Callable[[Block, Block], Block]
    """What follows the states without voltages, from a step and whitened innovations."""
    driven: Callable[[Block], Block]
    """What voltages (m (D + 1),), V, newest first, add."""
    mix: tuple[Array, Array, int] | None
    """Markov matrix Π, logarithms of the prior, and how many numbers each hypothesis has; None: hypotheses stay what they are."""

    def follow(self, step: Block, whitened: Block, voltages: Block, weights: Block, evidence: Block) -> tuple[Block, Block]:
        """The next states and evidence."""
        moved = self.onward(step, whitened)
        if self.mix is not None:
            moved, evidence = _mixed(*self.mix, moved, weights)
        return moved + self.driven(voltages), evidence


def moving(law: MultipleModel) -> Moving:
    """That of a law."""
    motion = motion_of(law.bank, law.state_gain, law.transition is not None)
    H = law.bank.counts[0]
    mix = None if law.transition is None else (law.transition, np.log(law.prior), motion.size // H)
    if isinstance(motion, ModalMotion):
        return _modal(motion, H, mix)
    if isinstance(motion, DenseMotion):
        return _dense(motion, H, mix)
    raise ValueError(f"law = {law.name} moves as no block does: {type(motion).__name__}.")


def _transposed(matrices: Array) -> Array:
    return np.ascontiguousarray(matrices.swapaxes(-1, -2))


def _columns(through: Block, H: int) -> list[Block]:
    """Each (H,), of rows (H, q) one after the other."""
    return [pick(through, np.arange(H) * (through.size // H) + i) for i in range(through.size // H)]


def _dense(motion: DenseMotion, H: int, mix: tuple[Array, Array, int] | None) -> Moving:
    states, s, bank = Delay(motion.size, label="predicted"), motion.size // H, motion.bank
    shown = motion.moved.shape[-1] - s
    asked = motion.onward.shape[-1] - s
    drive = bank.voltage_input.reshape(len(bank.voltage_input), -1).T
    return Moving(
        states,
        _columns(products(_transposed(motion.moved[..., :shown]), states, label="seen"), H),
        lambda step, whitened: products(_transposed(motion.onward[..., :asked]), whitened, step),
        lambda step, whitened: (
            products(_transposed(motion.moved[..., shown:]), states)
            + products(_transposed(motion.onward[..., asked:]), whitened, step)
        ),
        lambda voltages: affine(drive, voltages),
        mix,
    )


def _modal(motion: ModalMotion, H: int, mix: tuple[Array, Array, int] | None) -> Moving:
    states = Delay(motion.size, label="predicted")
    p = motion.answer.shape[-2]
    real, imaginary = np.repeat(motion.eigenvalues.real, 2), np.repeat(motion.eigenvalues.imag, 2)
    imaginary[::2] *= -1.0
    swapped = np.arange(motion.size).reshape(-1, 2)[:, ::-1]

    def of(block: Block, those: slice, each: int) -> Block:
        return block[those.start * each : those.stop * each]

    def onward(step: Block, whitened: Block) -> Block:
        turned = states * real + pick(states, swapped) * imaginary
        gained = (products(_transposed(each.gains), of(whitened, each.those, p), step) for each in motion.alike)
        return turned + join(*gained)

    seen = join(*(products(_transposed(each.seen), states[each.columns]) for each in motion.alike), label="seen")
    return Moving(
        states,
        _columns(seen, H),
        lambda step, whitened: products(_transposed(motion.answer), whitened, step),
        onward,
        lambda voltages: _driven(motion, H, voltages),
        mix,
    )


def _driven(motion: ModalMotion, H: int, voltages: Block) -> Block:
    """Those voltages that act by each hypothesis, through its modes."""
    m, delays = motion.answer.shape[-1], np.zeros(H, int)
    for delay, those in motion.late:
        delays[those] = delay
    acting = delays[:, None] * m + np.arange(m)
    return join(*(products(_transposed(each.drive), pick(voltages, acting[each.those])) for each in motion.alike))


def _mixed(transition: Array, log_prior: Array, size: int, states: Block, weights: Block) -> tuple[Block, Block]:
    """States (H, size) of what may follow, and how likely that is."""
    H = len(transition)
    following = pair("maximum", affine(transition.T, weights), TINY)
    by_number = np.arange(H * size).reshape(H, size)
    weighed = pick(states * pick(weights, np.repeat(np.arange(H), size)), by_number.T)
    led = products(np.broadcast_to(transition.T, (size, H, H)), weighed)
    mixed = pick(led, np.arange(size * H).reshape(size, H).T) / pick(following, np.repeat(np.arange(H), size))
    return mixed, pair("subtract", function("log", following), log_prior)
