"""How figures of the thesis are drawn: looks that mean the same everywhere, and legends that tell the truth."""

from dataclasses import replace

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from train.figures.figure import Curve, Look, Marker, Panel
from train.figures.palette import contrast
from train.figures.paper import THEMES
from train.reproduce.drawing import appearances, dressed, legend_entries, lightnesses
from train.reproduce.judging.study import Outcome

X = np.linspace(0.0, 1.0, 5)


def outcome(*labels, lines=None):
    return Outcome({}, [Panel("", "", "", [Curve(X, X, label) for label in labels])], lines or {})


@pytest.mark.parametrize(
    "labels",
    [("MFC", "PZT"), ("PZT", "MFC", "MFC, V/thickness"), ("MFC", "PZT", "MFC, printed density"), ("bare", "x", "PZT", "MFC")],
)
def test_mfc_and_pzt_look_alike_in_every_figure(labels):
    usual, looks = appearances(outcome("MFC", "PZT")), appearances(outcome(*labels))
    assert (looks["MFC"], looks["PZT"]) == (usual["MFC"], usual["PZT"])
    assert len({look.colour for look in looks.values()}) == len({look.marker.sign for look in looks.values()}) == len(labels)


def test_without_materials_lightness_is_evenly_spread():
    assert np.ptp(np.diff(lightnesses(["a", "b", "c", "d"]))) < 1e-12


@pytest.mark.parametrize("theme", THEMES)
@pytest.mark.parametrize("labels", ["abcdefgh", ("MFC", "PZT", "bare", "printed")])
def test_lines_stand_out_from_the_paper_of_both_themes(theme, labels):
    looks = appearances(outcome(*labels), theme)
    assert min(contrast(look.colour, THEMES[theme]["paper"]) for look in looks.values()) >= 3.0  # WCAG 2.1 (1.4.11)
    assert len({look.colour for look in looks.values()}) == len(labels)


def test_only_where_a_panel_has_dotted_curves_are_solid_ones_broad_and_pale():
    pairs = Panel("", "", "", [Curve(X, X, "27 °C"), Curve(X, X, "27 °C", "dotted")])
    alone = Panel("", "", "", [Curve(X, X, "LQG"), Curve(X, X, "robust LQG")])
    both = Outcome({}, [pairs, alone], {"solid": "controlled", "dotted": "no control"})
    looks = appearances(both)
    assert [curve.look.opacity for curve in dressed(pairs, looks, in_pairs=True).curves] == [0.5, 1.0]
    for curve, entry in zip(dressed(alone, looks, in_pairs=False).curves, legend_entries(both, looks)[-2:], strict=True):
        assert (curve.look.colour, curve.look.width, curve.line) == (entry.look.colour, entry.look.width, entry.line)


def test_two_points_in_one_place_are_both_seen():
    big, small = (Look(marker=Marker(size=size, fill=fill)) for size, fill in ((8, "none"), (3.5, "full")))
    curves = [
        Curve(X, X, "front"),
        *(Curve(X[:1], X[:1], name, "points", look) for name, look in (("own", big), ("thesis", small))),
    ]
    panel = Panel("", "", "", curves)
    found = appearances(Outcome({}, [panel]))
    assert [(found[name].marker.size, found[name].marker.fill) for name in ("own", "thesis")] == [(8, "none"), (3.5, "full")]
    drawn = dressed(panel, found, in_pairs=False)
    assert [curve.look.marker.fill for curve in drawn.curves[1:]] == ["none", "full"]


def test_bars_have_no_signs_in_the_panel_nor_in_the_legend():
    bars = [Curve(X, X, name, "bars") for name in ("actuators", "sensors")]
    panel = Panel("", "", "", bars)
    looks = appearances(Outcome({}, [panel]))
    assert [curve.look.marker for curve in dressed(panel, looks, in_pairs=False).curves] == [None, None]
    assert [entry.look.marker for entry in legend_entries(Outcome({}, [replace(panel)]), looks)] == [None, None]
