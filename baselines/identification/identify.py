"""From a measurement to a model: OKID and ERA to begin with, prediction error to refine, rows held back to choose the order by.

``control.eigensys_realization`` on the Markov parameters that ``control.markov`` estimates is no way at 1 % damping: these are
thousands a channel, and each as noisy as the readings. On those of an observer that forgets (``observer``) it finds all modes
that can be seen, within a tenth of a per cent of their frequencies and a tenth of their damping, and, of low order, with poles
that are none. Prediction error (``prediction_error``) halves the errors and tells how large they are; ``order`` takes the false
poles away.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from baselines.identification.files import read_measurement
from baselines.identification.fit import fit_of
from baselines.identification.identified import Identified
from baselines.identification.measurement import Measurement
from baselines.identification.observer import observer
from baselines.identification.order import first_order, pruned, settled
from baselines.identification.prediction_error import Spectra, refined
from baselines.identification.realisation import realise
from baselines.identification.white_noise import white_noise
from beamenv.configuration import Count, Instance, Number, Refused, checked

MOST_STATES = 60
SHARE = 0.25
"""Of the rows, held back."""

EXPLAINED = 0.05
"""Of the variance of a reading on the rows held back: below it its voltages might as well be those of another measurement."""

Progress = Callable[[str, float], None]
"""Is told what is being done and which share of the whole is done."""


def identify(
    data: Measurement | str | os.PathLike[str],
    order: int | Literal["auto"] = "auto",
    *,
    held_back: float = SHARE,
    collocated: float | None = None,
    progress: Progress | None = None,
) -> Identified:
    """Identify a model from a measurement, or from the CSV file that holds one (``read_measurement``).

    - ``order``: its number of states; with "auto" it is chosen by how well the rows held back are predicted.
    - ``held_back``: share of the rows, at the end, that is held back to judge the model; from 0.05 to 0.5.
    - ``collocated``: for piezoelectric sensors of current (A), one at the place of each actuator: the ratio of the sensor's charge
      per strain to the actuator's moment per volt, 1 if both are the same patch. With it the energy of modes is known, in joules.
    - ``progress``: called with what is being done and how much of it is done.

    Raises ``ValueError`` for another order or share, for a measurement that is too short, for one whose voltages explain nothing
    of its readings, and as ``Measurement`` and ``read_measurement`` do.
    """
    measurement = data if isinstance(data, Measurement) else read_measurement(data)
    wanted = None if isinstance(order, str) and order == "auto" else _checked_order(order)
    held_back = checked("held_back", held_back, Number(ge=0.05, le=0.5))
    told = progress or (lambda what, done: None)
    scaled = _scaled(checked("data", measurement, Instance(Measurement)))
    learned = len(scaled) - round(held_back * len(scaled))
    learning = scaled.first(learned)
    _check_collocated(collocated, measurement)
    told("observer", 0.0)
    realisation = realise(observer(learning), scaled.interval, MOST_STATES)
    candidates = range(2, len(realisation.A) + 1, 2)
    least, balanced = first_order(realisation, scaled, learned, candidates)
    begun = max(least, wanted or 0) if wanted is None or wanted <= len(realisation.A) else len(realisation.A)
    spectra = Spectra(learning)
    told(f"{begun} states", 0.1)
    first = refined(spectra, realisation.model(begun), progress=lambda done: told(f"{begun} states", 0.1 + 0.3 * done))
    choice = pruned(first, spectra, scaled, learned, wanted, lambda what, done: told(what, 0.4 + 0.4 * done))
    told(f"{choice.refined.model.order} states", 0.9)
    choice = settled(choice, spectra, scaled, learned)
    model = choice.refined.model
    told("noise", 0.95)
    whole = Identified(
        measurement=measurement,
        learned=learned,
        choice=choice,
        noise=white_noise(model, learned),
        balanced=balanced,
        stabilisation=realisation.stabilisation(),
        fit=fit_of(model, scaled, learned),
        collocated=collocated,
    )
    _check_explained(whole)
    told("done", 1.0)
    return whole


def _check_explained(found: Identified) -> None:
    """``ValueError`` where a free run of the model tells next to nothing of the rows held back."""
    explained = float((1.0 - (1.0 - found.fit.free_run.clip(0.0)) ** 2).max())
    if explained < EXPLAINED:
        raise ValueError(
            f"nothing could be identified: voltages explain {100.0 * explained:.2g} % of the variance of any reading on the rows "
            f"held back, but must explain {100.0 * EXPLAINED:g} %; are these the columns, and were the voltages large enough?"
        )


def _checked_order(order: object) -> int:
    try:
        return checked("order", order, Count(2, MOST_STATES))
    except ValueError:
        raise Refused("order", order, f"'auto' or a count of states from 2 to {MOST_STATES}") from None


def _scaled(measurement: Measurement) -> Measurement:
    """Without means, each column over its standard deviation."""
    columns = {name: getattr(measurement, name) for name in ("voltages", "readings")}
    return replace(measurement, **{name: (each - each.mean(axis=0)) / each.std(axis=0) for name, each in columns.items()})


def _check_collocated(collocated: float | None, measurement: Measurement) -> None:
    if collocated is None:
        return
    checked("collocated", collocated, Number(gt=0.0))
    m, p = measurement.voltages.shape[1], measurement.readings.shape[1]
    if m != p:
        raise ValueError(
            f"collocated = {collocated!r} needs a sensor for each actuator, but there are {p} sensors and {m} actuators."
        )
    if set(measurement.reading_units) - {"A", ""}:
        raise Refused("collocated", collocated, f"None with sensors in {', '.join(sorted(set(measurement.reading_units)))}, not A")
