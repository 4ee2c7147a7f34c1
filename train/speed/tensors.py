"""Blade-steps per second of ``beamenv.torch_vec`` on a device, over sizes of the batch, beside CartPole's native batch."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import gymnasium
import torch

import beamenv

SIZES = {"cpu": (256, 1024, 4096, 16384), "cuda": (4096, 65536, 1048576, 2097152)}
"""Blades, on either kind of device."""

WAYS: dict[str, dict[str, bool]] = {
    "plain": {},
    "captured": {"graph": True},
    "compiled": {"compiled": True},
    "compiled, captured": {"graph": True, "compiled": True},
}
"""How a GPU steps, and the arguments of ``beamenv.torch_vec`` that ask for it."""

CARTPOLE = 4096

TARGET = 1e9
"""Blade-steps/s on one GPU of the H100's class, at the best size."""


@dataclass(frozen=True, slots=True)
class Rate:
    """Steps per second of one batch."""

    label: str
    size: int
    rate: float
    """Environment steps/s."""


def device_name(device: torch.device) -> str:
    """What is said of a device: a GPU's own name, or that it is none."""
    return f"{torch.cuda.get_device_name(device)} (a GPU)" if device.type == "cuda" else "the processor: not measured on a GPU"


def rates(device: Any, seconds: float, dtype: str = "float32", scenario: Any = None) -> Iterator[Rate]:
    """CartPole's native batch, then the batches of tensors, each stepped for so many seconds; on a GPU in all ways."""
    cartpole = gymnasium.make_vec("CartPole-v1", num_envs=CARTPOLE)
    cartpole.action_space.seed(0)
    cartpole.reset(seed=0)
    actions = cartpole.action_space.sample()
    yield Rate("CartPole-v1, NumPy", CARTPOLE, rate(lambda: cartpole.step(actions), CARTPOLE, seconds))
    kind = beamenv.torch_vec(1, device).device.type
    for size in SIZES[kind]:
        for label, how in WAYS.items() if kind == "cuda" else (("plain", {}),):
            yield Rate(label, size, _of_tensors(size, device, seconds, how, dtype, scenario))


def _of_tensors(size: int, device: Any, seconds: float, how: Mapping[str, bool], dtype: str, scenario: Any) -> float:
    """With all noises, loads, rewards, info and autoresets, episodes spread over their length."""
    envs = beamenv.torch_vec(size, device, dtype=dtype, autoreset_mode="SameStep", scenario=scenario, **how)
    envs.reset(seed=0, options={"elapsed": torch.arange(size) * envs.steps // size})
    actions = torch.rand(size, 4, device=envs.device) - 0.5
    return rate(lambda: envs.step(actions), size, seconds, torch.cuda.synchronize if envs.device.type == "cuda" else None)


def rate(step: Callable[[], Any], size: int, seconds: float, wait: Callable[[], Any] | None = None) -> float:
    """Environment steps/s of calls that step ``size`` environments each, after some that do not count; ``wait`` for a device."""
    for _ in range(5):
        step()
    calls, spent = 5, 0.0
    while True:
        if wait is not None:
            wait()
        start = time.perf_counter()
        for _ in range(calls):
            step()
        if wait is not None:
            wait()
        spent = time.perf_counter() - start
        if spent >= 0.5 * seconds:
            return calls * size / spent
        calls = max(2 * calls, int(calls * seconds / max(spent, 1e-6)))
