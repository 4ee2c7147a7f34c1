"""ONNX models of controllers, run by ONNX' own reference, do in the loop what the controllers themselves do there."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from baselines import lqg
from beamenv.task import resolve_task
from tests.train.exports import EVERY
from tests.train.in_a_loop import TOLERANCE, by_python, in_a_loop
from train.export import export, exported

STEPS = 100  # the reference takes a millisecond a step


def onnx_steps(found):
    """From a row of what is measured to voltages, the memory going from outputs to inputs."""
    from onnx import load_model_from_string
    from onnx.reference import ReferenceEvaluator

    from train.export.onnx_model import onnx_model

    content = onnx_model(found)
    model, run = load_model_from_string(content), ReferenceEvaluator(content).run
    sizes = {each.name: each.type.tensor_type.shape.dim[0].dim_value for each in model.graph.input}
    outputs = [each.name for each in model.graph.output]
    kind = np.float64 if found.precision == "double" else np.float32
    memory = {name: np.zeros(size, kind) for name, size in sizes.items() if f"{name}_next" in outputs}

    def step(measured):
        row = np.asarray(measured, dtype=kind)
        feeds = {"sensors": row[: sizes["sensors"]], "speed": row[sizes["sensors"] :]}
        found = run(None, {**{name: feeds[name] for name in feeds if name in sizes}, **memory})
        memory.update({name.removesuffix("_next"): value for name, value in zip(outputs[1:], found[1:], strict=True)})
        return found[0]

    return step


@pytest.mark.parametrize(("build", "scenario"), EVERY)
def test_controller_in_onnx_asks_for_the_voltages_of_the_controller(build, scenario):
    pytest.importorskip("onnx")
    controller, plant = build(scenario), resolve_task(scenario=scenario).design_plant
    found = {precision: exported(controller, plant, precision=precision) for precision in TOLERANCE}
    reads_speed = len(found["double"].diagram.inputs) > 1
    _, voltages = by_python(controller, plant, scenario, reads_speed, STEPS)
    for precision, each in found.items():
        _, written = in_a_loop(onnx_steps(each), scenario, reads_speed, STEPS)
        worst = np.abs(written - voltages).max() / np.abs(plant.voltage_limits).max()
        assert worst < TOLERANCE[precision], precision


def test_model_tells_what_it_is_for(tmp_path):
    onnx = pytest.importorskip("onnx")
    plant = resolve_task().design_plant
    found = export(lqg(plant), plant, tmp_path / "mine.onnx", precision="single")
    model = onnx.load(tmp_path / "mine.onnx")
    assert {each.key: each.value for each in model.metadata_props} == found.facts
    assert found.facts["interval"] == "0.0005 s" and found.facts["volts[3]"] == "V, clipped to -1500 … 1500"


def test_without_the_package_the_command_says_what_to_install(tmp_path):
    root = str(Path(__file__).parents[2])
    code = f"import sys; sys.modules['onnx'] = None; sys.path.insert(0, {root!r}); from train.cli.command import main; main()"
    command = [sys.executable, "-c", code, "export", "none", "--format", "onnx"]
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert (run.returncode, run.stderr.count("\n"), list(tmp_path.iterdir())) == (1, 1, [])
    assert "'onnx' is missing; install it with pip install 'beamenv[export]'" in run.stderr
