"""What must hold whatever is given: a sentence or the meaning that was given; nothing changed; soon."""

import inspect
import os
import random
import signal
import sys
import time
import types
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path, PurePath
from typing import Any

import gymnasium as gym
import numpy as np
import stable_baselines3  # noqa: F401 - it and torch set themselves up when they are first imported
import torch
import torch.utils.tensorboard

from beamenv.blade.presets import PRESETS
from beamenv.configuration import Refused
from beamenv.scenarios.scenario import SCENARIOS
from tests.fuzz.meaning import NOTHING, Kind
from tests.fuzz.wrong import JUNK, copied

SECONDS = 10.0
"""Of the processor, for one example."""
LONGEST = 1000
"""Characters of a sentence."""


@dataclass(frozen=True)
class Door:
    """A way into the house: what it takes, right arguments, and how what comes out tells what was meant."""

    name: str
    call: Callable[..., Any]
    kinds: Mapping[str, Kind]
    valid: Callable[[], dict[str, Any]]
    """Right arguments, objects among them shared between examples."""
    read: Callable[[Any], Any] | None = None
    """From what the door gives to a table that holds the arguments by their names; None where it gives none."""
    told: tuple[str, ...] = ()
    """Words of sentences about what the arguments are together, in place of one of their names."""
    junk: Any = JUNK
    public: str = ""
    """The public name that it is a door of."""
    check: Callable[[Any], None] | None = None
    """What is besides to hold of what it gives."""
    plain: bool = True
    """Whether the call with the plain meaning is made too, and gives the same."""


@dataclass(frozen=True)
class Outcome:
    """refused, accepted, or a fault."""

    kind: str
    what: str = ""


def examined(door, given, paths) -> Outcome:
    """What becomes of one example."""
    before, world, begun = seen(given), around(), time.process_time()
    error, result = None, None
    try:
        with alarm(door.name):
            result = door.call(**given)
    except (Exception, SystemExit) as raised:
        error = raised
    spent = time.process_time() - begun
    if spent > SECONDS:
        return Outcome("fault", f"took {spent:.1f} s")
    for what, then, now in (("arguments", before, seen(given)), ("world", world, around())):
        if not same(then, now):
            return Outcome("fault", f"changed the {what}: {difference(then, now)}")
    if error is not None:
        return refusal(error, (*(str(name).lstrip("-") for path in paths for name in path), *door.told))
    return acceptance(door, given, result)


def refusal(error, words) -> Outcome:
    """A ``ValueError`` of one sentence that names what is wrong."""
    text = str(error)
    where = traced(error)
    if type(error) not in (ValueError, Refused):
        return Outcome("fault", f"{type(error).__name__}: {text[:200]} {where}")
    if "\n" in text or len(text) > LONGEST or not text.endswith("."):
        return Outcome("fault", f"no sentence: {text[:300]!r} {where}")
    if not any(word.casefold() in text.casefold() for word in words if word):
        return Outcome("fault", f"names none of {', '.join(words)}: {text[:200]!r} {where}")
    return Outcome("refused", text)


def acceptance(door, given, result) -> Outcome:
    """The meaning that was given, and no other."""
    meant = {name: door.kinds[name].means(value) for name, value in given.items() if name in door.kinds}
    for name, value in meant.items():
        if value is NOTHING:
            return Outcome("fault", f"accepted {name} = {shown(given[name])}")
    if door.read is not None and (wrong := disagreement(door.read(result), meant)):
        return Outcome("fault", f"another meaning: {wrong}")
    if door.check is not None:
        try:
            door.check(result)
        except Exception as error:
            return Outcome("fault", f"accepted what is then wrong: {type(error).__name__}: {str(error)[:200]}")
    if door.plain and not same(seen(given), seen(meant)):
        try:
            again = door.call(**{**given, **copied(meant)})
        except Exception as error:
            return Outcome("fault", f"accepted what is refused plainly: {type(error).__name__}: {str(error)[:200]}")
        if not same(seen(result), seen(again)):
            return Outcome("fault", f"another result than that of the plain values {shown(meant)}")
    return Outcome("accepted")


def disagreement(found, meant, path="") -> str:
    """Where what came out is not what was meant; empty if nowhere."""
    if isinstance(meant, dict):
        for name, value in meant.items():
            there = found.get(name, NOTHING) if isinstance(found, Mapping) else getattr(found, name, NOTHING)
            if there is not NOTHING and (wrong := disagreement(there, value, f"{path}.{name}")):
                return wrong
        return ""
    if meant is None:  # a default, which the door chooses
        return ""
    return "" if same(seen(found), seen(meant), exact=False) else f"{path[1:]} is {shown(found)}, not {shown(meant)}"


