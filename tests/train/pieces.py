"""Pieces of work for workers, and a controller that kills them: in a file of their own, for workers import it."""

import os
import signal

import numpy as np


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
