"""Scenarios as TOML files: their names are those of the files. A file takes part in the benchmark unless it is listed here."""

from collections.abc import Iterable, Mapping
from importlib.resources import files
from itertools import takewhile
from types import MappingProxyType

NOMINAL = "nominal"
"""The scenario that is meant where none is given."""

LOADS: Mapping[str, str] = MappingProxyType(
    {
        "step": "Every episode has a load that sets in and stays.",
        "pulse": "Every episode has a rectangular pulse.",
        "deflection": "Every episode starts at rest in a static deflection, which is released at t = 0.",
        "harmonic": "Every episode has a sinusoidal load.",
        "white": "White loads and sensor noise alone: what LQG is designed for.",
        "quiet": "Nothing at all: no load and no noise.",
    }
)
"""What those without a file are, which no benchmark and no environment id is of."""

FORMER: Mapping[str, str] = MappingProxyType({"default": NOMINAL})
"""Names that scenarios once had, and that still mean them."""

NAMES: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(".toml") for entry in files(__name__).iterdir() if entry.name.endswith(".toml"))
)

OPEN: tuple[str, ...] = ("drift", "gust-speed", "mid-failure", "unknown-everything")
"""Those in which the blade changes within the episode, or everything is wrong at once: agents and rules may learn on them."""

SOLIDS = ("solid", "solid-20")
"""Of the benchmark, and unseen too."""

UNSEEN: tuple[str, ...] = (
    *("biased-sensor", "delay-failure", "delay-off-model", "heat", "hysteresis-rotor", "long-delay", "off-speed-failure"),
    *("two-dead-actuators", *SOLIDS),
)
"""Those kept for judging, no agent trained and no rule tuned on them: pairs of the benchmark's faults, faults beyond its range, and
heat."""

BENCHMARK: tuple[str, ...] = tuple(name for name in NAMES if name not in OPEN and (name not in UNSEEN or name in SOLIDS))
"""Those of the benchmark's table."""

GROUPS: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {"benchmark": BENCHMARK, "open": OPEN, "unseen": UNSEEN, "all": tuple(dict.fromkeys((*BENCHMARK, *OPEN, *UNSEEN)))}
)
"""Words that stand for several, where several are asked for. No file here has such a name; one elsewhere is told by its ending."""


def expanded(names: Iterable[str]) -> tuple[str, ...]:
    """Names and files, and of groups their scenarios, each once and by its own name."""
    return tuple(dict.fromkeys(name for each in names for name in GROUPS.get(each, (FORMER.get(each, each),))))


def titles() -> dict[str, str]:
    """What every scenario is, in a line: the comment that its file opens with. ``NOMINAL`` first, those without a file next."""
    texts = {name: files(__name__).joinpath(f"{name}.toml").read_text(encoding="utf-8") for name in NAMES}
    told = {name: opening(text) for name, text in texts.items()}
    return {NOMINAL: told[NOMINAL], **LOADS, **told}


def opening(text: str) -> str:
    """The comment that a TOML file opens with."""
    return " ".join(line.lstrip("#").strip() for line in takewhile(lambda line: line.startswith("#"), text.splitlines()))