def seen(value, depth=0) -> Any:
    """A value as it is now, bit by bit, for a comparison later."""
    if isinstance(value, np.ndarray):
        content = tuple(seen(each, depth + 1) for each in value.ravel()) if value.dtype == object else value.tobytes()
        return "array", value.shape, value.dtype.str, value.flags.writeable, content
    if isinstance(value, Mapping):
        return "table", tuple((seen(name, depth + 1), seen(each, depth + 1)) for name, each in value.items())
    if isinstance(value, (list, tuple)):
        return type(value).__name__, tuple(seen(each, depth + 1) for each in value)
    if isinstance(value, types.GeneratorType):
        return "generator", inspect.getgeneratorstate(value)
    if is_dataclass(value) and not isinstance(value, type):
        return type(value), tuple(
            (each.name, seen(getattr(value, each.name, None), depth + 1)) for each in fields(value) if each.compare or each.init
        )
    if isinstance(value, (PurePath, slice)):
        return "text", str(value)
    if isinstance(value, (bytearray, memoryview)):
        return type(value), bytes(value)
    if isinstance(value, (int, float, complex, str, bytes, np.generic, type(None))):
        return type(value), repr(value)
    if isinstance(value, (set, frozenset)):
        return type(value), frozenset(map(repr, value))
    return type(value), id(value)


def same(one, other, exact=True) -> bool:
    """Whether two things seen are the same; not exactly: a list as a tuple, a number as its array."""
    if exact:
        return bool(one == other)
    return bool(_loosely(one) == _loosely(other))


def _loosely(part):
    if isinstance(part, tuple) and part and part[0] in ("list", "tuple"):
        return "sequence", tuple(map(_loosely, part[1]))
    if isinstance(part, tuple) and part and part[0] == "array":
        return part[:3] + part[4:]
    if isinstance(part, tuple) and len(part) == 2 and part[0] in (int, float):
        return "number", float(part[1])
    return tuple(map(_loosely, part)) if isinstance(part, tuple) else part


def difference(one, other) -> str:
    """The first part in which two things seen differ."""
    if isinstance(one, tuple) and isinstance(other, tuple) and len(one) == len(other):
        return next((difference(a, b) for a, b in zip(one, other, strict=True) if a != b), "")
    return f"{shown(one)} became {shown(other)}"


def around() -> tuple[Any, ...]:
    """What no call has any business to change."""
    return (
        ("registry", tuple(gym.registry)),
        ("scenarios", tuple(SCENARIOS.items())),
        ("presets", tuple(PRESETS.items())),
        ("numpy's chance", np.random.get_state()[1].tobytes()),  # noqa: NPY002 - the global state is what it is about
        ("chance", hash(random.getstate())),
        ("torch's chance", torch.get_rng_state().numpy().tobytes()),
        ("torch's threads", torch.get_num_threads()),
        ("torch's type", str(torch.get_default_dtype())),
        ("floating point", tuple(np.geterr().items())),
        ("warnings", len(warnings.filters)),
        ("folder", os.getcwd()),
        ("files", tuple(sorted(str(path) for path in Path.cwd().rglob("*")))),
        ("environment", tuple(os.environ.items())),
        ("signals", tuple(signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM))),
        ("output", (id(sys.stdout), id(sys.stderr))),
    )


@dataclass
class alarm:
    """Ends what hangs."""

    name: str
    seconds: int = 120
    before: Any = field(default=None)

    def __enter__(self):
        self.before = signal.signal(signal.SIGALRM, self.ring)
        signal.alarm(self.seconds)

    def __exit__(self, *_):
        signal.alarm(0)
        signal.signal(signal.SIGALRM, self.before)

    def ring(self, number, frame):
        raise TimeoutError(f"{self.name} hangs")


def traced(error) -> str:
    """Where in the house it was raised."""
    where, trace = "", error.__traceback__
    while trace is not None:
        file = trace.tb_frame.f_code.co_filename
        if any(f"/{wing}/" in file for wing in ("beamenv", "baselines", "train")):
            where = f"[{'/'.join(Path(file).parts[-2:])}:{trace.tb_lineno}]"
        trace = trace.tb_next
    return where


def shown(value) -> str:
    try:
        return repr(value)[:200]
    except Exception:  # whatever its own repr raises
        return f"an object of type {type(value).__name__}"
