"""What the explorer's server answers: this computer alone, and nothing that its own page would not ask, each in one sentence."""

import http.client
import json
import math
import socket
import threading
from contextlib import contextmanager

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from typer.testing import CliRunner

from train.cli.app import app as command

pytest.importorskip("dash", reason="dash is not installed")

from train.explore import app as page  # noqa: E402 - they need the package asked for above
from train.explore import serve  # noqa: E402
from train.explore.layout import RANGES  # noqa: E402
from train.explore.requests import LARGEST_BODY, MOST_AT_ONCE  # noqa: E402

CALLBACK = "/_dash-update-component"
START = [*(entry.value for entry in RANGES.values()), "flap"]


@pytest.fixture(scope="module")
def client():
    return page.create_app().server.test_client()


@pytest.fixture(scope="module")
def output(client):
    return next(each["output"] for each in client.get("/_dash-dependencies").get_json() if "results.hidden" in each["output"])


@pytest.fixture(scope="module")
def asked(output):
    """The body with which the page asks for a redraw, as a browser was seen to send it."""
    outputs = [dict(zip(("id", "property"), each.split("."), strict=True)) for each in output.strip(".").split("...")]
    inputs = [{"id": "wanted", "property": "data", "value": START}]
    return {"output": output, "outputs": outputs, "inputs": inputs, "changedPropIds": ["wanted.data"], "parsedChangedPropsIds": []}


def check_refused(response, status=(400, 403, 404, 405, 408, 411, 413, 415, 429)):
    said = response.get_data(as_text=True)
    assert response.status_code in status, said
    if response.request.method != "HEAD":
        assert said.count("\n") == 1 and said.endswith(".\n") and len(said) < 400
        assert "Traceback" not in said
        assert response.mimetype == "text/plain" and response.headers["X-Content-Type-Options"] == "nosniff"


def with_values(asked, **changed):
    values = dict(zip((*RANGES, "load"), START, strict=True)) | changed
    return asked | {"inputs": [{"id": "wanted", "property": "data", "value": list(values.values())}]}


def test_what_the_page_asks_is_answered_with_its_figures(client, asked):
    answer = client.post(CALLBACK, json=asked)
    assert answer.status_code == 200
    drawn = answer.get_json()["response"]
    assert drawn["message"]["children"] == "" and drawn["campbell"]["figure"]["data"]


EDGES = RANGES["actuators"].value


@pytest.mark.parametrize(
    "changed",
    [
        *(
            {name: wrong}
            for name in ("ply_angle_deg", "speed", "pretwist_deg", "taper")
            for wrong in (None, True, "30", [30.0], {}, -1.0, 1e9, -1e308, math.nan, math.inf, 10**400)
        ),
        *(
            {name: wrong}
            for name in ("actuators", "sensors")
            for wrong in (
                None,
                4,
                "0123",
                [],
                EDGES[:3],
                [*EDGES, 1300.0],
                EDGES * 2000,
                [None] * 4,
                [float("nan")] * 4,
                [-5.0, 1, 2, 3],
            )
        ),
        *({"load": wrong} for wrong in (None, 1, [], {}, "twist", "<script>alert(1)</script>", "flap\n")),
    ],
    ids=lambda changed: str(changed)[:40],
)
def test_values_that_no_slider_has_are_refused_by_their_names(client, asked, changed):
    answer = client.post(CALLBACK, data=json.dumps(with_values(asked, **changed)), content_type="application/json")
    check_refused(answer, [400])
    assert answer.get_data(as_text=True).startswith(next(iter(changed))) or 10**400 in changed.values()


@pytest.mark.parametrize("key", ["output", "inputs"])
@pytest.mark.parametrize(
    "wrong", ["left out", None, 1, True, "", "a.b", "..a.b..", [], [[]], [{}], {}, {"id": "wanted"}, [None] * 10], ids=str
)
def test_a_body_that_asks_for_something_else_is_refused(client, asked, key, wrong):
    body = {name: value for name, value in asked.items() if name != key} | ({} if wrong == "left out" else {key: wrong})
    check_refused(client.post(CALLBACK, json=body), [400])


def test_what_else_a_body_says_is_not_read(client, asked, monkeypatch):
    """Outputs, states and triggers come from the server's own page."""
    monkeypatch.setattr(page, "drawn", nothing)
    for wrong in (None, 1, "x", [], [1], {"a": 1}, [{"id": "message"}] * 99):
        body = asked | dict.fromkeys(("outputs", "state", "changedPropIds", "parsedChangedPropsIds", "other"), wrong)
        assert client.post(CALLBACK, json=body).status_code in (200, 204)


