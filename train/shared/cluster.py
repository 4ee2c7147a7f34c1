"""Ray, on which work goes to other processes and machines: a cluster that runs, or one of this process alone."""

from __future__ import annotations

import logging
import os
import signal
import socket
import threading
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from importlib.util import find_spec
from io import StringIO
from typing import Any

from beamenv.configuration import Refused, clause

LOCAL = "local"
"""In place of an address: the cores of this machine, for as long as this process needs them."""

CLIENT = "ray://"
"""Before the address of a cluster that this machine is no part of."""

ALLOWED = f"{LOCAL}, or the address HOST:PORT of a Ray cluster that runs, or {CLIENT}HOST:PORT from outside it"

PATIENCE = 1.5
"""s, for a machine to answer, and again for Ray there."""

SETTINGS = bytes((0, 0, 0, 4, 0, 0, 0, 0, 0))
"""A frame of HTTP/2 (RFC 9113, 6.5), of no settings; the fourth byte says what it is."""

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + SETTINGS
"""How a client begins where a server of gRPC is, as Ray's are (RFC 9113, 3.4); the server begins with settings too."""

QUIET = {"RAY_USAGE_STATS_ENABLED": "0", "RAY_NUM_REDIS_GET_RETRIES": "1", "RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO": "0"}
"""Ray's environment: it reports to nobody, tries an address once, and leaves what is asked of no GPU its environment."""


@contextmanager
def connected(address: str = LOCAL, cores: int | None = None) -> Iterator[None]:
    """Within it Ray works at an address, or with so many cores of this machine, all if None; it prints nothing.

    A connection that this process has already is used, whatever the address, and stays, and says what it said. Raises
    ``ValueError`` of one sentence if no cluster answers at the address.
    """
    check_address(address)
    os.environ |= {name: value for name, value in QUIET.items() if name not in os.environ}
    import ray

    if ray.is_initialized():
        yield
        return
    where = {"address": address} if address != LOCAL else {"address": LOCAL, "num_cpus": cores, "include_dashboard": False}
    try:
        with redirect_stdout(StringIO()), redirect_stderr(StringIO()), _handlers_kept():
            ray.init(**where, log_to_driver=False, logging_level=logging.CRITICAL)
    except (OSError, ValueError, RuntimeError, ImportError) as error:  # whatever else answers there
        raise ValueError(f"cluster = {address!r} must be {ALLOWED}, but {clause(error)}.") from None
    with _unheard(ray._private.worker):
        try:
            yield
        finally:
            ray.shutdown()


@contextmanager
def _unheard(worker: Any) -> Iterator[None]:
    """Ray prints of every worker that dies, whatever is asked of it, but for this switch, its debugger's."""
    before = getattr(worker, "_worker_logs_enabled", True)
    worker._worker_logs_enabled = False
    try:
        yield
    finally:
        worker._worker_logs_enabled = before


@contextmanager
def _handlers_kept() -> Iterator[None]:
    """Ray sets a handler of its own for the signal to end."""
    before = signal.getsignal(signal.SIGTERM)
    try:
        yield
    finally:
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGTERM, before)


def check_address(address: Any) -> None:
    """``ValueError`` of one sentence for what is no address, or one where no Ray answers: Ray itself would wait half a minute."""
    if not isinstance(address, str):
        raise Refused("cluster", address, ALLOWED)
    host, _, port = address.removeprefix(CLIENT).rpartition(":")
    if address != LOCAL and not (host and port.isdecimal() and port.isascii() and 0 < int(port[:6]) < 65536):
        raise Refused("cluster", address, ALLOWED)
    if find_spec("ray") is None:
        raise ModuleNotFoundError("No module named 'ray'", name="ray")
    if address == LOCAL:
        return
    try:
        answered = _answered(host.strip("[]"), int(port))
    except (OSError, ValueError) as error:  # ValueError: a host's name that no name can be
        raise ValueError(f"cluster = {address!r} must be {ALLOWED}, but there is no answer: {clause(error)}.") from None
    if not answered:
        raise ValueError(f"cluster = {address!r} must be {ALLOWED}, but what is there is no Ray.")


def _answered(host: str, port: int) -> bool:
    """Whether a server of gRPC is there; with TLS, whose keys only Ray knows, whether any is."""
    with socket.create_connection((host, port), PATIENCE) as connection:
        if os.environ.get("RAY_USE_TLS", "0").lower() in ("1", "true"):
            return True
        connection.sendall(PREFACE)
        with connection.makefile("rb") as answer:
            return answer.read(4)[3:] == SETTINGS[3:4]
