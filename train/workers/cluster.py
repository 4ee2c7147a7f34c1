"""Workers that are Ray's: on this machine, or on those of a cluster."""

from __future__ import annotations

import logging
import os
import signal
import socket
import threading
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from beamenv.configuration import Refused
from train.shared.threads import ONE_THREAD
from train.workers import arrival
from train.workers.node import opened, terms
from train.workers.parcel import packed
from train.workers.pool import DIED, Lost
from train.workers.workers import LOCAL, address_of

PATIENCE = 5.0
"""Seconds within which an address must answer."""

STORE = 200_000_000
"""Bytes of memory for results on their way, of a cluster that is started here."""

QUIETLY = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_NUM_REDIS_GET_RETRIES": "1"}
"""Settings of Ray's unless they are set otherwise: report to nobody, and try an address once."""


@contextmanager
def cluster(address: str, jobs: int | None) -> Iterator[Cluster]:
    """Workers of the cluster at an address; ``ValueError`` of one sentence if there is none.

    A connection to Ray that this process has already is used, and stays.
    """
    for name, value in QUIETLY.items():
        os.environ.setdefault(name, value)
    import ray

    joined = not ray.is_initialized()
    if joined:
        _join(ray, address, jobs)
    pool = Cluster(ray, jobs)
    try:
        yield pool
    finally:
        pool.end()
        if joined:
            ray.shutdown()


def _join(ray: Any, address: str, jobs: int | None) -> None:
    """Connect, or start one here."""
    place = address_of(address)
    if place is not None:
        _check_answers(address, place)
    own = {"num_cpus": jobs, "object_store_memory": STORE, "include_dashboard": False} if address == LOCAL else {}
    try:
        with _signals_kept():
            ray.init(address=address, log_to_driver=False, logging_level=logging.ERROR, **own)
    except Exception as error:  # noqa: BLE001 - Ray has many, of no common class
        raise Refused("cluster", address, f"a Ray cluster that can be joined: {_clause(error)}") from None


def _check_answers(address: str, place: tuple[str, int]) -> None:
    """Ray itself would try for minutes."""
    try:
        socket.create_connection(place, PATIENCE).close()
    except OSError as error:
        raise Refused("cluster", address, f"the address of a Ray cluster that answers: {error.strerror or error}") from None


@contextmanager
def _signals_kept() -> Iterator[None]:
    """Ray sets a handler of its own for the signal to end."""
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)


def _clause(error: Exception) -> str:
    """The first sentence of what Ray says."""
    words = " ".join(str(error).split()) or type(error).__name__
    return words.partition(". ")[0].rstrip(".")


class Cluster:
    """Tasks of Ray's on a processor each, and on one thread. They are not retried by Ray: ``hand_out`` does that."""

    def __init__(self, ray: Any, jobs: int | None) -> None:
        ray.cloudpickle.register_pickle_by_value(arrival)
        self._ray, self._jobs = ray, jobs
        self._task = ray.remote(arrival.arrived).options(num_cpus=1, max_retries=0, runtime_env={"env_vars": ONE_THREAD})
        self._begun: dict[Future[Any], Any] = {}

    def room(self) -> int:
        """Two a processor, so that none waits for the next, however many join meanwhile; or as many as were asked for."""
        return self._jobs or max(2, 2 * int(self._ray.cluster_resources().get("CPU", 1)))

    def submit(self, work: Callable[[Any], Any], piece: Any, files: Iterable[Path]) -> Future[Any]:
        """Send a piece with its files."""
        reference = self._task.remote(terms(), packed((work, piece), files), arrival.NOT_INSTALLED)
        future: Future[Any] = reference.future()
        self._begun[future] = reference
        return future

    def result(self, future: Future[Any]) -> Any:
        """What came of it; ``Lost`` if its worker or its machine died."""
        del self._begun[future]
        failures = self._ray.exceptions
        try:
            answer = future.result()
        except (failures.WorkerCrashedError, failures.NodeDiedError, failures.ObjectLostError, failures.OutOfMemoryError):
            raise Lost from None
        except (failures.RayError, CancelledError) as error:
            raise ChildProcessError(f"the cluster failed ({_clause(error)}), {DIED.partition(': ')[2]}") from None
        return opened(answer)

    def renewed(self) -> bool:
        """False: the others go on, and Ray puts another in its place."""
        return False

    def end(self) -> None:
        """Let go of what is begun."""
        for reference in self._begun.values():
            self._ray.cancel(reference, force=True)
        self._begun.clear()
