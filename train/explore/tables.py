"""What the page says in tables and sentences."""

from __future__ import annotations

from math import isfinite
from typing import Any

from dash import html

from beamenv.structure import RotatingBeam
from train.explore.along import rows
from train.explore.blade import View
from train.explore.hertz import TURN
from train.explore.loop import Loop
from train.explore.units import number, unit_of


def title(seen: View, name: str) -> str:
    """Of the page: which blade it is, and whether it turns."""
    return f"{name}, at rest" if seen.speed == 0.0 else f"{name}, rotating at {seen.speed:.6g} rad/s"


def along_rows(beam: RotatingBeam) -> list[html.Tr]:
    """A row a share of the span: z, chord, angle."""
    return [_row(*row) for row in rows(beam)]


def heading(seen: View, mode: int) -> list[Any]:
    """Of one mode's small figure."""
    frequency = seen.natural_frequencies[mode]
    return [f"{mode + 1} {seen.families[mode]} ", html.Span(f"{number(frequency)} rad/s, {number(frequency / TURN)} Hz")]


def damping_rows(seen: View) -> list[html.Tr]:
    """A row a mode: number, family, frequency in rad/s and in Hz, damping in per cent."""
    found = seen.families, seen.natural_frequencies, 100.0 * seen.damping.free, 100.0 * seen.damping.controlled
    rows = zip(*(each[: len(seen.damping.free)] for each in found), strict=True)
    return [
        _row(f"{mode} {family}", number(frequency), number(frequency / TURN), _percent(free), _percent(controlled))
        for mode, (family, frequency, free, controlled) in enumerate(rows, start=1)
    ]


def filter_note(seen: View) -> str:
    """On the poles that the table does not hold."""
    return (
        "Natural frequencies ω and f, and damping ratios ζ of the blade alone and with LQG: of the regulator's poles. "
        "The loop's other poles are its Kalman filter's, whose error decays at "
        f"{number(seen.damping.filter_rate, 3)} 1/s or faster."
    )


def margin_rows(closed: Loop) -> list[html.Tr]:
    """A row a margin, a column for each place where the loops are broken."""
    found = list(closed.margins.values())
    delays = unit_of([each.delay_margin for each in found if isfinite(each.delay_margin)], "s")
    return [
        _row("gain of one loop may fall by, dB", *(number(-each.gain_margin_db[0], 3) for each in found)),
        _row("gain of one loop may rise by, dB", *(number(each.gain_margin_db[1], 3) for each in found)),
        _row("phase of one loop may shift by, °", *(number(each.phase_margin_deg, 3) for each in found)),
        _row(f"one loop may be late by, {delays.name}", *(number(delays.per * each.delay_margin, 3) for each in found)),
        _row("disk margin α of all loops at once", *(number(each.disk_margin, 3) for each in found)),
        _row("largest singular value of S", *(number(each.peak_sensitivity, 3) for each in found)),
    ]


def peaks(closed: Loop) -> str:
    """Where S is largest."""
    found = []
    for where, gains in closed.sensitivity.items():
        frequency = float(closed.frequencies[gains.argmax()])
        largest = closed.margins[where].peak_sensitivity
        found.append(f"{number(largest, 3)} at {number(frequency)} rad/s ({number(frequency / TURN)} Hz) at the {where}")
    return f"Largest: {', and '.join(found)}."


def cost_note(closed: Loop) -> str:
    """What LQG costs in the long run, and whether other weights than the blade's own make it cost more."""
    with_own = "" if closed.cost == closed.least_cost else f", and {number(closed.least_cost)} of it with the blade's own Q and R"
    return (
        "On the plant that LQG is designed for; the true blade has more modes, filters and amplifiers. Under white loads J is "
        f"{number(closed.cost)} of that without control{with_own}."
    )


def _percent(value: float) -> str:
    """With two digits behind the point, and of a very small one with two digits."""
    return f"{value:.2f}" if abs(value) >= 0.1 else number(value, 2)


def _row(name: str, *cells: str) -> html.Tr:
    return html.Tr([html.Th(name, scope="row"), *(html.Td(cell) for cell in cells)])
