"""The documentation's pictures of sections: four blades of the examples in one, each of them for the gallery, the tutorial's blade.

``python -m train.tools.sections`` writes ``sections.png``, ``gallery/…`` and ``airfoil-section.png`` into ``docs/images``, or the
folder that is its argument, each with another beside it for dark pages.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any

from beamenv.blade.config import BladeConfig
from beamenv.blade.files import from_dict, load_config
from beamenv.configuration.files import parsed_table
from train.figures.paper import save_themes, styled
from train.figures.section import LEGEND, draw_on, elements_of, section_figure

FOLDER, BLADES, TUTORIAL = Path("docs/images"), Path("examples/blades"), Path("docs/tutorials/airfoil-blade.md")
NAMES = ("airfoil-two-webs", "two-cell-box", "channel", "round-tube")
SIZE = (8.4, 3.9)
"""Inches, of which a README is 8.4 wide."""


def sections_figure(blades: Mapping[str, BladeConfig], theme: str = "light") -> Any:
    """Wide sections above one another, beside them the others; one legend for all."""
    import matplotlib.pyplot as plt

    with styled(theme):
        figure = plt.figure(figsize=SIZE, layout="constrained")
        places = figure.add_gridspec(2, 3, width_ratios=(2.1, 1.0, 1.3))
        spots = (places[0, 0], places[1, 0], places[:, 1], places[:, 2])
        for (name, config), place in zip(blades.items(), spots, strict=True):
            axis = figure.add_subplot(place)
            beam = config.beam.build(model=config.model)
            found = beam.section.properties(beam.layup, 1.0)
            draw_on(axis, config, found, elements_of(config, 0.0), theme)
            axis.set(title=name.replace("-", " "), xlabel="x, mm")
        entries = dict(zip(*reversed(axis.get_legend_handles_labels()), strict=True))
        figure.legend(handles=list(entries.values()), loc="outside lower center", **LEGEND)
    return figure


def tutorial_blade() -> BladeConfig:
    """The blade that the tutorial's first block writes into a file."""
    text = TUTORIAL.read_text(encoding="utf-8")
    content = text.partition('write_text("""\\\n')[2].partition('""")')[0]
    return from_dict(parsed_table(content, str(TUTORIAL)))


def at_the_root(config: BladeConfig, theme: str) -> Any:
    """The figure that ``beamenv section`` draws."""
    beam = config.beam.build(model=config.model)
    return section_figure(config, beam.section.properties(beam.layup, 1.0), 0.0, theme)


def write_sections(folder: Path) -> None:
    """All pictures, each whole or not at all."""
    blades = {name: load_config(BLADES / f"{name}.toml") for name in NAMES}
    save_themes(lambda theme: sections_figure(blades, theme), folder / "sections.png")
    alone = {f"gallery/{file.stem}": load_config(file) for file in sorted(BLADES.glob("*.toml"))}
    for name, config in {**alone, "airfoil-section": tutorial_blade()}.items():
        save_themes(partial(at_the_root, config), folder / f"{name}.png", tight=True)


if __name__ == "__main__":
    write_sections(Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER)
