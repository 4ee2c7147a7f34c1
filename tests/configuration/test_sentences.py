"""A sentence says a path once, and has one full stop."""

import pytest

from beamenv.configuration import clause
from beamenv.configuration.sentence import joined
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, RotatingBeam


@pytest.mark.parametrize(
    ("path", "name", "whole"),
    [
        ("beam", "beam.chord_table", "beam.chord_table"),
        ("blade.beam.section", "section.thickness", "blade.beam.section.thickness"),
        ("blade.beam.section", "blade.beam.section.thickness", "blade.beam.section.thickness"),
        ("blade.beam", "section.thickness", "blade.beam.section.thickness"),
        ("", "thickness", "thickness"),
    ],
)
def test_what_a_path_and_a_name_have_in_common_is_said_once(path, name, whole):
    assert joined(path, name) == whole


def test_an_error_becomes_a_clause_without_its_full_stop():
    assert clause(ValueError("the file\n is  damaged.")) == "the file is damaged"


def test_a_table_of_a_beam_is_called_by_its_path():
    with pytest.raises(ValueError, match=r"^beam\.chord_table is \(\(0\.0, 1\.0\), \(0\.5, 2\.0\)\), but must be pairs"):
        RotatingBeam(
            section=BoxSection(0.2, 0.05, 0.005),
            layup=Layup.uniform(GRAPHITE_EPOXY, [0.0]),
            length=1.0,
            chord_table=((0.0, 1.0), (0.5, 2.0)),
        )
