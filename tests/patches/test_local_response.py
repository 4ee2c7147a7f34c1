"""What patches do where they are: by hand for solid sections of isotropic walls, and by trial functions for the blade."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.config import BeamConfig
from beamenv.patches import MFC, PZT, PatchLayout, actuation, local_response, patch_force
from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam

E, NU = 70e9, 0.3
ISOTROPIC = Layup.uniform(Lamina.isotropic(E=E, nu=NU, density=2700.0), angles_deg=[0])
SECTION = BoxSection(width=0.2, depth=0.05, thickness=0.004)
LENGTH = 2.0
MATERIALS = {"MFC": MFC, "PZT": PZT}


def hollow_rectangle():
    """A and ∫y² dA."""
    w, d, h = SECTION.width, SECTION.depth, SECTION.thickness
    return 2.0 * (w + d) * h, ((w + h) * (d + h) ** 3 - (w - h) * (d - h) ** 3) / 12.0


def resultants_per_volt(material, width):
    """N and M of a sheet flush with the top face: (e_zz − ν e_ss) over its area, for stretch and bending of an isotropic section
    strain it by −ν around at every depth, whatever the section (Saint-Venant): the hoop stress has a moment too.
    """
    span, hoop = material.piezoelectric_stress() / material.electrode_spacing
    force = (span - NU * hoop) * material.thickness * width
    return force, force * (0.5 * SECTION.depth + 0.5 * (SECTION.thickness - material.thickness))


@pytest.mark.parametrize("material", MATERIALS)
def test_energy_and_charge_of_a_patch_are_those_of_its_resultants(material):
    """½ L_p (N²/EA + M²/EI) per V², and for a sensor below the difference: to 1e-6."""
    layout = PatchLayout(actuators=(0.3, 0.9), sensors=(0.9,), material=material, passive=False)
    patch, (area, second) = MATERIALS[material], hollow_rectangle()
    force, moment = resultants_per_volt(patch, layout.width)
    found = local_response(RotatingBeam(SECTION, ISOTROPIC, LENGTH), layout)
    both = layout.length * np.array([force**2 / (E * area), moment**2 / (E * second)])
    assert found.energy == pytest.approx(both.sum() * np.eye(2), rel=1e-6, abs=1e-9 * both.sum())
    charge = patch.charge_per_reaction * (both[0] - both[1])
    assert found.charges == pytest.approx(np.array([[0.0, charge]]), rel=1e-6, abs=1e-9 * abs(charge))


@pytest.mark.parametrize("material", MATERIALS)
@pytest.mark.parametrize("start", [0.3, 0.7, 1.2])
def test_tip_deflection_per_volt_is_that_of_two_opposite_moments_of_solid_sections(material, start):
    """v(L) = −M/(EI) Lp (L − z_p − Lp/2), within 0.1 %.

    Wall kinematics leave out the moment of the hoop stress: 6 % with PZT.
    """
    beam, patch = RotatingBeam(SECTION, ISOTROPIC, LENGTH), MATERIALS[material]
    width, length = 0.057, 0.085
    _, moment = resultants_per_volt(patch, width)
    bent = np.linalg.solve(beam.matrices.elastic_stiffness, patch_force(beam, patch, "top", start, length, width))
    expected = -moment / (E * hollow_rectangle()[1]) * length * (LENGTH - start - 0.5 * length)
    assert beam.displacements(LENGTH)["v"][0] @ bent == pytest.approx(expected, rel=1e-3)


BLADE, LAYOUT = BeamConfig(), PatchLayout()


def by_trial_functions(terms, layout):
    """FᵀK_e⁻¹F."""
    beam = replace(BLADE, terms=terms).build(layout)
    force = actuation(beam, layout)
    return force.T @ np.linalg.solve(beam.matrices.elastic_stiffness, force)


def test_local_energy_does_not_depend_on_the_number_of_trial_functions():
    """From 10 to 25 terms less than 1 % is asked; there is none, for it knows no trial functions."""
    few, many = (local_response(replace(BLADE, terms=terms).build(LAYOUT), LAYOUT) for terms in (10, 25))
    assert few.energy == pytest.approx(many.energy, rel=1e-12)
    assert few.charges == pytest.approx(many.charges, rel=1e-12)


def test_trial_functions_approach_the_local_energy_from_below():
    """10, 16, 28 terms hold ever more of it, on interior patches: 85 mm of 2 m are hard to follow with polynomials."""
    whole = np.diag(local_response(BLADE.build(LAYOUT), LAYOUT).energy)[1:]
    shares = np.array([np.diag(by_trial_functions(terms, LAYOUT))[1:] / whole for terms in (10, 16, 28)])
    assert np.all(np.diff(shares, axis=0) > 0.0)
    assert np.all(shares < 1.0)


def test_long_patches_store_what_trial_functions_find():
    """A patch of 0.7 of the span in the middle of an unpretwisted blade, by 24 terms: 5 % are of its ends and of polynomials."""
    layout = PatchLayout(actuators=(0.2,), sensors=(0.2,), length=1.2)
    local = local_response(replace(BLADE, pretwist_deg=0.0).build(layout), layout).energy[0, 0]
    beam = replace(BLADE, pretwist_deg=0.0, terms=24).build(layout)
    force = actuation(beam, layout)
    found = (force.T @ np.linalg.solve(beam.matrices.elastic_stiffness, force))[0, 0]
    assert 0.95 < found / local < 1.01


def test_default_patches_store_the_energy_of_the_local_formula():
    """½ L_p fᵀS⁻¹f = 6.355e-10 J/V² each by wall resultants on the section of 2-D finite elements: within 2 % (6.452e-10)."""
    assert 0.5 * np.diag(local_response(BLADE.build(LAYOUT), LAYOUT).energy) == pytest.approx(6.355e-10, rel=0.02)
