"""What the server answers: the page's own files, and callbacks with values that its controls can have."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from io import BytesIO
from ipaddress import ip_address
from threading import BoundedSemaphore
from typing import Any
from urllib.parse import urlsplit

from werkzeug.exceptions import HTTPException
from werkzeug.wrappers import Request, Response

from beamenv.configuration import shown
from train.explore.controls import THESIS_PAGE, Page

CALLBACK = "/_dash-update-component"
LARGEST_BODY = 2**16
"""Bytes; the page's own have some 2000."""
MOST_AT_ONCE = 8
"""Redraws asked for and not yet answered; one page asks for one."""
ANSWERED = "the page's own files and callbacks are all that is answered"


class Unanswered(Exception):  # noqa: N818 - an answer, not an error of ours
    """What is not asked as the page asks, with the status and the sentence that answer it."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status = status


class OnlyThePage:
    """A WSGI application behind which another one gets nothing but what the page itself asks; the rest has a 4xx and a sentence.

    Hosts are names of this computer, so that no other site's name may be made to lead here. Bodies of the callback are read,
    checked and written anew: what the application gets of them are the values of the controls, within the controls' ranges.
    """

    def __init__(self, application: Any, asked: Mapping[str, str], page: Page = THESIS_PAGE) -> None:
        """``asked``: by what a callback gives, the store that asks for it."""
        self.application, self.asked, self.page = application, asked, page
        self.free = BoundedSemaphore(MOST_AT_ONCE)

    def __call__(self, environ: dict[str, Any], start_response: Any) -> Iterable[bytes]:
        """Answer one request."""
        request = Request(environ)
        try:
            check_host(request)
            if request.path != CALLBACK:
                check_method(request, "GET", "HEAD")
                answer: Iterable[bytes] = self.application(environ, start_response)
                return answer
            return self.redrawn(request, environ, start_response)
        except Unanswered as error:
            return told(str(error), error.status)(environ, start_response)

    def redrawn(self, request: Request, environ: dict[str, Any], start_response: Any) -> Iterable[bytes]:
        """The callback's answer."""
        body = json.dumps(self.body(*wanted(content(request), self.asked, self.page))).encode()
        if not self.free.acquire(blocking=False):
            raise Unanswered(429, f"{MOST_AT_ONCE} redraws are being made: ask again.")
        try:
            asked = {"wsgi.input": BytesIO(body), "CONTENT_LENGTH": str(len(body)), "CONTENT_TYPE": "application/json"}
            return Response.from_app(self.application, environ | asked, buffered=True)(environ, start_response)
        finally:
            self.free.release()

    def body(self, output: str, values: list[Any]) -> dict[str, Any]:
        """What the page would send."""
        asked = self.asked[output]
        outputs = [dict(zip(("id", "property"), each.rsplit(".", 1), strict=True)) for each in output.strip(".").split("...")]
        inputs = [{"id": asked, "property": "data", "value": values}]
        return {"output": output, "outputs": outputs, "inputs": inputs, "changedPropIds": [f"{asked}.data"]}


def told(sentence: str, status: int | None) -> Response:
    """A sentence that no browser takes for a page."""
    return Response(f"{sentence}\n", status, {"X-Content-Type-Options": "nosniff"}, mimetype="text/plain")


def is_loopback(host: Any) -> bool:
    """Whether an address, in digits, is this computer's own."""
    try:
        return isinstance(host, str) and ip_address(host).is_loopback
    except ValueError:
        return False


def check_host(request: Request) -> None:
    """``Unanswered`` unless it is asked under a name that this computer alone has, and from no other site's page."""
    name = _name(request.environ.get("HTTP_HOST", ""))
    if not (name == "localhost" or is_loopback(name)):
        raise Unanswered(400, "the page is for this computer alone: ask for it as localhost or under a loopback address.")
    origin = request.headers.get("Origin")
    if origin is not None and origin.partition("://")[2] != request.environ["HTTP_HOST"]:
        raise Unanswered(403, "the page is for itself alone: another site's may not ask.")


def _name(host: str) -> str | None:
    """Without the port."""
    try:
        return urlsplit(f"//{host}").hostname if not set(host) & set("/?#@\\") else None
    except ValueError:
        return None


def check_method(request: Request, *allowed: str) -> None:
    """``Unanswered`` for another one."""
    if request.method not in allowed:
        raise Unanswered(405, f"method is {shown(request.method)}, but must be {' or '.join(allowed)} here: {ANSWERED}.")


def content(request: Request) -> Any:
    """What the body of a callback's request says in JSON."""
    check_method(request, "POST")
    length = request.content_length
    if length is None or length > LARGEST_BODY:
        raise Unanswered(413, f"the body must say how long it is, and be at most {LARGEST_BODY} bytes.")
    try:
        return json.loads(request.get_data())
    except (ValueError, RecursionError):
        raise Unanswered(400, "the body must be JSON.") from None
    except (OSError, HTTPException):  # too long a pause, or the connection's end
        raise Unanswered(408, "the body must come whole, and without a long pause.") from None


def wanted(asked: Any, answers: Mapping[str, str], page: Page = THESIS_PAGE) -> tuple[str, list[Any]]:
    """What a callback's body asks for, and the controls' values in it."""
    match asked:
        case {"output": str(output), "inputs": [{"id": str(store), "property": "data", "value": list(values)}]}:
            if answers.get(output) == store and len(values) == len(page.controls):
                return output, controlled(dict(zip(page.controls, values, strict=True)), page)
    raise Unanswered(400, f"the body must ask for the page's outputs with the values of {', '.join(page.controls)}.")


def controlled(values: Mapping[str, Any], page: Page = THESIS_PAGE) -> list[Any]:
    """Values as the controls can have them."""
    try:
        read = page.checked(values)
    except ValueError as error:
        raise Unanswered(400, str(error)) from None
    return [list(value) if isinstance(value, tuple) else value for value in read.values()]
