"""All that is said of the thesis is computed in its own model."""

import pytest

from beamenv.structure import RotatingBeam
from train.reproduce.catalogue import THESIS_STUDIES, chosen
from train.reproduce.thesis import Model

QUICK = ("table-2.2", "table-3.2", "table-3.4", "figure-3.8", "figure-5.3", "figure-5.8", "figure-5.11")
SLOW = ("figure-6.7", *(study.name for study in THESIS_STUDIES if study.name not in QUICK and "-6." not in study.name))
"""Of chapter 6 one, for all take the same blade; the others search for minutes."""


@pytest.mark.parametrize("name", [*QUICK, *(pytest.param(name, marks=pytest.mark.slow) for name in SLOW)])
def test_every_blade_of_a_study_is_of_the_thesis_model(name, monkeypatch):
    made, check = [], RotatingBeam.__post_init__

    def noting(beam):
        made.append(beam.model)
        check(beam)

    monkeypatch.setattr(RotatingBeam, "__post_init__", noting)
    (study,) = chosen([name])
    study.compute(Model())
    assert set(made) == {"thesis"}
