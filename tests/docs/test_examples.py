"""Every example runs to its end: each asserts the numbers that it tells."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

from tests.docs.printed import assert_same_words

EXAMPLES = Path(__file__).parents[2] / "examples"
HOOK = runpy.run_path(str(EXAMPLES.parent / "docs" / "hooks" / "examples.py"))
SLOW = {"04_train_an_agent", "07_rllib"}
PACKAGES = {"03_placement": "matplotlib", "04_train_an_agent": "torch", "06_clone_from_data": "minari", "07_rllib": "ray.rllib"}
PACKAGES |= {"08_ppo_on_a_gpu": "torch"}


TIMES = re.compile(r"there and back|voltages within|^ *[\d.]+ s,|J over LQG's")
"""Lines that tell how long something took or how little is left of rounding: another run has other ones."""
LEARNT = {"04_train_an_agent", "06_clone_from_data", "07_rllib"}
"""Whose numbers a training has made: another machine's sums lead it elsewhere. Words are compared; the rest they assert."""


@pytest.mark.parametrize(
    "script",
    [pytest.param(path.stem, marks=[pytest.mark.slow] if path.stem in SLOW else []) for path in sorted(EXAMPLES.glob("[0-9]*.py"))],
)
def test_example_runs_its_numbers_hold_and_it_prints_what_its_page_shows(script, monkeypatch):
    if script in PACKAGES:
        pytest.importorskip(PACKAGES[script])
    if script == "03_placement":
        import matplotlib.pyplot as plt

        monkeypatch.setattr(plt, "show", lambda: plt.close("all"))
    monkeypatch.setattr("sys.argv", [script])
    file = EXAMPLES / f"{script}.py"
    printed, shown = HOOK["printed_by"](file), HOOK["kept"](file)
    assert printed.keys() == shown.keys()
    for place, text in printed.items():
        lines = ["\n".join(line for line in each.splitlines() if not TIMES.search(line)) for each in (text, shown[place])]
        assert_same_words(*lines, numbers=script not in LEARNT)
    if script == "02_lqg":
        page = (EXAMPLES.parent / "docs" / "lqg.md").read_text(encoding="utf-8")
        told = re.search(r"([\d.]+) µJ by the equations,\s+([\d.]+) ± ([\d.]+) µJ measured", page).groups()
        numbers = re.search(r"= ([\d.]+) µJ\n.*measured: ([\d.]+) ± ([\d.]+) µJ", "".join(printed.values()), re.DOTALL).groups()
        np.testing.assert_allclose([float(number) for number in told], [float(number) for number in numbers], atol=0.011)


def test_a_page_shows_below_each_cell_what_it_printed_and_drew():
    page = HOOK["example_page"](EXAMPLES / "03_placement.py")
    assert "least of 200 places" in page.partition('print(f"slope there')[2].partition("```python")[0]
    (picture,) = re.findall(r"\]\(\.\./(images/examples/[^)]*\.png)\)", page)
    assert (EXAMPLES.parent / "docs" / picture).is_file()


def test_hardware_in_the_loop_runs_without_a_compiler_too(monkeypatch, capsys):
    monkeypatch.setattr("shutil.which", lambda name, *given: None)
    runpy.run_path(str(EXAMPLES / "05_hardware_in_the_loop.py"))
    assert "there and back" in capsys.readouterr().out


@pytest.mark.parametrize("script", sorted(EXAMPLES.glob("[0-9]*.py"), key=str), ids=lambda path: path.stem)
def test_example_opens_with_its_title_and_an_equation(script):
    opening = script.read_text(encoding="utf-8").partition("# %%\n")[0]
    assert opening.startswith("# %% [markdown]\n# # ")
    assert opening.count("# $$") == 2
