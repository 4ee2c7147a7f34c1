import numpy as np
import pytest

from train.reproduce.judging.verdicts import (
    Below,
    Changes,
    Holds,
    Large,
    Marginal,
    Matches,
    Rule,
    Small,
    Substantial,
    Verdict,
    WhateverIsOpen,
    weakest,
)

GOOD, TREND, BAD, OPEN = Verdict.REPRODUCED, Verdict.TREND, Verdict.NOT_REPRODUCED, Verdict.UNTESTABLE


@pytest.mark.parametrize(
    ("rule", "evidence", "verdict"),
    [
        (Matches((100.0, 10.0), 0.01, 0.05), [100.9, 10.0], GOOD),
        (Matches((100.0, 10.0), 0.01, 0.05), [100.0, 10.4], TREND),
        (Matches((100.0, 10.0), 0.01, 0.05), [100.0, 11.0], BAD),
        (Changes(+1), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], GOOD),
        (Changes(+1), [[1.0, 2.0, 3.0], [4.0, 3.9, 6.0]], TREND),
        (Changes(+1), [[1.0, 2.0, 3.0], [4.0, 3.0, 2.0]], BAD),
        (Changes(-1), [3.0, 2.0, 1.0], GOOD),
        (Changes(-1), [1.0, 1.0], BAD),
        (Small(0.01, 0.05), [0.01, -0.005], GOOD),
        (Small(0.01, 0.05), [-0.04], TREND),
        (Small(0.01, 0.05), [0.06], BAD),
        (Large(0.05, 0.01), [0.0, -0.06], GOOD),
        (Large(0.05, 0.01), [0.02], TREND),
        (Large(0.05, 0.01), [0.005], BAD),
        (Marginal(-1), [-0.05, -0.01], GOOD),
        (Marginal(-1), [-0.05, -0.5], TREND),
        (Marginal(-1), [-0.05, 0.01], BAD),
        (Substantial(-1), [-0.05, -0.5], GOOD),
        (Substantial(-1), [-0.01, -0.5], TREND),
        (Substantial(-1), [0.01, -0.5], BAD),
        (Substantial(-1), [0.0, -0.5], BAD),
        (Substantial(+1, 0.1), [0.2], GOOD),
        (WhateverIsOpen(), [1, 1], GOOD),
        (WhateverIsOpen(), [1, 0], OPEN),
        (WhateverIsOpen(), [0, 0], BAD),
        (Holds(), [True, True], GOOD),
        (Holds(), [1, 1, 1, 0], TREND),
        (Holds(), [1, 0], BAD),
        (Below(1500.0, "V"), [100.0, 1400.0], GOOD),
        (Below(1500.0, "V"), [100.0, 1600.0], OPEN),
        (Below(1500.0, "V"), [1600.0], BAD),
    ],
)
def test_rule_turns_numbers_into_a_verdict(rule, evidence, verdict):
    judgement = rule.judge(np.array(evidence, dtype=float))
    assert judgement.verdict is verdict
    assert judgement.thesis and judgement.ours and judgement.deviation


@pytest.mark.parametrize(
    "rule",
    [
        Matches((1.0,), 0.1, 0.2),
        Changes(1),
        Small(0.1, 0.2),
        Large(),
        Marginal(1),
        Substantial(1),
        Holds(),
        WhateverIsOpen(),
        Below(1.0, "V"),
    ],
)
def test_every_rule_states_itself_and_refuses_numbers_that_are_none(rule: Rule):
    assert "reproduced" in rule.words
    for evidence in ([], [np.nan], [np.inf]):
        with pytest.raises(ValueError, match="evidence"):
            rule.judge(np.array(evidence))


def test_as_many_numbers_as_are_printed():
    with pytest.raises(ValueError, match="2 numbers"):
        Matches((1.0, 2.0), 0.1, 0.2).judge(np.array([1.0]))


def test_weakest_verdict_decides_and_untestable_ones_do_not_count():
    assert weakest([GOOD, TREND, OPEN]) is TREND
    assert weakest([GOOD, BAD, TREND]) is BAD
    assert weakest([GOOD, OPEN]) is GOOD
    assert weakest([OPEN]) is OPEN and weakest([]) is OPEN
