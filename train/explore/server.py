"""The page's server, which this computer alone can reach."""

from __future__ import annotations

import socket
from typing import Any

from werkzeug.serving import BaseWSGIServer, WSGIRequestHandler, make_server

from beamenv.blade.config import BladeConfig
from beamenv.blade.presets import THESIS
from beamenv.configuration import Count, Instance, Refused, Text, checked
from train.explore.app import create_app
from train.explore.controls import Page
from train.explore.requests import is_loopback

LOOPBACK = "127.0.0.1"


class _Quiet(WSGIRequestHandler):
    timeout = 10.0
    """s: a request whose next bytes take longer is dropped."""

    def log_request(self, *_: Any, **__: Any) -> None:
        """No line for every slider's move."""


def serve(port: int, host: str = LOOPBACK, base: BladeConfig = THESIS, name: str = "blade") -> BaseWSGIServer:
    """A server of the page of a blade of that name, bound and waiting for ``serve_forever``; port 0 takes a free one:
    ``server.port``.

    Raises ``ValueError`` for a host that is not loopback, and for a port that is none or cannot be had.
    """
    if not is_loopback(host):
        raise Refused("host", host, f"a loopback address such as {LOOPBACK}, for the page is for this computer alone")
    port = checked("port", port, Count(0, 65535))
    page = Page.of(checked("base", base, Instance(BladeConfig)), checked("name", name, Text(line=True)))
    try:
        bound = socket.create_server((host, port), family=socket.AF_INET6 if ":" in host else socket.AF_INET)
    except OSError as error:
        raise ValueError(f"port {port} of {host} cannot be had: {error.strerror}.") from None
    with bound:
        taken, wsgi = bound.getsockname()[1], create_app(page).server
        return make_server(host, taken, wsgi, threaded=True, request_handler=_Quiet, fd=bound.fileno())
