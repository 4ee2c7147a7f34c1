"""All studies, in the thesis' order and then those of what it left to others, and the finding of them by name."""

from __future__ import annotations

from collections.abc import Sequence

from beamenv.configuration import unknown_name
from train.reproduce.judging.study import Study
from train.reproduce.studies import (
    chapter2,
    chapter3_gyroscopic,
    chapter3_presetting,
    chapter3_pretwist,
    chapter3_tables,
    chapter3_taper,
    chapter3_veering,
    chapter5_individual,
    chapter5_modes,
    chapter5_one_voltage,
    chapter5_passive,
    chapter6_layouts,
    chapter6_tables,
    chapter7_adaptive,
    chapter7_elements,
    chapter7_equations,
    chapter7_graded,
    chapter7_heat,
    chapter7_sizing,
)

Chapter = tuple[str, tuple[Study, ...]]
"""Its title and what belongs to it."""

THESIS: tuple[Chapter, ...] = (
    ("Chapter 2: couplings", chapter2.STUDIES),
    (
        "Chapter 3: vibration",
        chapter3_tables.STUDIES
        + chapter3_gyroscopic.STUDIES
        + chapter3_veering.STUDIES
        + chapter3_taper.STUDIES
        + chapter3_pretwist.STUDIES
        + chapter3_presetting.STUDIES,
    ),
    (
        "Chapter 5: control",
        chapter5_modes.STUDIES + chapter5_passive.STUDIES + chapter5_one_voltage.STUDIES + chapter5_individual.STUDIES,
    ),
    ("Chapter 6: placement", chapter6_tables.STUDIES + chapter6_layouts.STUDIES),
)
"""The thesis' tables and figures, whose statements are counted."""

FUTURE_WORK: Chapter = (
    "Future work: section 7.2, done",
    (
        *chapter7_graded.STUDIES,
        *chapter7_adaptive.STUDIES,
        *chapter7_heat.STUDIES,
        *chapter7_elements.STUDIES,
        *chapter7_sizing.STUDIES,
        *chapter7_equations.STUDIES,
    ),
)
"""What the thesis' section 7.2 left to others: our own work with its checks, no part of any count of the thesis' statements."""

CHAPTERS = (*THESIS, FUTURE_WORK)


def studies_of(chapters: Sequence[Chapter]) -> tuple[Study, ...]:
    """All studies of several chapters, in order."""
    return tuple(study for _, studies in chapters for study in studies)


THESIS_STUDIES = studies_of(THESIS)
STUDIES = studies_of(CHAPTERS)
NAMES = tuple(study.name for study in STUDIES)


def chosen(names: Sequence[str]) -> tuple[Study, ...]:
    """The studies of these names in the page's order, all for none; ``ValueError`` for an unknown name, listing the known ones."""
    unknown = [name for name in names if name not in NAMES]
    if unknown:
        raise unknown_name("name", unknown[0], NAMES)
    return tuple(study for study in STUDIES if not names or study.name in names)
