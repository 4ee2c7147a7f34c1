"""The second verdict: whether the thesis computed a statement rightly by its own equations, whatever nature does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from train.reproduce.judging.study import Study, judged
from train.reproduce.judging.verdicts import Judgement, Verdict
from train.reproduce.thesis import Model
from train.reproduce.thesis.equations import Reading, readings, refutation
from train.reproduce.thesis.readings import read_by

RANK = (Verdict.UNTESTABLE, Verdict.NOT_REPRODUCED, Verdict.TREND, Verdict.REPRODUCED)
AS_PRINTED: Reading = ("what it prints",)
"""The reading of what is judged by the thesis' printed layouts."""

Results = Mapping[tuple[Reading, Any], Any]
"""What parts of a study came to, by reading and key."""

Tries = dict[Reading, dict[str, Judgement] | str]
"""Judgements by each reading, or why there are none."""


@dataclass(frozen=True, slots=True)
class Second:
    """One statement's second verdict."""

    verdict: Verdict
    ours: str = ""
    deviation: str = ""
    """What the thesis' equations give."""
    reading: Reading = ()
    """The first way of reading them, in their fixed order, that gives the verdict; empty where nothing differs from our model."""
    enough: Reading = ()
    """Where the verdict is better than by our model: the first equation that gives it alone, the others ours, or several needed."""
    reason: str = ""
    """Why they cannot be evaluated."""
    told: tuple[str, ...] = ()
    """What readings give that the thesis itself refutes."""


def judged_again(study: Study, model: Model, first: Mapping[str, Judgement], results: Results) -> dict[str, Second]:
    """The second verdict of every statement, by the best of the readings that the study rests on.

    Of questions of our own too, but those that the thesis' equations do not bear on.
    """
    if study.printed is not None or study.unprinted:
        return from_print(study, model)
    whole, *misprinted = readings(study.rests_on)
    tries: Tries = {whole: attempt(study, model, whole, results) if whole else dict(first)}
    for reading in misprinted:
        if any(verdict is not Verdict.REPRODUCED for verdict in study.verdicts(best(study, tries))):
            tries[reading] = attempt(study, model, reading, results)
    found = best(study, {reading: judged for reading, judged in tries.items() if not refutation(reading)})
    better = [key for key, second in found.items() if rank(second.verdict) > rank(first[key].verdict)]
    enough = needed(study, model, found, better)
    return {
        key: replace(second, enough=enough.get(key, ()), told=told(key, second.verdict, tries)) for key, second in found.items()
    }


def rank(verdict: Verdict) -> int:
    """The higher the better."""
    return RANK.index(verdict)


def told(key: str, verdict: Verdict, tries: Tries) -> tuple[str, ...]:
    """Which refuted readings give a statement a better verdict, in words."""
    sentences = []
    for reading, found in tries.items():
        refuted = refutation(reading)
        if refuted and not isinstance(found, str) and rank(found[key].verdict) > rank(verdict):
            sentences.append(f"with {reading[-1]} ({refuted}): {outcome_in_words(found[key])}")
    return tuple(sentences)


def outcome_in_words(judgement: Judgement) -> str:
    """Verdict and numbers."""
    return f"{judgement.verdict.value} ({judgement.ours})"


def attempt(study: Study, model: Model, reading: Reading, results: Results) -> dict[str, Judgement] | str:
    """The judgements by a reading, or why a blade cannot be computed by it."""
    parts = {key: result for (read, key), result in results.items() if read == reading}
    try:
        for failure in (each for each in parts.values() if isinstance(each, Exception)):
            raise failure
        evidence = study.compute(read_by(model, reading), parts or None).evidence
        return judged([each for each in study.statements if not each.aside or np.size(evidence[each.key])], evidence)
    except (ValueError, np.linalg.LinAlgError) as error:
        return str(error)


def best(study: Study, tries: Tries) -> dict[str, Second]:
    """The best verdict of each statement, by the first reading that gives it."""
    found = {statement.key: _best(statement.key, tries) for statement in study.statements}
    return {key: second for key, second in found.items() if second is not None}


def _best(key: str, tries: Tries) -> Second | None:
    judgements = {reading: found for reading, found in tries.items() if not isinstance(found, str)}
    known = [
        Second(found[key].verdict, found[key].ours, found[key].deviation, reading)
        for reading, found in judgements.items()
        if key in found
    ]
    if judgements and not known:
        return None
    if not known:
        return Second(Verdict.UNTESTABLE, reason=next(str(why) for why in tries.values()))
    return max(known, key=lambda second: rank(second.verdict))


def needed(study: Study, model: Model, found: Mapping[str, Second], better: list[str]) -> dict[str, Reading]:
    """For statements that the thesis' equations judge better than ours: the first equation that does so alone, the others ours, or
    what is left of all when one after another is dropped that is not needed.
    """
    tries: Tries = {}

    def suffices(key: str, reading: Reading) -> bool:
        if reading not in tries:
            tries[reading] = attempt(study, model, reading, {})
        judgements = tries[reading]
        return not isinstance(judgements, str) and judgements[key].verdict is found[key].verdict

    enough: dict[str, Reading] = {}
    for key in better:
        whole = found[key].reading
        alone = next(((name,) for name in whole if len(whole) == 1 or suffices(key, (name,))), ())
        enough[key] = alone or without_needless(key, whole, suffices)
    return enough


def without_needless(key: str, whole: Reading, suffices: Callable[[str, Reading], bool]) -> Reading:
    """Of several equations those without which a statement is judged worse."""
    kept = whole
    for name in whole:
        rest = tuple(each for each in kept if each != name)
        if rest and suffices(key, rest):
            kept = rest
    return kept


def from_print(study: Study, model: Model) -> dict[str, Second]:
    """Verdicts by what the thesis prints, its layouts above all, where the way to it is not printed."""
    evidence = study.printed(model) if study.printed is not None else {}
    known = judged([statement for statement in study.own_statements if statement.key in evidence], evidence)
    return {
        key: Second(known[key].verdict, known[key].ours, known[key].deviation, AS_PRINTED)
        if key in known
        else Second(Verdict.UNTESTABLE, reason=study.unprinted)
        for key in (statement.key for statement in study.own_statements)
    }
