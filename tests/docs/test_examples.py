"""Every example runs to its end: each asserts the numbers that it tells."""

import re
import runpy
from pathlib import Path

import numpy as np
import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
SLOW = {"04_train_an_agent", "07_rllib"}
PACKAGES = {"03_placement": "matplotlib", "04_train_an_agent": "torch", "06_clone_from_data": "minari", "07_rllib": "ray.rllib"}
PACKAGES |= {"08_ppo_on_a_gpu": "torch"}


@pytest.mark.parametrize(
    "script",
    [pytest.param(path.stem, marks=[pytest.mark.slow] if path.stem in SLOW else []) for path in sorted(EXAMPLES.glob("[0-9]*.py"))],
)
def test_example_runs_and_its_numbers_hold(script, monkeypatch, capsys):
    if script in PACKAGES:
        pytest.importorskip(PACKAGES[script])
    if script == "03_placement":
        import matplotlib.pyplot as plt

        monkeypatch.setattr(plt, "show", lambda: plt.close("all"))
    runpy.run_path(str(EXAMPLES / f"{script}.py"))
    if script == "02_lqg":
        page = (EXAMPLES.parent / "docs" / "lqg.md").read_text(encoding="utf-8")
        told = re.search(r"([\d.]+) µJ by the equations,\s+([\d.]+) ± ([\d.]+) µJ measured", page).groups()
        printed = re.search(r"= ([\d.]+) µJ\n.*measured: ([\d.]+) ± ([\d.]+) µJ", capsys.readouterr().out, re.DOTALL).groups()
        np.testing.assert_allclose([float(number) for number in told], [float(number) for number in printed], atol=0.011)


def test_hardware_in_the_loop_runs_without_a_compiler_too(monkeypatch, capsys):
    monkeypatch.setattr("shutil.which", lambda name, *given: None)
    runpy.run_path(str(EXAMPLES / "05_hardware_in_the_loop.py"))
    assert "there and back" in capsys.readouterr().out


@pytest.mark.parametrize("script", sorted(EXAMPLES.glob("[0-9]*.py"), key=str), ids=lambda path: path.stem)
def test_example_opens_with_its_title_and_an_equation(script):
    opening = script.read_text(encoding="utf-8").partition("# %%\n")[0]
    assert opening.startswith("# %% [markdown]\n# # ")
    assert opening.count("# $$") == 2
