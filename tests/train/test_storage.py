"""Files are written whole or not at all."""

import csv
import errno
import io
import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from beamenv.configuration.writing import write_whole
from train.controllers.policies import RecurrentPolicy
from train.controllers.policy_files import save_policy
from train.shared.files import check_file, check_folder, write_csv, write_json
from train.shared.lock import alone_in


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
    check_folder(tmp_path / "absent" / "deeper")
    check_file(tmp_path / "absent" / "picture.png", "picture")
    (tmp_path / "note").write_text("")
    with pytest.raises(ValueError, match="folder = .*note' must be a folder, or not be there yet, but is a file"):
        check_folder(tmp_path / "note")
    with pytest.raises(ValueError, match="folder = .*deeper' must be a folder, or not be there yet, but .*note' is a file"):
        check_folder(tmp_path / "note" / "deeper")
    with pytest.raises(ValueError, match="picture = .*note' must be a folder"):
        check_file(tmp_path / "note" / "picture.png", "picture")
    with pytest.raises(ValueError, match="picture = .* must be a file, or not be there yet, but is a folder"):
        check_file(tmp_path, "picture")
    for name in ("a" * 300, "a\0b"):
        with pytest.raises(ValueError, match="cannot be looked at|must be a folder"):
            check_folder(tmp_path / name)
    assert names(tmp_path) == ["note"]


def refused_by_the_system(number):
    def refuse(*_, **__):
        raise OSError(number, os.strerror(number))

    return refuse


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EACCES, errno.EROFS, errno.EDQUOT])
def test_a_folder_that_cannot_be_written_in_is_told_before_work_begins(tmp_path, monkeypatch, number):
    with monkeypatch.context() as patched:
        patched.setattr(Path, "write_bytes", refused_by_the_system(number))
        with pytest.raises(ValueError, match=f"folder = .* must be a folder that can be written in: {os.strerror(number)}"):
            check_folder(tmp_path / "results")
    assert names(tmp_path) == []


def test_a_disk_that_is_nearly_full_is_told_before_work_begins(tmp_path, monkeypatch):
    monkeypatch.setattr("train.shared.files.shutil.disk_usage", lambda _: SimpleNamespace(free=500_000))
    with pytest.raises(ValueError, match="folder = .* must have 16 MB free on its disk, but has 0.5"):
        check_folder(tmp_path)


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EIO])
def test_a_disk_that_fills_up_leaves_the_old_file_and_no_part_of_the_new(tmp_path, monkeypatch, number):
    path = tmp_path / "table.md"
    write_whole(path, "old")

    class Full(io.BytesIO):
        write = refused_by_the_system(number)

    def full(handle, _):
        os.close(handle)
        return Full()

    with monkeypatch.context() as patched:
        patched.setattr("beamenv.configuration.writing.os.fdopen", full)
        with pytest.raises(OSError, match=os.strerror(number)):
            write_whole(path, "new")
    assert (path.read_text(), names(tmp_path)) == ("old", ["table.md"])


def test_what_a_killed_process_had_begun_to_write_is_removed_by_the_next(tmp_path):
    begun = [tmp_path / "cells" / ".lqg.json.0123abcd.part", tmp_path / ".table.md.89abcdef.part"]
    others = [tmp_path / ".hidden.part", tmp_path / "table.part", tmp_path / ".table.md"]
    begun[0].parent.mkdir()
    for path in (*begun, *others):
        path.write_text("half")
    with alone_in(tmp_path):
        assert not any(path.exists() for path in begun)
        assert all(path.exists() for path in others)


def test_a_folder_is_one_s_alone_and_its_lock_leaves_nothing(tmp_path):
    folder = tmp_path / "results" / "mine"
    with alone_in(folder):
        taken = f"folder = .*mine' is in use by process {os.getpid()}: wait until that has ended"
        with pytest.raises(ValueError, match=taken), alone_in(folder):
            pass
        with alone_in(tmp_path / "other"):
            pass
    with alone_in(folder):
        (folder / "note").write_text("kept")
    assert names(tmp_path) == ["results"]
    assert names(folder) == ["note"]


HOLDS = """
import sys
from pathlib import Path
from train.shared.lock import alone_in
with alone_in(Path(sys.argv[1])):
    print("held", flush=True)
    sys.stdin.read()
"""


@pytest.mark.skipif(os.name != "posix", reason="it is killed")
def test_the_lock_of_a_process_that_was_killed_holds_nobody(tmp_path):
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).resolve().parents[2])}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
    with subprocess.Popen([sys.executable, "-c", HOLDS, str(tmp_path)], env=environment, **pipes) as holder:
        assert holder.stdout.readline() == "held\n"
        with pytest.raises(ValueError, match=f"is in use by process {holder.pid}"), alone_in(tmp_path):
            pass
        holder.kill()
    assert names(tmp_path) == [".in-use"]
    with alone_in(tmp_path):
        pass
    assert names(tmp_path) == []


@pytest.mark.skipif(os.name != "posix", reason="permissions are POSIX's")
def test_a_file_may_be_read_by_whom_the_umask_lets(tmp_path):
    write_whole(tmp_path / "page.html", "")
    (tmp_path / "plain").write_text("")
    assert (tmp_path / "page.html").stat().st_mode == (tmp_path / "plain").stat().st_mode


@pytest.mark.skipif(os.name != "posix", reason="permissions are POSIX's")
@pytest.mark.parametrize(("umask", "mode"), [(0o022, 0o644), (0o077, 0o600), (0o002, 0o664)])
def test_a_new_file_has_the_permissions_of_the_umask_and_a_replaced_one_keeps_its_own(tmp_path, umask, mode):
    before = os.umask(umask)
    try:
        write_whole(tmp_path / "new", "")
        write_whole(tmp_path / "private", "secret")
        (tmp_path / "private").chmod(0o640)
        write_whole(tmp_path / "private", "replaced")
    finally:
        os.umask(before)
    assert (tmp_path / "new").stat().st_mode & 0o777 == mode
    assert (tmp_path / "private").stat().st_mode & 0o777 == 0o640


@pytest.mark.skipif(os.name != "posix", reason="links and devices are POSIX's")
def test_a_link_stays_and_a_device_is_written_to(tmp_path):
    (tmp_path / "there").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "there" / "page.html")
    write_whole(tmp_path / "link", "page")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "there" / "page.html").read_text() == "page"
    os.mkfifo(tmp_path / "pipe")
    reader = os.open(tmp_path / "pipe", os.O_RDONLY | os.O_NONBLOCK)
    write_whole(tmp_path / "pipe", "told")
    assert os.read(reader, 10) == b"told"
    os.close(reader)
    assert (tmp_path / "pipe").is_fifo()
