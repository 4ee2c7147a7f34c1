"""Materials at another temperature: published values, ranges, and what follows from what."""

import numpy as np
import pytest

from beamenv.blade import blade_config, from_dict, to_dict
from beamenv.structure import ALUMINIUM, AS4_3501_6, GRAPHITE_EPOXY, Lamina, Layup
from beamenv.structure.walls.curves import Touloukian
from beamenv.structure.walls.named import ALUMINA, MATERIALS, SILICON_NITRIDE, SUS304, TI_6AL_4V, ZIRCONIA

AT_300_K = {
    "sus304": (SUS304, 207.788e9, 0.3178, 15.321e-6),
    "silicon nitride": (SILICON_NITRIDE, 322.271e9, 0.24, 7.475e-6),
    "ti-6al-4v": (TI_6AL_4V, 105.698e9, 0.2981, 6.941e-6),
    "zirconia": (ZIRCONIA, 168.063e9, 0.2980, 18.591e-6),
    "alumina": (ALUMINA, 320.235e9, 0.26, 7.203e-6),
}
"""Young's modulus, Poisson's ratio and expansion at 300 K, as the literature on graded shells prints them."""


@pytest.mark.parametrize(("material", "E", "nu", "alpha"), AT_300_K.values(), ids=AT_300_K)
def test_touloukian_coefficients_give_the_values_printed_for_300_kelvin(material, E, nu, alpha):
    assert (material.E1, material.nu12, material.alpha1) == pytest.approx((E, nu, alpha), rel=2e-4)
    there = material.at(300.0)
    assert (there.E1, there.G12, there.alpha2) == pytest.approx((material.E1, material.G12, material.alpha2), rel=1e-12)


def test_steel_at_600_kelvin_by_hand():
    """E = 201.04 (1 + 0.18474 − 0.235224) GPa, ν = 0.3262 (1 − 0.12012 + 0.136692), α = 12.33·10⁻⁶ (1 + 0.48516)."""
    steel = SUS304.at(600.0)
    assert pytest.approx(201.04e9 * 0.949516) == steel.E1
    assert steel.nu12 == pytest.approx(0.3262 * 1.016572)
    assert steel.alpha1 == steel.alpha2 == pytest.approx(12.33e-6 * 1.48516)
    assert steel.is_isotropic
    assert steel.density == SUS304.density


def test_aluminium_softens_with_heat_as_eurocode_9_has_it_and_stiffens_with_cold():
    """65.1 of 70 GPa at 150 °C; NIST: 73.6 of 70.35 GPa at 200 K; 67.9 … 65.1, halfway at 125 °C."""
    assert pytest.approx(68.9e9 * 65.1 / 70.0) == ALUMINIUM.at(423.15).E1
    assert pytest.approx(68.9e9 * 66.5 / 70.0) == ALUMINIUM.at(398.15).E1
    assert pytest.approx(68.9e9 * 73.5585 / 70.3530, rel=1e-3) == ALUMINIUM.at(200.0).E1
    assert ALUMINIUM.at(373.15).alpha1 == pytest.approx(23.7e-6, rel=1e-6)


@pytest.mark.parametrize(("temperature_K", "E2", "G12"), [(325.0, 8.5, 6.0), (350.0, 8.0, 5.5), (375.0, 7.5, 5.0)])
def test_the_thesis_ply_softens_as_a_published_graphite_epoxy_within_a_tenth(temperature_K, E2, G12):
    """Sai Ram and Sinha 1992: 9.5 and 6.0 GPa at 300 K, 130 GPa along the fibres at any temperature."""
    hot = GRAPHITE_EPOXY.at(temperature_K)
    assert hot.E1 == GRAPHITE_EPOXY.E1
    assert pytest.approx(E2 / 9.5, rel=0.1) == hot.E2 / GRAPHITE_EPOXY.E2
    assert pytest.approx(G12 / 6.0, rel=0.1) == hot.G12 / GRAPHITE_EPOXY.G12


def test_temperature_beyond_the_data_is_refused():
    with pytest.raises(ValueError, match=r"^temperature is 1200.0, but must be a number from 300 to 1000 \(K\), where data"):
        SUS304.at(1200.0)
    with pytest.raises(ValueError, match=r"^temperature is 50.0, but must be a number from 100 to 473.15 \(K\)"):
        Layup.uniform(ALUMINIUM, [0.0]).at(50.0)


def test_a_material_without_curves_is_the_same_at_any_temperature():
    assert AS4_3501_6.at(600.0) is AS4_3501_6
    layup = Layup.uniform(AS4_3501_6, [30.0, -30.0])
    assert all(here is there for here, there in zip(layup.at(400.0).default, layup.default, strict=True))


def test_unknown_expansion_is_refused_where_it_is_asked_for():
    assert GRAPHITE_EPOXY.expansion == (-0.5e-6, 32e-6)
    assert AS4_3501_6.expansion == (-1e-6, 26e-6)
    with pytest.raises(ValueError, match=r"^material.alpha1 is None, but must be a number \(1/K\) where temperature strains the"):
        Lamina.isotropic(70e9, 0.3, 2700.0).expansion  # noqa: B018 - a property that refuses


