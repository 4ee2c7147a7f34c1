"""Bodies that the explorer's server answers, and those that its own page would not send, each refused in one sentence."""

import json
import math

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

pytest.importorskip("dash", reason="dash is not installed")

from tests.train.explorer import CALLBACK, START, check_refused, nothing, with_values  # noqa: E402
from train.explore import app as page  # noqa: E402 - they need the package asked for above
from train.explore.controls import RANGES, THESIS_PAGE  # noqa: E402
from train.explore.requests import LARGEST_BODY  # noqa: E402


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
            for name in ("ply_angle_deg", "speed", "pretwist_deg", "taper", "white_load", "actuator_energy_weight")
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
        *({"actuator": wrong} for wrong in (None, 1, "0", "5", "-1", "1.0", "one")),
    ],
    ids=lambda changed: str(changed)[:40],
)
def test_values_that_no_slider_has_are_refused_by_their_names(client, asked, changed):
    answer = client.post(CALLBACK, data=json.dumps(with_values(asked, **changed)), content_type="application/json")
    check_refused(answer, [400])
    assert answer.get_data(as_text=True).startswith(next(iter(changed))) or 10**400 in changed.values()


def test_what_is_said_of_the_loop_is_asked_for_by_itself(client, asked):
    output = next(each["output"] for each in client.get("/_dash-dependencies").get_json() if "margins.children" in each["output"])
    inputs = [{"id": "settled", "property": "data", "value": START}]
    answer = client.post(CALLBACK, json={"output": output, "inputs": inputs})
    assert answer.status_code == 200
    said = answer.get_json()["response"]
    assert said["lost"]["children"] == "" and said["poles"]["figure"]["data"]
    crossed = {"output": output, "inputs": [{"id": "wanted", "property": "data", "value": START}]}
    check_refused(client.post(CALLBACK, json=crossed), [400])
    check_refused(client.post(CALLBACK, json={**asked, "inputs": inputs}), [400])


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


@given(st.sampled_from(["output", "inputs", "outputs"]), json_values, st.sampled_from([*THESIS_PAGE.controls]))
@example("inputs", [{"id": "wanted", "property": "data", "value": None}], "load")
@settings(max_examples=25, deadline=None, derandomize=True)
def test_no_payload_is_an_error_of_the_server(client, asked, key, value, control):
    check_payload(client, asked, key, value, control)


@pytest.mark.slow
@given(st.sampled_from(["output", "inputs", "outputs"]), json_values, st.sampled_from([*THESIS_PAGE.controls]))
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
