"""Two-dimensional plots: the course of an episode, its spectra, poles, learning curves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import plotly.graph_objects as go
from numpy.typing import NDArray
from scipy.signal import periodogram

from beamenv.blade.build import build_plant
from train.figures.palette import DASHES, NEUTRAL, PALETTE
from train.page.recording import RecordedEpisode, Recording

Array = NDArray[np.float64]

LEGEND = {"orientation": "h", "x": 0.0, "y": 1.02, "xanchor": "left", "yanchor": "bottom"}
MARGIN = {"l": 62, "r": 16, "t": 16, "b": 48}
TIP_PANELS = ["tip displacement, lag", "tip displacement, flap"]
LINEAR_POLES = 10.0
"""rad/s: real parts below this are drawn to scale, larger ones in the logarithm."""


@dataclass(frozen=True, slots=True, eq=False)
class LearningCurves:
    """How agents learned, and what they are measured against."""

    curves: Mapping[str, Array]
    """(k, 3) each: training time in s, steps, running cost relative to no control, exploration included."""
    levels: Mapping[str, float] = field(default_factory=dict)
    """Relative cost of controllers that do not learn: LQG's line."""


def time_series(episode: RecordedEpisode) -> go.Figure:
    """Tip displacement in lag and flap over the voltages of each controller, on one time axis."""
    voltages = [f"voltages, {recording.name}" for recording in episode.controlled]
    figure = go.Figure(layout=_stacked([*TIP_PANELS, *voltages], ["µm", "µm", *["V"] * len(voltages)]))
    for recording, colour in _coloured(episode):
        for row, displacement in enumerate(recording.tip.T, start=1):
            figure.add_trace(_line(1e3 * recording.time, 1e6 * displacement, recording.name, colour, row=row))
    for row, recording in enumerate(episode.controlled, start=3):
        _add_voltages(figure, recording, row)
        figure.update_layout({f"yaxis{row}": {"range": [1.08 * limit for limit in episode.blade.voltage_limits]}})
    return figure.update_layout(
        xaxis={"title": {"text": "time, ms"}, "range": [0.0, 1e3 * episode.without_control.time[-1]]},
        shapes=[_upright(0.0, width=1)],
    )


def _add_voltages(figure: go.Figure, recording: Recording, row: int) -> None:
    for actuator, volts in enumerate(recording.volts.T):
        colour, dash = PALETTE[(actuator + 2) % len(PALETTE)], DASHES[actuator % len(DASHES)]
        figure.add_trace(_line(1e3 * recording.time, volts, f"actuator {actuator + 1}", colour, dash, row, shape="vh"))


def spectra(episode: RecordedEpisode) -> go.Figure:
    """Amplitude spectral density of the tip in lag and flap, before and after; dotted: natural frequencies of the blade."""
    modes = build_plant(episode.blade).natural_frequencies / (2.0 * np.pi)
    highest = 1.1 * modes[-1]
    figure = go.Figure(layout=_stacked(TIP_PANELS, ["µm/√Hz"] * 2))
    for recording, colour in _coloured(episode):
        name = f"{recording.name} ({'before' if recording is episode.without_control else 'after'})"
        for row, displacement in enumerate(recording.tip.T, start=1):
            frequency, density = amplitude_density(displacement, episode.blade.control_interval)
            shown = frequency <= highest
            figure.add_trace(_line(frequency[shown], 1e6 * density[shown], name, colour, row=row))
    logarithmic = {"type": "log", "exponentformat": "power"}
    return figure.update_layout(
        xaxis={"title": {"text": "frequency, Hz"}, "range": [0.0, highest]},
        yaxis=logarithmic,
        yaxis2=logarithmic,
        shapes=[_upright(mode, color=NEUTRAL, width=1, dash="dot") for mode in modes],
    )


def _upright(x: float, **line: Any) -> dict[str, Any]:
    """A line through all panels."""
    return {"type": "line", "x0": x, "x1": x, "y0": 0, "y1": 1, "yref": "paper", "layer": "below", "line": line}


def amplitude_density(signal: Array, interval: float) -> tuple[Array, Array]:
    """Frequencies (Hz) without 0 and the amplitude spectral density √PSD (unit/√Hz) of a signal (K,) sampled every ``interval`` s:
    one-sided periodogram of the record less its mean, under a Hann window.
    """
    frequency, power = periodogram(signal, fs=1.0 / interval, window="hann", detrend="constant")
    return frequency[1:], np.sqrt(power[1:])


