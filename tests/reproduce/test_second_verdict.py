"""The thesis' own equations, and the verdicts by them."""

from dataclasses import fields, replace

import numpy as np
import pytest

from beamenv.patches import MFC, PatchLayout
from beamenv.structure import GRAPHITE_EPOXY
from beamenv.structure.walls.materials import Lamina
from train.figures.figure import Curve, Panel
from train.reproduce.catalogue import STUDIES, THESIS_STUDIES
from train.reproduce.judging.second import AS_PRINTED, judged_again
from train.reproduce.judging.study import Outcome, Statement, Study
from train.reproduce.judging.verdicts import Changes, Holds, Verdict
from train.reproduce.studies.closed_loop import blade, plant_of, printed_weight, under_pressure, weighed
from train.reproduce.thesis import Model
from train.reproduce.thesis.as_printed import PrintedQ, PrintedQ12, printed_stiffness, uniform_tension
from train.reproduce.thesis.equations import (
    CONTROLLED,
    EQUATIONS,
    FIBRES_ACROSS,
    FIELD,
    HOST,
    INPUT_WEIGHT,
    MFC_DENSITY,
    PRINTED_Q,
    PRINTED_Q12,
    SHEAR_FLOW,
    SIX_TERMS,
    TOGETHER,
    UNIFORM_TENSION,
    readings,
)
from train.reproduce.thesis.frequencies import wall_thickness
from train.reproduce.thesis.printed import numbers
from train.reproduce.thesis.readings import read_by
from train.reproduce.thesis.response import ForcedBlade

BY_NAME = {study.name: study for study in STUDIES}
KNOWN = {equation.name for equation in EQUATIONS}
Q = GRAPHITE_EPOXY.reduced_stiffness()


def read_as(kind):
    return kind(**{each.name: getattr(GRAPHITE_EPOXY, each.name) for each in fields(Lamina)})


def test_misprinted_stiffness_is_that_of_eq_4_5_at_45_degrees():
    """Worked out by hand: sin² = cos² = ½, so that Q̄16 and Q̄26 are ¼ (Q11 − Q22) as in Jones, and Q̄66 = ⅛ (Q11 − 2Q12 + Q22)."""
    printed, jones = printed_stiffness(GRAPHITE_EPOXY, np.pi / 4.0), GRAPHITE_EPOXY.transformed_stiffness(np.pi / 4.0)
    assert printed[0, 1] == pytest.approx(0.25 * (Q[0, 0] + Q[1, 1] - 4.0 * Q[2, 2]) + 0.5 * Q[1, 1])
    assert printed[2, 2] == pytest.approx(0.125 * (Q[0, 0] - 2.0 * Q[0, 1] + Q[1, 1]))
    assert printed[0, 2] == pytest.approx(0.25 * (Q[0, 0] - Q[1, 1])) == pytest.approx(jones[0, 2])
    assert printed[[0, 1], [0, 1]] == pytest.approx(jones[[0, 1], [0, 1]])


@pytest.mark.parametrize("angle_deg", [15.0, 30.0, 60.0])
def test_misprint_exchanges_the_shear_couplings_and_breaks_the_invariants(angle_deg):
    angle = np.radians(angle_deg)
    printed, jones = printed_stiffness(GRAPHITE_EPOXY, angle), GRAPHITE_EPOXY.transformed_stiffness(angle)
    assert printed[[0, 1], 2] == pytest.approx(jones[[1, 0], 2])
    assert printed[2, 2] - printed[0, 1] != pytest.approx(Q[2, 2] - Q[0, 1], rel=0.1)
    assert jones[2, 2] - jones[0, 1] == pytest.approx(Q[2, 2] - Q[0, 1])
    assert np.linalg.eigvalsh(printed)[0] < 0.0 < np.linalg.eigvalsh(jones)[0]


def test_a_ply_of_the_misprinted_q12_is_another_one_in_that_alone():
    one, other = (each.transformed_stiffness(0.5) for each in (read_as(PrintedQ12), GRAPHITE_EPOXY))
    assert np.flatnonzero((one != other).ravel()).tolist() == [1, 3]
    assert np.array_equal(read_as(PrintedQ).transformed_stiffness(0.5), printed_stiffness(GRAPHITE_EPOXY, 0.5))


def test_blade_of_the_misprinted_stiffness_cannot_be_computed():
    with pytest.raises(ValueError, match="beam cannot be computed"):
        _ = read_by(Model(), (PRINTED_Q,)).beam(30.0).matrices


