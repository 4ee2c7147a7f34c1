"""Who does pieces of work that do not depend on each other: this process, others on this machine, or a cluster."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import PurePath
from typing import Any

from beamenv.configuration import Count, Refused, checked
from train.workers.pool import Pool

LOCAL, AUTO = "local", "auto"
CLIENT = "ray://"


@dataclass(frozen=True, slots=True)
class Workers:
    """How many processes, and whether they are a cluster's. ``ValueError`` for less than one, and for no address."""

    jobs: int | None = None
    """Pieces in work at a time. If left out one, in this process; on a cluster as many as it has processors."""
    cluster: str | None = None
    """HOST:PORT or ray://HOST:PORT of a Ray cluster, "auto" for the one that this machine belongs to, or "local": one that is
    started here, and ends with the work."""

    def __post_init__(self) -> None:
        if self.jobs is not None:
            object.__setattr__(self, "jobs", checked("jobs", self.jobs, Count()))
        if self.cluster is not None:
            address_of(self.cluster)

    @property
    def alone(self) -> bool:
        """Whether everything stays in this process."""
        return self.cluster is None and self.jobs in (None, 1)

    def at_most(self, pieces: int) -> Workers:
        """No more of this machine's than there are pieces."""
        return self if self.cluster is not None or self.jobs is None else Workers(max(1, min(self.jobs, pieces)))

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


def address_of(cluster: Any) -> tuple[str, int] | None:
    """Host and port, None of those that have a word; ``ValueError`` for what is no address."""
    if cluster in (LOCAL, AUTO):
        return None
    host, _, port = str(cluster).removeprefix(CLIENT).rpartition(":")
    strange = not isinstance(cluster, str) or len(PurePath(host).parts) != 1 or not all(each.isprintable() for each in host)
    if strange or " " in host or not (port.isascii() and port.isdecimal() and 0 < int(port[:6]) < 65536):
        raise Refused("cluster", cluster, f"{LOCAL}, {AUTO}, HOST:PORT or {CLIENT}HOST:PORT")
    return host.strip("[]"), int(port)
