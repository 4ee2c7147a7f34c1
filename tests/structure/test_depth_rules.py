"""Rules of integration through a graded wall: exact for powers, whatever the exponent, and for weights that change sign."""

import numpy as np
import pytest

from beamenv.structure import FunctionallyGraded, Lamina
from beamenv.structure.walls.depth_rules import gauss_rule_of_weight, interpolating_rule, power_rule


@pytest.mark.parametrize("exponent", [1e-6, 0.01, 0.3, 1.0, 7.3, 1e3, 1e4])
def test_points_through_a_wall_integrate_any_power_to_round_off(exponent):
    """∫ ξ^(jp + k) dξ = 1/(jp + k + 1), at 137 points, to 1e-15; to 1e-12 at the exponent 10⁴."""
    rule = power_rule(exponent)
    assert len(rule.place) == 137
    share = 0.5 * (1.0 + rule.place)
    for j in range(4):
        for k in range(9):
            found = 0.5 * rule.weight @ (rule.volume**j * share**k)
            assert found == pytest.approx(1.0 / (j * exponent + k + 1.0), rel=0.0, abs=1e-12 if exponent > 1e3 else 2e-15)


def test_halving_the_step_changes_no_stiffness_of_a_strong_contrast():
    """Bulk moduli 1 : 30 by Mori and Tanaka, of which the mixture has a pole close to the wall."""
    for inner, outer in ((1e9, 30e9), (30e9, 1e9)):
        material = FunctionallyGraded(Lamina.isotropic(inner, 0.3, 1.0), Lamina.isotropic(outer, 0.3, 1.0), 0.6, "mori-tanaka")
        usual, fine = (power_rule(0.6, step=step) for step in (1.0 / 20.0, 1.0 / 40.0))
        sums = [rule.weight @ material.mixture(rule.volume).bulk for rule in (usual, fine)]
        assert sums[0] == pytest.approx(sums[1], rel=1e-14)


def test_gauss_rule_of_a_weight_is_gauss_own_where_nothing_changes():
    rule = power_rule(0.5)
    np.testing.assert_allclose(
        gauss_rule_of_weight(rule.place, rule.weight, 4), np.polynomial.legendre.leggauss(4), rtol=1e-13, atol=1e-14
    )
    places, weights = gauss_rule_of_weight(rule.place, rule.weight * (1.0 + 5.0 * rule.volume), 4)
    for k in range(8):
        expected = rule.weight @ ((1.0 + 5.0 * rule.volume) * rule.place**k)
        assert weights @ places**k == pytest.approx(expected, rel=1e-13, abs=1e-14)


def test_rule_of_a_weight_that_changes_its_sign_is_exact_for_polynomials():
    rule = power_rule(0.3)
    weight = rule.weight * (0.7 - rule.volume)
    places, weights = interpolating_rule(rule.place, weight, 8)
    for k in range(8):
        assert weights @ places**k == pytest.approx(weight @ rule.place**k, rel=1e-12, abs=1e-14)
