"""MATLAB files of controllers, read back by SciPy and run as docs/export.md says, ask for the controllers' voltages."""

import numpy as np
import pytest
from scipy.io import loadmat

from baselines import LinearController, lqg
from beamenv.task import resolve_task
from tests.train.exports import EVERY, LAWS
from tests.train.in_a_loop import TOLERANCE, by_python, in_a_loop, python_steps
from train.export import export

STEPS = 100

NUMBERS = {
    **{"tanh": np.tanh, "exp": np.exp, "log": np.log, "absolute": np.abs, "sigmoid": lambda x: 1.0 / (1.0 + np.exp(-x))},
    **{"add": np.add, "subtract": np.subtract, "multiply": np.multiply, "divide": np.divide},
    **{"maximum": np.maximum, "minimum": np.minimum, "greater": np.greater, "equal": np.equal},
}
PARTS = {"sum of parts": np.sum, "maximum of parts": np.max, "minimum of parts": np.min}


def read(path):
    return loadmat(path, squeeze_me=False, struct_as_record=False)


def words(cells):
    return [str(each.item()) for each in np.ravel(cells)]


def value(block, given):
    """What a block of the file makes of its sources."""
    does, size = block.does.item(), int(block.size.item())
    if does == "affine":
        return block.matrix @ given[0] + (block.bias.ravel() if block.bias.size else 0.0)
    if does == "blocks":
        matrices = block.matrix.reshape(*block.matrix.shape, *[1] * (4 - block.matrix.ndim))  # MATLAB drops last sizes of 1
        entry = int(min(given[1][0], matrices.shape[3] - 1)) if len(given) > 1 else 0
        parts = given[0].reshape(block.which.size, -1)
        own = zip(block.which.ravel().astype(int) - 1, parts, strict=True)
        return np.concatenate([matrices[:, :, which, entry] @ part for which, part in own])
    if does == "choose":
        return np.where(given[0] > 0.0, given[1], given[2])
    if does == "pick":
        return given[0][block.indices.ravel().astype(int) - 1]
    if does == "join":
        return np.concatenate(given)
    if does == "constant":
        return block.value.ravel()
    return PARTS[does](given[0].reshape(size, -1), axis=1) if does in PARTS else 1.0 * NUMBERS[does](*given)


def mat_steps(path):
    """From a row of what is measured to voltages, block by block."""
    file = read(path)
    blocks, rows = file["blocks"].ravel(), file["memory"].ravel()
    memory = {each.name.item(): np.zeros(int(each.size.item())) for each in rows}
    inputs = words(file["inputs"])
    sensors = len(file["sensor_full_scale"].ravel())

    def step(measured):
        signals = {**memory, **dict(zip(inputs, (measured[:sensors], measured[sensors:]), strict=False))}
        for block in blocks:
            signals[block.name.item()] = value(block, [signals[name] for name in words(block.of)])
        memory.update({each.name.item(): signals[each.next.item()] for each in rows})
        return signals[file["output"].item()]

    return step


@pytest.mark.parametrize(("build", "scenario"), EVERY)
def test_blocks_of_the_file_ask_for_the_voltages_of_the_controller(build, scenario, tmp_path):
    controller, plant = build(scenario), resolve_task(scenario=scenario).design_plant
    found = export(controller, plant, tmp_path / "mine.mat")
    reads_speed = len(found.diagram.inputs) > 1
    _, voltages = by_python(controller, plant, scenario, reads_speed, STEPS)
    _, written = in_a_loop(mat_steps(tmp_path / "mine.mat"), scenario, reads_speed, STEPS)
    assert np.abs(written - voltages).max() < TOLERANCE["double"] * np.abs(plant.voltage_limits).max()


@pytest.mark.parametrize(("build", "scenario"), LAWS)
def test_linear_laws_and_no_others_have_the_matrices_of_python_control(build, scenario, tmp_path):
    law, plant = build(scenario), resolve_task(scenario=scenario).design_plant
    export(law, plant, tmp_path / "mine.mat")
    file = read(tmp_path / "mine.mat")
    if not isinstance(law, LinearController):
        assert not set("ABCDFGHMT") & set(file)
        return
    system = law.to_control()
    for name in "ABCD":
        np.testing.assert_array_equal(file[name].reshape(getattr(system, name).shape), getattr(system, name))
    assert file["dt"].item() == system.dt


def test_matrices_with_limits_run_as_the_law_does(tmp_path):
    plant = resolve_task(scenario="rotor").design_plant
    law = lqg(plant)
    export(law, plant, tmp_path / "mine.mat")
    file = read(tmp_path / "mine.mat")
    F, G, H, M, T = (file[name] for name in "FGHMT")
    low, high = file["voltage_limits"]
    memory = np.zeros(len(F))

    def step(y):
        nonlocal memory
        u = np.clip(M @ memory + T @ y, low, high)
        memory = F @ memory + G @ y + H @ u
        return u

    _, voltages = in_a_loop(python_steps(law, plant), "rotor", steps=STEPS)
    _, written = in_a_loop(step, "rotor", steps=STEPS)
    assert np.abs(voltages).max() == high.max()  # the drive saturates
    assert np.abs(written - voltages).max() < TOLERANCE["double"] * high.max()
