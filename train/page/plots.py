"""Two-dimensional plots of an episode: its course and its spectra, of every recording, of which the page shows some."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray
from scipy.signal import periodogram

from train.figures import screen
from train.figures.figure import Curve, Look, Panel
from train.figures.palette import NEUTRAL, PALETTE
from train.figures.panels import voltage_curves
from train.page.recording import RecordedEpisode, Recording
from train.page.signals import Drawn, drawn_signals

Array = NDArray[np.float64]

ALWAYS = -1
"""In place of a recording, of a panel that is there whichever are shown."""
COLOURS = (NEUTRAL, PALETTE[0], PALETTE[1])
"""Without control, and of the two that are shown; the second is dashed besides."""


def time_series(episode: RecordedEpisode) -> go.Figure:
    """The signals of ``drawn_signals`` over the voltages of each controller, on one time axis.

    ``meta`` of its layout says what the page's script needs to show some recordings alone: of each panel whose it is.
    """
    panels = []
    for row, signal in enumerate(drawn_signals(episode)):
        curves = [
            Curve(1e3 * recording.time, values, recording.name, look=look, listed=row == 0)
            for values, (recording, look) in zip(signal.series, _coloured(episode), strict=True)
        ]
        panels.append(Panel(signal.title, "", signal.unit, curves))
    signals = len(panels)
    low, high = (1.08 * limit for limit in episode.blade.config.voltage_limits)
    controlled = range(1, len(episode.recordings))
    for recording in episode.recordings[1:]:
        curves = voltage_curves(1e3 * recording.time, recording.volts)
        panels.append(Panel(f"voltages, {recording.name}", "", "V", curves, y_limits=(low, high)))
    figure = _stacked(panels, [*[ALWAYS] * signals, *controlled], "time, ms", 1e3 * float(episode.time[-1]))
    figure.update_layout(yaxis_title_standoff=4)
    if not episode.has_shape:
        return figure
    return figure.update_layout(shapes=[screen.upright(0.0, width=1)])  # the instant of the blade, which the page moves


def spectra(episode: RecordedEpisode) -> go.Figure:
    """Amplitude spectral density of the same signals; dotted: natural frequencies."""
    modes = episode.blade.truth.natural_frequencies / (2.0 * np.pi)
    highest, panels = 1.1 * float(modes[-1]), []
    for row, signal in enumerate(drawn_signals(episode)):
        curves = _densities(episode, signal, highest, listed=row == 0)
        unit, marked = f"{signal.unit or '1'}/√Hz", () if row else modes.tolist()
        panels.append(Panel(signal.title, "", unit, curves, logarithmic=True, marked=marked, marked_line="dotted"))
    return _stacked(panels, [ALWAYS] * len(panels), "frequency, Hz", highest)


def _densities(episode: RecordedEpisode, signal: Drawn, highest: float, listed: bool) -> list[Curve]:
    """Up to ``highest`` (Hz)."""
    curves = []
    for values, (recording, look) in zip(signal.series, _coloured(episode), strict=True):
        frequency, density = amplitude_density(values, episode.blade.config.control_interval)
        shown = frequency <= highest
        curves.append(Curve(frequency[shown], density[shown], recording.name, look=look, listed=listed))
    return curves


def amplitude_density(signal: Array, interval: float) -> tuple[Array, Array]:
    """Frequencies (Hz) without 0 and the amplitude spectral density √PSD (unit/√Hz) of a signal (K,) sampled every ``interval`` s:
    one-sided periodogram of the record less its mean, under a Hann window.
    """
    frequency, power = periodogram(signal, fs=1.0 / interval, window="hann", detrend="constant")
    return frequency[1:], np.sqrt(power[1:])


def _coloured(episode: RecordedEpisode) -> list[tuple[Recording, Look]]:
    """Each recording with its colour, grey without control; the page's script gives those that it shows theirs."""
    colours = [NEUTRAL, *(PALETTE[place % len(PALETTE)] for place in range(len(episode.recordings) - 1))]
    return [(recording, Look(colour)) for recording, colour in zip(episode.recordings, colours, strict=True)]


def _stacked(panels: Sequence[Panel], whose: Sequence[int], along: str, end: float) -> go.Figure:
    """Panels over one another whose x axis ends at ``end``, read off together under one upright line. ``whose``: the recording of
    each panel, ``ALWAYS`` for one of all of them, curve by curve.
    """
    drawn = screen.figure(panels)
    places = [range(len(panel.curves)) for panel in panels]
    owners = [place if row == ALWAYS else row for curves, row in zip(places, whose, strict=True) for place in curves]
    for trace, owner in zip(drawn["data"], owners, strict=True):
        trace["meta"] = {"recording": owner}
        _evenly(trace)
    figure = go.Figure(drawn)
    spikes = {"showspikes": True, "spikemode": "across", "spikesnap": "cursor"}
    axis = {"title": {"text": along}, "range": [0.0, end], **spikes}
    meta = {"whose": list(whose), "colours": COLOURS}
    return figure.update_layout(xaxis=axis, legend={"y": 1.05}, hovermode="x unified", meta=meta)


def _evenly(trace: dict[str, Any]) -> None:
    """Abscissae at even intervals by their first and their distance."""
    x = np.asarray(trace["x"], dtype=np.float64)
    if len(x) > 1:
        del trace["x"]
        trace |= {"x0": float(x[0]), "dx": float(x[-1] - x[0]) / (len(x) - 1)}
