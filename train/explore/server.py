"""The page's server, which this computer alone can reach."""

from __future__ import annotations

import socket
from ipaddress import ip_address

from werkzeug.serving import BaseWSGIServer, make_server

from train.explore.app import create_app

LOOPBACK = "127.0.0.1"


def serve(port: int, host: str = LOOPBACK) -> BaseWSGIServer:
    """A server that is bound and waits for ``serve_forever``; port 0 takes a free one (``server.port``).

    Raises ``ValueError`` for a host that is not loopback, and for a port that is none or taken.
    """
    if not is_loopback(host):
        raise ValueError(f"host = {host!r} must be a loopback address such as {LOOPBACK}: the page is for this computer alone.")
    if not 0 <= port <= 65535:
        raise ValueError(f"port = {port!r} must be from 0 to 65535.")
    try:
        with socket.create_server((host, port)) as bound:
            return make_server(host, bound.getsockname()[1], create_app().server, threaded=True, fd=bound.detach())
    except OSError as error:
        raise ValueError(f"port = {port!r} cannot be had ({error.strerror}): choose another one.") from None


def is_loopback(host: str) -> bool:
    """Whether an address, in digits, is this computer's own."""
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False