def test_each_property_of_a_ply_follows_its_own_curve():
    ply = Lamina(
        E1=150e9, E2=9e9, G12=5e9, G13=5e9, G23=3e9, nu12=0.3, density=1600.0, alpha1=0.0, alpha2=30e-6,
        curves={"E2": [[200, 1.1], [300, 1.0], [400, 0.8]], "G12": [(250, 1.0), (350, 0.5)], "alpha2": [(200, 1.0), (400, 2.0)]},
    )  # fmt: skip
    assert ply.range_K == (250.0, 350.0)
    hot = ply.at(350.0)
    assert (150e9, pytest.approx(8.1e9), 2.5e9, 5e9) == (hot.E1, hot.E2, hot.G12, hot.G13)
    assert hot.alpha2 == pytest.approx(52.5e-6)
    assert hot.curves == ()


def test_curves_stay_shares_of_the_constants_that_a_table_changes():
    config = blade_config("aluminium-cantilever", {"beam": {"material": "aluminium"}})
    softer = blade_config("thesis", {"beam": {"material": {"curves": {"E2": [[200, 1.2], [400, 0.8]]}, "E2": 4e9}}})
    assert pytest.approx(3.2e9) == softer.beam.material.at(400.0).E2
    for each in (config, softer):
        assert from_dict(to_dict(each)) == each


REFUSED = {
    "falling": ({"E1": [[300, 1.0], [200, 1.1]]}, "curves is "),
    "of density": ({"density": [[200, 1.0], [300, 1.0]]}, "curves is "),
    "one point": ({"E1": [[300, 1.0]]}, "curves is "),
    "no range": ({"E1": {"P1": 1e-4}}, "curves is "),
    "below absolute zero": ({"E1": [[-3.0, 1.0], [300, 1.0]]}, "curves is "),
    "shear of an isotropic material": ({"G12": [[200, 1.0], [300, 1.0]]}, "curves is .*of E1, nu12, alpha1 alone in an isotropic"),
    "unknown expansion": ({"alpha1": [[200, 1.0], [300, 1.0]]}, r"alpha1 is None, but must be a number \(1/K\)"),
}


@pytest.mark.parametrize(("curves", "message"), REFUSED.values(), ids=REFUSED)
def test_curves_that_say_nothing_are_refused(curves, message):
    with pytest.raises(ValueError, match=f"^lamina.{message}"):
        Lamina.isotropic(70e9, 0.3, 2700.0, None, curves)


def test_all_named_materials_store_energy_throughout_their_range():
    for material in MATERIALS.values():
        for temperature in np.linspace(*material.range_K, 15) if material.range_K else ():
            there = material.at(temperature)
            assert np.linalg.eigvalsh(there.solid_stiffness()).min() > 0.0


def test_expansion_of_aluminium_below_room_is_nists():
    """Mean from 293 K of Δl/l = (−412.77 − 0.30389 T + 8.7696·10⁻³ T² − 9.9821·10⁻⁶ T³)·10⁻⁵ (NIST, 6061-T6)."""
    for temperature in (100.0, 150.0, 200.0, 250.0):
        T = temperature
        shrunk = 1e-5 * (-412.77 - 0.30389 * T + 8.7696e-3 * T**2 - 9.9821e-6 * T**3)
        assert ALUMINIUM.at(T).alpha1 == pytest.approx(shrunk / (T - 293.15), rel=5e-3)


def test_modulus_of_aluminium_below_room_is_nists():
    """77.71221 + 1.030646·10⁻² T − 2.9241·10⁻⁴ T² + 8.9936·10⁻⁷ T³ − 1.0709·10⁻⁹ T⁴ GPa (NIST, 6061-T6)."""

    def nist(T):
        return 77.71221 + 1.030646e-2 * T - 2.924100e-4 * T**2 + 8.993600e-7 * T**3 - 1.070900e-9 * T**4

    for temperature in (100.0, 150.0, 200.0, 250.0):
        found = ALUMINIUM.at(temperature).E1 / ALUMINIUM.E1
        assert found == pytest.approx(nist(temperature) / nist(293.15), rel=2e-3)


def test_all_that_the_resin_bears_softens_alike():
    hot = GRAPHITE_EPOXY.at(360.0)
    shares = [getattr(hot, name) / getattr(GRAPHITE_EPOXY, name) for name in ("E2", "G12", "G13", "G23")]
    assert shares == pytest.approx([np.sqrt((472.0 - 360.0) / 172.0)] * 4, rel=1e-6)
    assert hot.E1 == GRAPHITE_EPOXY.E1


def test_touloukians_first_coefficient_is_over_the_temperature():
    curve = Touloukian(300.0, 1000.0, P_minus1=-60.0)
    assert curve.share(600.0) == pytest.approx(0.9 / 0.8, rel=1e-12)


def test_curves_that_hold_at_no_temperature_together_are_refused():
    curves = {"E1": [(300.0, 1.0), (400.0, 0.9)], "nu12": [(500.0, 1.0), (600.0, 1.1)]}
    with pytest.raises(
        ValueError, match=r"lamina.curves is \['E1', 'nu12'\], but must be curves that all hold at some temperature"
    ):
        Lamina.isotropic(69e9, 0.33, 2700.0, curves=curves)
