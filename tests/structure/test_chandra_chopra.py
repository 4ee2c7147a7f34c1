"""Table 3.2: the CAS box beam of Chandra and Chopra (Journal of Aircraft 29, 1992), bending and twist coupled."""

import numpy as np
import pytest
from numpy.polynomial.legendre import legvander

from beamenv.structure import AS4_3501_6, BoxSection, Layup, RotatingBeam, trial_functions
from beamenv.structure.trial_functions import legendre_derivative

INCH, RPM = 0.0254, 2.0 * np.pi / 60.0
SECTION = BoxSection(width=(0.953 - 0.030) * INCH, depth=(0.537 - 0.030) * INCH, thickness=0.030 * INCH)
MODES = ("flap1", "lag1", "flap2")


def blade(material, terms=10, **options):
    """Plies at 30° from the span: 60° from the contour tangent; top and bottom mirrored, sides alternating."""
    layup = Layup.by_wall(material, top=[60] * 6, bottom=[-60] * 6, left=[60, -60] * 3, right=[60, -60] * 3)
    return RotatingBeam(SECTION, layup, length=0.84455, hub_radius=0.06985, terms=terms, **options)


@pytest.fixture
def finite_elements(table):
    """(2, 3) Hz: at rest and at 1000 rev/min, 2-D finite-element section and beam."""
    rows = {(row["mode"], row["speed_rpm"]): row["finite_elements_hz"] for row in table("thesis_table_3_2.csv")}
    reference = np.array([[rows[mode, speed] for mode in MODES] for speed in (0.0, 1000.0)])
    assert reference.tolist() == [[19.81, 37.40, 123.53], [27.51, 38.56, 131.34]]
    return reference


def hertz(beam):
    return np.array([beam.natural_frequencies(speed * RPM, 3) for speed in (0.0, 1000.0)]) / (2.0 * np.pi)


def test_cas_walls_agree_with_finite_elements_of_the_same_material(
    finite_elements, graphite_of_the_elements, deviation, thesis_world
):
    """Ten terms: 19.93, 37.34, 124.40 Hz at rest and 27.63, 38.50, 132.20 Hz at 1000 rev/min, within 0.71 %."""
    off = deviation(hertz(blade(graphite_of_the_elements, **thesis_world)), finite_elements)
    assert np.abs(off).max() < 0.71


def test_cas_beam_agrees_with_finite_elements_but_for_its_clamp(finite_elements, graphite_of_the_elements, deviation, monkeypatch):
    """The elements are of a section far from its ends. A section of the beam cannot warp at the clamp, which is worth 1.2 %; one
    that warps there too has their frequencies within 0.4 %.
    """
    clamped = deviation(hertz(blade(graphite_of_the_elements)), finite_elements)
    assert np.all((clamped > 0.0) & (clamped < 1.45))

    def unclamped(xi, terms, length, reach):
        value = legvander(2.0 * xi - 1.0, terms - 1)
        return value, value @ (2.0 * legendre_derivative(terms)) / length

    monkeypatch.setattr(trial_functions, "clamped_table", unclamped)
    assert np.abs(deviation(hertz(blade(graphite_of_the_elements)), finite_elements)).max() < 0.4


def test_cas_beam_of_the_thesis_material_agrees_too(finite_elements, deviation, thesis_world):
    """G12 = 6.135 GPa, 2.3 % stiffer in twist, to which CAS couples flap: ten terms are within 1.47 %, sixteen within 1.16 %.

    What ten terms lack is the boundary layer in which the clamp restrains warping (φ' = 0): polynomials resolve it slowly,
    and Ritz values come from above.
    """
    ten, sixteen = (deviation(hertz(blade(AS4_3501_6, terms=terms, **thesis_world)), finite_elements) for terms in (10, 16))
    assert np.abs(ten).max() < 1.5
    assert np.abs(sixteen).max() < 1.2
    assert np.all(sixteen <= ten)


def test_cas_beam_agrees_with_the_experiment_as_well_as_with_the_theory_of_its_authors(table, deviation, thesis_world):
    """Measured flap 1, lag 1 and flap 2 lie up to 5 % above; above Chandra and Chopra's own theory they lie 1 to 6 %."""
    rows = {(row["mode"], row["speed_rpm"]): row for row in table("thesis_table_3_2.csv")}
    ordered = [[rows[mode, speed] for mode in MODES] for speed in (0.0, 1000.0)]
    measured, theirs = (
        np.array([[row[name] for row in line] for line in ordered]) for name in ("experiment_hz", "chandra_chopra_hz")
    )
    ours = deviation(hertz(blade(AS4_3501_6, **thesis_world)), measured)
    assert np.all((ours > -5.0) & (ours < 0.0))
    assert np.abs(ours).max() < np.abs(deviation(theirs, measured)).max()


def test_first_modes_of_the_cas_beam_are_flap_lag_flap(graphite_of_the_elements, world):
    assert blade(graphite_of_the_elements, **world).modes(1000.0 * RPM, 3).families == ("flap", "lag", "flap")
