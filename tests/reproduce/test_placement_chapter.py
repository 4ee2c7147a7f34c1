"""Chapter 6 in the page: the tables as printed beside ours, and verdicts that follow the numbers."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.presets import blade_config
from train.reproduce.catalogue import STUDIES
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.runner import source_fingerprint
from train.reproduce.studies.chapter6_columns import all_header, all_rows, four_header, four_panels, four_rows
from train.reproduce.studies.chapter6_layouts import placed_blade
from train.reproduce.studies.chapter6_tables import printed_cost, speed_orders
from train.reproduce.studies.placement_study import COUNTS, SPEEDS, table_row
from train.reproduce.thesis import Model, printed_table

BY_NAME = {study.name: study for study in STUDIES}


@pytest.fixture(scope="module")
def pair():
    """One row at rest and one at 200 rad/s, of four actuators."""
    return [table_row("actuators", 4, speed, placed_blade(Model())) for speed in SPEEDS]


@pytest.fixture(scope="module")
def layouts():
    """Initial and optimal, by pretwist, which no load changes."""
    return {key: part.result() for key, part in BY_NAME["figure-6.7"].parts(Model()).items()}


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_printed_layouts_are_ascending_and_have_one_trace_each(number):
    rows = printed_table(f"table-6.{number}")
    cases = {}
    for row in rows:
        cases.setdefault((row.get("count", "4"), row["speed"]), []).append(row)
    assert len(cases) == (2 if number < 3 else len(COUNTS) * len(SPEEDS))
    for count, _ in cases:
        assert all(len(lines) == int(count) for (n, _), lines in cases.items() if n == count)
    for lines in cases.values():
        for method in ("ga", "sqp"):
            assert np.all(np.diff([float(line[f"{method}_position"]) for line in lines]) > 0.0)
            assert len({line[f"{method}_cost"] for line in lines}) == 1


def test_thesis_prints_a_smaller_trace_by_ga_then_sqp_than_by_ga():
    for number in (3, 4):
        assert all(float(row["sqp_cost"]) < float(row["ga_cost"]) for row in printed_table(f"table-6.{number}"))


def test_chapter_6_is_computed_from_the_model_and_is_the_preset_of_the_placement_in_the_thesis_world():
    world = {"model": "thesis", "beam": {"shear_flow": "consistent"}}
    assert placed_blade(Model()) == blade_config("thesis-untwisted", world)
    assert placed_blade(Model(), 30.0) == blade_config("thesis", world)
    longer = Model(box=replace(Model().box, length=2.1))
    assert placed_blade(longer).beam.length == 2.1 and source_fingerprint(longer) != source_fingerprint(Model())


def test_table_of_four_has_the_thesis_layout_with_ours_beside_it(pair):
    header, lines = four_header("actuators"), four_rows("actuators", pair)
    assert all(len(line) == len(header) for line in lines) and len(lines) == 8
    assert lines[0][:4] == ["0", "0.06681", f"{pair[0].ga.positions[0]:.5f}", "1.1212E+05"]
    assert lines[1][0] == "" and lines[4][0] == "200"
    assert header[4] == "GA tr(P) (s), ours"
    assert [len(panel.curves) for panel in four_panels("actuators", pair)] == [4, 4]


def test_table_of_one_to_four_has_a_line_for_each_patch(pair):
    by_case = {(row.count, row.speed): row for row in pair}
    rows = [by_case.get((n, s)) or replace(by_case[4, s], count=n) for n in COUNTS for s in SPEEDS]
    header, lines = all_header("actuators"), all_rows("actuators", rows)
    assert len(lines) == 20 and all(len(line) == len(header) for line in lines)
    assert lines[-1][:2] == ["", ""] and lines[-1][2] == "0.50643"


def test_order_of_the_trace_with_speed_depends_on_what_the_thesis_does_not_print(pair):
    found = speed_orders("actuators", pair, placed_blade(Model()))
    assert len(found) == 6 and 0 < sum(found) < 6


def test_layouts_that_the_thesis_found_better_are_better_on_our_blade_too():
    config = placed_blade(Model())
    for side in ("actuators", "sensors"):
        for speed in SPEEDS:
            assert printed_cost(side, config, speed, "ga") < printed_cost(side, config, speed, "sqp")


def test_placing_deepens_the_slowest_pole_of_every_loop(layouts):
    study = BY_NAME["figure-6.7"]
    outcome = study.compute(Model(), layouts)
    found = study.judge(outcome)
    assert found["slowest"].verdict is Verdict.REPRODUCED and found["mean"].verdict is Verdict.TREND
    assert [panel.x_label for panel in outcome.panels] == ["real part (1/s)"] * 4
    assert all(np.all(curve.x < 0.0) for panel in outcome.panels for curve in panel.curves)


def test_placing_settles_sooner_with_less_effort_and_more_voltage(layouts):
    study = BY_NAME["figure-6.6"]
    found = {key: judged.verdict for key, judged in study.judge(study.compute(Model(), layouts)).items()}
    assert found["settling"] is Verdict.REPRODUCED and found["effort"] is Verdict.REPRODUCED
    assert found["tip"] is Verdict.TREND and found["voltage"] is Verdict.NOT_REPRODUCED


def test_a_load_that_the_voltages_cannot_answer_loses_the_verdict_on_settling(layouts):
    study, heavier = BY_NAME["figure-6.6"], Model(load=3000.0)
    assert study.parts(heavier) == study.parts(Model())
    found = study.judge(study.compute(heavier, layouts))
    assert found["settling"].verdict is not Verdict.REPRODUCED


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "verdicts"),
    [
        ("table-6.3", {"then": Verdict.REPRODUCED, "shift": Verdict.REPRODUCED, "depends": Verdict.REPRODUCED}),
        ("table-6.4", {"shift": Verdict.NOT_REPRODUCED, "near": Verdict.TREND}),
        ("figure-6.4", {"falls": Verdict.REPRODUCED, "population": Verdict.REPRODUCED}),
    ],
)
def test_placement_is_reproduced_as_far_as_it_is(name, verdicts):
    found = {key: judged.verdict for key, judged in BY_NAME[name].judge(BY_NAME[name].compute(Model())).items()}
    assert {key: found[key] for key in verdicts} == verdicts
