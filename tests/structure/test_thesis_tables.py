"""Tables 3.1, 3.3 and 3.4 of the thesis: θ = 0, R₀ = 0.1 L, no gyroscopic coupling, bending modes."""

from functools import partial

import numpy as np
import pytest

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, RotatingBeam

BENDING = ("lag", "flap")
HOOP_PLIES = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[0] * 6)
thesis_blade = partial(RotatingBeam, model="thesis", shear_flow="consistent", layup=HOOP_PLIES, length=2.023, hub_radius=0.2023)


def columns(rows, *names):
    return np.array([[row[name] for name in names] for row in rows])


def test_table_3_4_thickness_ratios_within_a_tenth_of_a_percent(table, deviation):
    """Untwisted, Ω = 100 rad/s, higher-order theory: all 15 values within 0.07 %."""
    rows = table("thesis_table_3_4.csv")
    sections = [BoxSection(0.254, 0.0508, 0.127 / row["half_width_over_thickness"]) for row in rows]
    computed = [thesis_blade(section).natural_frequencies(100.0, 3, BENDING, gyroscopic=False) for section in sections]
    off = deviation(computed, columns(rows, "mode1", "mode2", "mode3"))
    assert off.size == 15
    assert np.abs(off).max() < 0.1


@pytest.fixture(scope="module")
def table_3_3(table, thesis_section):
    """Rows, the four entries that are wrong in the thesis, and what the rigid theory gives for a number of terms."""
    rows = table("thesis_table_3_3.csv")
    thesis, oh = columns(rows, "mode1", "mode2", "mode3"), columns(rows, "oh_mode1", "oh_mode2", "oh_mode3")
    wrong = np.zeros(thesis.shape, dtype=bool)
    wrong[[row["speed"] == 200.0 for row in rows], 2] = True

    def computed(terms):
        frequencies = []
        for row in rows:
            blade = thesis_blade(
                thesis_section, pretwist_deg=30.0, presetting_deg=row["presetting_deg"], shear="rigid", terms=terms
            )
            frequencies.append(blade.natural_frequencies(row["speed"], 3, BENDING, gyroscopic=False))
        return np.array(frequencies)

    return thesis, oh, wrong, computed


def test_table_3_3_is_what_six_terms_of_rigid_theory_give(table_3_3, deviation):
    """Pretwist 30°: 44 of 48 values agree to 0.01 %, all its digits, with six terms (not ten): the thesis stopped there."""
    thesis, _, wrong, computed = table_3_3
    off = deviation(computed(6), thesis)
    assert wrong.sum() == 4
    assert np.abs(off[~wrong]).max() < 0.01
    assert np.abs(deviation(computed(5), thesis)[~wrong]).max() > 1.0
    assert np.abs(deviation(computed(7), thesis)[~wrong]).max() > 0.5


def test_table_3_3_third_frequencies_at_200_rad_s_are_wrong_in_the_thesis(table_3_3, deviation):
    """3 to 8 % below this model, which agrees with Oh et al. (2003) to 1.5 %: Ritz values cannot be too high by so much there."""
    thesis, oh, wrong, computed = table_3_3
    for terms in (6, 10):
        assert np.all(deviation(computed(terms), thesis)[wrong] > 3.0)
        assert np.abs(deviation(computed(terms), oh)[wrong]).max() < 1.5


def test_table_3_3_converged_differs_by_less_than_0_8_percent_but_for_one_entry(table_3_3, deviation):
    """Ten terms, converged to 0.02 %, all at or below the thesis' six since Ritz values only fall.

    43 of 44 stay within 0.8 %. The other, ω₁ at 400 rad/s and 90° presetting, falls by 1.14 % (184.54 in the thesis, 182.44
    here) and meets Oh et al. (182.26) to 0.1 %: the thesis' own value is not converged.
    """
    thesis, oh, wrong, computed = table_3_3
    off = deviation(computed(10), thesis)
    last = (15, 0)
    assert off[last] == pytest.approx(-1.14, abs=0.01)  # own output: guards, does not prove
    assert abs(deviation(computed(10), oh)[last]) < 0.1
    assert off[~wrong].max() < 0.01
    off[last] = 0.0
    assert np.abs(off[~wrong]).max() < 0.8
    assert np.abs(deviation(computed(16), computed(10))).max() < 0.02


def test_table_3_1_converges_from_above_and_the_first_mode_first(thesis_section):
    """θ = 30°, pretwist 30°, 200 rad/s: the shape of Table 3.1, whose numbers fit no configuration tried."""
    oblique = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6)
    by_terms = [
        thesis_blade(thesis_section, layup=oblique, pretwist_deg=30.0, terms=terms).natural_frequencies(200.0, 3, gyroscopic=False)
        for terms in range(1, 11)
    ]
    by_terms = np.array(by_terms)
    assert np.all(np.diff(by_terms, axis=0) <= 0.0)
    assert by_terms[4] / by_terms[9] - 1.0 == pytest.approx(
        [0.0013, 0.0019, 0.0027], abs=1e-4
    )  # own output: guards, does not prove
