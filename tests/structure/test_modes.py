"""Natural frequencies and mode shapes: residuals, an independent eigensolver, families, theories."""

import pickle

import numpy as np
import pytest

from beamenv.structure import GRAPHITE_EPOXY, Layup, PolygonSection, RotatingBeam
from beamenv.structure.modes import whirling_frequencies

OBLIQUE = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6)
SPEED = 200.0


@pytest.fixture(scope="module")
def blade(thesis_section, world):
    return RotatingBeam(thesis_section, OBLIQUE, length=2.023, hub_radius=0.2023, pretwist_deg=30.0, **world)


@pytest.fixture(scope="module")
def blade_at_rest(thesis_section, thesis_world):
    """Which vibrates about its shape at rest at any speed."""
    return RotatingBeam(thesis_section, OBLIQUE, length=2.023, hub_radius=0.2023, pretwist_deg=30.0, **thesis_world)


def first_order_eigenvalues(beam, speed):
    """λ of ẋ = [[0, I], [−M⁻¹K, −M⁻¹G]] x by the general eigensolver."""
    matrices, size = beam.matrices, beam.space.size
    damping, stiffness = speed * matrices.gyroscopic, matrices.stiffness(speed)
    below = -np.linalg.solve(matrices.mass, np.hstack([stiffness, damping]))
    return np.linalg.eigvals(np.vstack([np.hstack([np.zeros((size, size)), np.eye(size)]), below]))


@pytest.mark.parametrize("speed", [1.0, SPEED, 1200.0])
def test_whirling_frequencies_are_the_imaginary_parts_of_the_first_order_matrix(blade_at_rest, speed):
    eigenvalues = first_order_eigenvalues(blade_at_rest, speed)
    upper = np.sort(eigenvalues.imag[eigenvalues.imag > 0.0])
    assert blade_at_rest.natural_frequencies(speed, 30) == pytest.approx(upper[:30], rel=1e-6)


def test_whirling_is_not_the_root_of_the_stiffness(blade_at_rest):
    """|Im λ|, not √λ of K: the coupling takes 3 % from the first frequency at 200 rad/s."""
    with_it, without = (blade_at_rest.natural_frequencies(SPEED, 1, gyroscopic=switch)[0] for switch in (True, False))
    assert with_it / without - 1.0 == pytest.approx(-0.032, abs=0.001)  # own output: guards, does not prove


@pytest.mark.parametrize("gyroscopic", [True, False])
def test_mode_shapes_leave_no_residual_and_have_unit_modal_mass(blade_at_rest, gyroscopic):
    """(−ω²M + iωG + K) ψ = 0 for q = Re(ψ exp(iωt)), and ψᴴMψ = 1."""
    modes, matrices = blade_at_rest.modes(SPEED, 12, gyroscopic=gyroscopic), blade_at_rest.matrices
    coupling = SPEED * matrices.gyroscopic if gyroscopic else np.zeros_like(matrices.mass)
    for frequency, shape in zip(modes.natural_frequencies, modes.mode_shapes.T, strict=True):
        inertia = frequency**2 * matrices.mass @ shape
        residual = matrices.stiffness(SPEED) @ shape + 1j * frequency * coupling @ shape - inertia
        assert np.abs(residual).max() < 1e-8 * np.abs(inertia).max()
        assert (shape.conj() @ matrices.mass @ shape).real == pytest.approx(1.0)


def test_frequencies_come_with_the_modes(blade):
    for gyroscopic in (True, False):
        assert blade.modes(SPEED, 8, gyroscopic=gyroscopic).natural_frequencies == pytest.approx(
            blade.natural_frequencies(SPEED, 8, gyroscopic=gyroscopic), rel=1e-9
        )


def test_shapes_of_chosen_motions_stay_within_them(blade):
    modes = blade.modes(SPEED, 3, motions=("flap",))
    outside = np.setdiff1d(np.arange(blade.space.size), blade.space.columns(("flap",)))
    assert modes.families == ("flap", "flap", "flap")
    assert not np.any(modes.mode_shapes[outside])
    assert modes.participation[:, 1] == pytest.approx(1.0)


