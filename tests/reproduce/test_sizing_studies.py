"""Sizing and joint placement in the chapter of our own work."""

import pytest

from train.reproduce.judging.verdicts import Verdict
from train.reproduce.studies.chapter7_sizing import STUDIES
from train.reproduce.thesis import Model


@pytest.mark.parametrize("study", STUDIES, ids=[study.name for study in STUDIES])
def test_what_is_expected_of_sizes_and_places_holds(study):
    judgements = study.judge(study.compute(Model()))
    assert {key: each.verdict for key, each in judgements.items()} == dict.fromkeys(judgements, Verdict.REPRODUCED)
