"""What steady rotation does to a blade: against rods in closed form, and as it must depend on the speed."""

import numpy as np
import pytest

from beamenv.blade.presets import PRESETS, blade_config
from beamenv.structure import BoxSection, Lamina, Layup, RotatingBeam
from beamenv.structure.steady_deformation import INTERVALS, face_strain, steady_deformation

HUB, LENGTH = 0.2, 2.0


def isotropic_rod(**changes):
    """A box of a material without Poisson's effect: the centrifugal pull only stretches it."""
    material = Lamina.isotropic(E=70e9, nu=0.0, density=2700.0)
    section = BoxSection(width=0.2, depth=0.05, thickness=0.004)
    return RotatingBeam(section, Layup.uniform(material, [0.0]), LENGTH, **{"hub_radius": HUB, "steady_state": "linear", **changes})


def test_a_rod_stretches_as_its_own_pull_says():
    """EA s' = ½ ρA Ω² ((R₀ + L)² − (R₀ + z)²), so that s(L) = ρΩ²/E (R₀ L²/2 + L³/3)."""
    speed = 60.0
    state = steady_deformation(isotropic_rod(), speed)
    pull = 2700.0 * speed**2 / 70e9
    assert state.stretch == pytest.approx(pull * (0.5 * HUB * LENGTH**2 + LENGTH**3 / 3.0), rel=1e-6)
    assert state.strain == pytest.approx(0.5 * pull * ((HUB + LENGTH) ** 2 - HUB**2), rel=1e-4)
    assert state.strain_at == 0.0
    assert abs(state.untwist) < 1e-9


def test_in_the_linear_state_everything_grows_with_the_square_of_the_speed():
    beam = isotropic_rod(pretwist_deg=30.0)
    slow, fast = steady_deformation(beam, 20.0), steady_deformation(beam, 60.0)
    for name in ("stretch", "untwist", "strain"):
        assert getattr(fast, name) == pytest.approx(9.0 * getattr(slow, name), rel=1e-9), name
    assert fast.untwist > 0.0
    assert fast.strain_at == slow.strain_at


def test_either_pretwist_is_unwound():
    one, other = (steady_deformation(isotropic_rod(pretwist_deg=angle), 60.0).untwist for angle in (30.0, -30.0))
    assert one == pytest.approx(other, rel=1e-6)
    assert one > 0.0


def test_a_slow_blade_s_non_linear_state_is_the_linear_one():
    linear, nonlinear = (
        steady_deformation(isotropic_rod(pretwist_deg=30.0, steady_state=kind), 5.0) for kind in ("linear", "nonlinear")
    )
    for name in ("stretch", "untwist", "strain"):
        assert getattr(linear, name) == pytest.approx(getattr(nonlinear, name), rel=1e-2), name


def test_a_blade_at_rest_and_the_thesis_model_know_none():
    assert steady_deformation(isotropic_rod(), 0.0).strain == 0.0
    thesis = blade_config(overrides={"model": "thesis"})
    assert steady_deformation(thesis.beam.build(model="thesis"), 200.0).stretch == 0.0


def test_the_thesis_blade_is_strained_beyond_what_it_is_made_of():
    config = PRESETS["thesis"]
    state = steady_deformation(config.beam.build(config.patches), config.speed)
    assert state.strain == pytest.approx(0.0279, rel=0.01)  # 0.030 by solid elements, of the blade without patches
    assert state.stretch == pytest.approx(0.0322, abs=3e-4)  # 33 mm by solid elements
    assert 14.0 < state.untwist < 17.0  # solid elements


@pytest.mark.parametrize("speed", [100.0, 300.0])
def test_the_sound_blade_stays_below_three_parts_in_a_thousand_everywhere(speed):
    config = PRESETS["sound-blade"]
    beam = config.beam.build(config.patches)
    strain = beam.steady_strain(np.linspace(1e-6, 1.0, 5 * INTERVALS + 1) * beam.length, speed)
    assert np.abs(strain).max() < 3e-3
    assert np.abs(strain).max() == pytest.approx(np.abs(face_strain(beam, speed)).max(), rel=5e-3)
    if speed == config.speed:
        assert np.abs(strain).max() < 4e-4
