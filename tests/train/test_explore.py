"""The explorer: what its page shows is the model's, its callback bears any slider's end, and it serves this computer alone."""

import itertools
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from baselines import closed_loop_poles, lqg
from baselines.laws.lqg import sampled_design
from beamenv.blade.build import build_beam, build_plant
from beamenv.blade.presets import THESIS, blade_config
from beamenv.plant.plant import drive_limit, sample
from beamenv.plant.poles import poles_of_sampled
from beamenv.scenarios.load_cases import static_deflection

pytest.importorskip("dash", reason="dash is not installed")
go = pytest.importorskip("plotly.graph_objects", reason="plotly is not installed")

from train.explore import Settings, view  # noqa: E402 - they need the packages asked for above
from train.explore.app import create_app, redraw  # noqa: E402
from train.explore.blade import built, campbell_speeds  # noqa: E402
from train.explore.controls import RANGES, THESIS_PAGE  # noqa: E402
from train.explore.loops import powers, step_responses  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
START = THESIS_PAGE.start
OF_THE_BEAM = ("ply_angle_deg", "speed", "pretwist_deg", "taper")
PATCH = 1e3 * THESIS.patches.length
INWARD, OUTWARD = ([edge + k * PATCH for k in range(4)] for edge in (0.0, RANGES["actuators"].high - 3 * PATCH))
BUDGET = 0.15
NEW_BEAM = ("ply_angle_deg", "pretwist_deg", "taper", "actuators", "sensors")


@pytest.fixture(scope="module")
def thesis():
    return view(Settings())


@pytest.fixture(scope="module")
def plant():
    return build_plant(THESIS)


@pytest.fixture(scope="module")
def design(plant):
    held, (_, K), (_, L) = sampled_design(plant)
    return held, K, L


def test_the_page_opens_with_the_thesis_blade(thesis):
    beam = build_beam(THESIS)
    np.testing.assert_allclose(thesis.natural_frequencies, beam.natural_frequencies(200.0, 11), rtol=1e-10)
    assert thesis.families == beam.modes(200.0, 11).families
    assert thesis.critical_speed == pytest.approx(beam.critical_speed, rel=1e-12)


def test_the_sliders_begin_at_the_thesis_blade():
    assert THESIS_PAGE.settings(START).config() == THESIS
    edges = 1e-3 * np.array(RANGES["actuators"].value)
    np.testing.assert_allclose(edges, THESIS.patches.actuator_positions(THESIS.beam.length), atol=1e-9)


def test_the_campbell_diagram_holds_the_frequencies_of_every_speed(thesis):
    beam = build_beam(THESIS)
    for speed, frequencies in list(zip(campbell_speeds(THESIS), thesis.campbell, strict=True))[::5]:
        np.testing.assert_allclose(frequencies, beam.natural_frequencies(speed, 6), rtol=1e-6)  # between steady states


def test_modes_at_rest_are_real_and_clamped_at_the_root():
    shapes = view(Settings(speed=0.0)).shapes
    np.testing.assert_array_equal(shapes.imag, 0.0)
    np.testing.assert_allclose(shapes[..., 0], 0.0, atol=1e-12)
    np.testing.assert_allclose(np.abs(shapes).max(axis=(1, 2)), 1.0, rtol=1e-12)


def test_the_gyroscopic_force_moves_parts_of_a_mode_a_quarter_of_a_period_later(thesis):
    assert np.abs(thesis.shapes.imag).max() > 0.01


def test_modes_above_half_the_sampling_rate_keep_their_own_damping():
    """A bench strip whose highest modes fold into lower ones as samples."""
    strip = {"beam": {"section": {"shape": "strip", "width": 0.03, "thickness": 0.002}, "length": 0.3, "material": "aluminium"}}
    group = {"positions": [0.0], "length": 0.05, "width": 0.03, "wall": "strip", "material": "PIC255", "bonded": True}
    patches = {"actuators": [group], "sensors": [{**group, "face": "inner"}]}
    base = blade_config("thesis", {**strip, "patches": patches, "speed": 0.0, "damping_ratio": 0.005})
    found = view(Settings(speed=0.0), base)
    assert found.natural_frequencies[base.modes - 1] > np.pi / base.control_interval
    np.testing.assert_allclose(found.damping.free, 0.005, rtol=1e-6)
    assert np.all(found.damping.controlled > 0.005 * (1.0 - 1e-6))


