"""What sections of one shape share, and that sharing changes nothing."""

import numpy as np
import pytest

from beamenv.blade.build import Blade
from beamenv.blade.changed import changed_blade
from beamenv.blade.presets import blade_config
from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, Web
from beamenv.structure.section import equations
from beamenv.structure.section.integrals import _remembered
from beamenv.structure.section.section import mesh_of

SECTION = BoxSection(0.20, 0.06, 0.004, webs=(Web(0.35),))


def test_sparse_systems_have_the_solutions_of_dense_ones(monkeypatch):
    """A two-cell box, whose web's ends are joints, by both: all 36 stiffnesses to 10⁻¹⁰ of the diagonals."""
    layup = Layup.uniform(GRAPHITE_EPOXY, [30.0, -50.0, 70.0])
    dense = SECTION.properties(layup).stiffness
    monkeypatch.setattr(equations, "DENSE", 0)
    sparse = SECTION.properties(layup).stiffness
    unit = np.sqrt(np.diag(dense))
    assert not np.array_equal(sparse, dense)  # it was another way
    np.testing.assert_allclose(sparse / np.outer(unit, unit), dense / np.outer(unit, unit), atol=1e-10)


def test_blades_of_other_plies_share_their_elements():
    config = blade_config("airfoil-blade")
    others = [
        changed_blade(config, speed=1.0, ply_angle=angle, modulus=0.97, mass=1.02, damping_ratio=0.01) for angle in (1.03, 1.05)
    ]
    one, two = (Blade(each).beam.exact.sections.solid for each in others)
    assert one.mesh is two.mesh
    assert not np.array_equal(one.stiffness, two.stiffness)


def test_what_is_remembered_changes_no_bit():
    """A blade before and after another of its shape, and with nothing remembered."""
    config = blade_config("airfoil-blade")
    other = changed_blade(config, speed=1.0, ply_angle=1.05, modulus=0.97, mass=1.02, damping_ratio=0.01)
    energies = []
    for forgets in (True, False, True):
        if forgets:
            _remembered.cache_clear()
            mesh_of.cache_clear()
        energies.append(Blade(config).beam.exact.sections.solid.energy)
        assert not np.array_equal(Blade(other).beam.exact.sections.solid.energy, energies[-1])
    assert np.array_equal(energies[0], energies[1])
    assert np.array_equal(energies[0], energies[2])


def test_a_wall_that_is_none_has_no_width():
    assert SECTION.wall_width("web") == pytest.approx(0.06)
    with pytest.raises(ValueError, match=r"wall is 'nose', but must be one wall of the section: right, top"):
        SECTION.wall_width("nose")
