"""What holds for every blade: random lay-ups, planforms and theories."""

from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from beamenv.structure import GRAPHITE_EPOXY, BoxSection, Layup, RotatingBeam, assembly
from beamenv.structure.stations import Stations
from beamenv.structure.walls.wall_kinematics import motion_rows

ANGLES = st.lists(st.floats(-90.0, 90.0), min_size=1, max_size=4)
WALLS = ("top", "bottom", "left", "right")


@st.composite
def layups(draw):
    if draw(st.booleans()):
        return Layup.uniform(GRAPHITE_EPOXY, draw(ANGLES))
    return Layup.by_wall(GRAPHITE_EPOXY, **{wall: draw(ANGLES) for wall in WALLS})


FEW_TERMS, ANY_LAYUP, ANY_PRETWIST = st.integers(2, 7), layups(), st.floats(-60.0, 60.0)
THESIS = st.sampled_from([{"model": "thesis"}, {"model": "thesis", "shear_flow": "consistent"}])
ANY_MODEL = st.just({}) | THESIS


@st.composite
def blades(draw, terms=FEW_TERMS, layup=ANY_LAYUP, pretwist=ANY_PRETWIST, model=ANY_MODEL):
    """Boxes of the thesis' order of size with random walls, lay-ups and theories."""
    world = draw(model)
    thinnest = 0.001 if world else 0.005  # thinner solid walls that twist by a radian a metre distort as no size of them alike
    return RotatingBeam(
        section=BoxSection(draw(st.floats(0.1, 0.3)), draw(st.floats(0.04, 0.2)), draw(st.floats(thinnest, 0.015))),
        layup=draw(layup),
        length=draw(st.floats(1.0, 4.0)),
        hub_radius=draw(st.floats(0.0, 1.0)),
        pretwist_deg=draw(pretwist),
        presetting_deg=draw(st.floats(-90.0, 90.0)),
        taper=draw(st.floats(1.0, 2.0)),
        shear=draw(st.sampled_from(["higher_order", "first_order", "rigid"])),
        terms=draw(terms),
        **world,
    )


SHARE_OF_CRITICAL_SPEED = st.floats(0.0, 0.98)
MODERATE = 0.15
"""Of the critical speed: up to here a blade keeps its shape by and large, as the thesis has it at every speed."""
few = settings(max_examples=40)
fewer = settings(max_examples=12)
"""Where solid sections of the blade's model take their time."""


@few
@given(beam=blades(model=THESIS))
def test_mass_and_stiffness_come_out_of_their_integrals_symmetric(beam):
    """Before their round-off is removed: a quadratic form that was put together wrongly would show here, and nowhere later."""
    with patch.object(assembly, "symmetric", lambda matrix: matrix):
        raw = replace(beam).matrices
    for matrix in (raw.mass, raw.elastic_stiffness, raw.spin_stiffness):
        assert matrix == pytest.approx(matrix.T, rel=0.0, abs=1e-13 * np.abs(matrix).max())


@few
@given(beam=blades(model=THESIS))
def test_the_gyroscopic_matrix_is_the_virtual_work_of_the_coriolis_force(beam):
    """2ρΩ (δU Ẇ − δW U̇) per volume, by a quadrature of its own through the wall; that it does no work on the motion follows."""
    stations = Stations.between(np.array([0.0, beam.length]), beam.space.terms + 8)
    walls = beam.walls_at(stations.z)
    motion = motion_rows(walls.points, walls.flow, walls.laws.thickness, beam.shear)
    displaced = assembly.generalised_displacements(beam.space.evaluate(stations.z))
    nodes, weights = np.polynomial.legendre.leggauss(4)
    half = 0.5 * beam.section.thickness
    work = np.zeros((beam.space.size, beam.space.size))
    for depth, share in zip(half * nodes, half * weights, strict=True):
        lag, span = (np.array([1.0, depth, depth**3]) @ part @ displaced for part in (motion.lag, motion.span))
        mass = GRAPHITE_EPOXY.density * share * stations.weight[:, None] * walls.points.ds
        weighted = (mass[..., None] * lag).reshape(-1, beam.space.size).T @ span.reshape(-1, beam.space.size)
        work += 2.0 * (weighted - weighted.T)
    assert beam.matrices.gyroscopic == pytest.approx(work, rel=0.0, abs=1e-11 * np.abs(work).max())


