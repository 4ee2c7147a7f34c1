"""Doors of identification: measurements in arrays and in files, what is asked of them."""

from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

from baselines import Measurement, identify, read_measurement
from tests.fuzz.damage import damaged
from tests.fuzz.meaning import COUNT, FLAG, MATRIX, NOTHING, NUMBER, TEXT, Kind, choice, either, instance, maybe
from tests.fuzz.oracle import Door

ROWS = 240


def _texts(value):
    if not isinstance(value, (list, tuple)):
        return NOTHING
    items = [each.item() if isinstance(each, np.ndarray) and each.ndim == 0 else each for each in value]
    return tuple(map(str, items)) if all(isinstance(each, str) for each in items) else NOTHING


TEXTS = Kind("texts", _texts, st.lists(st.sampled_from(["u1", "y1", "time", "", "a\nb", "x"]), max_size=3))


@cache
def arrays():
    rng = np.random.default_rng(0)
    volts, left = rng.standard_normal((ROWS, 1)), rng.standard_normal((ROWS, 1))
    return volts, np.convolve(volts[:, 0], 0.9 ** np.arange(20))[:ROWS, None] + 0.1 * left


@cache
def measurement():
    return Measurement(*arrays(), 0.01)


@cache
def text():
    rows = [f"{0.01 * k:.2f},{u:.4f},{y:.4f}" for k, (u, y) in enumerate(np.hstack(arrays()))]
    return "\n".join(["time [s],u1 [V],y1 [A]", *rows]) + "\n"


def read(content, **about):
    Path("mine.csv").write_bytes(content)
    try:
        return read_measurement("mine.csv", **about)
    finally:
        Path("mine.csv").unlink()


def finite(found):
    assert found.model.stable
    assert np.isfinite(found.fit.free_run).all()


DOORS = [
    Door(
        "Measurement",
        Measurement,
        {
            "voltages": MATRIX,
            "readings": MATRIX,
            "interval": NUMBER,
            "voltage_names": TEXTS,
            "reading_names": TEXTS,
            "reading_units": TEXTS,
        },
        lambda: {
            **dict(zip(("voltages", "readings"), arrays(), strict=True)),
            "interval": 0.01,
            "voltage_names": ("u",),
            "reading_names": ("y",),
            "reading_units": ("A",),
        },
        told=("measurement", "column"),
    ),
    Door(
        "identify",
        identify,
        {
            "data": either(instance(Measurement), TEXT),
            "order": either(choice("auto"), COUNT),
            "held_back": NUMBER,
            "collocated": maybe(NUMBER),
        },
        lambda: {"data": measurement(), "order": "auto", "held_back": 0.25, "collocated": 1.0},
        told=("measurement",),
        check=finite,
        plain=False,
    ),
    Door(
        "read_measurement",
        read,
        {
            "content": Kind("content", lambda value: value, damaged(text().encode())),
            "voltages": maybe(TEXTS),
            "readings": maybe(TEXTS),
            "time": maybe(TEXT),
            "interval": maybe(NUMBER),
            "before": FLAG,
        },
        lambda: {
            "content": text().encode(),
            "voltages": ["u1"],
            "readings": ["y1"],
            "time": "time",
            "interval": 0.01,
            "before": True,
        },
        told=("mine.csv",),
        junk=st.nothing(),
        plain=False,
    ),
]