def test_damping_at_rest_is_one_per_cent_in_every_mode():
    np.testing.assert_allclose(view(Settings(speed=0.0)).damping.free, 0.01, rtol=1e-8)


def test_lqg_damps_every_mode_more(thesis):
    assert np.all(thesis.damping.controlled > 2.0 * thesis.damping.free)
    assert thesis.damping.filter_rate > 0.0


def test_poles_of_regulator_and_filter_are_those_of_the_loop(plant, design):
    held, K, L = design
    parts = [poles_of_sampled(matrix, held.interval) for matrix in (held.A - held.B @ K, held.A - held.A @ L @ held.C)]
    whole = closed_loop_poles(plant, lqg(plant))
    for pole in np.concatenate(parts):
        assert np.abs(whole - pole).min() < 1e-6 * abs(pole)
    assert len(whole) == sum(map(len, parts))


@pytest.mark.parametrize("load", ["lag", "flap"])
def test_the_free_step_response_comes_to_rest_at_the_static_deflection(plant, design, load):
    line_load = 30.0 * np.array([load == "lag", load == "flap"])
    static = plant.tip_displacement @ static_deflection(plant, line_load)
    response = step_responses(plant, *design, line_load, duration=14.0)
    np.testing.assert_allclose(response.at_rest, static, rtol=1e-8, atol=1e-12)
    np.testing.assert_allclose(response.free[-1], static, rtol=1e-6, atol=1e-10)
    np.testing.assert_allclose(view(Settings(load=load)).response.at_rest, static, rtol=1e-8, atol=1e-12)


def test_lqg_brings_the_tip_to_rest_long_before_damping_does(thesis):
    response = thesis.response
    late = response.time > 0.3
    free, controlled = (np.ptp(each[late, 1]) for each in (response.free, response.controlled))
    assert controlled < 0.05 * free


def test_powers_by_doubling_are_powers():
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    turned = powers(turn, np.array([1.0, 0.0]), 7)
    np.testing.assert_array_equal(turned, [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 0], [0, 1], [-1, 0]])


def test_the_voltages_are_those_of_the_controller_saturated_or_not(plant, design):
    held, push = sample(plant), sample(plant).disturbance_input @ [0.0, 150.0]
    volts = step_responses(plant, *design, np.array([0.0, 150.0]), 119 * plant.control_interval).volts
    law, memory, x, expected = lqg(plant), None, np.zeros(len(plant.A)), []
    for _ in range(120):
        action, memory = law.predict(held.C @ x / plant.sensor_full_scale, memory)
        expected.append(action * drive_limit(plant))
        x = held.A @ x + held.B @ expected[-1] + push
    assert np.abs(volts).max() == 1500.0
    assert np.abs(volts).min(axis=0).max() < 1500.0
    np.testing.assert_allclose(volts, expected, rtol=1e-7, atol=1e-6)


def test_another_speed_needs_no_new_blade():
    view(Settings(pretwist_deg=12.0))
    before = built.cache_info().misses
    view(Settings(pretwist_deg=12.0, speed=215.0))
    assert built.cache_info().misses == before


def test_the_rotor_speed_is_told_in_hertz_and_revolutions_too():
    assert redraw(**START | {"speed": 62.8318530718})["hertz"] == ["10.0 Hz, 600 rpm"]


def check_figures(shown):
    assert shown["message"] == ""
    assert shown["results"] is False
    for figure in (shown["campbell"], shown["response"], *shown["shapes"]):
        drawn = go.Figure(figure)  # raises for a property that plotly does not know
        assert drawn.layout.xaxis.title.text
        assert drawn.layout.yaxis.title.text
        for trace in drawn.data:
            assert np.all(np.isfinite(np.array(trace.y, dtype=float)))
    assert len(shown["damping"]) == THESIS.modes


