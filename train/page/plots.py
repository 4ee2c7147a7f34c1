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

Array = NDArray[np.float64]

TIP_PANELS = ("tip displacement, lag", "tip displacement, flap")


def time_series(episode: RecordedEpisode) -> go.Figure:
    """Tip displacement in lag and flap over the voltages of each controller, on one time axis."""
    tips: list[list[Curve]] = [[], []]
    for recording, look in _coloured(episode):
        for row, displacement in enumerate(recording.tip.T):
            tips[row].append(Curve(1e3 * recording.time, 1e6 * displacement, recording.name, look=look, listed=row == 0))
    panels = [Panel(title, "", "µm", curves) for title, curves in zip(TIP_PANELS, tips, strict=True)]
    low, high = (1.08 * limit for limit in episode.blade.config.voltage_limits)
    for recording in episode.controlled:
        curves = voltage_curves(1e3 * recording.time, recording.volts)
        panels.append(Panel(f"voltages, {recording.name}", "", "V", curves, y_limits=(low, high)))
    figure = _stacked(panels, "time, ms", 1e3 * float(episode.without_control.time[-1]))
    return figure.update_layout(shapes=[screen.upright(0.0, width=1)])  # the instant of the blade, which the page moves


def spectra(episode: RecordedEpisode) -> go.Figure:
    """Amplitude spectral density of the tip in lag and flap, before and after; dotted: natural frequencies of the blade."""
    modes = episode.blade.truth.natural_frequencies / (2.0 * np.pi)
    highest = 1.1 * float(modes[-1])
    tips: list[list[Curve]] = [[], []]
    for recording, look in _coloured(episode):
        name = f"{recording.name} ({'before' if recording is episode.without_control else 'after'})"
        for row, displacement in enumerate(recording.tip.T):
            frequency, density = amplitude_density(displacement, episode.blade.config.control_interval)
            shown = frequency <= highest
            tips[row].append(Curve(frequency[shown], 1e6 * density[shown], name, look=look, listed=row == 0))
    panels = [
        Panel(title, "", "µm/√Hz", curves, logarithmic=True, marked=() if row else modes.tolist(), marked_line="dotted")
        for row, (title, curves) in enumerate(zip(TIP_PANELS, tips, strict=True))
    ]
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
