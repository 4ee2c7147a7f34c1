"""The command ``beamenv section``: what a section is worth to a beam, and what it looks like."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import typer

from beamenv.configuration import Number, checked
from train.cli.names import check_names
from train.cli.options import BladeOption, JsonOption, PresetOption, note, one_sentence, print_json
from train.cli.tables import Column, show_table
from train.shared.files import check_picture

ROWS = ("γx", "γy", "w′", "θx′", "θy′", "φ′")
MEANING = ("shear along x", "shear along y", "extension", "bending in flap", "bending in lag", "torsion")
UNITS = ("N", "N", "N", "N m²", "N m²", "N m²")
PLIES = "plies, ° from the contour,\ninner to outer"
SEEN = 1e-6
"""Couplings below this share of the root of the product of the diagonals are none."""


def section(
    preset: PresetOption = "thesis",
    blade: BladeOption = None,
    at: Annotated[float, typer.Option(help="Position along the span: 0 is the root, 1 the tip.")] = 0.0,
    picture: Annotated[
        Path | None, typer.Option(help="PNG file for a picture of the section with its walls, patches and centres.")
    ] = None,
    as_json: JsonOption = False,
) -> None:
    """Print stiffness, mass and centres of a blade's section, without its patches, about the origin of its coordinates."""
    with one_sentence():
        check_names(preset, blade=blade)
        at = checked("at", at, Number(ge=0.0, le=1.0))
        if picture is not None:
            check_picture(picture)
        from beamenv.blade.files import load_config
        from beamenv.blade.presets import blade_config

        config = blade_config(preset, load_config(blade) if blade else None)
        beam = config.beam.build(model=config.model)
        size = float(beam.planform.scale(np.array([at * beam.length]))[0])
        found = beam.section.properties(beam.layup, size)
        if picture is not None:
            from train.figures.section import draw_section

            draw_section(config, found, at, picture)
    walls = _walls(beam, size)
    if as_json:
        content = {each.name: np.asarray(getattr(found, each.name)).tolist() for each in fields(found)}
        print_json({"preset": preset, "at": at, "size": size, "walls": walls, **content})
        return
    _print(found, walls)


def _walls(beam: Any, size: float) -> list[dict[str, Any]]:
    rows = []
    for wall in beam.section.wall_names:
        lengths = [float(chain.lengths[[name == wall for name in chain.walls]].sum()) for chain in beam.section.chains]
        plies = beam.layup.plies(wall)
        angles, uniform = [ply.angle_deg for ply in plies], [ply.uniform is not None for ply in plies]
        row = {"wall": wall, "length": size * sum(lengths), "thickness": beam.section.thickness_of(wall), "ply_angles_deg": angles}
        rows.append(row if all(uniform) else {**row, "graded": [not each for each in uniform]})
    return rows


def _print(found: Any, walls: list[dict[str, Any]]) -> None:
    columns = (Column("wall", words=True), Column("length,\nmm"), Column("thickness,\nmm"), Column(PLIES, words=True))
    rows = [[row["wall"], f"{1e3 * row['length']:.4g}", f"{1e3 * row['thickness']:.4g}", _plies(row)] for row in walls]
    show_table(columns, rows, "Walls")
    diagonal = np.diag(found.stiffness)
    rows = [
        [*each[:2], f"{value:.5g}", each[2]] for each, value in zip(zip(ROWS, MEANING, UNITS, strict=True), diagonal, strict=True)
    ]
    scale = np.sqrt(np.outer(diagonal, diagonal))
    for one, other in zip(*np.triu_indices(len(ROWS), 1), strict=True):
        if abs(found.stiffness[one, other]) > SEEN * scale[one, other]:
            rows.append(
                [f"{ROWS[one]} {ROWS[other]}", "coupling", f"{found.stiffness[one, other]:.5g}", _unit(int(one), int(other))]
            )
    columns = (Column("", words=True), Column("meaning", words=True), Column("value"), Column("unit", words=True))
    show_table(columns, rows, "Stiffness, transverse shear with it")
    classical = np.diag(found.classical_stiffness)
    names = zip(("EA", "EI flap", "EI lag", "GJ"), classical, ("N", "N m²", "N m²", "N m²"), strict=True)
    note("no transverse force: " + ", ".join(f"{name} {value:.5g} {unit}" for name, value, unit in names))
    centres = (("tension", found.tension_centre), ("shear", found.shear_centre), ("mass", found.mass_centre))
    places = ", ".join(f"{name} centre ({_millimetres(x)}, {_millimetres(y)}) mm" for name, (x, y) in centres)
    note(f"{places}; {found.mass_per_length:.4g} kg/m")


def _plies(row: dict[str, Any]) -> str:
    """Angles from the inside outwards."""
    angles = row["ply_angles_deg"]
    graded = row.get("graded", [False] * len(angles))
    return ", ".join("graded" if each else f"{angle:g}" for angle, each in zip(angles, graded, strict=True))


def _unit(one: int, other: int) -> str:
    """Of a coupling, from the powers of the metre of both rows."""
    return ("N", "N m", "N m²")[sum(UNITS[k] != "N" for k in (one, other))]


def _millimetres(metres: float) -> str:
    return f"{round(1e3 * metres, 3) + 0.0:g}"
