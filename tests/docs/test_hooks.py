"""What the pages take from the package when they are built."""

import re
import runpy
from pathlib import Path
from types import SimpleNamespace

import pytest

pytest.importorskip("mkdocs")
pytest.importorskip("typer")

HOOKS = runpy.run_path(str(Path(__file__).parents[2] / "docs" / "hooks" / "filling.py"))


ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs").glob("*.md"))


@pytest.mark.parametrize(
    ("name", "row"),
    [
        ("scenario table", "| `delay` | "),
        ("recipes", "| `gradient` | "),
        ("shipped agents", "| `residual-generalist` | several scenarios at once | 0, 1, 2, 3, 4 | 1552 | 3302 |"),
        ("command line", "## beamenv frequencies"),
        ("gallery", "## Two cell box"),
        ("scenario films", "<summary>long-delay</summary>"),
        ("returns", "| `overload` | −42"),
    ],
)
def test_a_page_is_filled_in_where_it_asks_for_it(name, row):
    page = HOOKS["on_page_markdown"](f"before\n\n<!-- {name}: why -->\nstale\n<!-- end -->\n\nbehind")
    assert f"\n{row}" in page
    assert page.startswith("before") and page.endswith("behind")
    assert "<!--" not in page and "stale" not in page


def test_nothing_is_filled_in_elsewhere():
    assert HOOKS["on_page_markdown"]("<!-- another remark -->") == "<!-- another remark -->"


def test_every_mark_is_asked_for_by_a_page():
    pages = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    assert [name for name in HOOKS["FILLED"] if f"\n<!-- {name}: " not in pages] == []


def test_a_reader_of_the_unbuilt_pages_reads_what_a_build_would_put_there():
    """Where this fails, ``python docs/hooks/filling.py`` writes the pages again."""
    stale = [page.name for page in PAGES if HOOKS["written"](text := page.read_text(encoding="utf-8")) != text]
    assert stale == []


ELSEWHERE = runpy.run_path(str(ROOT / "docs" / "hooks" / "changes.py"))


def test_links_to_files_outside_the_pages_lead_to_their_pages():
    page = "[a](../examples/02_lqg.py), [b](../CONTRIBUTING.md#numbers), [c](../CHANGELOG.md), [d](lqg.md)"
    assert (
        ELSEWHERE["on_page_markdown"](page) == "[a](examples/02_lqg.md), [b](contributing.md#numbers), [c](changes.md), [d](lqg.md)"
    )


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


SHOWN = runpy.run_path(str(ROOT / "docs" / "hooks" / "pictures.py"))


def test_a_picture_is_shown_in_the_page_s_colours_and_at_half_of_its_fine_pixels():
    page = SimpleNamespace(file=SimpleNamespace(src_uri="tutorials/airfoil-blade.md"))
    shown = SHOWN["on_page_markdown"]("before ![a](../images/airfoil-section.png){ .wide }, ![b](../images/blade.svg)", page)
    light, dark = re.findall(r"!\[a\]\((\S+)\)\{ \.wide width=(\d+) \}", shown)
    assert [light[0], dark[0]] == ["../images/airfoil-section.png#only-light", "../images/airfoil-section-dark.png#only-dark"]
    assert int(light[1]) == int(dark[1]) and 650 < int(light[1]) < 760
    assert shown.endswith(", ![b](../images/blade.svg)")


def test_every_picture_that_pages_show_has_one_for_dark_pages():
    """But for drawings in colours, and the examples' on transparent ground, that are read on both."""
    missing = []
    for page in sorted((ROOT / "docs").rglob("*.md")):
        for place in re.findall(r"!\[[^\]]*\]\(([^)\s#:]+)", page.read_text(encoding="utf-8")):
            picture = page.parent / place
            if picture.suffix in (".png", ".webp") and not picture.with_stem(f"{picture.stem}-dark").is_file():
                missing.append(place)
    assert missing == []
