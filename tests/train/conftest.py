"""A clock that makes training deterministic."""

import itertools
from contextlib import contextmanager
from types import SimpleNamespace

import pytest


@pytest.fixture(scope="session")
def ticking():
    """Within it the trainers' clock goes on by so many seconds whenever it is read: a budget is a number of steps."""

    @contextmanager
    def clock(seconds):
        with pytest.MonkeyPatch.context() as patch:
            for timed in ("gradient", "session"):
                readings = itertools.count()
                patch.setattr(f"train.{timed}.time", SimpleNamespace(monotonic=lambda kept=readings: seconds * next(kept)))
            yield

    return clock