def pole_map(poles: Mapping[str, NDArray[np.complex128]]) -> go.Figure:
    """Poles (rad/s, complex) of each loop in the upper half plane, real parts on an axis that is linear near 0."""
    figure = go.Figure()
    symbols = ("x-thin", "cross-thin", "square-open", "circle-open", "diamond-open", "triangle-up-open")
    for index, (name, values) in enumerate(poles.items()):
        shown = values[values.imag >= -1e-9]
        colour = NEUTRAL if index == 0 else PALETTE[(index - 1) % len(PALETTE)]
        marker = {"symbol": symbols[index % len(symbols)], "size": 9, "color": colour, "line": {"width": 2, "color": colour}}
        figure.add_scatter(
            x=symmetric_logarithm(shown.real),
            y=shown.imag,
            customdata=shown.real,
            mode="markers",
            name=name,
            marker=marker,
            cliponaxis=False,
            hovertemplate="%{customdata:.1f} + %{y:.1f} j rad/s",
        )
    ticks = np.array([-10000.0, -1000.0, -100.0, -10.0, 0.0, 10.0, 100.0, 1000.0])
    names = [f"{tick:g}".replace("-", "−") for tick in ticks]
    axis = {"title": {"text": "real part, rad/s"}, "tickvals": symmetric_logarithm(ticks), "ticktext": names, "zeroline": True}
    figure.update_layout(xaxis=axis, yaxis={"title": {"text": "imaginary part, rad/s"}, "rangemode": "tozero"})
    return figure.update_layout(legend=LEGEND, margin=MARGIN, hovermode="closest")


def symmetric_logarithm(values: Array) -> Array:
    """sign(x) log₁₀(1 + |x|/10 rad/s): close to linear about 0, where slow poles tell apart stable from unstable."""
    return np.asarray(np.sign(values) * np.log10(1.0 + np.abs(values) / LINEAR_POLES))


def learning(learned: LearningCurves) -> go.Figure:
    """Running cost of each agent over its training time, and a line for each controller that does not learn."""
    figure = go.Figure()
    for index, (name, curve) in enumerate(learned.curves.items()):
        steps = f" ({curve[-1, 1] / 1e6:.1f} million steps)" if len(curve) else ""
        figure.add_trace(_line(curve[:, 0], curve[:, 2], name + steps, PALETTE[index % len(PALETTE)]))
    end = max([1.0, *(float(curve[-1, 0]) for curve in learned.curves.values() if len(curve))])
    for index, (name, level) in enumerate(learned.levels.items()):
        colour, dash = PALETTE[(len(learned.curves) + index) % len(PALETTE)], DASHES[1 + index % (len(DASHES) - 1)]
        figure.add_trace(_line(np.array([0.0, end]), np.full(2, level), f"{name}: {level:.3f}", colour, dash))
    highest = max([1.05, *(float(np.nanmedian(curve[:3, 2])) for curve in learned.curves.values() if len(curve))])
    return figure.update_layout(
        xaxis={"title": {"text": "training time, s"}, "range": [0.0, end]},
        yaxis={"title": {"text": "J / J without control"}, "range": [0.0, min(highest, 2.0)]},
        legend=LEGEND,
        margin=MARGIN,
        hovermode="x",
    )


def _coloured(episode: RecordedEpisode) -> list[tuple[Recording, str]]:
    """Each recording with its colour, grey without control."""
    return list(zip(episode.recordings, (NEUTRAL, *PALETTE), strict=False))


def _line(x: Array, y: Array, name: str, colour: str, dash: str = "solid", row: int = 1, shape: str = "linear") -> dict[str, Any]:
    """A trace in a row of panels; one name has one entry in the legend. Single precision is finer than any screen."""
    return {
        "type": "scatter",
        "mode": "lines",
        "x": x.astype(np.float32),
        "y": y.astype(np.float32),
        "yaxis": f"y{row if row > 1 else ''}",
        "name": name,
        "legendgroup": name,
        "showlegend": row in (1, 3),
        "line": {"color": colour, "dash": dash, "width": 1.4, "shape": shape},
    }


def _stacked(titles: list[str], units: list[str]) -> dict[str, Any]:
    """Panels over one another that share one x axis, so that they zoom and are read off together."""
    names = [f"y{row if row > 1 else ''}" for row in range(1, len(titles) + 1)]
    above = {"xref": "paper", "x": 0.0, "xanchor": "left", "y": 1.0, "yanchor": "bottom", "showarrow": False}
    return {
        "grid": {"rows": len(titles), "columns": 1, "subplots": [[f"x{name}"] for name in names], "ygap": 0.2},
        "annotations": [{**above, "text": title, "yref": f"{name} domain"} for title, name in zip(titles, names, strict=True)],
        "xaxis": {"showspikes": True, "spikemode": "across", "spikesnap": "cursor"},
        **{f"yaxis{name[1:]}": {"title": {"text": unit}} for name, unit in zip(names, units, strict=True)},
        "legend": {**LEGEND, "y": 1.05},
        "margin": MARGIN,
        "hovermode": "x unified",
    }
