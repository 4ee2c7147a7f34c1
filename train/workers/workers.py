"""Who does pieces of work that do not depend on each other: this process, others on this machine, or a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from beamenv.configuration import Count, checked
from train.shared.cluster import check_address
from train.shared.threads import one_thread
from train.workers.pool import Piece, Pool, Result, hand_out, no_files


@dataclass(frozen=True, slots=True)
class Workers:
    """How many processes, and whether they are a cluster's. ``ValueError`` for less than one, and where no cluster answers."""

    jobs: int | None = None
    """Pieces in work at a time. If left out one, in this process; on a cluster as many as it has processors."""
    cluster: str | None = None
    """HOST:PORT or ray://HOST:PORT of a Ray cluster, or "local": one that is started here, and ends with the work."""

    def __post_init__(self) -> None:
        if self.jobs is not None:
            object.__setattr__(self, "jobs", checked("jobs", self.jobs, Count()))
        if self.cluster is not None:
            check_address(self.cluster)

    @property
    def alone(self) -> bool:
        """Whether everything stays in this process."""
        return self.cluster is None and self.jobs in (None, 1)

    def at_most(self, pieces: int) -> Workers:
        """No more of this machine's than there are pieces."""
        return self if self.cluster is not None or self.jobs is None else Workers(max(1, min(self.jobs, pieces)))

    def do(
        self,
        work: Callable[[Piece], Result],
        pieces: Iterable[Piece],
        finished: Callable[[Piece, Result], Piece | None],
        files: Callable[[Piece], Iterable[Path]] = no_files,
    ) -> None:
        """``hand_out`` the pieces, or do them here one after another, on one thread as those are."""
        if self.alone:
            for each in pieces:
                piece: Piece | None = each
                while piece is not None:
                    with one_thread():
                        result = work(piece)
                    piece = finished(piece, result)
            return
        waiting = iter(pieces)
        for first in waiting:  # nobody is called for nothing
            with self.pool() as pool:
                hand_out(pool, work, chain([first], waiting), finished, files)

    @contextmanager
    def pool(self) -> Iterator[Pool]:
        """To hand pieces to; its processes end with this block, and what they are at is lost."""
        if self.cluster is None:
            from train.workers.processes import processes

            with processes(self.jobs or 1) as here:
                yield here
        else:
            from train.workers.cluster import cluster

            with cluster(self.cluster, self.jobs) as there:
                yield there