@fewer
@given(beam=blades())
def test_mass_and_elastic_stiffness_are_positive_definite(beam):
    """Every motion has kinetic energy and every deformation strain energy."""
    for matrix in (beam.matrices.mass, beam.matrices.elastic_stiffness):
        scale = np.sqrt(np.diag(matrix))
        assert np.linalg.eigvalsh(matrix / np.outer(scale, scale)).min() > 0.0


def runaway(beam):
    """Speed (rad/s) at which the blade as a rod of constant stiffness would run away, (π/2L)√(EA/m); the thesis' critical one."""
    if beam.model == "thesis":
        return beam.critical_speed
    solid = beam.exact.sections.solid
    return 0.5 * np.pi / beam.length * np.sqrt(solid.stiffness[0, 2, 2] / solid.inertia[0, 0])


@fewer
@given(beam=blades(), share=st.floats(0.0, MODERATE))
def test_no_mode_is_unstable_at_moderate_speed(beam, share):
    assert np.all(beam.natural_frequencies(share * runaway(beam), beam.space.size) > 0.0)


@few
@given(beam=blades(model=THESIS), share=SHARE_OF_CRITICAL_SPEED)
def test_frequencies_are_real_below_the_critical_speed(beam, share):
    """K > 0 there, so that every λ of the first-order matrix is imaginary: no mode diverges or flutters."""
    speed = share * beam.critical_speed
    frequencies = beam.natural_frequencies(speed, beam.space.size)
    assert np.all(frequencies > 0.0)
    matrices, size = beam.matrices, beam.space.size
    below = -np.linalg.solve(matrices.mass, np.hstack([matrices.stiffness(speed), speed * matrices.gyroscopic]))
    eigenvalues = np.linalg.eigvals(np.vstack([np.hstack([np.zeros((size, size)), np.eye(size)]), below]))
    assert np.abs(eigenvalues.real).max() < 1e-6 * np.abs(eigenvalues).max()
    assert np.sort(np.abs(eigenvalues.imag))[::2][-3:] == pytest.approx(frequencies[-3:], rel=1e-6)


@few
@given(beam=blades(model=THESIS))
def test_the_critical_speed_is_the_first_at_which_a_mode_loses_its_stiffness(beam):
    below, above = (
        beam.natural_frequencies(factor * beam.critical_speed, 1, gyroscopic=False)[0] for factor in (1.0 - 1e-6, 1.0 + 1e-6)
    )
    assert above == 0.0 < below


@fewer
@given(beam=blades(terms=st.integers(2, 6)), share=SHARE_OF_CRITICAL_SPEED)
def test_more_terms_never_raise_a_frequency_without_gyroscopic_coupling(beam, share):
    """Rayleigh and Ritz: the trial spaces are nested. About one shape, that is: at rest, or at any speed in the thesis' model."""
    finer = replace(beam, terms=beam.space.terms + 1)
    speed = share * finer.critical_speed if beam.model == "thesis" else 0.0
    coarse, fine = (each.natural_frequencies(speed, beam.space.size, gyroscopic=False) for each in (beam, finer))
    assert np.all(fine <= coarse * (1.0 + 1e-7) + 1e-9 * coarse[-1])
    if beam.model == "thesis":  # the pull of the blade's own steady state is no Ritz value
        assert finer.critical_speed <= beam.critical_speed * (1.0 + 1e-7)


