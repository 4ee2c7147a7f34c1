from dataclasses import replace

import numpy as np
import pytest

from train.reproduce.thesis import Model, printed_table
from train.reproduce.thesis.configurations import antisymmetric, built
from train.reproduce.thesis.couplings import coupled_fields, subsystems
from train.reproduce.thesis.frequencies import presetting_and_speed, printed_presettings, wall_thickness
from train.reproduce.thesis.printed import numbers
from train.reproduce.thesis.response import ForcedBlade, newmark_responses, settling_time
from train.reproduce.thesis.shapes import STATIONS, family_shapes
from train.reproduce.thesis.veering import exchange, locate_veering

MODEL = Model()


def test_table_3_3_was_computed_with_six_terms():
    trusted = np.array(numbers("table-3.3", "speed")) != 200.0
    off = presetting_and_speed(MODEL, 6) / printed_presettings() - 1.0
    assert np.abs(off[trusted]).max() < 1e-4
    assert np.abs(off[~trusted, :2]).max() < 1e-4
    assert np.all(off[~trusted, 2] > 0.03)


def test_table_3_4_within_a_tenth_of_a_percent():
    np.testing.assert_allclose(wall_thickness(MODEL), numbers("table-3.4", "thesis"), rtol=1e-3)


def test_printed_tables_are_whole():
    assert [len(printed_table(f"table-3.{k}")) for k in (1, 2, 3, 4)] == [10, 6, 16, 15]
    with pytest.raises(ValueError, match=r"table-9\.9.*table-3\.4"):
        printed_table("table-9.9")


def test_hoop_plies_untwisted_decouple_into_two_subsystems():
    groups = set(subsystems(coupled_fields(MODEL.beam(0.0))))
    assert groups == {frozenset({"u", "s", "theta_y"}), frozenset({"v", "theta_x", "phi"})}


def test_uniform_plies_couple_extension_with_twist_and_mirrored_ones_flap():
    uniform = coupled_fields(MODEL.beam(30.0))
    mirrored = coupled_fields(built(replace(MODEL.box, ply_angles_deg=antisymmetric(30.0))))
    assert "stiffness" in uniform["s", "phi"] and "stiffness" not in uniform["theta_x", "phi"]
    assert "stiffness" in mirrored["theta_x", "phi"]


def test_lag_mode_loses_its_stiffness_at_the_speed_of_the_extension():
    beam = MODEL.beam(0.0)
    section = beam.section.stiffness(beam.layup, shear_flow=beam.shear_flow, model=beam.model)
    density = 1528.15 * 2.0 * (0.254 + 0.0508) * 0.01016
    assert beam.critical_speed == pytest.approx(np.pi / (2.0 * beam.length) * np.sqrt(section[0, 0] / density), rel=1e-4)


def test_veering_lies_where_the_gap_is_least():
    beam = MODEL.beam(0.0)
    veering = locate_veering(beam, 1, np.linspace(500.0, 900.0, 81))
    for speed in (veering.speed - 5.0, veering.speed + 5.0):
        low, high = beam.natural_frequencies(speed, 3, ("lag", "extension"))[1:]
        assert high - low > veering.gap
    with pytest.raises(ValueError, match="least gap"):
        locate_veering(beam, 1, np.linspace(100.0, 300.0, 11))


def test_modes_keep_their_shape_over_a_vanishing_change_of_speed():
    beam = MODEL.beam(0.0)
    veering = locate_veering(beam, 1, np.linspace(500.0, 900.0, 81))
    np.testing.assert_allclose(exchange(beam, veering, 0.0), np.eye(2), atol=0.06)
    np.testing.assert_allclose(np.diag(exchange(beam, veering, 0.0)), 1.0, atol=1e-9)


@pytest.mark.parametrize("direction", ["lag", "flap"])
def test_newmark_with_the_thesis_constants_follows_the_exact_response(direction):
    blade = ForcedBlade(MODEL.beam(30.0, pretwist_deg=30.0), 200.0, direction, 0.01)
    _, exact = blade.step_response(30.0, 0.1)
    times, (integrated,) = newmark_responses([blade], 30.0, 0.1)
    assert np.abs(integrated - exact).max() < 0.005 * np.abs(exact).max()
    assert times[-1] == pytest.approx(0.1)


def test_step_response_comes_to_rest_at_the_static_displacement():
    blade = ForcedBlade(MODEL.beam(0.0), 200.0, "lag", 0.05)
    times, tip = blade.step_response(30.0, 3.0, 1e-3)
    rest = blade.static_displacement(30.0)
    assert tip[-1] == pytest.approx(rest, rel=1e-6)
    assert 0.0 < settling_time(times, tip, rest) < 1.0


def test_frequency_response_tends_to_the_static_displacement():
    blade = ForcedBlade(MODEL.beam(0.0), 200.0, "flap", 0.01)
    assert blade.frequency_response(np.array([1e-3]))[0] == pytest.approx(abs(blade.static_displacement(1.0)), rel=1e-6)


def test_straight_shape_has_no_bow():
    shapes = family_shapes(MODEL.beam(0.0), 400.0, "flap")
    assert all(shape.values[-1] > 0.0 and np.abs(shape.values).max() == pytest.approx(1.0) for shape in shapes)
    assert type(shapes[0])(1.0, STATIONS).bow == 0.0
    assert shapes[0].bow < shapes[1].bow
