from dataclasses import replace

import pytest

from train.reproduce.catalogue import STUDIES, chosen
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.thesis import Model

BY_NAME = {study.name: study for study in STUDIES}
AS_JUDGED = {
    "table-2.1": {"couplings": Verdict.REPRODUCED, "decoupling": Verdict.REPRODUCED},
    "table-2.2": {"couplings": Verdict.REPRODUCED, "pretwist": Verdict.REPRODUCED, "coupled": Verdict.REPRODUCED},
    "table-3.1": {"from-above": Verdict.REPRODUCED, "first-mode": Verdict.REPRODUCED, "values": Verdict.NOT_REPRODUCED},
    "table-3.2": {"theory": Verdict.REPRODUCED, "experiment": Verdict.REPRODUCED, "thesis": Verdict.TREND},
    "table-3.3": {"six-terms": Verdict.REPRODUCED, "oh": Verdict.REPRODUCED, "third-at-200": Verdict.NOT_REPRODUCED},
    "table-3.4": {"thesis": Verdict.REPRODUCED, "chandiramani": Verdict.REPRODUCED, "ratio": Verdict.REPRODUCED},
}


def verdicts(name, model):
    study = BY_NAME[name]
    return {key: found.verdict for key, found in study.judge(study.compute(model)).items()}


@pytest.mark.parametrize("name", AS_JUDGED)
def test_table_is_reproduced_as_far_as_it_can_be(name):
    found = verdicts(name, Model())
    assert {key: found[key] for key in AS_JUDGED[name]} == AS_JUDGED[name]


@pytest.mark.parametrize(
    ("name", "key", "changes"),
    [
        ("table-3.4", "thesis", {"hub_radius": 0.1}),
        ("table-3.3", "six-terms", {"hub_radius": 0.1}),
        ("table-3.4", "thesis", {"length": 2.05}),
        ("table-3.4", "chandiramani", {"shear": "rigid", "depth": 0.06}),
        ("table-2.1", "decoupling", {"pretwist_deg": 30.0}),
        ("figure-3.8", "critical", {"length": 1.6}),
        ("figure-3.3", "coupling", {"pretwist_deg": 60.0}),
    ],
)
def test_a_changed_model_loses_the_verdict(name, key, changes):
    changed = Model(box=replace(Model().box, **changes))
    assert verdicts(name, Model())[key] in (Verdict.REPRODUCED, Verdict.TREND)
    assert verdicts(name, changed)[key] is not verdicts(name, Model())[key]


def test_a_statement_without_evidence_is_refused():
    study = BY_NAME["table-3.4"]
    outcome = study.compute(Model())
    with pytest.raises(ValueError, match=r"evidence of table-3\.4"):
        study.judge(replace(outcome, evidence={}))


@pytest.mark.slow
def test_every_study_runs_and_judges_all_its_statements():
    for study in chosen([]):
        found = study.judge(study.compute(Model()))
        assert set(found) == {statement.key for statement in study.statements}
