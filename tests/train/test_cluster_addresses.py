"""Where Ray is looked for: an address that is none, or at which nobody answers, is told in a sentence and at once."""

import socket

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


def test_local_needs_no_answer():
    check_address("local")
