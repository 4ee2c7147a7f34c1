"""Where the explorer may be asked from: its own paths, methods and page, under the names of this computer."""

import pytest

pytest.importorskip("dash", reason="dash is not installed")

from tests.train.explorer import CALLBACK, PATHS, check_refused  # noqa: E402

LOST = [
    "/_dash-component-suites/foo/bar.js",
    "/_dash-component-suites/dash/../../x.js",
    "/_dash-component-suites/dash/dcc/nope.js",
    "/_dash-component-suites/dash/dash-renderer/build/",
    "/_dash-component-suites/",
    "/_dash-nothing",
    "/assets/../app.py",
    "/assets/%2e%2e/app.py",
    "/assets/%00",
    "/assets/",
    "/x/<script>",
    "/%ff%fe",
    "/" + "x" * 5000,
]


@pytest.mark.parametrize("path", LOST, ids=lambda path: path[:40])
def test_a_path_that_leads_nowhere_is_told(client, path):
    check_refused(client.get(path), [404])
    check_refused(client.head(path), [404])


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT", "BREW"])
def test_methods_that_the_page_does_not_use_are_refused(client, path, method):
    if (path, method) != (CALLBACK, "POST"):
        check_refused(client.open(path, method=method), [404, 405])


def test_the_callback_is_not_read_by_get(client):
    check_refused(client.get(CALLBACK), [405])


@pytest.mark.parametrize(
    "host", ["127.0.0.1:8050", "127.0.0.2:8050", "127.255.255.254", "[::1]:8050", "[::1]", "localhost", "localhost:1"]
)
def test_this_computer_is_answered_under_each_of_its_names(client, host):
    assert client.get("/", headers={"Host": host}).status_code == 200


@pytest.mark.parametrize("path", PATHS[:-1])
@pytest.mark.parametrize(
    "host",
    [
        "rebound.example",
        "rebound.example:8050",
        "127.0.0.1.rebound.example",
        "localhost.rebound.example",
        "192.168.1.2",
        "0.0.0.0",
        "",
    ]
    + [
        "[::]",
        "[::1",
        "127.0.0.1@rebound.example",
        "rebound.example#@127.0.0.1",
        "2130706433",
        "127.1",
        "localhost,x",
        "[fe80::1]:80",
    ],
)
def test_another_name_for_this_computer_is_not_answered(client, path, host):
    """A site may have its name lead to 127.0.0.1, and ask there from a visitor's browser."""
    check_refused(client.get(path, headers={"Host": host}), [400])


@pytest.mark.parametrize("origin", ["https://rebound.example", "null", "http://localhost:9999", "file://"])
def test_another_sites_page_is_not_answered(client, asked, origin):
    check_refused(client.post(CALLBACK, json=asked, headers={"Origin": origin}), [403])
