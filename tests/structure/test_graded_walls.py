"""Graded walls against integrals by hand, bounds of mixtures, and a rotating beam that is published."""

from math import comb

import numpy as np
import pytest
from scipy.integrate import quad

from beamenv.structure import (
    GRAPHITE_EPOXY,
    AirfoilSection,
    BoxSection,
    CSection,
    FunctionallyGraded,
    Inlay,
    ISection,
    Lamina,
    Laminate,
    Layup,
    Ply,
    RotatingBeam,
    StripSection,
    TubeSection,
    Web,
    ZSection,
)
from beamenv.structure.walls.graded import SCHEMES
from beamenv.structure.walls.laminate import wall_law
from beamenv.structure.walls.named import SILICON_NITRIDE, SUS304

NU, H = 0.3, 0.01
SOFT, STIFF = Lamina.isotropic(70e9, NU, 2700.0, 23e-6), Lamina.isotropic(380e9, NU, 3960.0, 7e-6)
EXPONENTS = (0.07, 0.5, 1.0, 2.7, 45.0)
BOX = BoxSection(0.254, 0.0508, 0.01016)
STEEL_WITHIN = FunctionallyGraded("sus304", "silicon-nitride", 0.7)


def graded(exponent, inner=SOFT, outer=STIFF, scheme="voigt"):
    return FunctionallyGraded(inner, outer, exponent, scheme)


def layup_of(exponent, **of):
    return Layup.uniform(graded(exponent, **of), [0.0])


