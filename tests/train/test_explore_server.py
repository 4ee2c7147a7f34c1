"""The explorer's server: many requests at once, loopback addresses and ports."""

import http.client
import socket
import threading
from contextlib import contextmanager

import pytest
from typer.testing import CliRunner

from train.cli.app import app as command

pytest.importorskip("dash", reason="dash is not installed")

from tests.train.explorer import CALLBACK, nothing, with_values  # noqa: E402
from train.explore import app as page  # noqa: E402 - they need the package asked for above
from train.explore import serve  # noqa: E402
from train.explore.requests import MOST_AT_ONCE  # noqa: E402


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
    assert (result.exit_code, result.stderr) == (2, "beamenv: --port is 70000, but must be a whole number from 0 to 65535.\n")


def test_a_port_that_is_taken_is_told():
    with socket.create_server(("127.0.0.1", 0)) as taken, pytest.raises(ValueError, match=f"port {taken.getsockname()[1]} of 127"):
        serve(taken.getsockname()[1])
