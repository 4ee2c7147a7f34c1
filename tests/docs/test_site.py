"""The site builds without a warning and asks for nothing from the net."""

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

FAR = r"""["']?(?:https?:)?//"""
LOADED_BY_PAGES = re.compile(rf"<(?:script|img|iframe)[^>]+src={FAR}|<link[^>]+rel=.(?:stylesheet|preconnect)[^>]+href={FAR}")
LOADED_BY_SHEETS = re.compile(rf"(?:url\(|@import ){FAR}")

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(importlib.util.find_spec("material") is None, reason="mkdocs-material is not installed"),
]


@pytest.fixture(name="site", scope="module")
def _site(tmp_path_factory):
    target = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--site-dir", str(target)]
    done = subprocess.run(command, cwd=ROOT, env={**os.environ, "NO_MKDOCS_2_WARNING": "1"}, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return target


def test_no_page_loads_anything_from_the_net(site):
    pages, sheets = list(site.rglob("*.html")), list(site.rglob("*.css"))
    assert len(pages) > 15
    assert sheets
    for page in pages:
        assert not LOADED_BY_PAGES.search(page.read_text(encoding="utf-8")), page
    for sheet in sheets:
        assert not LOADED_BY_SHEETS.search(sheet.read_text(encoding="utf-8")), sheet


def test_every_scenario_every_command_and_every_example_has_its_place(site):
    scenarios = (site / "scenarios.html").read_text(encoding="utf-8")
    assert all(file.stem in scenarios for file in (ROOT / "beamenv" / "scenarios" / "named").glob("*.toml"))
    assert all((site / "examples" / f"{file.stem}.html").is_file() for file in (ROOT / "examples").glob("[0-9]*.py"))
    assert "beamenv frequencies" in (site / "cli.html").read_text(encoding="utf-8")


def test_the_environments_page_is_its_docstring(site):
    page = (site / "environment.html").read_text(encoding="utf-8")
    assert all(f">{title}<" in page for title in ("Action Space", "Observation Space", "Rewards", "Episode End"))