def each_end():
    """All of the beam's sliders at their ends; quickly those where neighbours agree, or where each differs from the next."""
    for ends in itertools.product("01", repeat=len(OF_THE_BEAM)):
        changes = sum(one != other for one, other in itertools.pairwise(ends))
        yield pytest.param(ends, id="".join(ends), marks=() if changes in (0, len(ends) - 1) else pytest.mark.slow)


@pytest.mark.parametrize("ends", list(each_end()))
def test_the_sliders_ends_give_figures(ends):
    values = {name: (RANGES[name].low, RANGES[name].high)[int(end)] for name, end in zip(OF_THE_BEAM, ends, strict=True)}
    check_figures(redraw(**START | values))


@pytest.mark.parametrize("edges", [INWARD, OUTWARD])
@pytest.mark.parametrize("side", ["actuators", "sensors"])
def test_patches_side_by_side_at_an_end_give_figures(side, edges):
    shown = redraw(**START | {side: edges, "load": "lag"})
    check_figures(shown)
    assert f"{side} on the {'top' if side == 'actuators' else 'bottom'} wall at {edges[0]:.0f}, {edges[1]:.0f}" in shown["said"]


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"actuators": [0.0, 50.0, 500.0, 900.0]}, "overlap"),
        ({"sensors": [0.0, 400.0, 800.0, 1900.0]}, "sensors"),
        ({"speed": 2000.0}, "speed"),
        ({"taper": 6.0}, "taper"),
        ({"ply_angle_deg": None}, "ply_angle_deg"),
        ({"load": "twist"}, "load"),
    ],
)
def test_what_makes_no_blade_is_told_in_one_sentence_in_place_of_the_figures(values, named):
    shown = redraw(**START | values)
    assert shown["results"] is True
    assert named in shown["message"]
    assert shown["message"].endswith(".")
    assert "\n" not in shown["message"]


EACH_MOVE = [
    pytest.param(name, marks=pytest.mark.xfail(name in NEW_BEAM, strict=False, reason="needs eight steady states"))
    for name in (*RANGES, "load")
]


@pytest.mark.slow
@pytest.mark.parametrize("name", EACH_MOVE)
def test_a_move_is_answered_within_the_budget_on_one_core(name):
    """CPU time, as other programs only slow a clock down; for the same reason one quick answer is proof."""
    entry = RANGES.get(name)
    times = []
    for k in range(1, 8):
        if entry is None:
            value = ("lag", "flap")[k % 2]
        elif isinstance(entry.value, list):
            value = [edge + 8.7 * k if 0 < edge < 1000 else edge for edge in entry.value]
        else:
            value = entry.low * 10 ** (k * entry.step) if entry.logarithmic else entry.low + k * entry.step
        begun = time.process_time()
        check = redraw(**START | {name: value})
        times.append(time.process_time() - begun)
        assert check["message"] == ""
    assert min(times) < BUDGET


def test_the_page_loads_nothing_from_elsewhere():
    client = create_app().server.test_client()
    page = client.get("/").get_data(as_text=True)
    sources = re.findall(r'(?:src|href)="([^"]*)"', page)
    assert len(sources) > 5
    assert [source for source in sources if not source.startswith(("/", "data:"))] == []
    for source in sources:
        if "explore" in source or "graph" in source:
            with client.get(source) as response:
                assert response.status_code == 200


@pytest.mark.parametrize("hidden", ["dash", "werkzeug"])
def test_without_its_extra_the_command_says_how_to_install_it(hidden):
    hide = f"import sys; sys.modules.update({hidden}=None); from train.cli.command import main; main()"
    run = subprocess.run([sys.executable, "-c", hide, "explore"], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode == 1
    assert run.stderr.count("\n") == 1
    assert "pip install 'beamenv[explore]'" in run.stderr
