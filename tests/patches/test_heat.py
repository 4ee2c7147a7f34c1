"""Patches that are warm: what a volt does and shows, when they refuse, and how a sheet bends what it is bonded to."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import Blade
from beamenv.blade.config import BeamConfig, BladeConfig
from beamenv.patches import MFC, PATCH_MATERIALS, PatchLayout, actuation, local_response, sensing
from beamenv.patches.group import PatchGroup
from beamenv.patches.material import PZT
from beamenv.patches.operators import charge_per_kelvin
from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam, StripSection
from beamenv.task import resolve_task

ALUMINIUM = Layup.uniform(Lamina.isotropic(70e9, 0.33, 2700.0, alpha=23e-6), [0.0])
MADE_AT = 300.0
UNKNOWN = replace(MFC, lamina=replace(MFC.lamina, alpha1=None, alpha2=None))
LAYOUT = PatchLayout(actuators=(0.3, 0.9), sensors=(0.9,), passive=False)


def beam(**options):
    return RotatingBeam(BoxSection(0.2, 0.05, 0.004), ALUMINIUM, 2.0, **options)


@pytest.mark.parametrize("rise", [-70.0, 80.0])
@pytest.mark.parametrize("name", PATCH_MATERIALS)
def test_free_strain_rises_as_the_root_of_permittivity(name, rise):
    """d = k √(ε s), with 0.4 % of ε per K."""
    sheet = PATCH_MATERIALS[name]
    warm = sheet.at(MADE_AT + rise)
    share = 1.0 + 4e-3 * rise
    assert warm.capacitance(1e-3) == pytest.approx(share * sheet.capacitance(1e-3), rel=1e-12)
    assert (warm.d11 / sheet.d11) ** 2 == pytest.approx(share, rel=1e-12)
    assert warm.d12 / warm.d11 == pytest.approx(sheet.d12 / sheet.d11, rel=1e-12)


def test_force_charge_and_energy_of_a_warm_patch_follow():
    """Force and charge per strain with d, energy and charge per volt with its square, of walls that do not soften: within 0.3 %,
    for the blade is longer by 0.18 %.
    """
    either = [local_response(beam(temperature=temperature), LAYOUT) for temperature in (None, MADE_AT + 80.0)]
    assert either[1].energy == pytest.approx(1.32 * either[0].energy, rel=3e-3, abs=3e-3 * np.abs(either[0].energy).max())
    assert either[1].charges == pytest.approx(1.32 * either[0].charges, rel=3e-3, abs=3e-3 * np.abs(either[0].charges).max())
    forces = [actuation(beam(temperature=temperature), LAYOUT) for temperature in (None, MADE_AT + 80.0)]
    assert forces[1] == pytest.approx(np.sqrt(1.32) * forces[0], rel=3e-3, abs=3e-3 * np.abs(forces[0]).max())


def test_along_a_table_each_patch_is_as_warm_as_the_blade_there():
    table = ((0.0, MADE_AT), (1.0, MADE_AT + 80.0))
    found = local_response(beam(temperature_table=table), LAYOUT).energy
    cold = local_response(beam(), LAYOUT).energy
    rises = 80.0 * (np.array([0.3, 0.9]) + 0.5 * LAYOUT.length) / 2.0
    assert np.diag(found) / np.diag(cold) == pytest.approx(1.0 + 4e-3 * rises, rel=3e-3)


def test_springs_take_of_the_energy_what_they_hold_of_the_tip():
    """FᵀK⁻¹F − dᵀ (S⁻¹ + C)⁻¹ d, of the free blade's tip per volt d and compliance C, and the springs' S (Woodbury)."""
    springs = np.array([1e5, 2e5, 1e7, 3e3, 2e3, 1e3])
    free, held = beam(), beam(tip_springs=tuple(springs))
    rows = np.stack([row[0] for row in (free.displacements(2.0)[name] for name in ("u", "v", "s", "theta_x", "theta_y", "phi"))])
    static = np.linalg.solve(free.at(0.0).stiffness, np.column_stack([actuation(free, LAYOUT), rows.T]))
    moved, compliance = rows @ static[:, :2], rows @ static[:, 2:]
    taken = moved.T @ np.linalg.solve(np.diag(1.0 / springs) + compliance, moved)
    found = local_response(held, LAYOUT).energy
    assert found == pytest.approx(local_response(free, LAYOUT).energy - taken, rel=1e-6, abs=1e-9 * np.abs(found).max())
    assert np.abs(taken).max() > 0.04 * np.abs(found).max()
    either = local_response(free, LAYOUT).charges, local_response(held, LAYOUT).charges
    shown = sensing(free, LAYOUT) @ static[:, 2:] @ np.linalg.solve(np.diag(1.0 / springs) + compliance, moved)
    assert either[1] == pytest.approx(either[0] - shown, rel=1e-6, abs=1e-9 * np.abs(either[0]).max())
    assert np.abs(shown).max() > 0.04 * np.abs(either[0]).max()


def test_a_sheet_that_expands_less_bends_a_strip_as_two_layers():
    """Timoshenko's curvature of PZT on aluminium, over the length of the sheet; the strip's contraction differs by little."""
    length, layer, sheet = 0.2, 0.001, PATCH_MATERIALS["PIC255"]
    inlay = sheet.inlay("strip", 0.0, length, 0.01, bonded=True)
    strip = RotatingBeam(StripSection(0.01, layer), ALUMINIUM, length, inlays=(inlay,), temperature=MADE_AT + 50.0)
    m, n = sheet.thickness / layer, sheet.lamina.E1 / 70e9
    depth = layer + sheet.thickness
    curvature = 6.0 * (23e-6 - 3e-6) * 50.0 * (1.0 + m) ** 2
    curvature /= depth * (3.0 * (1.0 + m) ** 2 + (1.0 + m * n) * (m**2 + 1.0 / (m * n)))
    turned = (strip.displacements(length)["theta_x"] @ strip.at(0.0).steady.coefficients)[0]
    assert abs(turned) == pytest.approx(curvature * length, rel=0.02)


def test_a_sheet_that_expands_as_the_blade_does_gives_the_charge_of_a_free_one():
    """p A, whatever way it lies; and on a blade that it does not stiffen, with σ = Q (α_blade − α_sheet), d·σ A more."""
    blade = beam(temperature=MADE_AT)
    for sheet in (MFC, PZT):
        alike = replace(sheet, lamina=replace(sheet.lamina, alpha1=23e-6, alpha2=23e-6))
        for angle in (90.0, 20.0):
            group = PatchGroup(positions=(0.3, 0.9), wall="bottom", passive=False, material=alike, angle_deg=angle)
            area = group.length * group.width
            assert charge_per_kelvin(blade, group) == pytest.approx([alike.pyroelectric * area] * 2, rel=1e-9)
        group = PatchGroup(positions=(0.3,), wall="bottom", passive=False, material=sheet)
        along, across = sheet.lamina.expansion
        stress = sheet.lamina.reduced_stiffness() @ np.array([23e-6 - along, 23e-6 - across, 0.0])
        more = float(stress[:2] @ np.array([sheet.d11, sheet.d12]))
        assert charge_per_kelvin(blade, group) == pytest.approx([(sheet.pyroelectric + more) * area], rel=1e-9)


@pytest.mark.parametrize(("name", "warmest"), [("MFC", 403.15), ("PZT", 448.15)])
def test_a_blade_hotter_than_its_patches_may_be_is_refused_in_a_sentence(name, warmest):
    layout = PatchLayout(material=name)
    with pytest.raises(ValueError, match=rf"blade.beam.temperature is 460.0, but must be a number from 173.15 to {warmest} \(K\)"):
        BladeConfig(beam=BeamConfig(temperature=460.0, material="aluminium"), patches=layout)


def test_a_sheet_that_loses_its_permittivity_is_refused_by_the_temperature():
    layout = PatchLayout(material=replace(MFC, permittivity_per_K=-0.02))
    with pytest.raises(ValueError, match=r"blade.beam.temperature is 370.0, but must be one at which permittivity_per_K = -0.02"):
        BladeConfig(beam=BeamConfig(temperature=370.0), patches=layout)


@pytest.mark.parametrize(
    ("patches", "path"),
    [
        ({"material": UNKNOWN}, "blade.patches.material"),
        ({"sensors": [{"positions": 1}, {"positions": [1.0], "material": UNKNOWN}]}, r"blade.patches.sensors\[1\].material"),
    ],
)
def test_a_sheet_of_unknown_expansion_is_refused_by_its_path(patches, path):
    with pytest.raises(ValueError, match=f"{path}.lamina.alpha1 is None, but must be a number"):
        resolve_task(blade={"beam": {"temperature": 310.0}, "patches": patches})


def test_a_sheet_that_is_not_in_the_wall_needs_no_expansion_until_its_charge_is_asked_for():
    blade = {"patches": {"material": UNKNOWN, "passive": False}}
    plants = {"temperature": 310.0, "bank": 2}
    assert len(resolve_task(blade=blade, scenario={"plants": plants}).bank) == 2
    with pytest.raises(ValueError, match="blade.patches.material.lamina.alpha1 is None"):
        _ = resolve_task(blade=blade, scenario={"plants": plants | {"pyroelectric": True}}).bank


def test_a_sheet_is_as_stiff_as_it_is_warm():
    softens = ((200.0, 1.0), (300.0, 1.0), (400.0, 0.5))
    lamina = replace(MFC.lamina, curves=dict.fromkeys(("E1", "E2", "G12"), softens))
    warm = replace(MFC, lamina=lamina, permittivity_per_K=0.0).at(380.0)
    assert warm.piezoelectric_stress() == pytest.approx(0.6 * MFC.piezoelectric_stress(), rel=1e-12)


def test_a_sheet_without_data_is_the_same_at_any_temperature():
    sheet = replace(PZT, permittivity_per_K=0.0, warmest=None)
    warm = sheet.at(900.0)
    assert (warm.d11, warm.permittivity) == (sheet.d11, sheet.permittivity)
    assert MFC.at(MADE_AT).d11 == MFC.d11


def test_a_plant_at_the_reference_is_that_without_a_temperature():
    plants = [Blade(BladeConfig(beam=BeamConfig(temperature=temperature))).truth for temperature in (None, MADE_AT)]
    cold, warm = (responses(plant) for plant in plants)
    for one, other in zip(warm, cold, strict=True):
        assert np.abs(one - other).max() < 1e-5 * np.abs(other).max()
    assert plants[1].input_weight == pytest.approx(plants[0].input_weight, rel=1e-7)


def responses(plant):
    """Readings per volt at three frequencies."""
    n = len(plant.A)
    return [plant.C @ np.linalg.solve(1j * omega * np.eye(n) - plant.A, plant.B) for omega in (1.0, 150.0, 900.0)]
