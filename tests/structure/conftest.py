import csv
from pathlib import Path

import numpy as np
import pytest

from beamenv.structure import BoxSection, Lamina, Layup

DATA = Path(__file__).parents[1] / "data"

WORLDS = {"blade": {}, "thesis": {"model": "thesis", "shear_flow": "consistent"}}


@pytest.fixture(scope="session")
def table():
    """A reference table as a list of rows, numbers as floats where they are numbers."""

    def read(name):
        with (DATA / name).open(newline="") as file:
            return [{key: as_number(value) for key, value in row.items()} for row in csv.DictReader(file)]

    return read


def as_number(text):
    try:
        return float(text)
    except ValueError:
        return text


@pytest.fixture(scope="session", params=WORLDS.values(), ids=WORLDS)
def world(request):
    """What is true of any blade is asked of each model: arguments of beams and of ``section.stiffness``."""
    return request.param


@pytest.fixture(scope="session")
def thesis_world():
    """What is only said of the thesis' walls, or of vibration about the blade at rest, is asked of its model."""
    return WORLDS["thesis"]


@pytest.fixture(scope="session")
def aluminium():
    return Lamina.isotropic(E=70e9, nu=0.3, density=2700.0)


@pytest.fixture(scope="session")
def isotropic(aluminium):
    return Layup.uniform(aluminium, angles_deg=[0])


@pytest.fixture(scope="session")
def graphite_of_the_elements():
    """AS4/3501-6 with the constants that the 2-D finite elements used: G12 is 2.3 % below the thesis' 6.135 GPa."""
    return Lamina(E1=141.963e9, E2=9.7906e9, G12=5.99844e9, G13=5.99844e9, G23=4.79875e9, nu12=0.42, density=1444.8)


@pytest.fixture(scope="session")
def thesis_section():
    return BoxSection(width=0.254, depth=0.0508, thickness=0.01016)


@pytest.fixture(scope="session")
def deviation():
    """Relative deviation, %."""
    return lambda value, reference: 100.0 * (np.asarray(value) / np.asarray(reference) - 1.0)
