"""A name that there is not is told before anything heavy is imported."""

import os
import subprocess
import sys

import pytest

from baselines.placement import METHODS
from beamenv.blade.presets import PRESETS
from beamenv.scenarios.scenario import SCENARIOS
from train.cli import names
from train.export import FORMATS, PRECISIONS
from train.reproduce.catalogue import NAMES

TYPOS = {
    "frequencies --preset thesiss": "(did you mean thesis",
    "section --preset thesiss": "(did you mean thesis",
    "evaluate lqgg": "(did you mean lqg",
    "evaluate lqg --scenario delai": "(did you mean delay",
    "evaluate lqg --blade no.toml": "no.toml",
    "evaluate lqg --plant no.npz": "no.npz",
    "compare --scenario storm": "'storm'",
    "train ppoo": "(did you mean ppo",
    "train ppo --scenario generalst": "(did you mean generalist",
    "train ppo --device tpu": "'tpu'",
    "train ppo --recipe no.toml": "no.toml",
    "train ppo --from nowhere": "'nowhere'",
    "tune saac": "(did you mean sac",
    "tune sac --space no.toml": "no.toml",
    "record residul": "(did you mean residual",
    "export lqg --format d": "one of c, onnx, mat.",
    "export lqg --precision triple": "one of double, single.",
    "benchmark --scenario opn": "(did you mean open",
    "benchmark --controller mpcc": "(did you mean mpc",
    "benchmark --submit robust_lqg": "(did you mean robust-lqg",
    "benchmark --model no.zip --trust": "no.zip",
    "reproduce table-3.44": "(did you mean table-3.4",
    "place --preset thesiss": "(did you mean thesis",
    "place --method qp": "(did you mean sqp",
    "list controler": "(did you mean controllers?)",
    "schema bladee": "(did you mean blade?)",
    "explore --preset thesiss": "(did you mean thesis",
    "identify no.csv": "no.csv",
    "evaluat lqg": "Did you mean 'evaluate'?",
}
HEAVY = ("scipy", "torch", "matplotlib", "plotly", "baselines", "beamenv.blade", "beamenv.structure", "dash", "ray")

CALL = """
import sys
from train.cli.app import app
for words in sys.argv[1:]:
    try:
        app(words.split())
    except SystemExit as end:
        assert end.code == 2, words
print(*[name for name in {heavy} if name in sys.modules])
"""


def test_typos_are_told_in_one_line_each_and_nothing_heavy_is_imported(tmp_path):
    code = CALL.format(heavy=HEAVY)
    path = os.pathsep.join(path for path in sys.path if path)
    ended = subprocess.run(  # noqa: S603 - our own
        [sys.executable, "-c", code, *TYPOS], capture_output=True, text=True, cwd=tmp_path, env=os.environ | {"PYTHONPATH": path}
    )
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.split() == []
    lines = ended.stderr.splitlines()
    assert len(lines) == len(TYPOS)
    for (words, told), line in zip(TYPOS.items(), lines, strict=True):
        assert line.startswith("beamenv: "), words
        assert told in line, words
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("told", "there"),
    [
        (names.PRESETS, tuple(PRESETS)),
        (sorted(names.SCENARIOS), sorted(SCENARIOS)),
        (names.STUDIES, NAMES),
        (names.METHODS, tuple(METHODS)),
        (names.FORMATS, tuple(FORMATS)),
        (names.PRECISIONS, PRECISIONS),
    ],
)
def test_names_that_are_checked_are_those_that_there_are(told, there):
    assert told == there
