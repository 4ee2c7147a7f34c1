"""Doors of models of one's own: their matrices and what is said of them, and the files that hold them."""

import io
import json
from functools import cache
from pathlib import Path

import control
import numpy as np
from hypothesis import strategies as st
from scipy.io import savemat

from beamenv.plant.plant import Plant
from tests.fuzz.damage import damaged
from tests.fuzz.meaning import ANYTHING, MATRIX, NUMBER, Kind
from tests.fuzz.oracle import Door

MODEL = {"A": [[0.0, 30.0], [-30.0, -0.6]], "B": [[0.0], [1.0]], "C": [[0.0, 1.0]], "D": [[0.0]]}
ARRAYS = (
    *("energy", "output_weight", "input_weight", "disturbance_input", "reference_load", "process_noise", "state_noise"),
    *("sensor_noise", "full_scale", "actuator_limits", "tip_displacement"),
)
WORDS = ("sensor_names", "sensor_units")
SYSTEMS = {"small": control.ss(*MODEL.values())}


def valid():
    about = dict.fromkeys(ARRAYS, 0.01)
    matrices = {
        "energy": np.eye(2),
        "state_noise": 1e-6 * np.eye(2),
        "disturbance_input": [[0.0], [1.0]],
        "tip_displacement": [[1.0, 0.0]],
    }
    return {**MODEL, **about, **matrices, "actuator_limits": 5.0, "dt": None, "interval": 0.01, **dict.fromkeys(WORDS, ["m/s"])}


@cache
def contents(ending):
    if ending == ".json":
        return json.dumps(MODEL).encode()
    file = io.BytesIO()
    arrays = {name: np.array(value) for name, value in MODEL.items()}
    np.savez(file, **arrays) if ending == ".npz" else savemat(file, arrays)
    return file.getvalue()


def read(content, ending):
    Path(f"model{ending}").write_bytes(content)
    try:
        return Plant.from_file(f"model{ending}")
    finally:
        Path(f"model{ending}").unlink()


def of_file(ending):
    kind = Kind("content", lambda value: value, st.deferred(lambda: damaged(contents(ending))))
    return Door(
        f"model file{ending}",
        lambda content: read(content, ending),
        {"content": kind},
        lambda: {"content": contents(ending)},
        told=("file",),
        junk=st.deferred(lambda: damaged(contents(ending))),
        plain=False,
    )


DOORS = [
    Door(
        "Plant.from_state_space",
        Plant.from_state_space,
        {
            **dict.fromkeys(MODEL, MATRIX),
            **dict.fromkeys(ARRAYS, ANYTHING),
            **dict.fromkeys(WORDS, ANYTHING),
            "dt": ANYTHING,
            "interval": NUMBER,
        },
        valid,
        told=("model", "interval", "voltage"),
        plain=False,
    ),
    Door(
        "Plant.from_control",
        lambda system, **about: Plant.from_control(SYSTEMS.get(system, system) if isinstance(system, str) else system, **about),
        {"system": ANYTHING, **dict.fromkeys(ARRAYS, ANYTHING), **dict.fromkeys(WORDS, ANYTHING), "interval": NUMBER},
        lambda: {"system": "small", **{name: value for name, value in valid().items() if name not in (*MODEL, "dt")}},
        told=("model", "voltage", "D"),
        plain=False,
    ),
    *map(of_file, (".npz", ".mat", ".json")),
]
