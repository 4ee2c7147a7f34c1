"""C files of controllers do in the loop what the controllers themselves do there."""

import re
import subprocess
from dataclasses import replace

import numpy as np
import pytest

from baselines import LinearController, lqg
from baselines.design.loop import closed_loop, spectral_radius
from beamenv.plant.plant import sample
from beamenv.plant.signals import Signal
from beamenv.task import resolve_task
from tests.train.exports import EVERY, NOT_EXPORTED
from tests.train.in_a_loop import STEPS, TOLERANCE, in_a_loop, in_double_precision, python_steps
from train.controllers.named import discover
from train.controllers.shipped import shipped
from train.controllers.sources import Trained
from train.export import export, exported
from train.export.compiled import FLAGS, compiler, running, seconds_a_step

needs_a_compiler = pytest.mark.skipif(compiler() is None, reason="there is no C compiler")


def agrees(controller, plant, /, scenario, **blade):
    """Of both precisions with Python in double precision."""
    found = {precision: exported(controller, plant, precision=precision) for precision in TOLERANCE}
    reads_speed = len(found["double"].diagram.inputs) > 1
    with in_double_precision(controller) as own:
        measured, voltages = in_a_loop(python_steps(own, plant), scenario, reads_speed, **blade)
    assert len(voltages) == STEPS and (np.ptp(voltages) > 0.0 or controller.name == "none")
    for precision, each in found.items():
        with running(each) as step:
            if falls_apart(controller, blade):
                written = np.array([step(row) for row in measured])
            else:
                _, written = in_a_loop(step, scenario, reads_speed, **blade)
        worst = np.abs(written - voltages).max() / np.abs(plant.voltage_limits).max()
        assert worst < TOLERANCE[precision], precision


def falls_apart(controller, blade):
    """Whether the loop with the full plant is unstable: rounding grows in it, and only what both are shown can be compared."""
    if not isinstance(controller, LinearController):
        return False
    return spectral_radius(closed_loop(sample(resolve_task(**blade).design.full_plant), controller)[0]) > 1.0


@needs_a_compiler
@pytest.mark.parametrize(("build", "scenario"), EVERY)
def test_controller_in_c_asks_for_the_voltages_of_the_controller(build, scenario):
    agrees(build(scenario), resolve_task(scenario=scenario).design_plant, scenario)


@pytest.mark.parametrize("name", NOT_EXPORTED)
def test_law_that_cannot_be_exported_says_why(name):
    task = resolve_task()
    with pytest.raises(ValueError, match=f"cannot be exported: .*{NOT_EXPORTED[name]}"):
        exported(discover()[name].build_for(task), task.design_plant)


@pytest.mark.parametrize("unknown", [lambda readings: readings, object(), None])
def test_what_nobody_can_read_is_refused(unknown):
    with pytest.raises(ValueError, match="cannot be exported: what it does cannot be read from it"):
        exported(unknown, resolve_task().design_plant)


def test_law_of_another_clock_is_refused():
    slower = resolve_task(blade={"control_interval": 1e-3}).design_plant
    with pytest.raises(ValueError, match="plant has another interval than LQG was designed for: 0.001 in place of 0.0005"):
        exported(lqg(resolve_task().design_plant), slower)


def test_agent_of_another_blade_is_refused():
    (gradient,) = [each for each in shipped() if each.agent == "gradient" and each.seed == 0]
    policy = Trained(gradient.folder).build(resolve_task())
    with pytest.raises(ValueError, match="plant has 1 sensors and 1 voltages, which are not those that gradient"):
        exported(policy, resolve_task(preset="aluminium-cantilever").design_plant)


@needs_a_compiler
@pytest.mark.parametrize("name", ["lqg-load", "clipped-lqg", "multiple-model", "scheduled-lqg", "inverse-hysteresis"])
def test_blade_with_fewer_voltages_than_sensors(name):
    blade = {"patches": {"actuators": 2, "sensors": 3}}
    task = resolve_task(blade=blade, scenario="hysteresis")
    law, plant = discover()[name].build_for(task), task.design_plant
    found = exported(law, plant)
    full = plant.sensor_full_scale
    rows = np.clip(0.3 * full * np.random.default_rng(0).standard_normal((200, 3)), -full, full)
    rows = np.hstack([rows, *(np.full((200, each.size), 190.0) for each in found.diagram.inputs[1:])])
    with running(found) as step, in_double_precision(law) as own:
        here, limit = python_steps(own, plant), plant.voltage_limits.max()
        for row in rows:
            np.testing.assert_allclose(step(row), here(row), rtol=0.0, atol=1e-9 * limit)


@needs_a_compiler
@pytest.mark.parametrize("name", ["velocity", "lqg", "clipped-lqg-load", "multiple-model"])
def test_strip_with_one_patch_pair(name):
    task = resolve_task(preset="aluminium-cantilever")
    agrees(discover()[name].build_for(task), task.design_plant, "nominal", preset="aluminium-cantilever")