def nothing(values, *_):
    """In place of a redraw, which takes a while."""
    outputs = page.outputs().items()
    return {name: [page.no_update] * len(each) if isinstance(each, list) else page.no_update for name, each in outputs}


@pytest.mark.parametrize(
    "body",
    [
        b"",
        b"{",
        b"\xff\xfe",
        b"null",
        b"[]",
        b"0",
        b'"x"',
        b"NaN",
        b"[" * 60_000,
        b'{"a":' * 10_000,
        b"1" * 5000,
        b"\x00" * 100,
        b"{}" * 3,
    ],
    ids=lambda body: repr(body[:8]),
)
def test_a_body_that_is_no_table_is_refused(client, body):
    for kind in ("application/json", "text/plain"):
        check_refused(client.post(CALLBACK, data=body, content_type=kind), [400] if body else [413])


def test_a_long_body_is_refused_unread(client, asked):
    body = json.dumps(asked | {"more": "x" * LARGEST_BODY})
    check_refused(client.post(CALLBACK, data=body, content_type="application/json"), [413])
    check_refused(client.post(CALLBACK, headers={"Content-Length": "-5"}), [400, 413])
    check_refused(client.post(CALLBACK, headers={"Content-Length": "many"}), [400, 413])


json_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=8) | st.sampled_from(["wanted", "data", "value"]),
    lambda inner: (
        st.lists(inner, max_size=8) | st.dictionaries(st.sampled_from(["id", "property", "value", "a"]), inner, max_size=4)
    ),
    max_leaves=12,
)


def check_payload(client, asked, key, value, control):
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(page, "drawn", nothing)
        for body in (asked | {key: value}, with_values(asked, **{control: value})):
            answer = client.post(CALLBACK, data=json.dumps(body), content_type="application/json")
            if answer.status_code not in (200, 204):
                check_refused(answer, [400])


@given(st.sampled_from(["output", "inputs", "outputs"]), json_values, st.sampled_from([*RANGES, "load"]))
@example("inputs", [{"id": "wanted", "property": "data", "value": None}], "load")
@settings(max_examples=25, deadline=None, derandomize=True)
def test_no_payload_is_an_error_of_the_server(client, asked, key, value, control):
    check_payload(client, asked, key, value, control)


@pytest.mark.slow
@given(st.sampled_from(["output", "inputs", "outputs"]), json_values, st.sampled_from([*RANGES, "load"]))
@settings(max_examples=200, deadline=None, derandomize=True)
def test_no_payload_of_many_is_an_error_of_the_server(client, asked, key, value, control):
    check_payload(client, asked, key, value, control)


@pytest.mark.slow
@given(st.data())
@settings(max_examples=20, deadline=None, derandomize=True)
def test_whatever_the_sliders_say_is_answered(client, asked, data):
    values = {}
    for name, entry in RANGES.items():
        position = st.floats(entry.low, entry.high)
        values[name] = data.draw(st.lists(position, min_size=4, max_size=4) if isinstance(entry.value, list) else position, name)
    answer = client.post(CALLBACK, json=with_values(asked, **values))
    assert answer.status_code == 200
    assert answer.get_json()["response"]["message"]["children"].count("\n") == 0


PATHS = ["/", CALLBACK, "/_dash-layout", "/_dash-dependencies", "/_reload-hash", "/_favicon.ico", "/assets/explore.js", "/x"]
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


def test_many_redraws_at_once_are_answered_in_turn_and_too_many_refused(asked, monkeypatch):
    begun, go_on, at_work = threading.Semaphore(0), threading.Event(), []

    def slow(values, *_):
        at_work.append(1)
        assert sum(at_work) == 1  # one at a time
        begun.release()
        go_on.wait(30)
        at_work.append(-1)
        return nothing(values)

    monkeypatch.setattr(page, "drawn", slow)
    server = page.create_app().server
    statuses = []
    threads = [
        threading.Thread(target=lambda: statuses.append(server.test_client().post(CALLBACK, json=asked).status_code))
        for _ in range(MOST_AT_ONCE + 4)
    ]
    for thread in threads:
        thread.start()
    begun.acquire(timeout=30)
    for thread in threads:
        thread.join(0.2)  # those refused end at once
    assert statuses == [429] * 4
    go_on.set()
    for thread in threads:
        thread.join(30)
    assert sorted(statuses) == [200] * MOST_AT_ONCE + [429] * 4


