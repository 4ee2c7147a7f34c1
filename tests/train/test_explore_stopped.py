"""Work of the explorer that takes long can be stopped, and the next is done as if nothing had been."""

import threading
import time

import pytest

pytest.importorskip("dash", reason="dash is not installed")

from train.explore import app as page  # noqa: E402 - they need the package asked for above
from train.explore.controls import THESIS_PAGE  # noqa: E402
from train.explore.stoppable import Stopped, stop, stoppable  # noqa: E402


def endless(begun):
    begun.set()
    while True:
        time.sleep(0.001)


def stopped_soon(begun):
    begun.wait(30)
    stop()


def test_endless_work_ends_when_it_is_stopped():
    begun = threading.Event()
    threading.Thread(target=stopped_soon, args=(begun,)).start()
    with pytest.raises(Stopped):
        stoppable(lambda: endless(begun))
    assert stoppable(lambda: 3) == 3


def test_an_error_is_raised_where_the_work_was_asked_for():
    with pytest.raises(ZeroDivisionError):
        stoppable(lambda: 1 // 0)


def test_a_stopped_redraw_says_so_and_keeps_what_is_shown(monkeypatch):
    begun = threading.Event()
    with monkeypatch.context() as patched:
        patched.setattr(page, "drawn", lambda *_: endless(begun))
        threading.Thread(target=stopped_soon, args=(begun,)).start()
        said = page.redraw(**THESIS_PAGE.start)
    assert said["message"] == page.STOPPED
    assert said["campbell"] is page.no_update
    assert page.redraw(**THESIS_PAGE.start)["message"] == ""


def test_stopping_when_nothing_is_done_does_nothing():
    stop()
    assert page.stop_all(**THESIS_PAGE.start) == {"stopped": None}
