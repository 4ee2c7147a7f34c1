"""What the page's script shows of an episode, and lets readers choose."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from train.page.blade import drawn_blade, frame_times
from train.page.recording import RecordedEpisode, Recording


@dataclass(frozen=True, slots=True)
class Scale:
    """What colours mean."""

    title: str
    colours: str
    """As CSS has gradients."""
    low: str
    high: str


@dataclass(frozen=True, slots=True, eq=False)
class Shown:
    """One blade beside the other."""

    recordings: tuple[tuple[str, str], ...]
    """Of each one its name, and its J in the episode."""
    opens: int
    """Place of the one that is shown first beside no control."""
    times: tuple[float, ...]
    """ms, of the frames."""
    blade: dict[str, Any] | None
    """What it is drawn from; None of a model, which has no shape."""
    scales: tuple[Scale, ...]


def shown(episode: RecordedEpisode) -> Shown:
    """The episode as the page's script takes it."""
    blade = drawn_blade(episode) if episode.has_shape else None
    scales = () if blade is None else _scales(blade, episode)
    times = tuple(round(1e3 * float(time), 3) for time in frame_times(episode))
    named = tuple((recording.name, cost_in_words(recording, episode.without_control)) for recording in episode.recordings)
    return Shown(named, episode.opens, times, blade, scales)


def cost_in_words(recording: Recording, without: Recording) -> str:
    """J over that without control, J₀, in the very episode."""
    if not np.isfinite(recording.cost):
        return "the blade fails"
    return f"{recording.cost / without.cost:.3f} J₀" if np.isfinite(without.cost) else "the blade is saved"


def _scales(blade: dict[str, Any], episode: RecordedEpisode) -> tuple[Scale, ...]:
    limit = f"{blade['limit']:.4g}"
    voltage = Scale("actuator voltage, V", _gradient(blade["scales"]["voltage"]), f"−{limit}", limit)
    if not any(recording.readings.size for recording in episode.recordings):
        return (voltage,)
    return voltage, Scale("sensor output, full scale", _gradient(blade["scales"]["output"]), "−1", "1")


def _gradient(colours: list[list[int]]) -> str:
    return f"linear-gradient(to right, {', '.join(f'rgb({red} {green} {blue})' for red, green, blue in colours)})"
