"""Where patches may lie, and what is said about where they may not."""

import math
import re

import pytest

from beamenv.patches import MFC, PZT, PatchLayout, actuation, patch_force
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, RotatingBeam

SPAN = 2.0
BLADE = RotatingBeam(BoxSection(0.254, 0.0508, 0.01016), Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30]), SPAN)


def test_a_number_of_patches_is_spaced_equally_over_the_inner_seven_tenths():
    layout = PatchLayout(actuators=4, sensors=2)
    assert layout.actuator_positions(SPAN) == pytest.approx((0.0, 1.315 / 3, 2 * 1.315 / 3, 1.315))
    assert layout.sensor_positions(SPAN) == pytest.approx((0.0, 1.4 - 0.085))


def test_a_single_patch_sits_at_the_root():
    assert PatchLayout(actuators=1).actuator_positions(SPAN) == (0.0,)


@pytest.mark.parametrize("edge", [-1e-12, 1.4 - 0.085 + 1e-12])
def test_a_position_that_rounding_has_moved_out_of_bounds_lies_on_them(edge):
    layout = PatchLayout(actuators=[edge, 0.5])
    starts = layout.actuator_positions(SPAN)
    assert starts == (min(max(edge, 0.0), 1.4 - 0.085), 0.5)
    assert RotatingBeam(BLADE.section, BLADE.layup, SPAN, inlays=layout.inlays(SPAN)).inlays[0].start == starts[0]
    assert actuation(BLADE, layout).shape == (96, 2)


def test_given_positions_are_kept_in_their_order():
    assert PatchLayout(actuators=[0.9, 0.1]).actuator_positions(SPAN) == (0.9, 0.1)


def test_patches_may_touch_each_other_and_both_limits():
    layout = PatchLayout(actuators=(0.0, 0.085, 1.315))
    assert layout.actuator_positions(SPAN) == (0.0, 0.085, 1.315)
    assert len(layout.inlays(SPAN)) == 3 + 4


def test_actuators_are_above_and_sensors_below_with_fibres_along_the_span():
    inlays = PatchLayout(actuators=2, sensors=3).inlays(SPAN)
    assert [inlay.wall for inlay in inlays] == ["top"] * 2 + ["bottom"] * 3
    assert {inlay.ply.angle_deg for inlay in inlays} == {90.0}


def test_material_names_give_their_sheets():
    assert PatchLayout(material="MFC").only("actuators").patch is MFC
    assert PatchLayout(material="PZT").only("sensors").patch is PZT


def placed(**fields):
    return lambda: PatchLayout(**fields).inlays(SPAN)


REFUSED = {
    "overlap": (
        placed(actuators=(0.0, 0.05)),
        r"blade.patches.actuators is \(0\.0, 0\.05\), but must be at least one patch length, 0\.085 m, apart",
    ),
    "too many": (placed(sensors=18), "blade.patches.sensors is 18, but must be at least one patch length, 0.085 m, apart"),
    "same place twice": (
        placed(actuators=(0.4, 0.4)),
        "blade.patches.actuators is .*, but must be .*so that patches do not overlap",
    ),
    "before the root": (
        placed(actuators=(-0.01,)),
        r"blade.patches.actuators is \(-0\.01,\), but must be root-side edges between 0 and 1\.315 m",
    ),
    "beyond 0.7 L": (
        placed(sensors=(1.32,)),
        r"blade.patches.sensors is \(1\.32,\), but must be .* within 0 and 0\.7 of the 2 m span",
    ),
    "no room at all": (
        placed(length=1.5),
        r"patches.length is 1\.5 \(did you give millimetres\?\), but must be at most 0\.7 of the",
    ),
    "unknown material": (placed(material="PVDF"), "blade.patches.material is 'PVDF', but must be one of MFC, PZT"),
    "none": (placed(actuators=0), "blade.patches.actuators is 0, but must be a number of patches, at least one"),
    "minus one": (placed(sensors=-1), "blade.patches.sensors is -1, but must be a number of patches, at least one"),
    "empty list": (placed(actuators=()), r"blade.patches.actuators is \(\), but must be .* one or more finite positions"),
    "not a number": (
        placed(actuators=(0.1, math.nan)),
        r"blade.patches.actuators is \(0\.1, nan\), but must be .* one or more finite positions",
    ),
    "yes": (placed(actuators=True), "blade.patches.actuators is True, but must be a number of patches, at least one, or a list"),
    "text": (
        placed(actuators="root"),
        "blade.patches.actuators is 'root', but must be a number of patches, at least one, or a list",
    ),
    "no length": (placed(length=0.0), r"blade.patches.length is 0\.0, but must be a number above 0"),
    "width as text": (placed(width="57 mm"), "blade.patches.width is '57 mm', but must be a number above 0"),
    "wider than the wall, passive or not": (
        lambda: actuation(BLADE, PatchLayout(width=0.3, passive=False)),
        r"inlay\.width is 0\.3, but must be positive and at most the top wall's 0\.254 m",
    ),
    "off the blade": (
        lambda: patch_force(BLADE, MFC, "top", 1.95, 0.1, 0.05),
        r"inlay\.start is 1\.95, but .*its end, 2\.05, on the blade",
    ),
    "on no wall": (lambda: patch_force(BLADE, MFC, "nose", 0.1, 0.1, 0.05), "wall is 'nose', but must be one wall of the section"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_layout_is_refused_by_name_and_value(case):
    attempt, words = REFUSED[case]
    with pytest.raises(ValueError, match=words) as refusal:
        attempt()
    assert re.fullmatch(r"[^\n]+\.", str(refusal.value))
