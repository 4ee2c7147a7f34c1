"""A step of episodes on a GPU as one CUDA graph: hundreds of small kernels that are started at once.

A graph replays what was done to the same memory. So all tensors that a step replaces are given a place of their own, to which the
step's last act is to copy what is to be there: ``StaticStep`` does that on any device. Not measured on a GPU.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import fields, is_dataclass
from typing import Any

import torch

from beamenv.envs.torch_episodes import Outcome, TorchEpisodes

_WARM_UP = 3
"""Steps before a capture, as torch advises: libraries set themselves up in the first."""


class StaticStep:
    """A step of episodes whose tensors stay where they are: what moves is read from and written to the same memory.

    Actions are to be copied to ``actions``. It holds until something else than ``run`` moves the episodes.
    """

    def __init__(self, episodes: TorchEpisodes, actions: torch.Tensor, generator: torch.Generator) -> None:
        self.actions, self._episodes, self._generator = actions.clone(), episodes, generator
        self._places = self._moving()
        self._values = [mapped(getattr(owner, name), torch.Tensor.clone) for owner, name in self._places]
        self._memory = {leaf.untyped_storage().data_ptr() for value in self._values for leaf in leaves(value)}
        self._put_back()

    def _moving(self) -> list[tuple[Any, str]]:
        """Attributes that steps replace, found by some, which are then undone: tensors themselves are never written to."""
        places = [(owner, name) for owner in owners(self._episodes) for name in vars(owner)]
        before, drawn = [getattr(owner, name) for owner, name in places], self._generator.get_state()
        for _ in range(_WARM_UP):
            self._episodes.step(self.actions, self._generator)
        moved = [getattr(owner, name) is not value for (owner, name), value in zip(places, before, strict=True)]
        for (owner, name), value in zip(places, before, strict=True):
            setattr(owner, name, value)
        self._generator.set_state(drawn)
        return [
            place for place, value, has in zip(places, before, moved, strict=True) if has and next(leaves(value), None) is not None
        ]

    def run(self) -> Outcome:
        """One step under ``actions``."""
        outcome = mapped(self._episodes.step(self.actions, self._generator), self._apart)
        changed = [(value, getattr(*place)) for value, place in zip(self._values, self._places, strict=True)]
        pairs = [
            (into, new) for value, now in changed for into, new in zip(leaves(value), leaves(now), strict=True) if into is not new
        ]
        for (into, _), new in zip(pairs, [self._apart(new) for _, new in pairs], strict=True):
            into.copy_(new)
        self._put_back()
        return outcome

    def _apart(self, tensor: torch.Tensor) -> torch.Tensor:
        """The tensor, copied if it lies where a step writes to."""
        return tensor.clone() if tensor.untyped_storage().data_ptr() in self._memory else tensor

    def _put_back(self) -> None:
        for value, (owner, name) in zip(self._values, self._places, strict=True):
            setattr(owner, name, value)


class CapturedStep:
    """A step on a GPU that is captured once and replayed from then on."""

    def __init__(self, episodes: TorchEpisodes, actions: torch.Tensor, generator: torch.Generator) -> None:
        stream = torch.cuda.Stream(actions.device)  # type: ignore[no-untyped-call]
        stream.wait_stream(torch.cuda.current_stream(actions.device))
        with torch.cuda.stream(stream):
            self._step = StaticStep(episodes, actions, generator)
        torch.cuda.current_stream(actions.device).wait_stream(stream)
        self._graph = torch.cuda.CUDAGraph()
        self._graph.register_generator_state(generator)
        with torch.cuda.graph(self._graph):
            self._outcome = self._step.run()

    def __call__(self, actions: torch.Tensor) -> Outcome:
        """What a step brings, in tensors that later ones leave alone."""
        self._step.actions.copy_(actions)
        self._graph.replay()
        copies = {id(leaf): leaf for leaf in leaves(self._outcome)}
        copies = {name: leaf.clone() for name, leaf in copies.items()}
        return mapped(self._outcome, lambda leaf: copies[id(leaf)])


def owners(root: Any) -> Iterator[Any]:
    """The object and, of what it holds, those of this package that change."""
    yield root
    for value in list(vars(root).values()):
        if type(value).__module__.partition(".")[0] == "beamenv" and hasattr(value, "__dict__") and not is_dataclass(value):
            yield from owners(value)


def leaves(value: Any) -> Iterator[torch.Tensor]:
    """The tensors in a tensor, tuple or dataclass, in a fixed order."""
    if isinstance(value, torch.Tensor):
        yield value
    elif isinstance(value, tuple):
        for each in value:
            yield from leaves(each)
    elif is_dataclass(value) and not isinstance(value, type):
        for field in fields(value):
            yield from leaves(getattr(value, field.name))


def mapped(value: Any, function: Callable[[torch.Tensor], torch.Tensor]) -> Any:
    """The same with every tensor passed through a function."""
    if isinstance(value, torch.Tensor):
        return function(value)
    if isinstance(value, tuple):
        parts = [mapped(each, function) for each in value]
        return type(value)(*parts) if hasattr(value, "_fields") else tuple(parts)
    if is_dataclass(value) and not isinstance(value, type):
        return type(value)(**{each.name: mapped(getattr(value, each.name), function) for each in fields(value) if each.init})
    return value
