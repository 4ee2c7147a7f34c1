"""Scenarios as TOML files: their names are those of the files. A file takes part in the benchmark unless it is listed here."""

from importlib.resources import files

NAMES: tuple[str, ...] = tuple(
    sorted(entry.name.removesuffix(".toml") for entry in files(__name__).iterdir() if entry.name.endswith(".toml"))
)

OPEN: tuple[str, ...] = ("drift", "gust-speed", "mid-failure", "unknown-everything")
"""Those in which the blade changes within the episode, or everything is wrong at once: agents and rules may learn on them."""

SOLIDS = ("solid", "solid-20")
"""Of the benchmark, and unseen too."""

UNSEEN: tuple[str, ...] = (
    *("biased-sensor", "delay-failure", "delay-off-model", "hysteresis-rotor", "long-delay", "off-speed-failure"),
    *("two-dead-actuators", *SOLIDS),
)
"""Those kept for judging, no agent trained and no rule tuned on them: pairs of the benchmark's faults, faults beyond its range."""

BENCHMARK: tuple[str, ...] = tuple(name for name in NAMES if name not in OPEN and (name not in UNSEEN or name in SOLIDS))
"""Those of the benchmark's table."""