def moment(exponent, power, centre=-0.5, inner=SOFT.E1, outer=STIFF.E1, thickness=H):
    """∫ (inner + (outer − inner) ξᵖ) (h (ξ + centre))ᵏ h dξ, by the binomial theorem."""

    def of(p):
        return sum(comb(power, j) * centre ** (power - j) / (p + j + 1.0) for j in range(power + 1))

    return thickness ** (power + 1) * (inner * of(0.0) + (outer - inner) * of(exponent))


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("shear", ["higher_order", "first_order", "rigid"])
@pytest.mark.parametrize("model", ["thesis", "blade"])
def test_extreme_exponents_leave_one_material_to_the_last_bit(model, shear, scheme):
    for exponent, alone in ((0.0, SILICON_NITRIDE), (1e6, SUS304)):
        found = BOX.stiffness(layup_of(exponent, inner="sus304", outer="silicon-nitride", scheme=scheme), shear, model=model)
        assert np.array_equal(found, BOX.stiffness(Layup.uniform(alone, [0.0]), shear, model=model))


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_wall_law_has_the_moments_of_the_power_law(exponent):
    """A, B; D less what N_ss = 0 gives back, (D − ν² B²/A)/(1 − ν²); shear moduli in proportion; n⁰ … n⁶ of density."""
    law = wall_law(Laminate.equal_plies((Ply(graded(exponent), 30.0),), H))
    A, B, D = (moment(exponent, k) for k in range(3))
    scale = A * H ** np.arange(7)
    assert law.stiffness[0, 0] == pytest.approx(A, rel=1e-13)
    assert law.stiffness[0, 1] == pytest.approx(B, rel=1e-13, abs=1e-14 * A * H)
    assert law.stiffness[1, 1] == pytest.approx((D - NU**2 * B**2 / A) / (1.0 - NU**2), rel=1e-12)
    shear = [moment(exponent, k) / (2.0 * (1.0 + NU)) for k in range(7)]
    np.testing.assert_allclose(law.transverse_shear / scale, shear / scale, atol=1e-15)
    assert law.stiffness[5, 5] == pytest.approx(shear[4], rel=1e-12)
    density = [moment(exponent, k, inner=SOFT.density, outer=STIFF.density) for k in range(7)]
    np.testing.assert_allclose(law.density / H ** np.arange(1, 8), density / H ** np.arange(1.0, 8.0), rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("exponent", EXPONENTS)
def test_strip_stretches_and_bends_as_its_moments_say(exponent):
    """With one ν the stress is along the span alone, however the modulus changes: b A, b B, b D, A b³/12 edgewise; mass too."""
    width = 0.03
    strip = StripSection(width, H)
    found = strip.properties(layup_of(exponent))
    A, B, D = (width * moment(exponent, k) for k in range(3))
    stiffness = found.classical_stiffness
    assert stiffness[0, 0] == pytest.approx(A, rel=1e-10)
    assert abs(stiffness[0, 1]) == pytest.approx(abs(B), rel=1e-9, abs=1e-12 * A * H)
    assert stiffness[1, 1] == pytest.approx(D, rel=1e-9)
    assert stiffness[2, 2] == pytest.approx(A * width**2 / 12.0, rel=1e-9)
    mass, static = (width * moment(exponent, k, inner=SOFT.density, outer=STIFF.density) for k in range(2))
    assert found.mass_per_length == pytest.approx(mass, rel=1e-13)
    assert abs(found.mass_centre[1]) == pytest.approx(abs(static / mass), rel=1e-11, abs=1e-14)


@pytest.mark.parametrize("exponent", [0.5, 2.7])
def test_tube_twists_and_bends_as_rings_of_its_materials(exponent):
    """EA = 2π ∫E r dr, EI = π ∫E r³ dr, GJ = 2π ∫G r³ dr; within 1e-3, for the tube is a polygon of many sides."""
    radius, thickness = 0.05, 0.01
    found = np.diag(TubeSection(2.0 * radius, 2.0 * radius, thickness).properties(layup_of(exponent)).classical_stiffness)
    of_r, of_r3 = (moment(exponent, k, radius / thickness - 0.5, thickness=thickness) for k in (1, 3))
    np.testing.assert_allclose(found[:3], [2.0 * np.pi * of_r, np.pi * of_r3, np.pi * of_r3], rtol=1e-3)
    assert found[3] == pytest.approx(2.0 * np.pi * of_r3 / (2.0 * (1.0 + NU)), rel=1e-3)


@pytest.mark.parametrize("exponent", [0.5, 2.7])
def test_box_of_the_thesis_has_the_stiffness_of_its_walls(exponent):
    """EA = 2 (w + d) A; in flap the flanges' A d²/4 + B d + D*, and the webs' A d²/12, over their lengths."""
    law = wall_law(Laminate.equal_plies((Ply(graded(exponent), 0.0),), BOX.thickness))
    A, B, D = law.stiffness[0, 0], law.stiffness[0, 1], law.stiffness[1, 1]
    found = np.diag(BOX.stiffness(layup_of(exponent), "first_order", model="thesis"))
    w, d = BOX.width, BOX.depth
    assert found[0] == pytest.approx(2.0 * (w + d) * A, rel=1e-12)
    assert found[1] == pytest.approx(2.0 * w * (0.25 * A * d**2 + B * d + D) + A * d**3 / 6.0, rel=1e-9)


@pytest.mark.parametrize("inner", [SUS304, SILICON_NITRIDE])
def test_mori_tanaka_is_a_bound_of_hashin_and_shtrikman_and_voigt_beyond_both(inner):
    """Hashin and Shtrikman, J. Mech. Phys. Solids 11, 1963: the lower one where the matrix is the softer material."""
    outer = SILICON_NITRIDE if inner is SUS304 else SUS304
    share = np.linspace(0.05, 0.95, 10)

    def bound(of, other, rest):
        K, G, K2, G2 = (each for m in (of, other) for each in (m.E1 / (3.0 * (1.0 - 2.0 * m.nu12)), m.G12))
        bulk = K + (1.0 - rest) / (1.0 / (K2 - K) + 3.0 * rest / (3.0 * K + 4.0 * G))
        shear = G + (1.0 - rest) / (1.0 / (G2 - G) + 6.0 * rest * (K + 2.0 * G) / (5.0 * G * (3.0 * K + 4.0 * G)))
        return bulk, shear

    found = graded(1.0, inner, outer, "mori-tanaka").mixture(share)
    one, other = bound(inner, outer, 1.0 - share), bound(outer, inner, share)
    np.testing.assert_allclose([found.bulk, found.shear], one, rtol=1e-12)
    voigt = graded(1.0, inner, outer).mixture(share)
    assert np.all(voigt.bulk > np.maximum(one[0], other[0])) and np.all(voigt.shear > np.maximum(one[1], other[1]))


def test_expansion_of_a_mixture_lies_between_and_follows_the_bulk_modulus():
    """Levin 1967: (α − αi)/(αo − αi) = (1/K − 1/Ki)/(1/Ko − 1/Ki), exact for any mixture of two isotropic materials."""
    mixture = graded(1.0, SUS304, SILICON_NITRIDE, "mori-tanaka").mixture(np.array([0.0, 0.3, 1.0]))
    first, last = (1.0 / (3.0 * (1.0 - 2.0 * m.nu12) / m.E1) for m in (SUS304, SILICON_NITRIDE))
    share = (1.0 / mixture.bulk - 1.0 / first) / (1.0 / last - 1.0 / first)
    np.testing.assert_allclose(mixture.alpha, SUS304.alpha1 + (SILICON_NITRIDE.alpha1 - SUS304.alpha1) * share, rtol=1e-12)
    assert graded(1.0, Lamina.isotropic(7e10, 0.3, 2700.0)).mixture(np.array([0.5])).alpha is None


def by_quadrature(low, high, value):
    """∫ value(ξ) nᵏ dn of a wall graded from −h/2 to h/2, k = 0 … 2."""
    return [quad(lambda n, k=k: value(n / H + 0.5) * n**k, low, high, epsabs=0.0, epsrel=1e-12)[0] for k in range(3)]


@pytest.mark.parametrize("face", ["outer", "inner"])
def test_flush_inlay_leaves_the_rest_of_the_wall_graded_as_it_was(face):
    thickness, sheet = 0.002, Lamina.isotropic(60e9, 0.3, 7800.0)
    inlay = Inlay("top", 0.0, 1.0, 0.1, Ply(sheet, 0.0), thickness, face=face)
    wall = inlay.let_into(Laminate.equal_plies((Ply(graded(0.5), 0.0),), H))
    low, high = (-0.5 * H, 0.5 * H - thickness) if face == "outer" else (-0.5 * H + thickness, 0.5 * H)
    left, right = (high, 0.5 * H) if face == "outer" else (-0.5 * H, low)
    expected = np.add(
        by_quadrature(low, high, lambda x: 2700.0 + 1260.0 * np.sqrt(x)), by_quadrature(left, right, lambda x: 7800.0)
    )
    np.testing.assert_allclose(wall_law(wall).density[:3], expected, rtol=1e-10)


def test_bonded_sheet_leaves_the_wall_graded_as_it_is():
    sheet = Ply(Lamina.isotropic(60e9, 0.3, 7800.0), 0.0)
    wall = Laminate.equal_plies((Ply(graded(0.5), 0.0),), H)
    with_sheet = wall.with_layer_on_top(sheet, 0.001)
    assert wall_law(with_sheet).density[0] - 7.8 == pytest.approx(wall_law(wall).density[0], rel=1e-12)


def test_turned_over_wall_couples_the_other_way():
    wall = Laminate.equal_plies((Ply(graded(1.7), 0.0), Ply(GRAPHITE_EPOXY, 30.0)), H)
    law, turned = wall_law(wall), wall_law(wall.turned_over)
    assert turned.density == pytest.approx(law.density * (-1.0) ** np.arange(7), rel=1e-12)
    assert turned.stiffness[0, 1] == pytest.approx(-law.stiffness[0, 1], rel=1e-12)
    assert wall.turned_over.turned_over == wall


def test_pieces_of_a_graded_ply_make_the_whole():
    material = graded(0.4)
    halves = (Ply(material.part(0.0, 0.3), 0.0), Ply(material.part(0.3, 1.0), 0.0))
    pieces = Laminate((-0.5 * H, -0.2 * H, 0.5 * H), halves)
    whole = Laminate.equal_plies((Ply(material, 0.0),), H)
    assert wall_law(pieces).density == pytest.approx(wall_law(whole).density, rel=1e-12, abs=1e-18)


def test_a_wall_of_it_is_graded_once_and_a_ply_among_others_by_itself():
    wall = layup_of(1.0).plies("top")
    assert Layup.uniform(graded(1.0), [30.0] * 6).plies("top")[0].material == wall[0].material
    among = Laminate.equal_plies((Ply(STIFF, 0.0), Ply(graded(1.0), 0.0)), H)
    assert wall_law(among).density[0] == pytest.approx(0.5 * H * 3960.0 + 0.5 * H * (2700.0 + 3960.0) / 2.0)
    twice = Laminate.equal_plies((Ply(graded(3.0), 0.0),) * 2, H)
    assert wall_law(twice).density[0] == pytest.approx(H * (2700.0 + 1260.0 / 4.0))
    strip = StripSection(0.03, H)
    in_two = strip.properties(Layup((Ply(graded(3.0), 0.0),) * 2)).mass_per_length
    assert in_two == pytest.approx(0.03 * H * (2700.0 + 1260.0 / 4.0))


@pytest.mark.parametrize("exponent", [0.5, 1.0, 10.0])
def test_rotating_graded_beam_spins_up_as_the_uniform_one_of_its_bending_stiffness(exponent, table):
    """Wright et al. 1982 and others: ω √(m L⁴/EI) at Ω √(m L⁴/EI), here with EI = D − B²/A about the neutral axis.

    E and ρ are 1 : 10 both (the beam of Ferreira and Fantuzzi 2020, problem 16), so that the mass lies on the neutral axis, and no
    Poisson's ratio lets the clamp hold anything back; without shear only rotary inertia is left: 1e-5 (2.8e-6 reached).
    """
    width, inner, outer = 2.0 * H, Lamina.isotropic(1.44e9, 0.0, 1.22e3), Lamina.isotropic(14.4e9, 0.0, 12.2e3)
    A, B, D = (width * moment(exponent, k, inner=1.44e9, outer=14.4e9) for k in range(3))
    bending, mass = D - B**2 / A, width * moment(exponent, 0, inner=1.22e3, outer=12.2e3)
    length = 5000.0 * np.sqrt(bending / A)
    time = np.sqrt(mass * length**4 / bending)
    rows = [row for row in table("rotating_cantilever.csv") if row["motion"] == "flap" and row["speed"] in (0.0, 2.0, 12.0)]
    assert len(rows) >= 3
    for row in rows:
        beam = RotatingBeam(
            StripSection(width, H), layup_of(exponent, inner=inner, outer=outer), length, row["hub_ratio"] * length, shear="rigid",
            terms=12,
        )  # fmt: skip
        found = time * beam.natural_frequencies(row["speed"] / time, 4, ("flap", "extension"), gyroscopic=False)
        reference = [row[f"mode{k}"] for k in (1, 2, 3, 4)]
        np.testing.assert_allclose(found, reference, rtol=1e-5)


def test_moments_are_those_that_ferreira_and_fantuzzi_print_for_their_beam():
    """MATLAB Codes for Finite Element Analysis, 2020, problem 16: Axx, Bxx, Dxx of E1/E2 = M and the exponent n."""
    M, n, E2 = 10.0, 10.0, 1.44e9
    thickness = 17.6e-6
    wall = Laminate.equal_plies(
        (Ply(graded(n, Lamina.isotropic(E2, 0.0, 1.0), Lamina.isotropic(M * E2, 0.0, 1.0)), 0.0),), thickness
    )
    law = wall_law(wall).stiffness
    assert law[0, 0] == pytest.approx(E2 * thickness * (M + n) / (1.0 + n))
    assert law[0, 1] == pytest.approx(E2 * thickness**2 * n * (M - 1.0) / (2.0 * (1.0 + n) * (2.0 + n)))
    numerator = (6.0 + 3.0 * n + 3.0 * n**2) * M + 8.0 * n + 3.0 * n**2 + n**3
    assert law[1, 1] == pytest.approx(E2 * thickness**3 / 12.0 * numerator / (6.0 + 11.0 * n + 6.0 * n**2 + n**3))


OPEN_AND_WEBBED = {
    "channel": CSection(0.04, 0.08, 0.002),
    "i": ISection(0.06, 0.06, 0.002),
    "z": ZSection(0.06, 0.06, 0.002),
    "airfoil": AirfoilSection(chord=0.2, thickness=0.0015, profile="NACA 0012", webs=(Web(0.35),)),
    "box": BoxSection(0.2, 0.08, 0.003, webs=(Web(0.4),)),
}


@pytest.mark.parametrize("section", OPEN_AND_WEBBED.values(), ids=OPEN_AND_WEBBED)
def test_open_walls_and_webs_are_graded_too(section):
    """Thin walls: p/(1 + p) of the volume is the inner material, within what the mid-line's curvature shifts."""
    steel, ceramic, mixed = (section.properties(Layup.uniform(each, [0.0])) for each in (SUS304, SILICON_NITRIDE, STEEL_WITHIN))
    share = (mixed.mass_per_length - ceramic.mass_per_length) / (steel.mass_per_length - ceramic.mass_per_length)
    assert share == pytest.approx(0.7 / 1.7, rel=0.03)
    stretch = [each.classical_stiffness[0, 0] for each in (steel, mixed, ceramic)]
    assert stretch == sorted(stretch)
    limit = section.properties(layup_of(0.0, inner=SUS304, outer=SILICON_NITRIDE))
    assert np.array_equal(limit.stiffness, ceramic.stiffness)


def test_one_wall_may_be_graded_and_the_others_laid_up():
    walls = {name: [30.0, -30.0] for name in ("bottom", "left", "right")}
    laid_up = Layup.by_wall(GRAPHITE_EPOXY, **walls, top=[30.0, -30.0])
    mixed = Layup(None, {**laid_up.walls, "top": Layup.uniform(STEEL_WITHIN, [0.0]).default})
    found, plain = (BOX.properties(each) for each in (mixed, laid_up))
    assert found.mass_centre[1] > plain.mass_centre[1] + 0.1 * BOX.depth
    half = BOX.properties(Layup(None, {**mixed.walls, "top": Layup.uniform(STEEL_WITHIN, [0.0] * 4).default}))
    assert np.array_equal(found.stiffness, half.stiffness)


REFUSED = {
    "exponent below 0": ({"exponent": -0.1}, "graded.exponent is -0.1, but must be zero or a positive number"),
    "no number": ({"exponent": np.nan}, "graded.exponent is nan, but must be zero or a positive number"),
    "infinite": ({"exponent": np.inf}, "graded.exponent is inf, but must be zero or a positive number"),
    "a ply": ({"inner": GRAPHITE_EPOXY}, "graded.inner is Lamina.*, but must be an isotropic material"),
    "a ply by name": ({"outer": "as4-3501-6"}, "graded.outer is 'as4-3501-6', but must be an isotropic material"),
    "unknown": ({"outer": "steel"}, "graded.outer is 'steel', but must be one of graphite-epoxy, .*, or a Lamina"),
    "another rule": ({"scheme": "reuss"}, "graded.scheme is 'reuss', but must be one of voigt, mori-tanaka"),
    "nothing covered": ({"covered": (0.5, 0.5)}, "graded.covered is .*, but must be two shares that differ"),
}


@pytest.mark.parametrize(("changes", "message"), REFUSED.values(), ids=REFUSED)
def test_what_cannot_be_graded_is_refused(changes, message):
    with pytest.raises(ValueError, match=f"^{message}"):
        FunctionallyGraded(**{"inner": SOFT, "outer": STIFF, "exponent": 1.0, **changes})


@pytest.mark.parametrize("scheme", ["voigt", "mori-tanaka"])
def test_mass_goes_by_volume_and_scales_by_itself(scheme):
    graded = FunctionallyGraded("sus304", "silicon-nitride", 2.0, scheme)
    inner, outer = graded.constituents
    volume = np.array([0.0, 0.3, 1.0])
    found, scaled = graded.mixture(volume), graded.scaled(1.2, 0.9).mixture(volume)
    assert found.density == pytest.approx((1.0 - volume) * inner.density + volume * outer.density, rel=1e-12)
    assert scaled.density == pytest.approx(0.9 * found.density, rel=1e-12)
    np.testing.assert_allclose(scaled.E, 1.2 * found.E, rtol=1e-12)
    assert scaled.nu == pytest.approx(found.nu, rel=1e-12)