def test_table_3_4_refutes_the_misprinted_q12():
    printed = np.array(numbers("table-3.4", "thesis"))
    off = [np.abs(wall_thickness(read_by(Model(), reading)) / printed - 1.0).max() for reading in ((), (PRINTED_Q12,))]
    assert off[0] < 1e-3 and off[1] > 5e-3


def test_tension_of_a_uniform_beam_is_true_of_a_uniform_beam_and_too_large_under_taper():
    bare, read = Model(), read_by(Model(), (UNIFORM_TENSION,))
    assert read.beam(30.0).natural_frequencies(200.0) == pytest.approx(bare.beam(30.0).natural_frequencies(200.0), rel=1e-9)
    true, taken = (each.beam(30.0, taper=3.0).matrices for each in (bare, read))
    stiffer = np.linalg.eigvalsh(taken.spin_stiffness - true.spin_stiffness)
    assert stiffer[-1] > 0.0 and stiffer[0] > -1e-9 * stiffer[-1]
    assert np.array_equal(taken.mass, true.mass) and np.array_equal(taken.elastic_stiffness, true.elastic_stiffness)


def test_excess_tension_acts_on_twist_by_the_sections_radius_of_gyration():
    """R(z)(I7 + I8) in K66 of the thesis: between those of the tip and of the root, where mass per length alone would give one."""
    bare, taken = (read_by(Model(), reading).beam(30.0, taper=3.0) for reading in ((), (UNIFORM_TENSION,)))
    excess, functions = taken.matrices.spin_stiffness - bare.matrices.spin_stiffness, bare.space.evaluate(np.array([0.5, 1.5]))
    lag, twist = (fit(functions[field, 1], [1.0, 1.0]) for field in ("u", "phi"))
    ends = bare.walls_at(np.array([bare.length, 0.0])).inertia()
    tip, root = ends.polar / ends.mass_per_length
    assert tip < twist @ excess @ twist / (lag @ excess @ lag) < root < 0.1


def fit(functions, values):
    """Of all coefficients the least that give these values."""
    return np.linalg.lstsq(functions, np.array(values), rcond=None)[0]


@pytest.mark.parametrize("taper", [1.0, 4.0])
def test_load_that_falls_with_the_chord_bends_a_parabola_as_by_hand(taper):
    """∫ (1 − n z/L) z² dz with n = 1 − 1/η: the work of 1 N/m at the root on u = z²."""
    beam = Model().beam(30.0, taper=taper)
    z = np.linspace(0.0, beam.length, 40)
    parabola = fit(beam.space.evaluate(z)["u", 0], z**2)
    force = ForcedBlade(beam, 200.0, "lag", 0.01, pressure=True).force
    assert force @ parabola == pytest.approx(beam.length**3 * (1.0 / 3.0 - (1.0 - 1.0 / taper) / 4.0), rel=1e-9)


@pytest.mark.parametrize("taper", [1.0, 3.0])
def test_controlled_blade_under_such_a_load_is_less_loaded_in_flap_alone(taper):
    config = blade(Model(), Model().blade(30.0, taper=taper))
    plant = plant_of(config)
    lag, flap = under_pressure(plant, config).disturbance_input.T
    assert np.array_equal(lag, plant.disturbance_input[:, 0])
    assert np.linalg.norm(flap) / np.linalg.norm(plant.disturbance_input[:, 1]) == pytest.approx(1.0, rel=1e-9) or taper > 1.0
    assert taper == 1.0 or np.linalg.norm(flap) < 0.8 * np.linalg.norm(plant.disturbance_input[:, 1])


def test_tension_by_hand():
    """At the root of a beam that tapers to half, b₁ R overestimates ∫ m (R₀ + σ) dσ by the mass that is not there."""
    length, hub, z = 2.0, 0.2, np.array([0.0, 1.0, 2.0])
    mass = 3.0 * (1.0 - 0.25 * z)
    assert uniform_tension(mass, hub, length, z) == pytest.approx([3.0 * 2.4, 2.25 * 1.7, 0.0])
    true_root = 3.0 * (hub * length + 0.5 * length**2) - 0.75 * (hub * length**2 / 2.0 + length**3 / 3.0)
    assert uniform_tension(mass, hub, length, z)[0] > true_root


