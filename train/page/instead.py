"""What figures show, in words, for those who cannot see them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.figures.panels import LearningCurves
from train.page.plots import amplitude_density
from train.page.recording import RecordedEpisode
from train.page.signals import drawn_signals

HEAT_MAP = "Every number is in the tables."


def of_course(episode: RecordedEpisode) -> str:
    """The largest value of each signal and the largest voltage, controller by controller."""
    signals, found = drawn_signals(episode), []
    for place, recording in enumerate(episode.recordings):
        largest = [f"{each.title} {np.abs(each.series[place]).max():.3g} {each.unit}".rstrip() for each in signals]
        found.append(f"{recording.name}: {', '.join(largest)}, voltage {np.abs(recording.volts).max():.0f} V")
    return f"Largest values. {'; '.join(found)}."


def of_spectra(episode: RecordedEpisode) -> str:
    """Where the density of each signal is highest, controller by controller."""
    signals, found = drawn_signals(episode), []
    for place, recording in enumerate(episode.recordings):
        peaks = []
        for each in signals:
            frequency, density = amplitude_density(each.series[place], episode.blade.config.control_interval)
            peaks.append(f"{each.title} {density.max():.3g} {each.unit or '1'}/√Hz at {frequency[density.argmax()]:.0f} Hz")
        found.append(f"{recording.name}: {', '.join(peaks)}")
    return f"Highest peaks. {'; '.join(found)}."


def of_poles(poles: Mapping[str, NDArray[Any]]) -> str:
    """The largest real part of each loop, which tells whether it is stable."""
    found = [f"{name} {values.real.max():.3g} rad/s".replace("-", "−") for name, values in poles.items()]
    return f"Largest real parts, below 0 for a stable loop: {'; '.join(found)}."


def of_learning(learned: LearningCurves) -> str:
    """Where each curve ends, and the levels."""
    ends = [f"{name} {curve[-1, 2]:.3f} after {curve[-1, 0]:.0f} s" for name, curve in learned.curves.items() if len(curve)]
    levels = [f"{name} {level:.3f}" for name, level in learned.levels.items()]
    return f"J over J without control in the end: {'; '.join([*ends, *levels])}."
