"""Columns of estimates, and how a table writes their numbers."""

from __future__ import annotations

from dataclasses import dataclass

from baselines import Estimate


@dataclass(frozen=True, slots=True)
class Column:
    """One estimate of each row."""

    name: str
    """Of the estimate."""
    heading: str
    """With its unit."""
    factor: float
    """From SI units to the heading's."""
    form: str
    """For ``str.format``."""
    interval: bool = False
    """Whether it stands beside the value."""
    fine: bool = False
    """Whether values below 10 have three digits, whatever the form says."""

    def text(self, estimate: Estimate | None) -> str:
        """A value, with its interval where that is shown; a dash for None."""
        if estimate is None:
            return "–"
        value, low, high = (self.number(each) for each in (estimate.value, estimate.low, estimate.high))
        return f"{value} [{low}, {high}]" if self.interval else value

    def number(self, value: float) -> str:
        """A value in SI units, in the heading's."""
        return self._number(self.factor * value)

    def _number(self, value: float) -> str:
        return number(value, "{:.3g}" if self.fine and abs(value) < 10.0 else self.form)


EVALUATION = (
    Column("relative_cost", "J / J without control", 1.0, "{:.3f}", interval=True),
    Column("settling_time", "settling (5 %), s", 1.0, "{:.3f}"),
    Column("peak_tip", "peak tip, µm", 1e6, "{:.0f}"),
    Column("rms_tip", "RMS tip, µm", 1e6, "{:.1f}"),
    Column("peak_voltage", "peak, V", 1.0, "{:.0f}", fine=True),
    Column("rms_voltage", "RMS, V", 1.0, "{:.0f}", fine=True),
    Column("saturation", "saturated, %", 100.0, "{:.1f}"),
)
"""What tables show of an ``Evaluation``."""


def number(value: float, form: str) -> str:
    """For readers: three digits at most where it is large; ∞ for a blade that broke, a dash for what is not known."""
    if value != value:  # NaN
        return "–"
    if abs(value) == float("inf"):
        return "∞" if value > 0 else "−∞"
    written = f"{value:.3g}" if abs(value) >= 1e3 and form != "{:.0f}" else form.format(value)
    return f"−{written[1:]}" if written.startswith("-") else written  # a minus, not a hyphen


def share(value: float) -> str:
    """In per cent, never rounded to none or all."""
    return "< 1 %" if 0.0 < value < 0.01 else "> 99 %" if 0.99 < value < 1.0 else f"{100.0 * value:.0f} %"
