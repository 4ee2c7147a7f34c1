"""What the explorer's page asks of its server, and how it refuses."""

from train.explore import app as page
from train.explore.controls import THESIS_PAGE

CALLBACK = "/_dash-update-component"
START = list(THESIS_PAGE.start.values())


def check_refused(response, status=(400, 403, 404, 405, 408, 411, 413, 415, 429)):
    said = response.get_data(as_text=True)
    assert response.status_code in status, said
    if response.request.method != "HEAD":
        assert said.count("\n") == 1 and said.endswith(".\n") and len(said) < 400
        assert "Traceback" not in said
        assert response.mimetype == "text/plain" and response.headers["X-Content-Type-Options"] == "nosniff"


def with_values(asked, **changed):
    values = THESIS_PAGE.start | changed
    return asked | {"inputs": [{"id": "wanted", "property": "data", "value": list(values.values())}]}


def nothing(values, *_):
    """In place of a redraw, which takes a while."""
    outputs = page.quick_outputs().items()
    return {name: [page.no_update] * len(each) if isinstance(each, list) else page.no_update for name, each in outputs}


PATHS = ["/", CALLBACK, "/_dash-layout", "/_dash-dependencies", "/_reload-hash", "/_favicon.ico", "/assets/explore.js", "/x"]
