"""Where the corners of a section are counted from is bookkeeping; where the blade is, is not."""

from dataclasses import replace

import pytest

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, PolygonSection, RotatingBeam

BOX = BoxSection(0.254, 0.0508, 0.01016)
SECTION = PolygonSection(tuple(map(tuple, BOX.vertices.tolist())), BOX.walls, BOX.thickness)
SHIFTED = replace(SECTION, corners=tuple((x + 0.1, y - 0.07) for x, y in SECTION.corners))
LAYUP = Layup.by_wall(GRAPHITE_EPOXY, top=[30] * 6, bottom=[45] * 6, left=[30] * 6, right=[60] * 6)
BLADE = RotatingBeam(SECTION, LAYUP, 2.023, hub_radius=0.2023, pretwist_deg=30.0, presetting_deg=20.0)


@pytest.mark.parametrize("taper", [1.0, 1.5])
@pytest.mark.parametrize("steady_state", ["linear", "nonlinear"])
@pytest.mark.parametrize("speed", [0.0, 200.0])
def test_frequencies_do_not_change_with_the_origin_of_the_corners(taper, steady_state, speed):
    """Moved by (0.1, −0.07) m: 1e-6 relative is asked, rotating, pretwisted, preset and tapered."""
    one, other = (replace(BLADE, section=section, taper=taper, steady_state=steady_state) for section in (SECTION, SHIFTED))
    assert other.natural_frequencies(speed, 12) == pytest.approx(one.natural_frequencies(speed, 12), rel=1e-6)


@pytest.fixture
def off_axis(monkeypatch):
    """Sections that stay where their corners are, beside the pitch axis, and with them the blade."""
    monkeypatch.setattr(PolygonSection, "placed_chains", property(lambda section: section.chains))


def beside(shift, speed, **options):
    """Frequencies of a box with its axis (x, y) m from the pitch axis, over those on it."""
    blade = replace(BLADE, presetting_deg=0.0, **options)
    moved = replace(blade, section=replace(SECTION, corners=tuple((x + shift[0], y + shift[1]) for x, y in SECTION.corners)))
    return moved.natural_frequencies(speed, 6, gyroscopic=False) / blade.natural_frequencies(speed, 6, gyroscopic=False)


def test_another_reference_line_in_the_same_blade_changes_no_frequency_at_rest(off_axis):
    """The equations are written for a line beside the sections: stretch, bending, twist and inertia then all couple."""
    assert beside((0.1, -0.07), 0.0, pretwist_deg=0.0) == pytest.approx(1.0, abs=1e-6)


def test_a_blade_beside_the_radius_vibrates_as_solid_elements_say(off_axis, isotropic):
    """0.1 m along the chord, 200 rad/s, pretwisted aluminium: flap −0.2 and twist +0.1 %, by wall kinematics −1.4 and +6.4 %."""
    flap, twist = 100.0 * (beside((0.1, 0.0), 200.0, layup=isotropic, steady_state="linear") - 1.0)[[0, 3]]
    assert flap == pytest.approx(-0.2, abs=0.06)
    assert twist == pytest.approx(0.1, abs=0.06)
