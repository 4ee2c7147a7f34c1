"""What the pages take from the package when they are built."""

import runpy
from pathlib import Path

import pytest

pytest.importorskip("mkdocs")
pytest.importorskip("typer")

HOOKS = runpy.run_path(str(Path(__file__).parents[2] / "docs" / "hooks.py"))


@pytest.mark.parametrize(
    ("name", "row"),
    [
        ("scenario table", "| `delay` | "),
        ("recipes", "| `gradient` | "),
        ("shipped agents", "| `residual-generalist` | several scenarios at once | 0, 1, 2, 3, 4 | 1552 | 3302 |"),
        ("command line", "## beamenv frequencies"),
        ("gallery", "## Two cell box"),
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
