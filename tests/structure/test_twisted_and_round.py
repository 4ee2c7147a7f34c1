"""Blades of many turns, and tubes, whose sections stay plane when they twist."""

import numpy as np
import pytest

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Lamina, Layup, PolygonSection, RotatingBeam
from beamenv.structure import beam as module


def frequencies(pretwist, model):
    section, layup = BoxSection(0.254, 0.0508, 0.01016), Layup.uniform(GRAPHITE_EPOXY, [30] * 6)
    return RotatingBeam(section, layup, 2.023, hub_radius=0.2, pretwist_deg=pretwist, model=model).natural_frequencies()


@pytest.mark.parametrize(
    ("pretwist", "model"),
    [(720.0, "thesis"), (-720.0, "thesis"), (1440.0, "thesis"), (500.0, "blade"), (720.0, "blade"), (-720.0, "blade")],
)
def test_stations_are_enough_for_blades_of_several_turns(pretwist, model, monkeypatch):
    """Six frequencies within 2e-6 of those with thirty more stations on each piece."""
    ours = frequencies(pretwist, model)
    monkeypatch.setattr(module, "EXTRA_STATIONS", 36)
    np.testing.assert_allclose(ours, frequencies(pretwist, model), rtol=2e-6)


def test_sections_that_are_turned_too_fast_to_be_worked_out_are_refused():
    """At four turns in two metres the box's edges lie at 58° to the span."""
    with pytest.raises(ValueError, match="large enough beside the section for a pretwist of 12.4 rad/m"):
        frequencies(1440.0, "blade")


@pytest.mark.parametrize(("model", "within"), [("thesis", 1e-4), ("blade", 1e-3)])
def test_a_tube_twists_as_a_shaft_does(model, within):
    """π/2L √(GJ/ρI_p), Bredt's J of a polygon of 64 edges: nothing warps, and the clamp holds nothing back."""
    radius, thickness, length, angle = 0.05, 0.001, 2.0, 2.0 * np.pi * np.arange(64) / 64
    section = PolygonSection(radius * np.column_stack([np.cos(angle), np.sin(angle)]), ["wall"] * 64, thickness)
    beam = RotatingBeam(section, Layup.uniform(Lamina.isotropic(7e10, 0.3, 2700.0), [0]), length, model=model, terms=10)
    start, edges = section.placed_chains[0].points, section.chains[0].lengths
    end = np.roll(start, -1, axis=0)
    area = 0.5 * np.sum(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0])
    polar = thickness * np.sum(edges * ((start**2).sum(axis=1) + (start * end).sum(axis=1) + (end**2).sum(axis=1)) / 3.0)
    torsion = 4.0 * area**2 * thickness / edges.sum()
    expected = 0.5 * np.pi / length * np.sqrt(7e10 / 2.6 * torsion / (2700.0 * polar))
    assert beam.natural_frequencies(count=1, motions=("twist",))[0] == pytest.approx(expected, rel=within)


def test_a_box_that_warps_is_held_by_its_clamp_in_the_thesis_world():
    layup = Layup.uniform(GRAPHITE_EPOXY, [30] * 6)
    for section, order in ((BoxSection(0.254, 0.0508, 0.01016), 2), (BoxSection(0.1, 0.1, 0.005), 1)):
        assert RotatingBeam(section, layup, 2.0, model="thesis").space.root_order("phi") == order
