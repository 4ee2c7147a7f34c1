"""Doors of the command line: every option of every command, in this process, where the work itself is left out or small."""

import os
import shutil
import warnings
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path

import plotly.graph_objects
import pytest
import torch
from hypothesis import strategies as st
from typer.testing import CliRunner

from tests.fuzz.command_words import COMMANDS
from tests.fuzz.meaning import Kind
from tests.fuzz.oracle import Door
from train.cli.app import app

for _room in (
    "comparison.page",
    "comparison.compare",
    "datasets",
    "explore.server",
    "learning.job",
    "tuning.tuning",
    "benchmark.campaign",
    "benchmark.showing.heat_map",
    "benchmark.showing.page",
    "figures.paper_heat_map",
    "figures.screen_heat_map",
    "figures.section",
    "identification.files",
    "placement.front_picture",
    "placement.picture",
):
    import_module(f"train.{_room}")  # what they import sets itself up, once
plotly.graph_objects.Figure()  # and this when the first figure is made

BLADE = 'model = "thesis"\nmodes = 3\n[beam]\nterms = 4\n[patches]\nactuators = 2\nsensors = 2\n'
MEASURED = "time,u1,y1 [A]\n" + "".join(f"{0.001 * k:.3f},{k * k % 17},{k * k % 13}\n" for k in range(240))
WORDS = (
    *("no", "false", "nan", "inf", "-1", "0", "1", "2", "3", "2.5", "1e400", "1_0", "0x10", "10**9", "99999999999999999999", "x"),
    *("--", "-", "=", ".", "..", "/", "~", "*", "None", "null", "true", "é", "{}", "[1]", "", " ", "a\nb", "\ud800", "x" * 5000),
    *("/dev/null", "/dev/full", "/proc/x", "no.toml", "no.json", "blade.toml", "broken.toml", "broken.json", "folder", "nowhere/x"),
    *("--help", "thesis", "nominal", "rotor", "lqg", "none", "gradient", "127.0.0.1", "::1", "0.0.0.0", "8050", "70000"),
)
WORD = Kind("word", lambda value: value, st.one_of(st.sampled_from(WORDS), st.text(max_size=5)))


OTHER_NAMES = (
    *(
        "path",
        "file",
        "controller",
        "agent",
        "recipe",
        "folder",
        "kind",
        "model",
        "name",
        "studies",
        "teacher",
        "minutes",
        "updates",
    ),
    *("ption", "argument", "command", "json", "held_back", "drive_limit"),
)
"""What sentences call arguments that have no option's name."""


class Reached(ValueError):
    """The work begins."""


def reached(*given, **named):
    """In place of long work: all has been read and checked."""
    raise Reached("the work begins.")


@contextmanager
def work_left_out(names):
    with warnings.catch_warnings(), pytest.MonkeyPatch.context() as patch, torch.random.fork_rng():  # a training seeds it
        for name in names:
            patch.setattr(name, reached)
        settings = dict(os.environ)
        yield
        os.environ.clear()
        os.environ.update(settings)


def invoked(command):
    """The command with words in place of some options: what its shell is told."""
    positional, options, flags, left_out = COMMANDS[command]

    def call(**words):
        given = [words[f"argument {k}"] for k in range(len(positional)) if words.get(f"argument {k}") is not None]
        for name in options:
            if words.get(name) is not None:
                given += [name, words[name]]
        given += [flag for flag in flags if words.get(flag)]
        if words.get("more") is not None:
            given.append(words["more"])
        Path("blade.toml").write_text(BLADE)
        Path("measured.csv").write_text(MEASURED)
        Path("broken.toml").write_text("[")
        Path("broken.json").write_text("{")
        Path("folder").mkdir(exist_ok=True)
        before = files()
        with work_left_out(left_out):
            result = CliRunner().invoke(app, [command.split()[0], *given])
        untouched = files() == before
        for each in Path.cwd().iterdir():
            shutil.rmtree(each) if each.is_dir() else each.unlink()
        return judged(result, untouched)

    kinds = {
        **{f"argument {k}": WORD for k in range(len(positional))},
        **dict.fromkeys(options, WORD),
        **dict.fromkeys(flags, Kind("flag", bool, st.booleans())),
        "more": Kind("more", lambda value: value, st.sampled_from(["--colour", "--", "x", "-x", "--json=3", "--episodes"])),
    }
    valid = {**{f"argument {k}": word for k, word in enumerate(positional)}, **options, **dict.fromkeys(flags, False), "more": None}
    return Door(f"beamenv {command}", call, kinds, lambda: dict(valid), junk=st.nothing(), plain=False, told=OTHER_NAMES)


def files():
    """What is in the folder: the bytes of each file."""
    return {str(path): path.read_bytes() if path.is_file() else None for path in Path.cwd().rglob("*")}


def judged(result, untouched):
    """Raises what the command line said, if it refused; AssertionError for a traceback, files that a refusal leaves, and noise."""
    error = result.exception
    if isinstance(error, Reached):
        return str(error)
    assert error is None or isinstance(error, SystemExit), f"{type(error).__name__}: {str(error)[:200]}"
    assert "Traceback" not in result.output
    if result.exit_code == 0:
        return result.stdout
    assert result.exit_code == 2, f"status {result.exit_code}: {result.stderr[:200]}"
    lines = [line for line in result.stderr.splitlines() if line.strip()]
    assert len(lines) == 1 and lines[0].startswith("beamenv: "), f"not one line: {result.stderr[:300]!r}"
    said = lines[0].removeprefix("beamenv: ")
    if said == "the work begins.":
        return said
    assert untouched, f"files are not as they were after {said!r}"
    raise ValueError(said)


DOORS = [invoked(command) for command in COMMANDS]
