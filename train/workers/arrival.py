"""The first function to run on a machine of a cluster: sent as it stands, for beamenv may not be there: no imports here."""

NOT_INSTALLED = (
    "cluster has a machine, {host!r}, that lacks this version of beamenv ({error}): install the same on all of them, with "
    "pip install 'beamenv[cluster]'."
)


def arrived(terms: dict[str, str], parcel: bytes, sentence: str) -> bytes:
    """A parcel carried out, as ``node`` says; where beamenv is not installed the ``sentence`` about it."""
    import importlib
    import pickle
    import socket

    try:
        node = importlib.import_module("beamenv.train.workers.node")
    except ImportError as error:
        refusal = (False, ValueError(sentence.format(host=socket.gethostname(), error=error)))
        return pickle.dumps((pickle.dumps(refusal), {}))
    return bytes(node.carried_out(terms, parcel))