def test_sheets_are_read_as_printed():
    group = read_by(Model(), (MFC_DENSITY, FIELD)).layout(PatchLayout()).only("actuators").patch
    assert (group.lamina.density, group.electrode_spacing) == (8528.0, MFC.thickness)
    turned = read_by(Model(), (FIBRES_ACROSS,)).layout(PatchLayout()).only("actuators").patch
    assert turned.stress_in_wall(90.0) == pytest.approx(MFC.stress_in_wall(0.0), abs=1e-9)
    layout = PatchLayout(material="PZT")
    assert read_by(Model(), TOGETHER).layout(layout) == layout


def test_input_weight_of_eq_5_9_weighs_stiff_modes_more():
    read = read_by(Model(), (INPUT_WEIGHT,))
    plant = plant_of(blade(read, read.blade(30.0)))
    omega = plant.natural_frequencies
    force = plant.B[-len(omega) :]
    assert printed_weight(plant) == pytest.approx(force.T @ np.diag(omega**2) @ force)
    assert printed_weight(replace(plant, natural_frequencies=2.0 * omega)) == pytest.approx(4.0 * printed_weight(plant))
    read_plant = weighed(read, plant)
    assert np.trace(read_plant.input_weight) == pytest.approx(np.trace(plant.input_weight))
    assert np.linalg.eigvalsh(read_plant.input_weight)[0] > 0.0
    assert np.allclose(weighed(read, plant, 5.0).input_weight, 10.0 * read_plant.input_weight)
    assert weighed(Model(), plant) is plant


def test_readings_are_all_together_first_and_then_each_misprint_in_order():
    assert readings(()) == ((),)
    assert readings((UNIFORM_TENSION, *HOST)) == ((SHEAR_FLOW, UNIFORM_TENSION),)
    whole = (SHEAR_FLOW, MFC_DENSITY, FIELD, INPUT_WEIGHT)
    assert readings((PRINTED_Q12, SIX_TERMS, *CONTROLLED, *HOST)) == (
        whole,
        *((*whole, name) for name in (SIX_TERMS, PRINTED_Q12, FIBRES_ACROSS)),
    )


def test_every_study_rests_on_known_equations():
    assert all(set(study.rests_on) <= KNOWN for study in STUDIES)


def taper_study(outcome, rests_on=(SHEAR_FLOW, UNIFORM_TENSION)):
    statements = (Statement("falls", "It falls", Changes(-1)), Statement("ours", "Ours", Holds(), aside=True))
    return Study("figure-9.9", "a title", "", statements, outcome, rests_on=rests_on)


def falls_with(*names):
    """An outcome whose number falls where these equations are taken as printed, and rises else."""

    def outcome(model):
        x = np.array([1.0, 0.5 if set(names) <= set(model.reading) else 2.0])
        return Outcome({"falls": x, "ours": [True]}, [Panel("", "", "", [Curve(x, x, "")])])

    return outcome


def again(study):
    first = study.judge(study.compute(Model()))
    return first["falls"].verdict, judged_again(study, Model(), first, {})["falls"]


def test_a_statement_that_the_thesis_equations_bear_out_names_the_first_equation_that_is_enough():
    first, second = again(taper_study(falls_with(UNIFORM_TENSION)))
    assert first is Verdict.NOT_REPRODUCED and second.verdict is Verdict.REPRODUCED
    assert second.reading == (SHEAR_FLOW, UNIFORM_TENSION) and second.enough == (UNIFORM_TENSION,)


def test_a_question_of_our_own_is_answered_twice_where_the_equations_bear_on_it_and_decides_nothing():
    study = taper_study(falls_with(UNIFORM_TENSION))

    def silent_outcome(model):
        return Outcome(study.compute(model).evidence | {"ours": [True] * (not model.reading)}, [])

    silent = replace(study, outcome=silent_outcome)
    first = study.judge(study.compute(Model()))
    assert judged_again(study, Model(), first, {})["ours"].verdict is Verdict.REPRODUCED
    found = judged_again(silent, Model(), first, {})
    assert "ours" not in found and study.verdict(found) is Verdict.REPRODUCED


def test_a_statement_that_needs_several_equations_names_those():
    study = taper_study(falls_with(SHEAR_FLOW, INPUT_WEIGHT), (SHEAR_FLOW, UNIFORM_TENSION, FIELD, INPUT_WEIGHT))
    _, second = again(study)
    assert second.verdict is Verdict.REPRODUCED and second.enough == (SHEAR_FLOW, INPUT_WEIGHT)


