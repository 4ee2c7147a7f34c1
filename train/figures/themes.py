"""The two themes of pages, light and dark."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any

import plotly.io

from train.figures.palette import PALETTE


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
