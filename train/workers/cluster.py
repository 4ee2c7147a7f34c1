"""Workers that are Ray's: on this machine, or on those of a cluster."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import CancelledError, Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from train.shared.cluster import LOCAL, connected
from train.shared.threads import ONE_THREAD
from train.workers import arrival
from train.workers.node import opened, terms
from train.workers.parcel import packed
from train.workers.pool import DIED, Lost


@contextmanager
def cluster(address: str, jobs: int | None) -> Iterator[Cluster]:
    """Workers of the cluster at an address; ``ValueError`` of one sentence if there is none."""
    with connected(address, jobs):
        import ray

        paths = {"PYTHONPATH": os.pathsep.join(each or os.curdir for each in sys.path)} if address == LOCAL else {}
        pool = Cluster(ray, jobs, {**ONE_THREAD, **paths})
        try:
            yield pool
        finally:
            pool.end()


def _clause(error: Exception) -> str:
    """The first sentence of what Ray says."""
    words = " ".join(str(error).split()) or type(error).__name__
    return words.partition(". ")[0].rstrip(".")


class Cluster:
    """Tasks of Ray's on a processor each, and on one thread. They are not retried by Ray: ``hand_out`` does that."""

    def __init__(self, ray: Any, jobs: int | None, environment: Mapping[str, str]) -> None:
        ray.cloudpickle.register_pickle_by_value(arrival)
        self._ray, self._jobs = ray, jobs
        self._task = ray.remote(arrival.arrived).options(num_cpus=1, max_retries=0, runtime_env={"env_vars": dict(environment)})
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
