"""Arguments of the batch of tensors, checked; ``ValueError`` names the one that is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from beamenv.arrays import Arrays, on_host
from beamenv.configuration import Flag, Refused, checked
from beamenv.scenarios.scenario import Scenario
from beamenv.task import checked_action, checked_dtype

try:
    import torch as torch
except ImportError as error:
    raise ImportError('beamenv.torch_vec needs PyTorch: pip install "torch".') from error

DEVICES = ("cpu", "cuda")
"""Kinds of devices that have numbers of 64 bits, with which is drawn."""


def checked_device(device: Any) -> torch.device:
    """A device that is there, with its number; of None the GPU if there is one, else the processor."""
    if device is None:
        device = "cuda" if torch.cuda.is_available() else "cpu"
    try:
        found = torch.device(device) if isinstance(device, (str, torch.device)) else None
    except RuntimeError:
        found = None
    if found is None or found.type not in DEVICES:
        raise Refused("device", device, "None, 'cpu', 'cuda' or 'cuda:' with a number")
    if found.type == "cpu":
        return torch.device("cpu")
    count = torch.cuda.device_count() if torch.cuda.is_available() else 0
    if (found.index or 0) >= count:
        there = "'cpu', for torch finds no GPU" if not count else f"'cpu', or one of {count} GPUs, the first of which is 'cuda:0'"
        raise Refused("device", str(found), there)
    return torch.device("cuda", torch.cuda.current_device() if found.index is None else found.index)


def checked_precision(dtype: Any) -> Any:
    """``"float32"`` or ``"float64"``, also of torch's types of these names."""
    named = str(dtype).removeprefix("torch.") if isinstance(dtype, torch.dtype) else dtype
    return checked_dtype(named)


def checked_recording(
    graph: Any, compiled: Any, device: torch.device, differentiable: bool, scenario: Scenario
) -> tuple[bool, bool]:
    """Whether steps are captured, and whether they are compiled; ``ValueError`` where they cannot be."""
    wanted = {name: bool(checked(name, value, Flag())) for name, value in (("graph", graph), ("compiled", compiled))}
    if wanted["graph"] and device.type != "cuda":
        raise Refused("graph", graph, f"False on {device}: only a GPU has graphs")
    for name, value in wanted.items():
        if value and differentiable:
            raise Refused(name, value, "False with differentiable, for no gradient passes through a recorded step")
        if value and scenario.loads:
            raise Refused(name, value, "False with loads of one's own, which are worked out on the host")
    return wanted["graph"], wanted["compiled"]


def checked_actions(actions: Any, shape: tuple[int, ...], zeros: torch.Tensor, arrays: Arrays) -> torch.Tensor:
    """The actions in the numbers of ``zeros`` and on its device: a tensor that is there already, or an array of NumPy, copied.

    ``ValueError`` for another shape or device, and for numbers that are not finite where to look at them costs nothing.
    """
    if not isinstance(actions, torch.Tensor):
        return torch.tensor(checked_action(actions, shape), dtype=zeros.dtype, device=zeros.device)
    if tuple(actions.shape) != shape:
        raise ValueError(f"action has shape {tuple(actions.shape)}, but must have shape {shape}.")
    if actions.device != zeros.device:
        raise ValueError(f"action is on {actions.device}, but must be on {zeros.device}, where the blades are.")
    if actions.is_complex() or actions.dtype == torch.bool or actions.layout is not torch.strided:
        raise Refused("action", actions, "a dense tensor of real numbers")
    if arrays.on_host and not bool(torch.isfinite(actions).all()):
        wrong = (~torch.isfinite(actions)).nonzero()[0].tolist()
        raise ValueError(f"action{wrong} is {actions[tuple(wrong)].item()}, but every number must be finite.")
    return actions.to(zeros.dtype)


def host_options(options: Any) -> Any:
    """The options of a reset with arrays of NumPy in the place of tensors."""
    return {name: on_host(value) for name, value in options.items()} if isinstance(options, Mapping) else options


def torch_seed(seed: int) -> int:
    """64 bits of a seed however large: torch's generator for the processor takes 32 of what it is given, and these differ too."""
    return int(np.random.SeedSequence(seed).generate_state(1, np.uint64)[0])
