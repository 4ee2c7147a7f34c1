"""A step of episodes as one recording, which is run again and again: captured as a CUDA graph, compiled, or both.

A batch of tensors steps in some hundred operations, each of which goes through all blades in memory and has to be started. To
compile the step makes few of them, to capture it starts all that is left at once. Either repeats what was done to the same memory,
so the tensors that a step replaces have a place of their own, to which its last act is to copy what is to be there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields, is_dataclass
from functools import reduce
from typing import Any

import torch
from torch.overrides import TorchFunctionMode

from beamenv.configuration import Refused
from beamenv.envs.torch_episodes import Outcome, TorchEpisodes

_WARM_UP = 3
"""Steps before a capture, as torch advises: libraries set themselves up in the first."""

Path = tuple[str, ...]
"""Names of attributes, from the episodes on."""


class StaticStep:
    """A step of episodes whose tensors stay where they are: what moves is read from and written to the same memory.

    Actions are to be copied to ``actions``. Where something else than ``run`` moves the episodes, ``renew`` takes that up.
    """

    def __init__(self, episodes: TorchEpisodes, actions: torch.Tensor, generator: torch.Generator) -> None:
        self.actions, self._episodes, self._generator = actions.clone(), episodes, generator
        self._paths = self._moving()
        self._read = [dict(vars(owner)) for _, owner in owners(episodes)]
        """What a graph reads besides: a reset makes others, and these must not be freed."""
        self._values = [mapped(self._now(path), torch.Tensor.clone) for path in self._paths]
        self._put(self._values)

    @property
    def memory(self) -> list[torch.Tensor]:
        """The tensors that a step reads and writes to."""
        return list(leaves(tuple(self._values)))

    def _moving(self) -> list[Path]:
        """Attributes that steps or beginning episodes replace, found by some, which are then undone: tensors themselves are never
        written to.
        """
        places = [(*path, name) for path, owner in owners(self._episodes) for name in vars(owner)]
        before, drawn = [self._now(path) for path in places], self._generator.get_state()
        for _ in range(_WARM_UP):
            self._episodes.step(self.actions, self._generator)
        self._episodes.blades.begin(self._generator, torch.ones_like(self._episodes.over))
        moved = [self._now(path) is not value for path, value in zip(places, before, strict=True)]
        for path, value in zip(places, before, strict=True):
            self._set(path, value)
        self._generator.set_state(drawn)
        return [
            path for path, value, has in zip(places, before, moved, strict=True) if has and next(leaves(value), None) is not None
        ]

    def run(self) -> Outcome:
        """One step under ``actions``."""
        outcome = mapped(self._episodes.step(self.actions, self._generator), self._apart)
        self._take_up(self._apart)
        return outcome

    def renew(self) -> None:
        """Go on from where the episodes are now."""
        self._take_up(torch.Tensor.clone)

    def undone(self, act: Callable[[], Any]) -> Any:
        """What an act brings, after which all that moves is where it was."""
        before, drawn = [leaf.clone() for leaf in self.memory], self._generator.get_state()
        try:
            return act()
        finally:
            for leaf, value in zip(self.memory, before, strict=True):
                leaf.copy_(value)
            self._generator.set_state(drawn)

    def on(self, memory: Sequence[torch.Tensor], actions: torch.Tensor) -> Outcome:
        """``run`` on other tensors than its own: what a recording of it is made from."""
        own, given = (self._values, self.actions), iter(memory)
        self._values, self.actions = [mapped(value, lambda _: next(given)) for value in self._values], actions
        self._put(self._values)
        try:
            return self.run()
        finally:
            self._values, self.actions = own
            self._put(self._values)

    def _take_up(self, copied: Callable[[torch.Tensor], torch.Tensor]) -> None:
        """Write to the memory what the episodes have come to."""
        changed = [(value, self._now(path)) for value, path in zip(self._values, self._paths, strict=True)]
        pairs = [
            (into, new) for value, now in changed for into, new in zip(leaves(value), leaves(now), strict=True) if into is not new
        ]
        for (into, _), new in zip(pairs, [copied(new) for _, new in pairs], strict=True):
            into.copy_(new)
        self._put(self._values)

    def _apart(self, tensor: torch.Tensor) -> torch.Tensor:
        """The tensor, copied if it lies where a step writes to."""
        mine = tensor.untyped_storage().data_ptr()
        return tensor.clone() if any(leaf.untyped_storage().data_ptr() == mine for leaf in self.memory) else tensor

    def _put(self, values: Sequence[Any]) -> None:
        for path, value in zip(self._paths, values, strict=True):
            self._set(path, value)

    def _now(self, path: Path) -> Any:
        return reduce(getattr, path, self._episodes)

    def _set(self, path: Path, value: Any) -> None:
        setattr(reduce(getattr, path[:-1], self._episodes), path[-1], value)


class CompiledStep:
    """A ``StaticStep`` traced once, and compiled: what is drawn is handed in, for a generator draws outside."""

    def __init__(self, step: StaticStep) -> None:
        from torch._dynamo.exc import BackendCompilerFailed  # these take longer to import than torch itself
        from torch.fx.experimental.proxy_tensor import make_fx

        self._step = step
        with _Drawing() as drawing:
            self._outcome = step.undone(step.run)
        self._calls = drawing.calls

        def function(memory: list[torch.Tensor], actions: torch.Tensor, drawn: list[torch.Tensor]) -> list[torch.Tensor]:
            with _Given(drawn):
                return list(leaves(step.on(memory, actions)))

        graph = step.undone(lambda: make_fx(function)(step.memory, step.actions, self._drawn()))
        self._function: Any = torch.compile(graph, dynamic=False)
        try:
            step.undone(self.run)
        except BackendCompilerFailed as error:
            reason = str(error).partition("\n")[0]
            raise Refused("compiled", True, f"False on this machine, where torch cannot compile ({reason})") from None

    def _drawn(self) -> list[torch.Tensor]:
        return [draw() for draw in self._calls]

    def run(self, actions: torch.Tensor | None = None) -> Outcome:
        """One step under actions, or the static step's."""
        actions = self._step.actions if actions is None else actions
        told = iter(self._function(self._step.memory, actions, self._drawn()))
        return mapped(self._outcome, lambda _: next(told))


