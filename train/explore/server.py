"""The page's server, which this computer alone can reach."""

from __future__ import annotations

import socket
from ipaddress import ip_address
from typing import Any

from werkzeug.serving import BaseWSGIServer, WSGIRequestHandler, make_server

from train.explore.app import create_app

LOOPBACK = "127.0.0.1"


class _Quiet(WSGIRequestHandler):
    def log_request(self, *_: Any, **__: Any) -> None:
        """No line for every slider's move."""


def serve(port: int, host: str = LOOPBACK) -> BaseWSGIServer:
    """A server that is bound and waits for ``serve_forever``; port 0 takes a free one, which ``server.port`` gives.

    Raises ``ValueError`` for a host that is not loopback, and for a port that is none or cannot be had.
    """
    if not is_loopback(host):
        raise ValueError(f"host = {host!r} must be a loopback address such as {LOOPBACK}: the page is for this computer alone.")
    if not 0 <= port <= 65535:
        raise ValueError(f"port = {port!r} must be from 0 to 65535.")
    try:
        bound = socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError as error:
        raise ValueError(f"port = {port!r} of {host} must be a free one, but: {error.strerror}.") from None
    with bound:
        taken, wsgi = bound.getsockname()[1], create_app().server
        return make_server(host, taken, wsgi, threaded=True, request_handler=_Quiet, fd=bound.fileno())


def is_loopback(host: str) -> bool:
    """Whether an address, in digits, is this computer's own."""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False
