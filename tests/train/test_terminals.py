"""The command line on terminals of every kind: narrow, without Unicode, or gone."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

RUN = [sys.executable, "-c", "from train.cli.command import main; main()"]


def beamenv(*arguments, encoding="utf-8", columns="80"):
    changed = {"PYTHONIOENCODING": encoding, "COLUMNS": columns}
    return subprocess.run(RUN + list(arguments), capture_output=True, env=os.environ | changed, check=False)  # noqa: S603 - our own


@pytest.mark.parametrize(("encoding", "degrees"), [("ascii", "by 15.1?"), ("latin-1", "by 15.1°")])
def test_a_terminal_that_lacks_a_letter_shows_a_question_mark(encoding, degrees):
    shown = beamenv("frequencies", encoding=encoding)
    assert shown.returncode == 0
    assert not shown.stderr
    assert degrees in shown.stdout.decode(encoding)


def test_no_number_is_cut_off_on_a_narrow_terminal():
    narrow, wide = (beamenv("frequencies", columns=columns).stdout.decode() for columns in ("20", "200"))
    shown = [sorted(word for word in text.split() if word.replace(".", "").isdigit() and "." in word) for text in (narrow, wide)]
    assert shown[0] == shown[1] and len(shown[0]) > 10
    assert "…" not in narrow


def test_a_warning_is_a_sentence_of_the_command(tmp_path):
    path = tmp_path / "blade.toml"
    path.write_text("[beam]\npretwist_deg = 0.5236\n")
    shown = beamenv("frequencies", "--blade", str(path))
    assert shown.returncode == 0
    sentence = "beamenv: blade.beam.pretwist_deg is taken for 0.5236 degrees; if these are radians, give 30.\n"
    assert shown.stderr.decode() == sentence


def test_a_reader_that_has_gone_ends_a_command_quietly():
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "wb") as output:
        ended = subprocess.run([*RUN, "schema", "blade"], stdout=output, stderr=subprocess.PIPE, check=False)  # noqa: S603 - our own
    assert ended.returncode == 1
    assert ended.stderr == b""
