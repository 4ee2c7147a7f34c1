"""What the pages take from the package when they are built."""

import runpy
from pathlib import Path

import pytest

pytest.importorskip("mkdocs")
pytest.importorskip("typer")

HOOKS = runpy.run_path(str(Path(__file__).parents[2] / "docs" / "hooks" / "filling.py"))


@pytest.mark.parametrize(
    ("name", "row"),
    [
        ("scenario table", "| `delay` | "),
        ("recipes", "| `gradient` | "),
        ("shipped agents", "| `residual-generalist` | several scenarios at once | 0, 1, 2, 3, 4 | 1552 | 3302 |"),
        ("command line", "## beamenv frequencies"),
        ("gallery", "## Two cell box"),
        ("scenario films", '??? example "long-delay"'),
        ("returns", "| `overload` | −42"),
    ],
)
def test_a_page_is_filled_in_where_it_asks_for_it(name, row):
    page = HOOKS["on_page_markdown"](f"before\n\n<!-- {name} -->\n\nbehind")
    assert f"\n{row}" in page
    assert "<!--" not in page


def test_nothing_is_filled_in_elsewhere():
    assert HOOKS["on_page_markdown"]("<!-- another remark -->") == "<!-- another remark -->"


def test_every_mark_is_asked_for_by_a_page():
    pages = "\n".join(page.read_text(encoding="utf-8") for page in (Path(__file__).parents[2] / "docs").glob("*.md"))
    assert [name for name in HOOKS["FILLED"] if f"<!-- {name} -->" not in pages] == []


NAMES = runpy.run_path(str(Path(__file__).parents[2] / "docs" / "hooks" / "public_names.py"))


def test_every_package_of_the_list_of_public_names_is_there_and_each_name_is_said_to_be_something():
    for package in NAMES["PACKAGES"]:
        homes = NAMES["homes"](package)
        assert set(homes) == set(NAMES["public"](package)), package
        silent = [name for name, home in homes.items() if not NAMES["opening"](home)]
        assert set(silent) <= {"PATCH_MATERIALS", "MATERIALS"}, package


def test_a_public_name_leads_to_the_module_that_defines_it():
    assert NAMES["homes"]("beamenv")["RotatingBeam"] == "beamenv.structure.beam.RotatingBeam"
    assert NAMES["homes"]("beamenv.baselines")["lqg"] == "baselines.laws.lqg.lqg"
    assert NAMES["opening"]("beamenv.ENV_ID") == "`'beamenv/RotatingBeam-v0'`"


def test_public_names_that_the_list_gives_are_those_that_python_gives():
    import importlib

    for package in ("beamenv", "beamenv.structure", "beamenv.baselines", "beamenv.train.export"):
        for name, home in NAMES["homes"](package).items():
            value = getattr(importlib.import_module(package), name)
            module, _, own = home.rpartition(".")
            assert getattr(importlib.import_module(module), own) is value, home
