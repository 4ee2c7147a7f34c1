"""What was printed, held against what a page shows."""

import re

import pytest

NUMBER = re.compile(r"-?\d+\.\d+(?:e[-+]\d+)?")


def assert_same_words(printed, shown, numbers=True):
    """Word for word, numbers within 1 %: sums are another machine's."""
    assert NUMBER.sub("#", printed).split() == NUMBER.sub("#", shown).split()
    values = [[float(each) for each in NUMBER.findall(text)] for text in (printed, shown)]
    assert len(values[0]) == len(values[1])
    if numbers:
        assert values[0] == pytest.approx(values[1], rel=0.01)
