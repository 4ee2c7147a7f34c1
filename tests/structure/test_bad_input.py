"""One sentence names the argument, its value and what is allowed."""

import math
from dataclasses import replace
from functools import partial
from pathlib import Path

import pytest

from beamenv.blade.build import build_beam
from beamenv.blade.files import load_config
from beamenv.structure import (
    GRAPHITE_EPOXY,
    BoxSection,
    Inlay,
    Lamina,
    Layup,
    Ply,
    PolygonSection,
    RotatingBeam,
)

NAN = math.nan
OBLIQUE = Layup.uniform(GRAPHITE_EPOXY, angles_deg=[30] * 6)
box = partial(BoxSection, width=0.254, depth=0.0508)
lamina = partial(Lamina, E1=2e11, E2=5e9, G12=3e9, G13=3e9, G23=2.5e9, nu12=0.25, density=1500.0)
graphite_walls = partial(Layup.by_wall, GRAPHITE_EPOXY)


def blade(**changes):
    return RotatingBeam(**{"section": box(thickness=0.01), "layup": OBLIQUE, "length": 2.0, **changes})


def blade_with(**changes):
    patch = {"wall": "top", "start": 0.5, "length": 0.1, "width": 0.05, "ply": Ply(GRAPHITE_EPOXY, 90.0), "thickness": 3e-4}
    return lambda: blade(inlays=(Inlay(**{**patch, **changes}),))


def triangle(corners=((0.0, 0.0), (0.1, 0.0), (0.0, 0.1)), walls=("a", "b", "c"), thickness=0.001):
    return lambda: PolygonSection(corners, walls, thickness)


def overlapping_inlays():
    pair = (Inlay("top", start, 0.1, 0.05, Ply(GRAPHITE_EPOXY, 90.0), 3e-4) for start in (0.3, 0.25))
    return blade(inlays=tuple(pair))


