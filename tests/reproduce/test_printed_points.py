"""Numbers that the thesis prints are drawn beside ours: all of them, where they belong, and in their own colour."""

import io

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image

from train.figures.figure import Curve, Panel
from train.reproduce.catalogue import chosen
from train.reproduce.drawing import appearances, curve_rows, draw, legend_entries
from train.reproduce.judging.study import Outcome
from train.reproduce.judging.stumbling import STUMBLING
from train.reproduce.judging.verdicts import Verdict
from train.reproduce.thesis import Model, printed_table
from train.reproduce.thesis.points import COLOUR, ONE_AXIS, PRINTED, is_printed, on_x, on_y, printed, with_points

X = np.linspace(1.0, 3.0, 5)


def panel(*labels):
    return Panel("one", "x (m)", "y (m)", [Curve(X, k + X, label) for k, label in enumerate(labels, 1)])


def drawn(name):
    (study,) = chosen([name])
    return [curve for each in study.compute(Model()).panels for curve in each.curves if is_printed(curve)]


def columns(name, *wanted):
    return [float(row[column]) for row in printed_table(name) for column in wanted]


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("table-3.1", ("omega1", "omega2", "omega3")),
        ("table-3.2", ("thesis",)),
        ("table-3.3", ("omega1", "omega2", "omega3")),
        ("table-3.4", ("thesis",)),
    ],
)
def test_every_frequency_that_a_table_prints_is_drawn(name, wanted):
    assert sorted(np.concatenate([curve.y for curve in drawn(name)])) == sorted(columns(name, *wanted))


def test_frequencies_stand_at_the_speed_that_the_table_names():
    rows = {(float(row["speed"]), float(row[f"omega{mode}"])) for row in printed_table("table-3.3") for mode in (1, 2, 3)}
    assert {(x, y) for curve in drawn("table-3.3") for x, y in zip(curve.x, curve.y, strict=True)} == rows


def test_speeds_read_off_a_plot_stand_on_the_axis_and_the_critical_one_where_the_frequency_is_zero():
    whole = {curve.label: curve for curve in drawn("figure-3.8")}
    assert list(whole[ONE_AXIS].x) == [430.0, 925.0]
    assert (list(whole[PRINTED].x), list(whole[PRINTED].y)) == ([1480.0], [0.0])


def test_what_has_one_coordinate_stands_at_the_foot_or_the_left_edge_of_our_curves():
    below, left = (each.curves[-1] for each in (on_x(panel("a", "b"), 2.5), on_y(panel("a", "b"), 4.0)))
    assert (below.x, below.y) == (2.5, 2.0) and (left.x, left.y) == (1.0, 4.0)


def test_printed_numbers_change_nothing_of_how_our_curves_look():
    plain, with_them = (Outcome({}, [each]) for each in (panel("a", "b"), with_points(panel("a", "b"), [1.0], [2.0])))
    assert appearances(plain) == appearances(with_them)
    entries = [[(each.label, each.look) for each in legend_entries(one, appearances(one))] for one in (plain, with_them)]
    assert entries[1][:-1] == entries[0] and entries[1][-1][0] == PRINTED


def test_a_few_points_keep_their_colour_among_many_curves():
    busy = [panel(*(f"η = {k}" for k in range(8))) for _ in range(4)]
    picture = draw(Outcome({}, [*busy[1:], on_x(busy[0], 2.0)]), "busy")
    pixels = np.asarray(Image.open(io.BytesIO(picture)).convert("RGB")) / 255.0
    assert np.abs(pixels - to_rgb(COLOUR)).max(axis=2).min() < 0.05


def test_the_numbers_file_tells_printed_points_from_newmark_s():
    curves = [Curve(X, X, "a"), Curve(X, X, "a", "points"), printed([1.0], [2.0])]
    _, rows = curve_rows(Outcome({}, [Panel("one", "x", "y", curves)], {"points": "Newmark"}))
    assert {(row[1], row[2]) for row in rows} == {("a", ""), ("a", "Newmark"), (PRINTED, "")}


def test_table_3_1_does_not_count_as_reproduced_for_its_numbers_are_far_off():
    (study,) = chosen(["table-3.1"])
    outcome = study.compute(Model())
    assert study.verdict(study.judge(outcome)) is Verdict.NOT_REPRODUCED
    last = np.array([float(printed_table("table-3.1")[-1][f"omega{mode}"]) for mode in (1, 2, 3)])
    off = 1.0 - np.asarray(outcome.evidence["values"]) / last
    (told,) = [row for row in STUMBLING if row.section == "Table 3.1"]
    assert "gives {:.0f}, {:.0f} and {:.0f} % less".format(*100.0 * off) in told.remark and off.min() > 0.1
