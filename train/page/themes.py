"""The two themes of the page, and the colours of lines, which are legible in both."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import plotly.io


@dataclass(frozen=True, slots=True)
class Theme:
    """Colours of what is no datum."""

    base: str
    """The template of plotly that it starts from."""
    paper: str
    panel: str
    ink: str
    faint: str
    grid: str

    def template(self) -> dict[str, Any]:
        """As plotly takes it: transparent, so that the page's own panels show."""
        template = copy.deepcopy(plotly.io.templates[self.base].to_plotly_json())
        axis = {"gridcolor": self.grid, "zerolinecolor": self.grid, "linecolor": self.faint, "tickcolor": self.faint}
        lines = {**axis, "spikecolor": self.faint, "spikethickness": 1, "spikedash": "dot"}
        scene = {**axis, "backgroundcolor": "rgba(0,0,0,0)", "showbackground": False, "showspikes": False}
        template["layout"] |= {
            "paper_bgcolor": "rgba(0,0,0,0)",
            "plot_bgcolor": "rgba(0,0,0,0)",
            "font": {"color": self.ink, "family": "system-ui, sans-serif", "size": 13},
            "hoverlabel": {"bgcolor": self.panel, "bordercolor": self.faint, "font": {"color": self.ink}},
            "legend": {"bgcolor": "rgba(0,0,0,0)"},
            "colorway": list(PALETTE),
            "modebar": {"bgcolor": "rgba(0,0,0,0)", "color": self.faint, "activecolor": self.ink},
            "shapedefaults": {"line": {"color": self.ink}},
        }
        template["layout"]["xaxis"] |= lines
        template["layout"]["yaxis"] |= lines
        template["layout"]["scene"] = {f"{name}axis": scene for name in "xyz"}
        return template


THEMES = MappingProxyType(
    {
        "light": Theme("plotly_white", paper="#f4f6f8", panel="#ffffff", ink="#1f2933", faint="#5f6b78", grid="#dde2e8"),
        "dark": Theme("plotly_dark", paper="#10151b", panel="#181f27", ink="#e6eaef", faint="#98a4b1", grid="#2e3843"),
    }
)

PALETTE = ("#2f7fc2", "#d9601a", "#23945a", "#9a63c9", "#b8860b", "#d6428f")
"""Contrast of at least 3 on both panels, as WCAG 2.1 (1.4.11) asks of lines."""
NEUTRAL = "#7d8793"
"""What is without control."""
DASHES = ("solid", "dash", "dot", "dashdot")
"""The second sign besides colour."""


def contrast(one: str, other: str) -> float:
    """Ratio of the luminances of two colours "#rrggbb", 1 to 21 (WCAG 2.1)."""
    low, high = sorted(_luminance(colour) for colour in (one, other))
    return (high + 0.05) / (low + 0.05)


def _luminance(colour: str) -> float:
    channels = [int(colour[start : start + 2], 16) / 255.0 for start in (1, 3, 5)]
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4 for value in channels]
    return sum(weight * value for weight, value in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
