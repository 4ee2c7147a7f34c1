"""Chapter 2: which motions couple, read off the assembled matrices."""

from __future__ import annotations

from dataclasses import replace

from beamenv.blade.config import ON_EVERY_WALL
from beamenv.structure import RotatingBeam
from train.reproduce.judging.study import Grid, Outcome, Statement, Study
from train.reproduce.judging.verdicts import Holds
from train.reproduce.thesis import Model, printed_table
from train.reproduce.thesis.configurations import antisymmetric, built
from train.reproduce.thesis.couplings import KINDS, coupled_fields, subsystems
from train.reproduce.thesis.equations import HOST

Couplings = dict[tuple[str, str], frozenset[str]]

SYMBOLS = {"u": "u", "v": "v", "s": "s", "theta_x": "θx", "theta_y": "θy", "phi": "φ"}
LETTERS = {"stiffness": "K", "gyroscopic": "G", "centrifugal": "Ω", "rotary_inertia": "M"}

UNSYMMETRIC = (0.0, 0.0, 0.0, 30.0, 30.0, 30.0)
"""A wall whose inner and outer plies differ: the arbitrary lay-up for which the thesis' tables list every possible coupling."""

DECOUPLED = {frozenset({"u", "s", "theta_y"}), frozenset({"v", "theta_x", "phi"})}


def agreement(table: str, ours: Couplings) -> list[bool]:
    """Cell by cell, whether a kind of coupling is there exactly where the thesis prints it.

    Cells on which it contradicts itself are left out.
    """
    return [
        (kind in ours[row["first"], row["second"]]) == (row[kind] == "1")
        for row in printed_table(table)
        for kind in KINDS
        if row[kind]
    ]


def stiffness_agreement(table: str, ours: Couplings) -> list[bool]:
    """The same for the stiffness couplings alone."""
    return [("stiffness" in ours[row["first"], row["second"]]) == (row["stiffness"] == "1") for row in printed_table(table)]


def cases(model: Model, pretwist_deg: float) -> dict[str, RotatingBeam]:
    """The lay-ups compared, by the name the table gives them."""
    cus = model.blade(30.0, pretwist_deg=pretwist_deg)
    return {
        "arbitrary plies": built(replace(cus, ply_angles_deg=((ON_EVERY_WALL, UNSYMMETRIC),))),
        "CUS 30°, thesis' shear flow": built(replace(cus, shear_flow="thesis")),
        "CUS 30°": built(cus),
        "CAS 30°": built(replace(cus, ply_angles_deg=antisymmetric(30.0))),
    }


def letters(kinds: frozenset[str]) -> str:
    """Kinds of coupling as letters."""
    return " ".join(LETTERS[kind] for kind in KINDS if kind in kinds)


def grid(title: str, couplings: Couplings) -> Grid:
    """The couplings as a symmetric table."""
    cells = {(SYMBOLS[a], SYMBOLS[b]): letters(kinds) for (a, b), kinds in couplings.items()}
    return Grid(title, tuple(SYMBOLS.values()), cells | {(b, a): text for (a, b), text in cells.items()})


def printed_couplings(table: str) -> Couplings:
    """The thesis' own table."""
    return {(row["first"], row["second"]): frozenset(kind for kind in KINDS if row[kind] == "1") for row in printed_table(table)}


def outcome(table: str, found: dict[str, Couplings], evidence: dict[str, list[bool]]) -> Outcome:
    """The printed couplings beside ours."""
    everything = {"thesis": printed_couplings(table), **found}
    pairs = list(everything["thesis"])
    rows = [[SYMBOLS[a], SYMBOLS[b], *(letters(case[a, b]) for case in everything.values())] for a, b in pairs]
    panels = [grid(name, case) for name, case in everything.items() if name != "CUS 30°, thesis' shear flow"]
    return Outcome(evidence=evidence, panels=panels, header=["field", "field", *everything], rows=rows)


def untwisted(model: Model) -> Outcome:
    """Table 2.1."""
    found = {name: coupled_fields(beam) for name, beam in cases(model, 0.0).items()}
    blades = [
        blade
        for angle in (0.0, 90.0)
        for blade in (model.blade(angle), replace(model.blade(angle), ply_angles_deg=antisymmetric(angle)))
    ]
    decoupled = [set(subsystems(coupled_fields(built(blade)))) == DECOUPLED for blade in blades]
    evidence = {
        "couplings": agreement("table-2.1", found["arbitrary plies"]),
        "closed-cell": stiffness_agreement("table-2.1", found["CUS 30°"]),
        "decoupling": decoupled,
    }
    return outcome("table-2.1", found, evidence)


def pretwisted(model: Model) -> Outcome:
    """Table 2.2."""
    found = {name: coupled_fields(beam) for name, beam in cases(model, 30.0).items()}
    straight = coupled_fields(model.beam(30.0))
    twisted = found["CUS 30°"]
    by_pretwist = [("u", "phi"), ("theta_y", "phi")]
    evidence = {
        "couplings": agreement("table-2.2", found["arbitrary plies"]),
        "closed-cell": stiffness_agreement("table-2.2", twisted),
        "pretwist": [("gyroscopic" in twisted[pair]) and ("gyroscopic" not in straight[pair]) for pair in by_pretwist],
        "coupled": [len(set(subsystems(twisted))) == 1],
    }
    return outcome("table-2.2", found, evidence)


ARBITRARY = (
    f"walls of plies {', '.join(f'{angle:g}' for angle in UNSYMMETRIC)}° for the arbitrary lay-up; K stiffness, G "
    "gyroscopic, Ω centrifugal, M rotary inertia"
)

STUDIES = (
    Study(
        "table-2.1",
        "Couplings of the untwisted rotating beam",
        ARBITRARY + "; θx–φ and θy–φ left out where the thesis' table is not symmetric",
        (
            Statement("couplings", "The couplings listed are present and no others, for an arbitrary lay-up", Holds()),
            Statement(
                "closed-cell",
                "The stiffness couplings listed are all there for the 30° lay-up of the examples",
                Holds(),
                "Of the listed ones u–v needs unsymmetric walls; u–θx, v–θy and θx–θy vanish once the shear flow is constant "
                "around the "
                "closed cell, which the thesis does not require.",
                aside=True,
            ),
            Statement(
                "decoupling",
                "For θ = 0° or 90°, untwisted, the system decouples into u–s–θy and v–θx–φ (CUS and CAS)",
                Holds(),
            ),
        ),
        untwisted,
        rests_on=HOST,
    ),
    Study(
        "table-2.2",
        "Couplings of the pretwisted rotating beam",
        ARBITRARY + "; 30° pretwist",
        (
            Statement("couplings", "The couplings listed are present and no others, for an arbitrary lay-up", Holds()),
            Statement(
                "closed-cell",
                "The stiffness couplings listed are all there for the 30° lay-up of the examples",
                Holds(),
                aside=True,
            ),
            Statement("pretwist", "The gyroscopic couplings u–φ and θy–φ arise due to pretwist", Holds()),
            Statement("coupled", "All the equations of the pretwisted beam are coupled", Holds()),
        ),
        pretwisted,
        rests_on=HOST,
    ),
)
