"""One thread for linear algebra: more would only be in each other's way."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

ONE_THREAD = {f"{library}_NUM_THREADS": "1" for library in ("OMP", "OPENBLAS", "MKL", "VECLIB_MAXIMUM")}
"""Environment of a process with one thread: BLAS reads these when NumPy is imported."""


@contextmanager
def one_thread() -> Iterator[None]:
    """Within it the linear algebra that is imported already works on one thread, and so to the same last bit on any machine."""
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        yield


@contextmanager
def one_torch_thread() -> Iterator[None]:
    """Within it torch works on one thread: small networks lose by more, and on a busy machine a hundredfold."""
    import torch

    threads = torch.get_num_threads()
    torch.set_num_threads(1)
    try:
        yield
    finally:
        torch.set_num_threads(threads)