REFUSED = {
    "negative thickness": (lambda: box(thickness=-0.01), r"section.thickness is -0\.01, but must be a positive number"),
    "thickness not a number": (lambda: box(thickness=NAN), "section.thickness is nan, but must be a positive"),
    "thickness missing": (lambda: box(thickness=None), "section.thickness is None, but must be a positive"),
    "wall too thick": (lambda: box(thickness=0.06), r"section.thickness is 0\.06, but must be below 0\.0508 m"),
    "infinite width": (lambda: BoxSection(math.inf, 0.05, 0.01), "section.width is inf, but must be a positive"),
    "two corners": (
        triangle(((0.0, 0.0), (0.1, 0.0)), ("a", "b")),
        "section.corners is .*, but must be a list of 3 to 1000 points",
    ),
    "names for other edges": (
        triangle(walls=("a", "b")),
        "section.edge_walls is .*, but must be one wall name for each of the 3 edges",
    ),
    "clockwise": (triangle(((0.0, 0.0), (0.0, 0.1), (0.1, 0.0))), "section.corners is .* counter-clockwise"),
    "the same corner twice": (triangle(((0.0, 0.0), (0.1, 0.0), (0.1, 0.0))), "section.corners is .*, but must be distinct"),
    "corner not a number": (
        triangle(((0.0, 0.0), (0.1, 0.0), (NAN, 0.1))),
        r"section.corners is .*nan.*, but must be a list of 3 to 1000 points \[x, y\] \(m\)",
    ),
    "a mid-line that crosses itself": (
        lambda: PolygonSection(((0.0, 0.0), (0.2, 0.2), (0.4, 0.0), (0.4, 0.2), (0.2, 0.0), (0.0, 0.3)), tuple("abcdef"), 0.001),
        "section.corners is .*, but must be those of a mid-line that neither crosses nor touches itself",
    ),
    "a mid-line that goes back on itself": (
        lambda: PolygonSection(((0.0, 0.0), (0.1, 0.0), (0.2, 0.0), (0.1, 0.0), (0.0, 0.1)), tuple("abcde"), 0.001),
        "section.corners is .*, but must be those of a mid-line that neither crosses nor touches itself",
    ),
    "a corner on another edge": (
        lambda: PolygonSection(((0.0, 0.0), (0.2, 0.0), (0.2, 0.1), (0.1, 0.0), (0.0, 0.1)), tuple("abcde"), 0.001),
        "section.corners is .*, but must be those of a mid-line that neither crosses nor touches itself",
    ),
    "walls as one string": (triangle(walls="abc"), "section.edge_walls is 'abc', but must be a list of strings"),
    "a hundred thousand plies": (
        lambda: Layup.uniform(GRAPHITE_EPOXY, [30] * 100_000),
        "angles_deg is .*, but must be a list of one or more ply angles, at most 1000, each",
    ),
    "polygon too thick": (triangle(thickness=0.1), r"section.thickness is 0\.1, but must be below 0\.0585786 m"),
    "unknown theory": (
        lambda: blade(shear="timoshenko"),
        "beam.shear is 'timoshenko', but must be one of higher_order, first_order, rigid",
    ),
    "unknown model": (lambda: blade(model="shell"), "beam.model is 'shell', but must be one of blade, thesis"),
    "unknown flow": (lambda: blade(shear_flow="open"), "beam.shear_flow is 'open', but must be None or one of consistent, thesis"),
    "the thesis' flow in another model": (
        lambda: blade(shear_flow="thesis"),
        "beam.shear_flow is 'thesis', but must be None or consistent, or come with model = 'thesis'",
    ),
    "the thesis' flow in a section of another model": (
        lambda: box(thickness=0.01).stiffness(OBLIQUE, shear_flow="thesis"),
        "shear_flow is 'thesis', but must be None or consistent, or come with model = 'thesis'",
    ),
    "steady state in the thesis' model": (
        lambda: blade(model="thesis", steady_state="linear"),
        "beam.steady_state is 'linear', but must be None with model = 'thesis'",
    ),
    "unknown steady state": (
        lambda: blade(steady_state="stalled"),
        "beam.steady_state is 'stalled', but must be None or one of nonlinear, linear",
    ),
    "unknown theory of a section": (lambda: box(thickness=0.01).stiffness(OBLIQUE, shear="stiff"), "shear is 'stiff', but must be"),
    "no plies for a wall": (
        lambda: blade(layup=graphite_walls(top=[0])),
        "layup has no plies for wall 'right'; it has them for top",
    ),
    "no plies in a section": (lambda: box(thickness=0.01).stiffness(graphite_walls(top=[0])), "layup has no plies for wall"),
    "plies for no wall": (
        lambda: blade(layup=graphite_walls(top=[0], bottom=[0], left=[0], right=[0], nose=[0])),
        "layup has plies for wall 'nose'; the section has right, top, left, bottom",
    ),
    "no plies": (lambda: Layup.uniform(GRAPHITE_EPOXY, []), r"angles_deg is \[\], but must be a list of one or more ply angles"),
    "one number for plies": (
        lambda: Layup.uniform(GRAPHITE_EPOXY, 30),
        "angles_deg is 30, but must be a list of one or more ply angles",
    ),
    "ply angle not a number": (
        lambda: Layup.uniform(GRAPHITE_EPOXY, [0, NAN]),
        r"angles_deg is \[0, nan\], but must be .*, each a number from -36000 to 36000 \(degrees\)",
    ),
    "ply of no material": (
        lambda: Layup.uniform("steel", [0]),
        "ply.material is 'steel', but must be a Lamina or",
    ),
    "negative modulus": (lambda: lamina(E2=-1.0), r"lamina.E2 is -1\.0, but must be a positive number \(Pa\)"),
    "no density": (lambda: lamina(density=0.0), r"lamina.density is 0\.0, but must be a positive"),
    "Poisson's ratio too large": (
        lambda: lamina(nu12=6.4),
        r"lamina.nu12 is 6\.4, but must be smaller in magnitude than sqrt\(E1/E2\) = 6\.325",
    ),
    "Poisson's ratio not a number": (lambda: lamina(nu12=NAN), "lamina.nu12 is nan, but must be a finite number"),
    "isotropic Poisson's ratio": (
        lambda: Lamina.isotropic(7e10, 0.6, 2700.0),
        r"nu is 0\.6, but must be a number above -1 and below 0\.5",
    ),
    "isotropic modulus": (lambda: Lamina.isotropic(-7e10, 0.3, 2700.0), "E is -70000000000.0, but must be a positive"),
    "no terms": (lambda: blade(terms=0), "beam.terms is 0, but must be None or a whole number from 1 to 30"),
    "half a term": (lambda: blade(terms=2.5), r"beam.terms is 2\.5, but must be None or a whole number from 1 to 30"),
    "no length": (lambda: blade(length=0.0), r"beam.length is 0\.0, but must be a positive"),
    "length as text": (lambda: blade(length="2 m"), "beam.length is '2 m', but must be a positive"),
    "negative hub": (lambda: blade(hub_radius=-0.1), r"beam.hub_radius is -0\.1, but must be zero or a positive number \(m\)"),
    "pretwist not a number": (
        lambda: blade(pretwist_deg=NAN),
        r"beam.pretwist_deg is nan, but must be a number from -36000 to 36000 \(degrees\)",
    ),
    "negative taper": (lambda: blade(taper=-1.0), r"beam.taper is -1\.0, but must be a positive"),
    "tip of wall only": (
        lambda: blade(taper=6.0),
        r"beam.section.thickness is 0\.01, but must be below 0\.00846667 m at its narrow end",
    ),
    "speed of an operating point": (
        lambda: blade().at(-100.0),
        r"speed is -100\.0, but must be zero or a positive number \(rad/s\)",
    ),
    "speed of an operating point as text": (
        lambda: blade(model="thesis").at("fast"),
        "speed is 'fast', but must be zero or a positive number",
    ),
    "negative speed": (
        lambda: blade().natural_frequencies(-1.0),
        r"speed is -1\.0, but must be zero or a positive number \(rad/s\)",
    ),
    "speed not a number": (lambda: blade().natural_frequencies(NAN), "speed is nan, but must be zero or a positive"),
    "speed as text": (lambda: blade().natural_frequencies("fast"), "speed is 'fast', but must be zero or a positive"),
    "more modes than terms": (
        lambda: blade().natural_frequencies(count=97),
        "count is 97, but must be a whole number from 1 to 96",
    ),
    "no modes": (lambda: blade().modes(count=0), "count is 0, but must be a whole number from 1 to 96"),
    "more modes than chosen motions": (
        lambda: blade().modes(count=17, motions=("twist",)),
        "count is 17, but must be .* from 1 to 16",
    ),
    "unknown motion": (
        lambda: blade().modes(motions=("lead",)),
        r"motions is \('lead',\), but must be a list of one or more of lag, flap",
    ),
    "motion not in a tuple": (lambda: blade().natural_frequencies(motions="lag"), "motions is 'lag', but must be a list of"),
    "no motion": (lambda: blade().natural_frequencies(motions=()), r"motions is \(\), but must be a list of one or more"),
    "overlapping inlays": (overlapping_inlays, r"inlays at 0\.25 and 0\.3 m on the top wall must be 0\.1 m apart"),
    "inlay past the tip": (
        blade_with(start=1.95),
        r"inlay.start is 1\.95, but must be 0 at least, and its end, 2\.05, on the blade, 0 to 2\.0 m",
    ),
    "inlay before the root": (blade_with(start=-0.1), r"inlay.start is -0\.1, but must be 0 at least"),
    "inlay wider than its wall": (
        blade_with(width=0.3),
        r"inlay.width is 0\.3, but must be positive and at most the top wall's 0\.254 m",
    ),
    "inlay as thick as its wall": (
        blade_with(thickness=0.01),
        r"inlay.thickness is 0\.01, but must be positive and below the wall's 0\.01 m",
    ),
    "inlay on no wall": (
        blade_with(wall="nose"),
        "wall is 'nose', but must be one wall of the section: right, top, left, bottom",
    ),
    "inlay nowhere": (blade_with(start=NAN), "inlay.start is nan, but must be a finite number"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_bad_input_is_refused_by_name_and_value(case):
    attempt, words = REFUSED[case]
    with pytest.raises(ValueError, match=words) as refusal:
        attempt()
    assert str(refusal.value).endswith(".")
    assert "\n" not in str(refusal.value)


def test_inlay_that_fits_the_root_but_not_the_tapered_tip_is_refused():
    inlay = Inlay("top", 0.0, 0.1, 0.2, Ply(GRAPHITE_EPOXY, 90.0), 3e-4)
    blade(inlays=(inlay,))
    with pytest.raises(ValueError, match=r"width is 0\.2, but must be .* at most the top wall's 0\.127 m"):
        blade(inlays=(inlay,), taper=2.0)


def test_patches_may_touch():
    pair = (Inlay("top", start, 0.1, 0.05, Ply(GRAPHITE_EPOXY, 90.0), 3e-4) for start in (0.1, 0.2))
    assert blade(inlays=tuple(pair)).natural_frequencies(0.0, 1)[0] > 0.0


def test_thirty_trial_functions_are_told_apart_beside_breaks():
    z = load_config(Path(__file__).parents[2] / "examples" / "blades" / "z-stringer.toml")
    usual, thirty = (build_beam(replace(z, beam=replace(z.beam, terms=terms))).natural_frequencies(0.0, 3) for terms in (None, 30))
    assert thirty == pytest.approx(usual, rel=1e-3)
    assert (thirty < usual).all()  # a wider space


def test_a_blade_a_thousand_kilometres_long_is_out_of_scale():
    with pytest.raises(ValueError, match="^beam cannot be computed: one of its numbers"):  # as many as usual would not do either
        blade(terms=30, length=1e6).natural_frequencies(0.0, count=3)
