"""What a kept result depends on, by the names of modules and packages."""

import shutil
from pathlib import Path

import pytest

from train.benchmark import cells
from train.reproduce import runner
from train.shared.digests import ROOT, digest, source_digest, source_files


@pytest.fixture
def copied(tmp_path):
    """A copy of the sources, to be changed."""
    for wing in ("beamenv", "baselines", "train"):
        shutil.copytree(ROOT / wing, tmp_path / wing, ignore=shutil.ignore_patterns("trained", "__pycache__"))
    return tmp_path


def appended(path: Path):
    path.write_text(path.read_text(encoding="utf-8") + "\n# changed\n", encoding="utf-8")


@pytest.mark.parametrize("names", [cells.DEPENDS_ON, runner.DEPENDS_ON], ids=["benchmark", "reproduction"])
def test_every_name_leads_to_files(names):
    assert all(source_files(name) for name in names)
    assert source_digest(names) == source_digest(names)


@pytest.mark.parametrize("change", [Path.unlink, lambda path: path.rename(path.with_name("moved.py"))], ids=["removed", "moved"])
def test_a_module_that_is_not_where_it_is_named_is_told(copied, change):
    change(copied / "train" / "controllers" / "policies.py")
    with pytest.raises(ModuleNotFoundError, match="module 'train.controllers.policies', which kept results depend on, is not in"):
        source_digest(cells.DEPENDS_ON, copied)


@pytest.mark.parametrize(
    ("file", "benchmark", "reproduction"),
    [
        ("train/controllers/policies.py", True, False),
        ("train/controllers/lstm_policy.py", True, False),
        ("train/benchmark/cells.py", True, False),
        ("train/controllers/models.py", True, False),
        ("baselines/laws/lqg.py", True, True),
        ("baselines/identification/order.py", False, True),
        ("beamenv/simulation/blades.py", True, True),
        ("train/reproduce/runner.py", False, True),
        ("train/page/page.py", False, False),
        ("train/benchmark/showing/report.py", False, False),
    ],
)
def test_only_what_decides_results_changes_their_digest(copied, file, benchmark, reproduction):
    before = [source_digest(names, copied) for names in (cells.DEPENDS_ON, runner.DEPENDS_ON)]
    assert before == [source_digest(names) for names in (cells.DEPENDS_ON, runner.DEPENDS_ON)]
    appended(copied / file)
    after = [source_digest(names, copied) for names in (cells.DEPENDS_ON, runner.DEPENDS_ON)]
    assert [one != other for one, other in zip(before, after, strict=True)] == [benchmark, reproduction]


def test_a_digest_tells_where_one_content_ends():
    assert digest(b"ab", b"c") != digest(b"a", b"bc")
    assert len(digest()) == 16