def test_isotropic_untwisted_blade_at_rest_has_pure_families_in_the_order_of_their_own_frequencies(
    thesis_section, isotropic, world
):
    """Nothing couples them: each mode is of one family alone, and the frequencies are those of the four motions, merged."""
    beam = RotatingBeam(thesis_section, isotropic, length=2.023, **world)
    modes = beam.modes(0.0, 9)
    motions = ("lag", "flap", "extension", "twist")
    alone = sorted((frequency, motion) for motion in motions for frequency in beam.natural_frequencies(0.0, 6, (motion,)))[:9]
    assert modes.natural_frequencies == pytest.approx([frequency for frequency, _ in alone], rel=1e-8)
    assert modes.families == tuple(motion for _, motion in alone)
    assert modes.families[:5] == ("flap", "lag", "flap", "twist", "flap")
    assert modes.participation.max(axis=1) == pytest.approx(1.0, abs=1e-9)


def test_upright_chord_swaps_lag_and_flap(thesis_section, isotropic, world):
    beam = RotatingBeam(thesis_section, isotropic, length=2.023, presetting_deg=90.0, **world)
    assert beam.modes(0.0, 5).families == ("lag", "flap", "lag", "twist", "lag")


@pytest.mark.parametrize("model", ["blade", "thesis"])
def test_each_freedom_of_the_section_lowers_the_frequencies(thesis_section, isotropic, model):
    """Rigid theory is first-order shear theory with γ = 0 imposed: its frequencies cannot be lower.

    In the blade's model as long as shear couples with nothing: there rigid sections do not turn against the reference line, and
    otherwise strain as they please.
    """
    layup, pretwist = (OBLIQUE, 30.0) if model == "thesis" else (isotropic, 0.0)
    rigid, first = (
        RotatingBeam(thesis_section, layup, 2.023, pretwist_deg=pretwist, shear=shear, model=model).natural_frequencies(0.0, 20)
        for shear in ("rigid", "first_order")
    )
    assert np.all(first <= rigid * (1.0 + 1e-9))
    assert np.any(first < 0.99 * rigid)


def test_past_the_critical_speed_modes_are_named_unstable_by_a_zero_not_by_an_error(blade_at_rest):
    speed = 1.2 * blade_at_rest.critical_speed
    assert blade_at_rest.natural_frequencies(speed, 3)[0] == 0.0
    assert blade_at_rest.natural_frequencies(speed, 3, gyroscopic=False)[0] == 0.0
    with pytest.raises(ValueError, match=r"speed is .*, but must be below the critical speed, 158"):
        blade_at_rest.modes(speed)


def test_one_oscillator_with_gyroscopic_coupling():
    """Foucault's pendulum: ω = √(ω₀² + Ω²) ± Ω for m = 1, g = 2Ω, k = ω₀²."""
    natural, spin = 3.0, 0.4
    coupling = 2.0 * spin * np.array([[0.0, -1.0], [1.0, 0.0]])
    found = whirling_frequencies(np.eye(2), coupling, natural**2 * np.eye(2))
    assert found == pytest.approx(np.hypot(natural, spin) + spin * np.array([-1.0, 1.0]))


def test_box_and_the_polygon_of_its_corners_give_one_blade(blade, world):
    corners = ((0.127, -0.0254), (0.127, 0.0254), (-0.127, 0.0254), (-0.127, -0.0254))
    polygon = PolygonSection(corners, ("right", "top", "left", "bottom"), 0.01016)
    other = RotatingBeam(polygon, OBLIQUE, length=2.023, hub_radius=0.2023, pretwist_deg=30.0, **world)
    assert np.array_equal(other.natural_frequencies(SPEED), blade.natural_frequencies(SPEED))


def test_blade_survives_pickling(blade):
    copy = pickle.loads(pickle.dumps(blade))
    assert np.array_equal(copy.natural_frequencies(SPEED), blade.natural_frequencies(SPEED))
    assert copy.layup == blade.layup
    assert hash(copy.layup) == hash(blade.layup)
