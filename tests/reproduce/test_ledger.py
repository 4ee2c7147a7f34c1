import re

import numpy as np
import pytest

from train.reproduce.catalogue import FUTURE_WORK, NAMES, STUDIES, THESIS_STUDIES, chosen
from train.reproduce.judging.ledger import ROWS
from train.reproduce.judging.stumbling import STUMBLING
from train.reproduce.judging.verdicts import Below, Changes, Holds, Large, Marginal, Matches, Small, Substantial, Verdict

BY_NAME = {study.name: study for study in STUDIES}
DECIDED = [row for row in ROWS if row.decided_by]


def supporting(rule):
    match rule:
        case Matches():
            return rule.printed
        case Changes():
            return (1.0, 2.0) if rule.direction > 0 else (2.0, 1.0)
        case Small():
            return (0.0,)
        case Large():
            return (2.0 * rule.limit,)
        case Marginal():
            return (0.5 * rule.direction * rule.limit,)
        case Substantial():
            return (2.0 * rule.direction * rule.limit,)
        case Holds():
            return (1.0,)
        case Below():
            return (0.5 * rule.limit,)
    raise TypeError(rule)


def contradicting(rule):
    match rule:
        case Matches():
            return tuple(10.0 * value for value in rule.printed)
        case Changes():
            return (2.0, 1.0) if rule.direction > 0 else (1.0, 2.0)
        case Small():
            return (10.0 * rule.trend,)
        case Large() | Holds():
            return (0.0,)
        case Marginal() | Substantial():
            return (-0.5 * rule.direction * rule.limit,)
        case Below():
            return (2.0 * rule.limit,)
    raise TypeError(rule)


def statement(study, key):
    return next(found for found in BY_NAME[study].statements if found.key == key)


def judged(row, against=None):
    """Judgements in favour of a row, but for one study's key, which speaks against it."""
    judgements = {}
    for study, key in row.decided_by:
        rule = statement(study, key).rule
        evidence = contradicting(rule) if (study, key) == against else supporting(rule)
        judgements.setdefault(study, {})[key] = rule.judge(np.array(evidence, dtype=float))
    return judgements


@pytest.mark.parametrize("row", DECIDED, ids=lambda row: f"{row.section}: {row.text[:40]}")
def test_conclusion_stands_on_numbers_in_favour_and_falls_with_any_one_against(row):
    assert row.verdict(judged(row)) is Verdict.REPRODUCED
    for against in row.decided_by:
        assert row.verdict(judged(row, against)) is Verdict.NOT_REPRODUCED


@pytest.mark.parametrize("row", [*DECIDED, *STUMBLING], ids=lambda row: f"{row.section}: {row.text[:40]}")
def test_conclusions_are_decided_by_what_the_thesis_states(row):
    assert not any(statement(study, key).aside for study, key in row.decided_by)


def test_conclusion_without_a_result_cannot_be_tested_and_one_that_was_not_run_has_no_verdict():
    empty = [row for row in ROWS if not row.decided_by]
    assert empty and all(row.verdict({}) is Verdict.UNTESTABLE and row.remark for row in empty)
    assert DECIDED[0].verdict({}) is None


def test_what_is_stumbled_over_is_explained_and_decided_by_the_tables_and_figures_that_it_names():
    for row in STUMBLING:
        assert row.remark and row.decided_by
        numbers = {study.split("-")[1] for study, _ in row.decided_by}
        assert numbers == set(re.findall(r"\d\.\d+", row.section))


def test_every_section_of_conclusions_is_there():
    assert {row.section for row in ROWS} == {"3.7", "5.6", "6.6", "7.1"}
    assert sum(row.section == "3.7" for row in ROWS) == 10
    assert sum(row.section == "6.6" for row in ROWS) == 6


def test_keys_are_unique_and_every_table_and_figure_of_chapters_2_3_5_and_6_is_there():
    for study in STUDIES:
        keys = [found.key for found in study.statements]
        assert len(set(keys)) == len(keys)
    wanted = [f"table-{n}" for n in ("2.1", "2.2", "3.1", "3.2", "3.3", "3.4", "6.1", "6.2", "6.3", "6.4")]
    wanted += (
        [f"figure-3.{n}" for n in range(2, 25)] + [f"figure-5.{n}" for n in range(1, 18)] + [f"figure-6.{n}" for n in range(4, 8)]
    )
    assert sorted(study.name for study in THESIS_STUDIES) == sorted(wanted)


def test_own_work_decides_no_conclusion_and_names_no_table_or_figure_of_the_thesis():
    own = {study.name for study in FUTURE_WORK[1]}
    assert not own & {study for row in ROWS for study, _ in row.decided_by}
    assert not any(name.startswith(("table-", "figure-")) for name in own)
    assert len(set(NAMES)) == len(NAMES) == len(THESIS_STUDIES) + len(own)


def test_an_unknown_name_lists_the_known_ones():
    with pytest.raises(ValueError, match=r"figure-9\.9.*table-2\.1.*figure-6\.7"):
        chosen(["figure-9.9"])
