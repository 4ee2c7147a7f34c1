"""The sheets against their data sheets and hand values."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.patches import MFC, PATCH_MATERIALS, PZT


def test_mfc_strains_by_0_92_ppm_per_volt():
    """d11/electrode spacing = 460 pm/V / 0.5 mm: the field runs between the fingers, not through the sheet."""
    assert MFC.free_strain(1.0) == pytest.approx(0.92e-6)
    assert MFC.free_strain(1500.0) == pytest.approx(1380e-6)
    assert MFC.free_strain(-500.0) == pytest.approx(-460e-6)


def test_mfc_blocks_716_newtons_at_1500_volts():
    """M-8557-P1, 57 mm × 0.3 mm: E1 × free strain × section = 717.4 N, within 0.5 % of the data sheet."""
    blocking_force = MFC.lamina.E1 * MFC.free_strain(1500.0) * 0.057 * MFC.thickness
    assert blocking_force == pytest.approx(716.0, rel=5e-3)


def test_mfc_stress_per_field_is_d_times_the_plane_stress_stiffness():
    """e11 = Q11 d11 + Q12 d12 = 13.635 C/m² and e12 = Q12 d11 + Q22 d12 = −1.125 C/m², with Q = E/(1 − ν12²E2/E1).

    13.61, which is also quoted, takes a rounded Q; e12 agrees to every digit.
    """
    through = 1.0 - 0.31**2 * 15.86 / 30.4
    q11, q22, q12 = 30.4e9 / through, 15.86e9 / through, 0.31 * 15.86e9 / through
    by_hand = [q11 * 460e-12 - q12 * 210e-12, q12 * 460e-12 - q22 * 210e-12]
    assert MFC.piezoelectric_stress() == pytest.approx(by_hand, rel=1e-12)
    assert MFC.piezoelectric_stress() == pytest.approx([13.635, -1.125], abs=6e-4)


def test_fibres_pull_along_the_span():
    """(ss, zz, sz) of the wall: 13.6 C/m² along the span and −1.1 around the section, no shear; turned, −1.1 would be left."""
    assert MFC.stress_in_wall() == pytest.approx([-1.125, 13.635, 0.0], abs=6e-4)


def test_blocked_free_sheet_is_the_free_strain_again():
    """S = Q⁻¹ e E: what the stress per field does to an unloaded sheet is d."""
    strain = np.linalg.solve(MFC.lamina.reduced_stiffness()[:2, :2], MFC.piezoelectric_stress())
    assert strain == pytest.approx([MFC.d11, MFC.d12])


def test_pzt_is_driven_through_its_thickness():
    """E = V/thickness, d31 the same along and across, contracting under a positive voltage."""
    assert PZT.electrode_spacing == PZT.thickness
    assert PZT.free_strain(100.0) == pytest.approx(-140e-12 * 100.0 / PZT.thickness)
    along, across = PZT.piezoelectric_stress()
    assert along < 0.0
    assert across < 0.0
    assert PZT.charge_per_reaction == 1.0


def test_resultants_are_the_moments_of_the_stress_over_the_outer_skin():
    """∫ e (1, n, n³) dn over the sheet's depth per spacing, without hoop coupling."""
    wall, sheet = 0.01, MFC.thickness
    n = np.linspace(0.5 * wall - sheet, 0.5 * wall, 20001)
    stress = MFC.piezoelectric_stress()[0] / MFC.electrode_spacing
    by_hand = [np.trapezoid(stress * n**power, n) for power in (0, 1, 3)]
    resultants = MFC.wall_resultants(wall, hoop_coupling=np.zeros(6))
    assert resultants[:3] == pytest.approx(by_hand, rel=1e-7)
    assert resultants[3:] == pytest.approx(0.0, abs=1e-12 * resultants[0])


def test_hoop_stress_takes_its_share_since_the_wall_is_free_around():
    """f0 = (e_zz − ν e_ss) t/spacing in an isotropic wall; −ν e_ss adds, e_ss being negative."""
    free = MFC.wall_resultants(0.01, hoop_coupling=np.zeros(6))
    coupled = MFC.wall_resultants(0.01, hoop_coupling=np.array([0.3, 0.0, 0.0, 0.0, 0.0, 0.0]))
    gain = -0.3 * MFC.piezoelectric_stress()[1] * MFC.thickness / MFC.electrode_spacing
    assert coupled[0] - free[0] == pytest.approx(gain)
    assert gain > 0.0
    assert coupled[1:] == pytest.approx(free[1:])


def test_capacitance_is_the_data_sheets():
    """14.5 nF of an M-8557-P1's 48.45 cm² at 0.30 nF/cm²; ε33 A/t of a plate of PIC255."""
    assert MFC.capacitance(0.085 * 0.057) == pytest.approx(0.30e-9 * 48.45, rel=1e-12)
    plate = PATCH_MATERIALS["PIC255"]
    assert plate.capacitance(0.05 * 0.025) == pytest.approx(1750.0 * 8.854e-12 * 0.05 * 0.025 / 0.5e-3, rel=1e-4)
    with pytest.raises(ValueError, match="permittivity is None, but must be known"):
        replace(MFC, permittivity=None).capacitance(1e-3)
