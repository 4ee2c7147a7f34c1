"""What was printed, held against what a page shows.

Words are the same. A number is the same within one unit of the last digit that is shown or within a thousandth, whichever is more:
sums of another machine end in other digits. Two kinds are not compared. Below the title ``ELSEWHERE`` only
words are, as a training goes another way on another machine. Lines that tell a time on the clock, or what rounding leaves,
are left out where a test names them.
"""

import re

NUMBER = re.compile(r"-?\d+\.\d*(?:e[-+]?\d+)?|-?\d+e[-+]?\d+")
ELSEWHERE = "Output: numbers of your machine will differ"
"""The title of a block whose numbers a training has made."""


def assert_same_words(printed, shown, numbers=True):
    """By the rule above; without ``numbers``, words alone."""
    assert NUMBER.sub("#", printed).split() == NUMBER.sub("#", shown).split()
    if numbers:
        pairs = zip(NUMBER.findall(printed), NUMBER.findall(shown), strict=True)
        assert [pair for pair in pairs if not same(*pair)] == []


def same(printed, shown):
    """Whether two numbers, as they are written, are the same but for rounding."""
    value = float(shown)
    return abs(float(printed) - value) <= 1.001 * max(last_digit(shown), 1e-3 * abs(value))


def last_digit(text):
    """One unit of the last digit of a number as it is written: 0.01 of 2.50, 1e-5 of 1.6e-4."""
    mantissa, _, exponent = text.partition("e")
    return 10.0 ** (int(exponent or 0) - len(mantissa.partition(".")[2]))
