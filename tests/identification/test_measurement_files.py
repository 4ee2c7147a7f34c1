"""Measurements in CSV files, and what is said of those that are none."""

from pathlib import Path

import numpy as np
import pytest

from baselines import Measurement, read_measurement

ROWS = 240
RNG = np.random.default_rng(0)
VOLTS, READINGS = RNG.standard_normal((ROWS, 2)), RNG.standard_normal((ROWS, 1))


def lines(step=0.002):
    rows = [f"{k * step:.4f},{u[0]:.6f},{u[1]:.6f},{y[0]:.6e}" for k, (u, y) in enumerate(zip(VOLTS, READINGS, strict=True))]
    return ["time [s],u1 [V],u2 [V],y (A)", *rows]


def read(text, tmp_path, **about):
    path = Path(tmp_path) / "data.csv"
    path.write_text(text if isinstance(text, str) else "\n".join(text) + "\n", encoding="utf-8")
    return read_measurement(path, **about)


def with_cell(line, column, value):
    rows = [each.split(",") for each in lines()]
    rows[line - 1][column] = value
    return [",".join(each) for each in rows]


def test_columns_units_and_rate_come_from_the_file(tmp_path):
    found = read(lines(), tmp_path)
    assert (found.voltage_names, found.reading_names, found.reading_units) == (("u1", "u2"), ("y",), ("A",))
    assert found.interval == pytest.approx(0.002, rel=1e-9)
    assert np.allclose(found.voltages, VOLTS, atol=1e-6)
    assert np.allclose(found.readings, READINGS, rtol=1e-5)


@pytest.mark.parametrize("separator", [";", "\t"])
def test_other_separators_and_other_names_do(tmp_path, separator):
    text = "\n".join(lines()).replace(",", separator).replace("u1", "drive").replace("y (A)", "gauge")
    found = read(text, tmp_path, voltages=["drive"], readings=["gauge"])
    assert found.voltages.shape == (ROWS, 1)
    assert found.reading_names == ("gauge",)


def test_without_a_column_of_time_the_interval_is_given(tmp_path):
    text = [line.partition(",")[2] for line in lines()]
    assert read(text, tmp_path, interval=0.5).interval == 0.5
    with pytest.raises(ValueError, match="it has no column of time, so interval must be given"):
        read(text, tmp_path)


def test_voltages_that_were_on_before_the_readings_stand_in_the_row_before(tmp_path):
    found = read(lines(), tmp_path, before=True)
    assert len(found) == ROWS - 1
    assert np.allclose(found.voltages, VOLTS[1:], atol=1e-6)
    assert np.allclose(found.readings, READINGS[:-1], rtol=1e-5)


WRONG = [
    ("", {}, "it is empty, but must have a line of names, then a row for each instant"),
    (lines()[1:], {}, "its first line has numbers, but must name the columns"),
    (lines()[:100], {}, "the measurement has 99 rows, but must have at least 100"),
    (with_cell(7, 3, "nan"), {}, "column 'y' is nan on line 7, but must be finite in every row"),
    (with_cell(7, 1, ""), {}, "column 'u1' is empty on line 7, but must be a number in every row"),
    (with_cell(9, 1, "off"), {}, "column 'u1' holds 'off' on line 9, but must be a number in every row"),
    ([*lines()[:50], lines()[50] + ",1", *lines()[51:]], {}, "line 51 has 5 cells, but must have 4"),
    ([*lines()[:50], *lines()[60:]], {}, "0.022 s pass before line 51, but 0.002 s elsewhere: rows are missing there"),
    (with_cell(50, 0, "0.0970"), {}, "time on line 50 is 0.001 s off a constant rate of one row in 0.002 s"),
    ([*lines()[:50], lines()[49], *lines()[50:]], {}, "time does not rise on line 51, but must in every row"),
    (lines(), {"interval": 0.001}, "its rows are 0.002 s apart, but interval is 0.001 s"),
    (lines(), {"voltages": ["u3"]}, "voltages is 'u3', but must be one of time, u1, u2, y"),
    (lines(), {"readings": ["u1"]}, "column 'u1' is both a voltage and a reading, but must be one of them"),
    (lines(), {"time": "clock"}, "time is 'clock', but must be one of time, u1"),
    (
        [line.replace("u", "v") for line in lines()],
        {},
        "no column begins with u: its columns are time, v1, v2, y; voltages must name them",
    ),
]


@pytest.mark.parametrize(("text", "about", "said"), WRONG, ids=[said[:40] for _, _, said in WRONG])
def test_what_is_wrong_with_a_file_is_one_sentence(tmp_path, text, about, said):
    with pytest.raises(ValueError, match="data.csv") as refused:
        read(text, tmp_path, **about)
    message = str(refused.value)
    assert said in message
    assert message.endswith(".")
    assert "\n" not in message


def test_constant_and_proportional_columns_teach_nothing():
    still = np.zeros((ROWS, 1))
    with pytest.raises(ValueError, match=r"^column 'y1' is constant, but must move for anything to be learned from it\.$"):
        Measurement(VOLTS, still, 0.01)
    together = np.hstack([VOLTS[:, :1], -2.0 * VOLTS[:, :1]])
    with pytest.raises(ValueError, match=r"^voltages u1, u2 are in proportion to each other"):
        Measurement(together, READINGS, 0.01)


def test_readings_that_a_sensors_range_cuts_off_are_refused():
    rng = np.random.default_rng(0)
    volts, moving = rng.normal(size=(1000, 1)), rng.normal(size=(1000, 1))
    cut = np.clip(moving, -1.0, 1.0)  # a third of a normal distribution lies beyond one standard deviation
    Measurement(volts, np.clip(moving, -2.5, 2.5), 1e-3)  # 1.2 % beyond two and a half
    with pytest.raises(ValueError, match="^column 'y1' is at its limits, -1 and 1, in 3[0-4] % of the rows, but may be in 5 %"):
        Measurement(volts, cut, 1e-3)


def test_a_file_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ValueError, match=r"nobody\.csv' cannot be read: No such file or directory\.$"):
        read_measurement(tmp_path / "nobody.csv")
