"""Bytes of files damaged, and what a table still says."""

import json
import sys

from hypothesis import strategies as st

from tests.fuzz.meaning import NOTHING

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PLAIN = [
    "none",
    "true",
    "false",
    "nan",
    "inf",
    "-0",
    "huge",
    "minus",
    "half",
    "text no",
    "text false",
    "text number",
    "text empty",
    "surrogate",
    "text nul",
    "empty list",
    "empty dict",
    "list of none",
    "list of text",
    "list of bools",
    "list of lists",
    "list of five",
    "dict",
    "nested dict",
    "large",
    "text two lines",
]


@st.composite
def damaged(draw, content):
    """Bytes with some cut out, put in, changed or said twice."""
    content = bytes(content)
    for _ in range(draw(st.integers(1, 2))):
        at = draw(st.integers(0, len(content)))
        to = min(len(content), at + draw(st.integers(0, 12)))
        put = draw(
            st.one_of(
                st.just(b""),
                st.binary(max_size=4),
                st.sampled_from([b"\n", b'"', b"=", b"[", b"{", b"\xff", b"\0", b"nan", b"-", b"e999"]),
            )
        )
        kind = draw(st.sampled_from(["replace", "cut", "flip", "twice", "end"]))
        if kind == "replace":
            content = content[:at] + put + content[to:]
        elif kind == "cut":
            content = content[:at]
        elif kind == "twice":
            content = content[:to] + content[at:to] + content[to:]
        elif kind == "end":
            content += put
        elif content and at < len(content):
            content = content[:at] + bytes([content[at] ^ (1 << draw(st.integers(0, 7)))]) + content[at + 1 :]
    return content


def no_twice(pairs):
    """A JSON object that says nothing twice."""
    if len({name for name, _ in pairs}) < len(pairs):
        raise ValueError
    return dict(pairs)


def read_anew(ending, content):
    """The table in a file, or NOTHING."""
    try:
        text = content.decode("utf-8")
        found = json.loads(text, object_pairs_hook=no_twice) if ending == ".json" else tomllib.loads(text)
    except (ValueError, RecursionError):
        return NOTHING
    return {name: value for name, value in found.items() if name != "$schema"} if isinstance(found, dict) else NOTHING
