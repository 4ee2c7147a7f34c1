"""Patches in groups: bonded or let in, on any wall and face, at any angle, of any sheet."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import Blade
from beamenv.blade.layouts import with_positions
from beamenv.blade.presets import blade_config
from beamenv.patches import PZT, PatchGroup, PatchLayout, actuation, patch_force, sensing
from beamenv.structure import CSection, ISection, Lamina, Layup, RotatingBeam, StripSection, ZSection
from beamenv.structure.walls.laminate import Laminate

E, NU = 70e9, 0.3
METAL = Lamina.isotropic(E, NU, 2700.0)
LENGTH, WIDTH, THICKNESS = 0.3, 0.03, 0.002
START, PATCH = 0.06, 0.05


def strip(layout, **changes):
    return RotatingBeam(
        StripSection(WIDTH, THICKNESS), Layup.uniform(METAL, [0.0]), length=LENGTH, inlays=layout.inlays(LENGTH), **changes
    )


def group(**changes):
    return PatchGroup(**{"positions": (START,), "material": "PZT", "length": PATCH, "width": WIDTH, "wall": "strip", **changes})


def one_volt(beam, layout, field="v"):
    """Static displacement of the tip per volt."""
    still = np.linalg.solve(beam.matrices.elastic_stiffness, actuation(beam, layout)[:, 0])
    return float(beam.displacements(LENGTH)[field][0] @ still)


def curvature(layers):
    """Of a plate strip with free edges per volt: layers (bottom, top, Q, free strain per volt), by classical lamination theory."""
    stiffness, load = np.zeros((6, 6)), np.zeros(6)
    for low, high, Q, free in layers:
        powers = [(high**k - low**k) / k for k in (1, 2, 3)]
        stiffness += np.block([[powers[0] * Q, powers[1] * Q], [powers[1] * Q, powers[2] * Q]])
        load += np.concatenate([powers[0] * Q @ free, powers[1] * Q @ free])
    return np.linalg.solve(stiffness, load)[4]  # κ_zz of (ss, zz, sz)


@pytest.mark.parametrize("bonded", [True, False])
@pytest.mark.parametrize("face", ["outer", "inner"])
def test_a_sheet_as_wide_as_the_strip_bends_it_as_lamination_theory_says(bonded, face):
    """Curvature under the sheet, none elsewhere, within 1 % (0.5 reached); with 10 and 24 trial functions the same within 0.4 %."""
    layout = PatchLayout(actuators=(group(face=face, bonded=bonded),), sensors=(group(positions=(0.15,), passive=False),))
    metal, sheet = METAL.reduced_stiffness(), PZT.lamina.transformed_stiffness(np.pi / 2.0)
    free = np.array([PZT.d12, PZT.d11, 0.0]) / PZT.electrode_spacing
    inner = 0.5 * THICKNESS - (0.0 if bonded else PZT.thickness)
    layers = [(-0.5 * THICKNESS, inner, metal, np.zeros(3)), (inner, inner + PZT.thickness, sheet, free)]
    turned = curvature(layers) * (1.0 if face == "outer" else -1.0)
    wanted = -turned * PATCH * (LENGTH - START - 0.5 * PATCH)
    found = [one_volt(strip(layout, terms=terms), layout) for terms in (16, 10, 24)]
    assert found[0] == pytest.approx(wanted, rel=0.01)
    np.testing.assert_allclose(found[1:], found[0], rtol=0.004)


def test_a_bonded_pair_of_opposite_faces_bends_and_does_not_stretch_when_driven_against_each_other():
    """By symmetry: the two columns stretch alike and bend oppositely."""
    pair = PatchLayout(
        actuators=(group(bonded=True), group(bonded=True, face="inner")), sensors=(group(positions=(0.2,), passive=False),)
    )
    beam = strip(pair)
    force = actuation(beam, pair)
    tip = np.linalg.solve(beam.matrices.elastic_stiffness, force)
    bent, stretched = (beam.displacements(LENGTH)[field][0] @ tip for field in ("v", "s"))
    assert bent[0] == pytest.approx(-bent[1], rel=1e-9)
    assert stretched[0] == pytest.approx(stretched[1], rel=1e-9)


def test_a_ganged_group_is_one_voltage_that_drives_all_of_it():
    apart = PatchLayout(actuators=(group(positions=(0.05, 0.15)),), sensors=(group(positions=(0.05, 0.15), face="inner"),))
    ganged = PatchLayout(
        actuators=(group(positions=(0.05, 0.15), ganged=True),), sensors=(group(positions=(0.05, 0.15), face="inner", ganged=True),)
    )
    beam = strip(apart)
    np.testing.assert_allclose(actuation(beam, ganged)[:, 0], actuation(beam, apart).sum(axis=1))
    np.testing.assert_allclose(sensing(beam, ganged)[0], sensing(beam, apart).sum(axis=0))
    assert (ganged.channels("actuators"), ganged.channels("sensors"), apart.channels("actuators")) == (1, 1, 2)


def test_fibres_at_45_degrees_twist_a_box_and_turned_the_other_way_twist_it_back():
    def twist(angle):
        config = blade_config(
            "thesis",
            {
                "speed": 0.0,
                "beam": {"pretwist_deg": 0.0, "ply_angles_deg": [90.0, 0.0, 0.0, 90.0]},
                "patches": {"actuators": [{"positions": [0.5], "angle_deg": angle, "passive": False}], "sensors": 1},
            },
        )
        blade = Blade(config)
        still = np.linalg.solve(blade.beam.matrices.elastic_stiffness, blade.full.forces[:, 0])
        return float(blade.beam.displacements(blade.beam.length)["phi"][0] @ still)

    assert abs(twist(45.0)) > 1e-8
    assert twist(45.0) == pytest.approx(-twist(-45.0), rel=1e-6)
    assert abs(twist(90.0)) < 1e-3 * abs(twist(45.0))


def test_a_patch_across_the_wall_of_a_channel_reads_where_it_is():
    """Off the middle of the web by d it bends the channel about the other axis too, in proportion to d."""
    section, layup = CSection(0.04, 0.08, 0.002), Layup.uniform(METAL, [0.0])

    def moment(offset):
        layout = PatchLayout(
            actuators=(PatchGroup((0.3,), "PZT", 0.05, 0.01, "web", offset=offset, passive=False),),
            sensors=(PatchGroup((0.3,), "PZT", 0.05, 0.01, "top", passive=False),),
        )
        beam = RotatingBeam(section, layup, length=1.0)
        still = np.linalg.solve(beam.matrices.elastic_stiffness, actuation(beam, layout)[:, 0])
        return float(beam.displacements(1.0)["v"][0] @ still)

    assert moment(0.0) == pytest.approx(0.0, abs=1e-3 * abs(moment(0.02)))
    assert moment(0.02) == pytest.approx(-moment(-0.02), rel=1e-6)
    assert moment(0.02) == pytest.approx(2.0 * moment(0.01), rel=0.01)


def test_a_sheet_of_one_s_own_is_a_table_that_departs_from_a_named_one():
    config = blade_config("thesis", {"patches": {"material": {"d11": 500e-12}}})
    assert config.patches.only("actuators").patch.d11 == 500e-12
    assert config.patches.only("actuators").patch.lamina == blade_config().patches.only("actuators").patch.lamina
    own, named = (np.linalg.norm(Blade(each).full.forces) for each in (config, blade_config()))
    assert own / named == pytest.approx(500.0 / 460.0, rel=0.02)  # d12 pulls across the span, and little of it bends


def test_several_groups_move_together_in_their_order():
    config = blade_config(
        "thesis", {"patches": {"actuators": [{"positions": [0.1, 0.5]}, {"positions": [0.3], "wall": "bottom"}], "sensors": 1}}
    )
    moved = with_positions(config, {"actuators": (0.2, 0.6, 0.4)}).patches.groups("actuators")
    assert [each.positions for each in moved] == [(0.2, 0.6), (0.4,)]
    with pytest.raises(
        ValueError, match=r"blade\.patches\.actuators is \[?\(?0\.2.*3 positions \(m\), \[2, 1\] of its groups in turn"
    ):
        with_positions(config, {"actuators": (0.2, 0.6)})


def test_patches_beyond_seven_tenths_of_the_span_are_there_for_groups():
    config = blade_config("thesis", {"patches": {"actuators": [{"positions": [1.9]}], "sensors": 1}})
    assert Blade(config).full.forces.shape[1] == 1
    with pytest.raises(ValueError, match="lies within 0 and 0.7"):
        assert Blade(blade_config("thesis", {"patches": {"actuators": [1.9], "sensors": 1}})).beam


REFUSED = {
    "an unknown face": ({"face": "left"}, r"actuators\[0\]\.face is 'left', but must be one of outer, inner"),
    "an unknown field": ({"place": 0.1}, r"actuators\[0\] has no field 'place'"),
    "off its wall": (
        {"offset": 0.12},
        r"blade.patches.actuators\[0\].width is 0\.057, but must be positive and at most the top wall's 0\.014 m \(offset 0\.12",
    ),
    "beside its wall": ({"offset": 0.5}, r"at most the top wall's 0 m \(offset 0\.5 m from its middle"),
    "of so many pC/N": ({"material": {"d11": 400.0}}, r"d11 is 400.0, but must be a number from -1e-06 to 1e-06 \(m/V\)"),
    "on no wall": ({"wall": "nose"}, "wall is 'nose', but must be one wall of the section"),
    "beyond the tip": ({"positions": [2.0]}, "lies within 0 and 1.0 of the 2.023 m span"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_a_group_that_cannot_be_is_refused_in_one_sentence(case):
    changes, words = REFUSED[case]
    with pytest.raises(ValueError, match=words):
        assert Blade(blade_config("thesis", {"patches": {"actuators": [changes], "sensors": 1}})).plant


def test_thick_walls_of_layers_turned_over_are_the_same_walls():
    laminate = Laminate.equal_plies(Layup.uniform(METAL, [0.0, 30.0, 60.0]).plies("strip"), 0.003)
    assert laminate.turned_over.turned_over == laminate
    inlay = PZT.inlay("strip", 0.0, 1.0, 0.01, face="inner", bonded=True)
    assert inlay.let_into(laminate).interfaces[0] == pytest.approx(-0.0015 - PZT.thickness)
    assert inlay.depths(0.003) == pytest.approx((-0.0015 - PZT.thickness, -0.0015))


def test_equal_patches_by_number_and_as_a_group_are_the_same_blade():
    plain = blade_config("thesis", {"patches": {"actuators": [0.1, 0.5], "sensors": [0.2]}})
    listed = {"actuators": [{"positions": [0.1, 0.5]}], "sensors": [{"positions": [0.2], "wall": "bottom"}]}
    grouped = replace(plain, patches=blade_config("thesis", {"patches": listed}).patches)
    np.testing.assert_array_equal(Blade(plain).plant.B, Blade(grouped).plant.B)
    np.testing.assert_array_equal(Blade(plain).plant.C, Blade(grouped).plant.C)


def test_one_patch_alone_is_its_group_s():
    layout = PatchLayout(actuators=(group(passive=False),), sensors=(group(passive=False, face="inner"),))
    beam = strip(layout)
    np.testing.assert_allclose(actuation(beam, layout)[:, 0], patch_force(beam, PZT, "strip", START, PATCH, WIDTH), rtol=1e-12)


@pytest.mark.parametrize("section", [CSection(0.04, 0.08, 0.002), ZSection(0.04, 0.08, 0.002), ISection(0.04, 0.08, 0.002)])
def test_a_sheet_of_the_walls_own_metal_makes_an_open_section_no_softer(section):
    """Bonded to both flanges near the clamp, 4 % of the mass there: every mode is higher (Rayleigh), by less than 2 %. Warping in
    torsion and under forces beside the shear centre goes on from the bare section to the covered one.
    """
    sheet = replace(PZT, lamina=METAL)
    layout = PatchLayout(
        actuators=(PatchGroup((0.02,), sheet, 0.1, 0.03, "top", bonded=True),),
        sensors=(PatchGroup((0.02,), sheet, 0.1, 0.03, "bottom", bonded=True),),
    )
    layup = Layup.uniform(METAL, [0.0])
    bare, covered = (
        RotatingBeam(section, layup, length=1.0, inlays=inlays).natural_frequencies(count=6) for inlays in ((), layout.inlays(1.0))
    )
    assert np.all(covered > bare)
    np.testing.assert_allclose(covered, bare, rtol=0.02)


def test_soft_sheets_over_almost_the_whole_span_do_as_much_as_over_all_of_it():
    """Let in, half as stiff as the metal: within 0.3 %, torsion too."""
    soft = replace(PZT, lamina=Lamina.isotropic(0.5 * E, NU, METAL.density))
    found = []
    for start, length in ((0.0, 1.0), (0.02, 0.95)):
        groups = (PatchGroup((start,), soft, length, 0.03, wall) for wall in ("top", "bottom"))
        inlays = [inlay for group in groups for inlay in group.inlays("actuators", 1.0)]
        beam = RotatingBeam(CSection(0.04, 0.08, 0.002), Layup.uniform(METAL, [0.0]), length=1.0, inlays=tuple(inlays))
        found.append(beam.natural_frequencies(count=6))
    np.testing.assert_allclose(found[1], found[0], rtol=0.003)


def test_a_group_s_sheet_may_be_a_table_that_departs_from_a_named_one():
    group = {"positions": [0.3], "material": {"d11": 500e-12}}
    config = blade_config("thesis", {"patches": {"actuators": [group], "sensors": 1}})
    assert config.patches.only("actuators").patch.d11 == 500e-12
    with pytest.raises(ValueError, match=r"actuators\[0\]\.material has no field 'foo'"):
        blade_config("thesis", {"patches": {"actuators": [{**group, "material": {"foo": 1.0}}], "sensors": 1}})


@pytest.mark.parametrize(("length", "allowed"), [(0.3, "at least one patch length"), (2.0, "a list of groups")])
def test_patches_that_nobody_asked_for_are_told_to_be_the_default(length, allowed):
    """An actuator alone on a strip: four sensor patches have no room on it, or no wall."""
    strip = {"length": length, "pretwist_deg": 0.0, "section": {"shape": "strip", "width": 0.03, "thickness": 0.002}}
    sheet = {"positions": [0.01], "wall": "strip", "length": 0.05, "width": 0.025, "bonded": True}
    with pytest.raises(
        ValueError, match=rf"sensors is 4 \(the default; \[patches\] sensors = \[\] for none\), but must be {allowed}"
    ):
        Blade(blade_config(overrides={"beam": strip, "patches": {"actuators": [sheet]}})).plant  # noqa: B018 - built when asked
