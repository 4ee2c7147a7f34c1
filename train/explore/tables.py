"""What the page says in tables and sentences."""

from __future__ import annotations

from math import isfinite
from typing import Any

from dash import html

from train.explore.blade import View
from train.explore.hertz import TURN
from train.explore.loop import Loop


def heading(seen: View, mode: int) -> list[Any]:
    """Of one mode's small figure."""
    frequency = seen.natural_frequencies[mode]
    return [f"{mode + 1} {seen.families[mode]} ", html.Span(f"{frequency:.1f} rad/s, {frequency / TURN:.1f} Hz")]


def damping_rows(seen: View) -> list[html.Tr]:
    """A row a mode: number, family, frequency in rad/s and in Hz, damping in per cent."""
    found = seen.families, seen.natural_frequencies, 100.0 * seen.damping.free, 100.0 * seen.damping.controlled
    rows = zip(*(each[: len(seen.damping.free)] for each in found), strict=True)
    return [
        _row(f"{mode} {family}", f"{frequency:.1f}", f"{frequency / TURN:.1f}", f"{free:.2f}", f"{controlled:.2f}")
        for mode, (family, frequency, free, controlled) in enumerate(rows, start=1)
    ]


def filter_note(seen: View) -> str:
    """On the poles that the table does not hold."""
    return (
        "Natural frequencies ω and f, and damping ratios ζ of the blade alone and with LQG: of the regulator's poles. "
        f"The loop's other poles are its Kalman filter's, whose error decays at {seen.damping.filter_rate:.1f} 1/s or faster."
    )


def margin_rows(closed: Loop) -> list[html.Tr]:
    """A row a margin, a column for each place where the loops are broken."""
    found = list(closed.margins.values())
    return [
        _row("gain of one loop may fall by, dB", *(_number(-each.gain_margin_db[0], ".1f") for each in found)),
        _row("gain of one loop may rise by, dB", *(_number(each.gain_margin_db[1], ".1f") for each in found)),
        _row("phase of one loop may shift by, °", *(_number(each.phase_margin_deg, ".1f") for each in found)),
        _row("one loop may be late by, ms", *(_number(1e3 * each.delay_margin, ".2f") for each in found)),
        _row("disk margin α of all loops at once", *(_number(each.disk_margin, ".3f") for each in found)),
        _row("largest singular value of S", *(_number(each.peak_sensitivity, ".2f") for each in found)),
    ]


def cost_note(closed: Loop) -> str:
    """What LQG costs in the long run, and whether other weights than the blade's own make it cost more."""
    own = _number(closed.least_cost, ".4g")
    with_own = "" if closed.cost == closed.least_cost else f", and {own} of it with the blade's own Q and R"
    return (
        "On the plant that LQG is designed for; the true blade has more modes, filters and amplifiers. Under white loads J is "
        f"{_number(closed.cost, '.4g')} of that without control{with_own}."
    )


def _number(value: float, digits: str) -> str:
    """A number, or the sign of one that is beyond all bounds."""
    return format(value, digits) if isfinite(value) else "∞" if value > 0.0 else "no number"


def _row(name: str, *cells: str) -> html.Tr:
    return html.Tr([html.Th(name, scope="row"), *(html.Td(cell) for cell in cells)])
