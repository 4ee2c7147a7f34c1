import pytest

from beamenv.structure.sweep import frequency_sweep
from train.reproduce.studies.chapter5_passive import SHEETS
from train.reproduce.studies.closed_loop import patches
from train.reproduce.studies.study_patches import FIELD_OVER_THICKNESS, PRINTED_DENSITY, covering
from train.reproduce.thesis import Model
from train.reproduce.thesis.configurations import built


def test_sheets_of_the_printed_density_are_heavier_than_those_of_the_data_sheet():
    blade = Model().blade(30.0)
    (listed,), (printed,) = (frequency_sweep([built(blade, SHEETS[name])], [0.0], 1)[0] for name in ("MFC", "MFC, printed density"))
    (sheet,) = SHEETS["MFC, printed density"].groups("actuators")
    assert sheet.patch is PRINTED_DENSITY and printed[0] < listed[0]


def test_a_field_of_v_over_thickness_acts_more_per_volt():
    (listed,), (printed,) = (patches(material=material).groups("actuators") for material in ("MFC", FIELD_OVER_THICKNESS))
    assert printed.patch.electrode_spacing < listed.patch.electrode_spacing


@pytest.mark.parametrize("share", [0.1, 1.0])
def test_a_covering_patch_reaches_from_the_root_to_any_place_up_to_the_tip(share):
    length = Model().box.length
    for inlay in covering(share * length, 0.2).inlays(length):
        assert (inlay.start, inlay.start + inlay.length) == (0.0, pytest.approx(share * length))