class RecordedStep:
    """A step that is compiled, captured on a GPU, or both."""

    def __init__(
        self, episodes: TorchEpisodes, actions: torch.Tensor, generator: torch.Generator, compiled: bool, captured: bool
    ) -> None:
        self._graph: torch.cuda.CUDAGraph | None = None
        if not captured:
            self._prepare(episodes, actions, generator, compiled)
            return
        stream = torch.cuda.Stream(actions.device)  # type: ignore[no-untyped-call]
        stream.wait_stream(torch.cuda.current_stream(actions.device))
        with torch.cuda.stream(stream):
            self._prepare(episodes, actions, generator, compiled)
        torch.cuda.current_stream(actions.device).wait_stream(stream)
        self._graph = torch.cuda.CUDAGraph()
        self._graph.register_generator_state(generator)
        with torch.cuda.graph(self._graph):
            self._outcome = self._run()

    def _prepare(self, episodes: TorchEpisodes, actions: torch.Tensor, generator: torch.Generator, compiled: bool) -> None:
        self._step = StaticStep(episodes, actions, generator)
        self._run: Any = CompiledStep(self._step).run if compiled else self._step.run

    def renew(self) -> None:
        """Go on from where the episodes are now."""
        self._step.renew()

    def __call__(self, actions: torch.Tensor) -> Outcome:
        """What a step brings, in tensors that later ones leave alone."""
        if self._graph is None:
            return self._run(actions)
        self._step.actions.copy_(actions)
        self._graph.replay()
        copies = {id(leaf): leaf for leaf in leaves(self._outcome)}
        copies = {name: leaf.clone() for name, leaf in copies.items()}
        return mapped(self._outcome, lambda leaf: copies[id(leaf)])


class _Drawing(TorchFunctionMode):
    """Keeps what is asked of a generator."""

    def __init__(self) -> None:
        super().__init__()
        self.calls: list[Callable[[], torch.Tensor]] = []

    def __torch_function__(self, function: Any, types: Any, args: Any = (), kwargs: Any = None) -> Any:
        told = kwargs or {}
        if told.get("generator") is not None:
            self.calls.append(lambda: function(*args, **told))
        return function(*args, **told)


class _Given(TorchFunctionMode):
    """Answers what is asked of a generator with what was drawn before."""

    def __init__(self, drawn: Sequence[torch.Tensor]) -> None:
        super().__init__()
        self._drawn = iter(drawn)

    def __torch_function__(self, function: Any, types: Any, args: Any = (), kwargs: Any = None) -> Any:
        told = kwargs or {}
        return function(*args, **told) if told.get("generator") is None else next(self._drawn)


def owners(root: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    """The object and, of what it holds, those of this package that change; with their paths."""
    yield path, root
    for name, value in list(vars(root).items()):
        if type(value).__module__.partition(".")[0] == "beamenv" and hasattr(value, "__dict__") and not is_dataclass(value):
            yield from owners(value, (*path, name))


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