def test_two_redraws_at_once_show_what_each_alone_shows(asked, client):
    bodies = [with_values(asked, taper=1.25), with_values(asked, taper=1.25, load="lag"), with_values(asked, pretwist_deg=11.0)]
    answers: dict[int, str] = {}

    def ask(k):
        answers[k] = page_client.post(CALLBACK, json=bodies[k]).get_data(as_text=True)

    page_client = page.create_app().server.test_client()
    threads = [threading.Thread(target=ask, args=(k,)) for k in range(len(bodies))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert [answers[k] for k in range(len(bodies))] == [client.post(CALLBACK, json=body).get_data(as_text=True) for body in bodies]


@contextmanager
def served(host):
    try:
        socket.create_server((host, 0), family=socket.AF_INET6 if ":" in host else socket.AF_INET).close()
    except OSError:
        pytest.skip(f"{host} is not to be had here")
    server = serve(0, host)
    thread = threading.Thread(target=server.serve_forever, daemon=True)
    thread.start()
    try:
        yield server
    finally:
        server.shutdown()
        server.server_close()
        thread.join()


@pytest.mark.parametrize("host", ["127.0.0.1", "127.0.0.2", "::1"])
def test_the_page_is_served_at_every_loopback_address(host):
    with served(host) as server:
        assert server.socket.getsockname()[:2] == (host, server.port)
        for path in ("/", "/_dash-layout", "/assets/explore.js"):
            connection = http.client.HTTPConnection(host, server.port, timeout=30)
            connection.request("GET", path)
            answer = connection.getresponse()
            assert answer.status == 200
            assert answer.read()
            connection.close()


def test_what_is_no_request_is_answered_without_a_traceback(capfd):
    """Raw bytes: a wrong version, no host, a body shorter than it says, chunks, a foreign site in full."""
    sent = {
        b"HELLO\r\n\r\n": b"400",
        b"GET / HTTP/9.9\r\n\r\n": b"505",
        b"GET / HTTP/1.0\r\n\r\n": b"400",
        b"GET http://rebound.example/ HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n": b"400",
        b"POST " + CALLBACK.encode() + b" HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n": b"4",
        b"POST " + CALLBACK.encode() + b" HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 99\r\n\r\n{": b"408",
        b"GET /" + b"x" * 70_000 + b" HTTP/1.1\r\n\r\n": b"414",
    }
    with served("127.0.0.1") as server:
        for request, status in sent.items():
            with socket.create_connection(("127.0.0.1", server.port), timeout=30) as connection:
                connection.sendall(request)
                connection.shutdown(socket.SHUT_WR)
                answer = connection.recv(4000)
                assert answer.partition(b" ")[2].startswith(status) or status in answer, (request[:60], answer)
    assert "Traceback" not in capfd.readouterr().err


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.2", "example.org", "", "127.0.0.1.example.org"])
def test_a_host_that_others_reach_is_refused_in_one_sentence(host):
    result = CliRunner().invoke(command, ["explore", "--host", host, "--port", "0"])
    assert result.exit_code == 2
    assert result.stderr.count("\n") == 1
    assert "loopback" in result.stderr


@pytest.mark.parametrize("host", [None, 1, 2130706433, b"127.0.0.1", ["127.0.0.1"], "0.0.0.0"])
def test_only_addresses_of_this_computer_are_served_at(host):
    with pytest.raises(ValueError, match="host is .*, but must be a loopback address"):
        serve(0, host)


@pytest.mark.parametrize("port", [None, "8050", -1, 65536, 80.5, True, float("nan"), [8050]])
def test_a_port_is_a_whole_number_up_to_65535(port):
    with pytest.raises(ValueError, match="port is .*, but must be a whole number from 0 to 65535"):
        serve(port)


def test_a_port_that_is_none_is_refused_in_one_sentence():
    result = CliRunner().invoke(command, ["explore", "--port", "70000"])
    assert (result.exit_code, result.stderr) == (2, "beamenv: port is 70000, but must be a whole number from 0 to 65535.\n")


def test_a_port_that_is_taken_is_told():
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(ValueError, match=f"port {taken.getsockname()[1]} of 127"):
        serve(taken.getsockname()[1])