@needs_a_compiler
@pytest.mark.parametrize("name", ["lqg-load", "multiple-model"])
def test_accelerometer_that_feels_the_voltages(name):
    blade = {"sensors": [{"kind": "accelerometer"}, {"kind": "velocity", "position": 0.2}]}
    task = resolve_task(preset="aluminium-cantilever", blade=blade)
    law, plant = discover()[name].build_for(task), task.design_plant
    assert plant.D[0].any()
    agrees(law, plant, "nominal", preset="aluminium-cantilever", blade=blade)


def test_sensors_are_called_what_the_plant_calls_them():
    plant = resolve_task(preset="aluminium-cantilever").design_plant
    found = exported(lqg(plant), replace(plant, sensors=(Signal("tip", "m/s²"),)))
    assert found.facts["sensors[0]"] == f"tip, m/s², clipped to ±{plant.sensor_full_scale[0]:.9g}"


@needs_a_compiler
@pytest.mark.parametrize("precision", TOLERANCE)
def test_readings_and_voltages_are_clipped_as_the_environment_clips_them(precision):
    plant = resolve_task().design_plant
    law = lqg(plant)
    beyond = np.array([3.0, -2.0, 0.5, -0.25]) * plant.sensor_full_scale
    within = np.clip(beyond, -plant.sensor_full_scale, plant.sensor_full_scale)
    with running(exported(law, plant, precision=precision)) as step, running(exported(law, plant, precision=precision)) as other:
        for _ in range(20):
            volts = step(beyond)
            np.testing.assert_array_equal(volts, other(within))
            assert (volts >= plant.voltage_limits[0]).all() and (volts <= plant.voltage_limits[1]).all()
    assert np.abs(volts).max() == plant.voltage_limits[1].max()  # so it was the drive that ended it


@needs_a_compiler
@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_measurement_that_is_no_number_is_answered_with_status_one(bad):
    plant = resolve_task().design_plant
    with running(exported(lqg(plant), plant)) as step, pytest.raises(ValueError, match="ended with status 3"):
        step([0.0, bad, 0.0, 0.0])


ASKS_FOR_THE_SIZE = """\
#include <stdio.h>
#define OWN_DECLARATIONS
#include "own.c"
int main(void) { return !printf("%lu", (unsigned long)sizeof(own_state)); }
"""


@needs_a_compiler
@pytest.mark.parametrize("precision", TOLERANCE)
@pytest.mark.parametrize("name", ["velocity", "lqg", "scheduled-lqg"])  # no memory, signals on the stack, signals in the state
def test_file_is_clean_to_stricter_compilers_and_tells_its_size(name, precision, tmp_path):
    task = resolve_task()
    export(discover()[name].build_for(task), task.design_plant, tmp_path / "own.c", precision=precision, name="own")
    (tmp_path / "main.c").write_text(ASKS_FOR_THE_SIZE)
    strict = ("-Wconversion", "-Wshadow", "-Wdouble-promotion", "-Wcast-qual", "-Wno-unused-const-variable")
    command = [compiler(), *FLAGS, *strict, "main.c", "own.c", "-o", "main", "-lm"]
    assert subprocess.run(command, cwd=tmp_path, capture_output=True, text=True).stderr == ""
    size = int(subprocess.run([str(tmp_path / "main")], capture_output=True, text=True).stdout)
    (told,) = re.findall(r"a state (\d+), signals", (tmp_path / "own.c").read_text(encoding="utf-8"))
    assert int(told) == size


@needs_a_compiler
def test_step_is_timed():
    plant = resolve_task().design_plant
    rows = 0.1 * plant.sensor_full_scale * np.random.default_rng(0).standard_normal((2000, 4))
    assert 0.0 < seconds_a_step(exported(lqg(plant), plant), rows, passes=20) < plant.control_interval


@needs_a_compiler
def test_names_that_would_break_a_comment_do_not():
    plant = resolve_task().design_plant
    law = replace(lqg(plant), name="*/ int x; /* ??/ $name %s \\")
    with running(exported(law, plant)) as step:
        assert step(np.zeros(4)).tolist() == [0.0] * 4


@needs_a_compiler
@pytest.mark.parametrize("name", ["lqg", "lqg-load", "h-infinity", "multiple-model"])
def test_law_of_a_model_whose_sensors_feel_the_voltages(name):
    A = [[0.0, 30.0, 0.0], [-30.0, -0.6, 0.0], [0.0, 0.0, -60.0]]
    B, C = [[0.0, 0.0], [1.0, 0.3], [1.0, -0.9]], [[0.0, 1.0, 0.2], [0.3, 0.0, -0.8], [0.1, 0.5, 0.3]]
    model = {"A": A, "B": B, "C": C, "D": [[0.01, 0.0], [0.0, 0.01], [0.01, 0.01]], "interval": 0.01}
    task = resolve_task(plant=model)
    agrees(discover()[name].build_for(task), task.design_plant, "nominal", plant=model)
