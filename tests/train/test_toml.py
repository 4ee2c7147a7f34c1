"""Tables written as TOML are read as they were."""

import pytest

from beamenv.configuration.files import parsed_table
from train.shared.toml import as_toml

TABLE = {
    "text": 'a "quoted" word, C:\\x, é and\na line',
    "flag": True,
    "count": 3,
    "small": 1e-30,
    "large": 7e10,
    "empty": [],
    "pairs": [["top", [60.0, -60.0]], ["bottom", [0.0]]],
    "groups": [{"wall": "web", "positions": [0.03], "sheet": {"thickness": 2e-4}}, {"wall": "top", "positions": 2}],
    "inner": {"x": 1.5, "a key of words": {"y": [1, 2]}, "more": {"z": "z"}},
}


def test_what_is_written_is_read():
    assert parsed_table(as_toml(TABLE, "A comment\nof two lines"), "made.toml") == TABLE


def test_fields_that_are_none_are_left_out():
    text = as_toml({"a": None, "b": {"c": None, "d": 1}, "e": [{"f": None, "g": 2}]})
    assert parsed_table(text, "made.toml") == {"b": {"d": 1}, "e": [{"g": 2}]}


@pytest.mark.parametrize("says", ["", "one", "one\ntwo"])
def test_what_it_says_is_a_comment(says):
    comments = [line for line in as_toml({"a": 1}, says).splitlines() if line.startswith("#")]
    assert comments == [f"# {each}" for each in says.splitlines()]
