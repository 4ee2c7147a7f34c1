"""Tables in Markdown: whatever stands in a cell stays in it, as text."""

import pytest

from train.shared.columns import Column, number, share
from train.shared.markdown import escaped, table


def test_words_are_left_aligned_and_numbers_right():
    assert table(("controller", "J"), [("LQG", "0.443 [0.42, 0.46]")], words=1) == (
        "| controller | J |\n| --- | ---: |\n| LQG | 0.443 [0.42, 0.46] |"
    )
    assert table(("a", "b"), []) == "| a | b |\n| --- | --- |"


@pytest.mark.parametrize(
    ("name", "written"),
    [
        ("a|b", r"a\|b"),
        (r"a\|b", r"a\\\|b"),
        ("`rm`", r"\`rm\`"),
        ("<script>alert(1)</script>", "&lt;script>alert(1)&lt;/script>"),
        ("<!-- gone", "&lt;!-- gone"),
        ("&lt;b>", "&amp;lt;b>"),
        ("[here](javascript:x)", r"[here]\(javascript:x)"),
        ("two\nlines", "two lines"),
        ("one\u2028line\x1b[2J", "one line [2J"),
        ("very *bold* or **bolder**", r"very \*bold\* or \*\*bolder\*\*"),
        ("_slanted_", r"\_slanted\_"),
        ("~~gone~~", "&#126;~gone&#126;~"),
        ("$x^2$", "&#36;x^2&#36;"),
        ("[here][there]", r"[here]\[there]"),
        ("https://elsewhere", "https&#58;//elsewhere"),
    ],
)
def test_a_name_cannot_end_its_cell_or_become_markup(name, written):
    assert escaped(name) == written


@pytest.mark.parametrize(
    "text", ["0.548 (< 1 % unstable)", "P(J < LQG's)", "Chandra & Chopra (Hz)", "[0.1, 0.2] (mean)", "lqg_2*x"]
)
def test_what_is_no_markup_is_left_as_it_stands(text):
    assert escaped(text) == text


def test_a_column_writes_value_interval_and_what_is_infinite():
    from baselines import Estimate

    estimate = Estimate(1.5e-6, 1e-6, float("inf"))
    assert Column("tip", "tip, µm", 1e6, "{:.1f}").text(estimate) == "1.5"
    assert Column("tip", "tip, µm", 1e6, "{:.1f}", interval=True).text(estimate) == "1.5 [1.0, ∞]"
    assert Column("tip", "tip, µm", 1e6, "{:.1f}").text(None) == "–"
    assert number(12345.0, "{:.1f}") == "1.23e+04"
    assert number(-0.5, "{:.2f}") == "−0.50"  # a minus sign, not a hyphen
    assert number(12345.0, "{:.0f}") == "12345"


def test_a_share_is_never_rounded_to_none_or_all():
    assert [share(value) for value in (0.0, 0.001, 0.5, 0.999, 1.0)] == ["0 %", "< 1 %", "50 %", "> 99 %", "100 %"]
