"""Temperatures that a blade cannot have: beyond its data, beside what they do not go with, or where it buckles."""

from dataclasses import replace

import pytest

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Lamina, Layup, RotatingBeam

ALUMINIUM = replace(Lamina.isotropic(70e9, 0.3, 2700.0), alpha1=23e-6, alpha2=23e-6)
CLAMPED = (1e12,) * 6


def blade(layup=None, **options):
    return RotatingBeam(BoxSection(0.1, 0.05, 0.004), layup or Layup.uniform(ALUMINIUM, [0.0]), 2.0, **options)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"temperature_difference": 5.0, "model": "thesis"}, "beam.temperature_difference is 5.0"),
        ({"temperature": 310.0, "temperature_table": ((0.0, 300.0), (1.0, 310.0))}, "beam.temperature"),
        ({"temperature_table": ((0.0, 300.0), (0.9, 310.0))}, "beam.temperature_table"),
        ({"temperature": 310.0, "model": "thesis"}, "beam.temperature"),
        ({"tip_springs": (1.0,) * 6, "model": "thesis"}, "beam.tip_springs"),
        ({"tip_springs": (1.0,) * 5}, "beam.tip_springs"),
        ({"temperature": -1.0}, "beam.temperature"),
        ({"temperature": 20.0}, r"beam.temperature is 20.0, but must be None or a number from 100 to 5000 \(K\)"),
        ({"reference_temperature": 20.0}, "beam.reference_temperature is 20.0"),
        ({"temperature_table": ((0.0, 300.0), (1.0, 20.0))}, "beam.temperature_table is 20.0, but must be a number from 100"),
        ({"temperature_table": ((0.0, 300.0), (1.0, 310.0)), "model": "thesis"}, "beam.temperature_table is"),
    ],
)
def test_what_does_not_go_together_is_refused_in_a_sentence(options, said):
    with pytest.raises(ValueError, match=said):
        blade(**options)


def test_a_buckled_blade_is_refused_in_a_sentence():
    with pytest.raises(ValueError, match=r"beam.temperature is 600.* buckles"):
        blade(temperature=600.0, tip_springs=CLAMPED).at(0.0)
    with pytest.raises(ValueError, match=r"beam.temperature is 600.* buckles"):
        blade(temperature=600.0, tip_springs=CLAMPED, steady_state="linear").natural_frequencies()


def test_a_blade_that_a_difference_bends_out_of_reach_is_refused_by_that_difference():
    with pytest.raises(ValueError, match=r"beam.temperature_difference is 5000.0, but must be nearer to 0, "):
        blade(temperature_difference=5000.0).at(0.0)


def test_a_table_that_buckles_is_refused_by_its_name():
    with pytest.raises(
        ValueError, match=r"beam.temperature_table is \[\[0.0, 600.0\], \[1.0, 590.0\]\], but must be nearer to 300 K"
    ):
        blade(temperature_table=((0.0, 600.0), (1.0, 590.0)), tip_springs=CLAMPED).at(0.0)


def test_a_curve_that_leaves_no_stiffness_is_refused_by_the_temperature():
    melts = replace(ALUMINIUM, curves={"E1": [(200.0, 1.0), (310.0, 1.0), (373.0, -1.0)]})
    with pytest.raises(
        ValueError, match=r"beam.temperature is 370.0, but must be one at which E is a positive number \(Pa\), not -"
    ):
        blade(layup=Layup.uniform(melts, [0.0]), temperature=370.0)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"temperature_table": ((0.0, 300.0), (1.0, 500.0))}, "beam.temperature_table is 500.0, but must be a number from 200"),
        ({"temperature_difference": 5.0, "reference_temperature": 500.0}, "beam.reference_temperature is 500.0, but must be"),
    ],
)
def test_data_are_refused_by_what_said_the_temperature(options, said):
    with pytest.raises(ValueError, match=said):
        blade(layup=Layup.uniform(GRAPHITE_EPOXY, [30.0]), **options)


def test_a_temperature_beyond_a_materials_data_is_refused_in_a_sentence():
    with pytest.raises(ValueError, match=r"beam.temperature is 500.0, but must be a number from 200 to 380 \(K\)"):
        blade(layup=Layup.uniform(GRAPHITE_EPOXY, [30.0]), temperature=500.0)


def test_a_material_of_unknown_expansion_is_refused_in_a_sentence():
    unknown = replace(ALUMINIUM, alpha1=None, alpha2=None)
    with pytest.raises(ValueError, match="alpha1"):
        blade(layup=Layup.uniform(unknown, [0.0]), temperature=310.0).at(0.0)
