"""Figures of an identification: the stabilisation diagram above the spectra, and the fit on rows held back."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from baselines.identification.identified import Identified
from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import INK, LINES, NEUTRAL, colour
from train.figures.paper import draw_panel, handles, save, styled

Array = NDArray[np.float64]

PERIODS = 2
"""Of the slowest mode, that readings are shown over."""
SEGMENT = 4096
"""Rows of a segment, at most, over which measured spectra are averaged."""
MOST = 4
"""Readings that are drawn."""
LEAST = 1e-5
"""Loss that is drawn for the best: its logarithm has none."""


def draw_figures(found: Identified, folder: Path) -> list[Path]:
    """Write ``stabilisation.png`` and ``fit.png`` into a folder; their paths."""
    drawn = {"stabilisation.png": stabilisation_figure, "fit.png": fit_figure}
    for name, figure in drawn.items():
        save(figure(found), folder / name)
    return [folder / name for name in drawn]


def stabilisation_figure(found: Identified, theme: str = "light") -> Any:
    """Poles over the order of the model, above the spectra."""
    return _figure([stabilisation_panel(found), spectrum_panel(found)], True, theme)


def fit_figure(found: Identified, theme: str = "light") -> Any:
    """How well rows held back are met: readings, errors, orders."""
    return _figure([history_panel(found), whiteness_panel(found), order_panel(found)], False, theme)


def _figure(panels: Sequence[Panel], share_x: bool, theme: str) -> Any:
    import matplotlib.pyplot as plt

    with styled(theme):
        size = {"figsize": (7.6, 2.7 * len(panels)), "sharex": share_x, "squeeze": False, "layout": "constrained"}
        figure, axes = plt.subplots(len(panels), 1, **size)
        for axis, panel in zip(axes[:, 0], panels, strict=True):
            draw_panel(axis, panel)
            axis.legend(handles=handles([panel]), loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return figure


def stabilisation_panel(found: Identified) -> Panel:
    """Poles of the balanced models over their order, lines at the modes of the model chosen."""
    poles, highest = found.stabilisation, np.pi / found.measurement.interval
    stable = Look(colour(0), marker=Marker("circle", size=3))
    passing = Look(NEUTRAL, opacity=0.6, marker=Marker("x-thin", size=3))
    curves = [
        Curve(poles.frequency[~poles.stable], poles.order[~poles.stable], "moves", "points", passing),
        Curve(poles.frequency[poles.stable], poles.order[poles.stable], "stays (1 %, damping 5 %)", "points", stable),
    ]
    modes = tuple(found.modes.frequency.tolist())
    title = "Poles by the order of the model; lines: modes identified"
    return Panel(title, "", "states", curves, marked=modes, marked_line="dotted", whole=True, x_limits=(0.0, highest))


def spectrum_panel(found: Identified) -> Panel:
    """Power of the readings, all of unit variance together: measured, and of the model with what it takes for noise."""
    measurement, model = found.measurement, found.scaled
    rate = 1.0 / measurement.interval
    from scipy.signal import welch

    rows = min(SEGMENT, len(measurement))
    scaled = measurement.readings / measurement.readings.std(axis=0)
    hertz, measured = welch(scaled, rate, nperseg=rows, axis=0)
    volts = measurement.voltages / measurement.voltages.std(axis=0)
    _, driven = welch(model.simulated(volts - volts.mean(axis=0)), rate, nperseg=rows, axis=0)
    left = _noise_power(found, hertz) / rate * 2.0
    shown = slice(1, -1)
    omega = 2.0 * np.pi * hertz[shown]
    curves = [
        Curve(omega, measured.sum(axis=1)[shown] / (2.0 * np.pi), "measured", "solid", Look(NEUTRAL, width=2.4)),
        Curve(omega, (driven.sum(axis=1) + left)[shown] / (2.0 * np.pi), "model", "solid", Look(colour(0), width=0.7)),
        Curve(omega, left[shown] / (2.0 * np.pi), "of it loads and noise", "dashed", Look(colour(1))),
    ]
    return Panel("Spectrum of all readings, each of unit variance", "rad/s", "power, s", curves, logarithmic=True)


def _noise_power(found: Identified, hertz: Array) -> Array:
    """Tr Φ (F,) of the readings left alone, a row's variance being the mean over the circle."""
    model = found.scaled
    z = np.exp(2j * np.pi * hertz * model.interval)[:, None, None]
    shaped = np.eye(len(model.C)) + model.C @ np.linalg.solve(z * np.eye(model.order) - model.A, model.K[None])
    return np.asarray(np.einsum("fpq,qr,fpr->f", shaped, model.covariance, shaped.conj()).real)


def history_panel(found: Identified) -> Panel:
    """The reading that is fitted best, over a few periods held back: measured and in free run."""
    measurement, model, best = found.measurement, found.model, int(np.argmax(found.fit.free_run))
    rows = _window(found)
    volts = measurement.voltages - measurement.voltages.mean(axis=0)
    free = model.simulated(volts)[rows, best]
    measured = (measurement.readings - measurement.readings.mean(axis=0))[rows, best]
    time = measurement.interval * np.arange(rows.start, rows.stop)
    name, unit = measurement.reading_names[best], measurement.reading_units[best]
    curves = [
        Curve(time, measured, "measured", "solid", Look(NEUTRAL, width=1.6)),
        Curve(time, free, "free run", "solid", Look(INK)),
    ]
    return Panel("Rows held back, from the voltages alone", "s", f"{name}, {unit}" if unit else name, curves)


def _window(found: Identified) -> slice:
    slowest = found.modes.frequency[0] if len(found.modes) else float(np.abs(found.model.poles).min())
    rows = max(50, round(PERIODS * 2.0 * np.pi / slowest / found.measurement.interval))
    return slice(found.learned, min(found.learned + rows, len(found.measurement)))


def whiteness_panel(found: Identified) -> Panel:
    """Autocorrelation of one-step errors on the rows held back, with the band of what is white."""
    fit, names = found.fit, found.measurement.reading_names
    lags = np.arange(1.0, len(fit.autocorrelation))
    curves = [
        Curve(lags, fit.autocorrelation[1:, k], name, LINES[k % len(LINES)], Look(colour(k))) for k, name in enumerate(names[:MOST])
    ]
    band = Look(NEUTRAL, width=0.8)
    curves += [Curve(lags[[0, -1]], np.full(2, side * fit.band), "95 %", "dashed", band, side > 0.0) for side in (1.0, -1.0)]
    return Panel("Autocorrelation of one-step errors, rows held back", "rows", "", curves)


def order_panel(found: Identified) -> Panel:
    """How much worse rows held back are predicted than by the best, over the order."""
    orders, losses = np.array(list(found.balanced), dtype=float), np.array(list(found.balanced.values()))
    tried = np.array([[each.order, each.loss] for each in found.choice.tried])
    tried = tried[np.isfinite(tried[:, 1])]
    least, finite = min(losses.min(), tried[:, 1].min()), np.isfinite(losses)
    balanced, refined = Look(NEUTRAL, marker=Marker("circle", size=3)), Look(colour(0), marker=Marker("square", size=4))
    curves = [
        Curve(orders[finite], np.maximum(losses[finite] - least, LEAST), "balanced", "dotted", balanced),
        Curve(tried[:, 0], np.maximum(tried[:, 1] - least, LEAST), "refined", "points", refined),
    ]
    title, chosen = "Loss of likelihood a row held back; line: the order chosen", (float(found.model.order),)
    return Panel(title, "states", "", curves, logarithmic=True, marked=chosen, marked_line="dotted")