def test_a_misprint_that_the_thesis_refutes_is_told_and_does_not_count():
    _, second = again(taper_study(falls_with(PRINTED_Q12), (SHEAR_FLOW, PRINTED_Q12)))
    assert second.verdict is Verdict.NOT_REPRODUCED and second.reading == (SHEAR_FLOW,)
    assert second.told == ("with printed Q̄12 (Tables 3.3 and 3.4 refute it): reproduced (1 of 1 steps fall)",)


def test_a_refuted_reading_that_changes_no_verdict_is_not_told():
    _, second = again(taper_study(falls_with("nothing known"), (SHEAR_FLOW, PRINTED_Q12)))
    assert second.verdict is Verdict.NOT_REPRODUCED and not second.told


def test_all_that_the_thesis_refutes_is_told_alone():
    """Six terms too: its text says ten."""
    refuted = [equation.name for equation in EQUATIONS if equation.refuted]
    assert refuted == [SIX_TERMS, PRINTED_Q12, PRINTED_Q, FIBRES_ACROSS] and not set(refuted) & set(TOGETHER)
    for name in refuted:
        _, second = again(taper_study(falls_with(name), (SHEAR_FLOW, name)))
        assert second.verdict is Verdict.NOT_REPRODUCED and len(second.told) == 1


def test_what_rests_on_no_equation_of_the_thesis_has_one_verdict_twice():
    study = taper_study(lambda model: falls_with()(model), ())
    first, second = again(study)
    assert first is second.verdict is Verdict.REPRODUCED and not second.reading


def test_a_blade_that_the_equations_do_not_give_cannot_be_evaluated():
    def outcome(model):
        if model.reading:
            raise ValueError("no such blade")
        return falls_with()(model)

    _, second = again(taper_study(outcome))
    assert second.verdict is Verdict.UNTESTABLE and second.reason == "no such blade"


@pytest.mark.parametrize(
    ("name", "key", "verdict", "enough"),
    [
        ("table-3.1", "values", Verdict.NOT_REPRODUCED, ()),
        ("table-3.3", "ten-terms", Verdict.TREND, ()),
        ("figure-5.5", "falls", Verdict.REPRODUCED, (SHEAR_FLOW,)),
        pytest.param("figure-5.12", "pressure-tip", Verdict.REPRODUCED, (UNIFORM_TENSION,), marks=pytest.mark.slow),
        ("figure-3.5", "softening", Verdict.REPRODUCED, (SHEAR_FLOW,)),
        ("figure-3.15", "turn", Verdict.NOT_REPRODUCED, ()),
        pytest.param("figure-3.16", "peak", Verdict.TREND, (UNIFORM_TENSION,), marks=pytest.mark.slow),
        ("figure-5.16", "fourth", Verdict.REPRODUCED, (INPUT_WEIGHT,)),
    ],
)
def test_second_verdicts_as_judged(name, key, verdict, enough):
    study = BY_NAME[name]
    first = study.judge(study.compute(Model()))
    found = judged_again(study, Model(), first, {})
    assert (found[key].verdict, found[key].enough) == (verdict, enough)
    assert found == judged_again(study, Model(), first, {})


@pytest.mark.parametrize("name", ["table-6.1", "table-6.2"])
def test_layouts_of_chapter_6_are_judged_as_they_are_printed(name):
    study = BY_NAME[name]
    found = judged_again(study, Model(), {}, {})
    assert found["ga-below-sqp"].verdict is Verdict.REPRODUCED and found["ga-below-sqp"].reading == AS_PRINTED
    assert found["start"].verdict is Verdict.UNTESTABLE and "neither β, α and η" in found["start"].reason


def test_what_is_printed_speaks_of_the_thesis_statements_alone():
    for study in THESIS_STUDIES:
        if study.printed is not None:
            assert set(study.printed(Model())) <= {statement.key for statement in study.own_statements}


def test_parts_are_found_for_every_reading():
    study = BY_NAME["figure-5.3"]
    parts = study.parts_by_reading(Model())
    assert [reading for reading, _ in parts] == [(), *readings(study.rests_on)]
    assert len(set(parts.values())) == len(parts)
    assert set(BY_NAME["table-6.1"].parts_by_reading(Model()).values()) == set(BY_NAME["table-6.1"].parts(Model()).values())
    assert replace(study, rests_on=()).parts_by_reading(Model()) == {((), "frequencies"): parts[(), "frequencies"]}
