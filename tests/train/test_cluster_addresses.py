"""Where Ray is looked for: an address that is none, or at which nobody answers, is told in a sentence and at once."""

import socket
import threading
import time
from concurrent import futures

import pytest

from train.shared.cluster import check_address


@pytest.mark.parametrize("address", ["", "auto", ":", "here:", ":6379", "here:0", "here:65536", "here:٣", "here:1e3", "ray://here"])
def test_what_is_no_address_is_refused(address):
    with pytest.raises(ValueError, match="^cluster is .*, but must be local, or the address HOST:PORT of a Ray cluster"):
        check_address(address)


def test_an_address_without_a_cluster_is_told_at_once():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))  # and nobody listens
        with pytest.raises(ValueError, match="but there is no answer: .*refused"):
            check_address(f"127.0.0.1:{taken.getsockname()[1]}")


@pytest.mark.parametrize("prefix", ["", "ray://"])
@pytest.mark.parametrize(
    ("words", "said"), [(b"", "timed out"), (b"HTTP/1.0 505 HTTP Version Not Supported\r\n", "what is there is no Ray")]
)
def test_a_port_of_something_else_is_told_within_three_seconds(prefix, words, said):
    with socket.create_server(("127.0.0.1", 0)) as other:
        open_ones = []

        def answers():
            open_ones.append(other.accept()[0])
            open_ones[0].sendall(words)

        thread = threading.Thread(target=answers, daemon=True)
        thread.start()
        begin = time.monotonic()
        with pytest.raises(ValueError, match=f"^cluster = .* must be local, or the address HOST:PORT .*, but .*{said}"):
            check_address(f"{prefix}127.0.0.1:{other.getsockname()[1]}")
        thread.join()
        open_ones[0].close()
    assert time.monotonic() - begin < 3.0


def test_a_server_of_grpc_is_taken_for_ray():
    grpc = pytest.importorskip("grpc", reason="comes with Ray's client")
    server = grpc.server(futures.ThreadPoolExecutor(1))
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    check_address(f"ray://127.0.0.1:{port}")
    server.stop(None).wait()


def test_local_needs_no_answer():
    check_address("local")
