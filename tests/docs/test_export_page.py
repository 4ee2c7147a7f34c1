"""The page on export names every controller, and declares what the C file declares."""

import re
from pathlib import Path

import pytest

from baselines import reference_lqg
from beamenv.task import resolve_task
from train.controllers.named import discover
from train.controllers.shipped import shipped
from train.export import exported
from train.export.c_source import c_source

PAGE = (Path(__file__).parents[2] / "docs" / "export.md").read_text(encoding="utf-8")


def names_in(table):
    """The names in the first column."""
    rows = re.findall(r"^\| (`.*?) \|", table, flags=re.MULTILINE)
    return {name for row in rows for name in re.findall(r"`([a-z-]+)`", row)} - {"nominal", "failure", "hysteresis"}


def test_page_says_of_every_controller_whether_it_is_written():
    tables = PAGE.partition("\n## Which controllers can be exported\n")[2]
    written, _, not_written = tables.partition("| not exported | because |")
    task, known = resolve_task(), set(discover())
    agents = {each.agent for each in shipped()}
    assert names_in(written) | names_in(not_written) == known | agents
    assert not names_in(written) & names_in(not_written)
    for name in names_in(not_written):
        with pytest.raises(ValueError, match="cannot be exported"):
            exported(discover()[name].build_for(task), task.design_plant)


def test_page_declares_what_the_file_declares():
    design = resolve_task().design
    text = " ".join(c_source(exported(reference_lqg(design.full_plant), design.plant, name="tail")).split())
    (block,) = re.findall(r"^```c\n(.*?)^```$", PAGE, flags=re.MULTILINE | re.DOTALL)
    for line in filter(None, block.splitlines()):
        assert " ".join(line.split()) in text, line