@fewer
@given(
    beam=blades(terms=st.none()),
    inside=st.lists(st.floats(0.05, 0.95), min_size=1, max_size=3, unique_by=lambda share: round(share, 2)),
    order=st.integers(2, 3),
)
def test_finer_mesh_never_raises_a_frequency_at_rest(beam, inside, order):
    """Rayleigh and Ritz: with every element cut in half the spaces are nested, whatever the mesh."""
    shares = np.array([0.0, *sorted(inside), 1.0])
    halved = np.sort([*shares, *(0.5 * (shares[1:] + shares[:-1]))])
    ways = {"discretisation": "finite-elements", "element_order": order}
    coarse, fine = (replace(beam, mesh=tuple(mesh.tolist()), **ways) for mesh in (shares, halved))
    lower, upper = (each.natural_frequencies(0.0, coarse.space.size) for each in (fine, coarse))
    assert np.all(lower <= upper * (1.0 + 1e-7) + 1e-9 * upper[-1])


@settings(fewer, suppress_health_check=[HealthCheck.too_slow])
@given(beam=blades(terms=st.none()), share=st.floats(0.0, MODERATE))
def test_elements_and_polynomials_agree_on_any_blade(beam, share):
    """Four frequencies; in the thesis' model sheared blades have a layer at the clamp that polynomials miss by 2/(N + 1)²."""
    polynomials, elements = replace(beam, terms=20), replace(beam, discretisation="finite-elements", elements=6)
    one, other = (each.natural_frequencies(share * runaway(beam), 4) for each in (elements, polynomials))
    layer = beam.model == "thesis" and beam.shear != "rigid"
    assert one == pytest.approx(other, rel=2.0 / 21.0**2 if layer else 1e-3)


@fewer
@given(beam=blades(pretwist=st.just(0.0)), angle=st.floats(-180.0, 180.0))
def test_presetting_changes_no_frequency_at_rest(beam, angle):
    turned = replace(beam, presetting_deg=angle)
    count = beam.space.size
    assert turned.natural_frequencies(0.0, count) == pytest.approx(beam.natural_frequencies(0.0, count), rel=1e-6)


@few
@given(beam=blades(pretwist=st.just(0.0), model=THESIS), angle=st.floats(-180.0, 180.0))
def test_presetting_changes_no_stretch_and_twist_stiffness_of_the_walls(beam, angle):
    turned = replace(beam, presetting_deg=angle)
    one, other = (each.walls_at(np.zeros(1)).stiffness()[0][np.ix_([0, 7], [0, 7])] for each in (beam, turned))
    assert other == pytest.approx(one, rel=1e-9, abs=1e-9 * one[0, 0])


@fewer
@given(beam=blades(layup=st.builds(Layup.uniform, st.just(GRAPHITE_EPOXY), ANGLES)), share=SHARE_OF_CRITICAL_SPEED)
def test_a_blade_and_its_mirror_image_whirl_alike(beam, share):
    """Reflection in the plane of rotation: ply angles, pretwist and presetting change sign, the spin does not."""
    mirror = replace(beam, layup=beam.layup.mirrored(), pretwist_deg=-beam.pretwist_deg, presetting_deg=-beam.presetting_deg)
    speed = share * runaway(beam) * (1.0 if beam.model == "thesis" else MODERATE)
    assert mirror.critical_speed == pytest.approx(beam.critical_speed, rel=1e-8)
    assert mirror.natural_frequencies(speed) == pytest.approx(beam.natural_frequencies(speed), rel=1e-6)


@fewer
@given(beam=blades(), factor=st.floats(0.2, 5.0))
def test_frequencies_scale_with_the_root_of_modulus_over_density_and_inversely_with_size(beam, factor):
    """A blade of the same shape, ``factor`` times as large: all frequencies and the critical speed divided by it."""
    box = beam.section
    larger = replace(
        beam,
        section=BoxSection(factor * box.width, factor * box.depth, factor * box.thickness),
        length=factor * beam.length,
        hub_radius=factor * beam.hub_radius,
    )
    speed = runaway(beam) * (0.5 if beam.model == "thesis" else MODERATE)
    # what iterations stop at: the pretwist's of a section at 1e-6 of its largest strain, Newton's at a step of 1e-4 m
    critical, same = (1e-8, 1e-6) if beam.model == "thesis" else (1e-5, 1e-5)
    assert factor * larger.critical_speed == pytest.approx(beam.critical_speed, rel=critical)
    assert factor * larger.natural_frequencies(speed / factor) == pytest.approx(beam.natural_frequencies(speed), rel=same)
