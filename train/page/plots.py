"""Two-dimensional plots of an episode: its course and its spectra."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray
from scipy.signal import periodogram

from train.figures import screen
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import NEUTRAL, PALETTE
from train.figures.panels import voltage_curves
from train.page.recording import RecordedEpisode, Recording
from train.page.signals import drawn_signals

Array = NDArray[np.float64]


def time_series(episode: RecordedEpisode) -> go.Figure:
    """The signals of ``drawn_signals`` over the voltages of each controller, on one time axis."""
    panels = []
    for row, signal in enumerate(drawn_signals(episode)):
        curves = [
            Curve(1e3 * recording.time, values, recording.name, look=look, listed=row == 0)
            for values, (recording, look) in zip(signal.series, _coloured(episode), strict=True)
        ]
        panels.append(Panel(signal.title, "", signal.unit, curves))
    low, high = (1.08 * limit for limit in episode.blade.config.voltage_limits)
    for recording in episode.controlled:
        curves = voltage_curves(1e3 * recording.time, recording.volts)
        panels.append(Panel(f"voltages, {recording.name}", "", "V", curves, y_limits=(low, high)))
    figure = _stacked(panels, "time, ms", 1e3 * float(episode.without_control.time[-1]))
    if not episode.has_shape:
        return figure
    return figure.update_layout(shapes=[screen.upright(0.0, width=1)])  # the instant of the blade, which the page moves


def spectra(episode: RecordedEpisode) -> go.Figure:
    """Amplitude spectral density of the same signals, before and after; dotted: natural frequencies."""
    modes = episode.blade.truth.natural_frequencies / (2.0 * np.pi)
    highest, panels = 1.1 * float(modes[-1]), []
    for row, signal in enumerate(drawn_signals(episode)):
        curves = []
        for values, (recording, look) in zip(signal.series, _coloured(episode), strict=True):
            name = f"{recording.name} ({'before' if recording is episode.without_control else 'after'})"
            frequency, density = amplitude_density(values, episode.blade.config.control_interval)
            shown = frequency <= highest
            curves.append(Curve(frequency[shown], density[shown], name, look=look, listed=row == 0))
        unit, marked = f"{signal.unit or '1'}/√Hz", () if row else modes.tolist()
        panels.append(Panel(signal.title, "", unit, curves, logarithmic=True, marked=marked, marked_line="dotted"))
    return _stacked(panels, "frequency, Hz", highest)


def amplitude_density(signal: Array, interval: float) -> tuple[Array, Array]:
    """Frequencies (Hz) without 0 and the amplitude spectral density √PSD (unit/√Hz) of a signal (K,) sampled every ``interval`` s:
    one-sided periodogram of the record less its mean, under a Hann window.
    """
    frequency, power = periodogram(signal, fs=1.0 / interval, window="hann", detrend="constant")
    return frequency[1:], np.sqrt(power[1:])


def _coloured(episode: RecordedEpisode) -> list[tuple[Recording, Look]]:
    """Each recording with its colour, grey without control."""
    return [(recording, Look(colour)) for recording, colour in zip(episode.recordings, (NEUTRAL, *PALETTE), strict=False)]


def _stacked(panels: Sequence[Panel], along: str, end: float) -> go.Figure:
    """Panels over one another whose x axis ends at ``end``, read off together under one upright line."""
    figure = go.Figure(screen.figure(panels))
    spikes = {"showspikes": True, "spikemode": "across", "spikesnap": "cursor"}
    axis = {"title": {"text": along}, "range": [0.0, end], **spikes}
    return figure.update_layout(xaxis=axis, legend={"y": 1.05}, hovermode="x unified")
