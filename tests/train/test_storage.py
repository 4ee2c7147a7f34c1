"""Files are written whole or not at all."""

import csv
import os

import numpy as np
import pytest

from beamenv.configuration.writing import write_whole
from train.controllers.policies import RecurrentPolicy
from train.controllers.policy_files import save_policy
from train.shared.files import check_folder, write_csv, write_json


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_a_file_is_replaced_and_its_folder_made(tmp_path):
    path = tmp_path / "new" / "note.txt"
    write_whole(path, "µm")
    write_whole(path, b"shorter")
    assert path.read_bytes() == b"shorter"
    assert names(path.parent) == ["note.txt"]


@pytest.mark.parametrize("interruption", [KeyboardInterrupt, OSError])
@pytest.mark.parametrize("call", ["replace", "fdopen"])
def test_an_interrupted_write_leaves_the_old_file_whole_and_no_litter(tmp_path, monkeypatch, call, interruption):
    path = tmp_path / "table.md"
    write_whole(path, "old")
    kept = getattr(os, call)

    def interrupt(first, *arguments):
        if call == "fdopen":
            kept(first, *arguments).close()
        raise interruption

    monkeypatch.setattr(f"beamenv.configuration.writing.os.{call}", interrupt)
    with pytest.raises(interruption):
        write_whole(path, "new")
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert names(tmp_path) == ["table.md"]


def test_json_that_is_no_json_leaves_the_old_file(tmp_path):
    path = tmp_path / "content.json"
    write_json(path, {"cost": 1.0})
    before = path.read_text()
    with pytest.raises(ValueError, match="JSON"):
        write_json(path, {"cost": float("nan")})
    assert path.read_text() == before
    assert names(tmp_path) == ["content.json"]


def test_a_table_without_rows_has_its_columns(tmp_path):
    write_csv(tmp_path / "empty.csv", [], ["elapsed", "cost"])
    write_csv(tmp_path / "full.csv", [{"elapsed": 1.0, "cost": 0.5}])
    assert (tmp_path / "empty.csv").read_text() == "elapsed,cost\n"
    with (tmp_path / "full.csv").open() as file:
        assert list(csv.DictReader(file)) == [{"elapsed": "1.0", "cost": "0.5"}]


def test_an_agent_half_saved_is_no_agent(tmp_path, monkeypatch):
    one = np.ones(1, np.float32)
    monkeypatch.setattr("train.controllers.policy_files.write_json", lambda *_: (_ for _ in ()).throw(KeyboardInterrupt))
    with pytest.raises(KeyboardInterrupt):
        save_policy(RecurrentPolicy("half", {"bias_out": one}, {}, -one, one), tmp_path)
    assert names(tmp_path) == ["weights.npz"]


def test_a_file_in_the_folder_s_place_is_told_before_work_begins(tmp_path):
    check_folder(tmp_path)
    check_folder(tmp_path / "absent")
    (tmp_path / "note").write_text("")
    with pytest.raises(ValueError, match="folder = .*note' must be a folder"):
        check_folder(tmp_path / "note")


@pytest.mark.skipif(os.name != "posix", reason="permissions are POSIX's")
def test_a_file_may_be_read_by_whom_the_umask_lets(tmp_path):
    write_whole(tmp_path / "page.html", "")
    (tmp_path / "plain").write_text("")
    assert (tmp_path / "page.html").stat().st_mode == (tmp_path / "plain").stat().st_mode
