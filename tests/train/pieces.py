"""Pieces of work for workers, and a controller that kills them: in a file of their own, for workers import it."""

import os
import signal
from concurrent.futures import Future

import numpy as np

from train.workers.pool import Lost


class Mortal:
    """Kills the process that it is in, in mid-episode, while a file is there; counts its beginnings in another."""

    def __init__(self, folder, name):
        self.deadly, self.count = folder / f"{name}.deadly", folder / f"{name}.count"

    def predict(self, observation, state=None, episode_start=None, deterministic=True):
        if state is None:
            with self.count.open("a") as file:
                file.write("x")
        if state == 9 and self.deadly.exists():
            self.deadly.unlink()
            os.kill(os.getpid(), signal.SIGKILL)
        return np.full((len(observation), 4), 0.1 * np.sin(state or 0)), (state or 0) + 1


def kill(piece):
    os.kill(os.getpid(), signal.SIGKILL)


def halved(number):
    if number == 3.0:
        raise ValueError(f"number = {number} is not allowed.")
    return number / 2


def killed_once(stretch):
    """A stretch of a training whose worker is killed after its third update, while a file is there."""
    from train.learning import job  # torch, which other pieces do without
    from train.learning.several import trained_on

    deadly = stretch.home.parent / "deadly"
    if deadly.exists():
        deadly.unlink()
        note = job.Journal.note

        def last_note(journal, progress):
            note(journal, progress)
            if progress.updates == 3:
                os.kill(os.getpid(), signal.SIGKILL)

        job.Journal.note = last_note
    return trained_on(stretch)


def threads(number):
    """How many threads this process' libraries are told to have."""
    return {name: value for name, value in os.environ.items() if name.endswith("_NUM_THREADS")}


class Waiting:
    """A pool in which all pieces are begun before the first is answered, and the worker of the first dies."""

    def __init__(self, together):
        self.begun, self._futures, self._together, self._dies = [], [], together, True

    def room(self):
        return 2

    def submit(self, work, piece, files):
        self.begun.append(piece)
        self._futures.append((Future(), piece))
        if len(self.begun) != 2:  # the second is at work until others are begun
            for future, at in self._futures:
                if not future.done():
                    future.set_result(at)
        return self._futures[-1][0]

    def result(self, future):
        if self._dies:
            self._dies = False
            raise Lost
        return future.result()

    def renewed(self):
        return self._together
