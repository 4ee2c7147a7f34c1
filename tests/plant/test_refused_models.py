"""Models that no plant can be made of: what is wrong is named, in one sentence."""

import control
import numpy as np
import pytest
from scipy.linalg import block_diag, expm

from beamenv import Plant
from tests.plant.two_modes import SYSTEM, A, B, C, oscillator

REFUSED = {
    "A has mode 1 at 2 rad/s (0.3183 Hz) that is unstable": lambda: Plant.from_state_space([[0, 1], [-4, 0.1]], [0, 1], [1, 0]),
    "A has mode 1 at 2 rad/s (0.3183 Hz) that is unstable and that no voltage reaches, but every": lambda: Plant.from_state_space(
        np.diag([2.0, -3.0]), [0, 1], [1, 1]
    ),
    "A has mode 1 at 2 rad/s (0.3183 Hz) that has no damping, but every mode must die away": lambda: Plant.from_state_space(
        [[0, 1], [-4, 0]], [0, 1], [1, 0]
    ),
    "A has mode 1 at 2 rad/s (0.3183 Hz) that has no damping, but": lambda: Plant.from_state_space(
        expm(0.1 * np.array([[0, 1], [-4, 0]])), [0, 1], [1, 0], dt=0.1
    ),
    "A has mode 1 at 0 rad/s (0 Hz) that drifts without end (a rigid body, an integrator), but every": lambda: (
        Plant.from_state_space([[0, 1, 0, 0], [0, 0, 0, 0], [0, 0, 0, 1], [0, 0, -900, -1]], [0, 1, 0, 1], [1, 0, 1, 0])
    ),
    "A has mode 1 at 0 rad/s (0 Hz) that drifts without end": lambda: Plant.from_state_space(np.eye(1), [1], [1], dt=0.1),
    "the model has no field 'colour': its fields are A, B, C, D, dt, interval": lambda: Plant.from_state_space(A, B, C, colour=1),
    "the model has no field 'colour': its fields are A, B, C, D, dt, interval,": lambda: Plant.from_control(SYSTEM, colour=1),
    "dt is 0.1, but must be left out: system has its own": lambda: Plant.from_control(SYSTEM, dt=0.1),
    "system is 'tf', but must be a control.StateSpace, or what control.ss makes one of": lambda: Plant.from_control("tf"),
    "system is 'tf', but must be a control.StateSpace": lambda: Plant.from_control("tf", Plant.from_control(SYSTEM)),
    "like is 3, but must be a Plant": lambda: Plant.from_control(SYSTEM, 3),
    "Plant has no field 'colour': its fields are A, B, C, D, disturbance_input": lambda: Plant.from_control(
        SYSTEM, Plant.from_control(SYSTEM), colour=1
    ),
    "A has mode 2 at 2 rad/s (0.3183 Hz) that no voltage reaches": lambda: Plant.from_state_space(
        np.diag([-1.0, -2.0]), [1, 0], [1, 1]
    ),
    "A has mode 2 at 2 rad/s (0.3183 Hz) that no sensor sees": lambda: Plant.from_state_space(
        np.diag([-1.0, -2.0]), [1, 1], [1, 0]
    ),
    "C has shape (1, 3), but must have shape (any, 4)": lambda: Plant.from_state_space(A, B, [1, 0, 0]),
    "D has shape (3, 1), but must have shape (2, 1)": lambda: Plant.from_state_space(A, B, C, np.zeros((3, 1))),
    "A has shape (4, 3), but must have shape (4, 4)": lambda: Plant.from_state_space(A[:, :3], B, C),
    "energy has the eigenvalue -1": lambda: Plant.from_state_space(A, B, C, energy=-np.eye(4)),
    "energy has shape (3, 3), but must have shape (4, 4)": lambda: Plant.from_state_space(A, B, C, energy=0.5 * np.eye(3)),
    "process_noise[0] is nan, but every number": lambda: Plant.from_state_space(A, B, C, process_noise=[np.nan]),
    "sensor_noise[1] is nan, but every number": lambda: Plant.from_state_space(A, B, C, sensor_noise=[0.1, np.nan]),
    "sensor_names is ['a', 'a'], but must be a name of its own": lambda: Plant.from_state_space(A, B, C, sensor_names=["a", "a"]),
    "disturbance_units is ['N', 'm'], but must be 1": lambda: Plant.from_state_space(A, B, C, disturbance_units=["N", "m"]),
    "sensor_units is ['A'], but must be 2, one for each sensor": lambda: Plant.from_state_space(A, B, C, sensor_units=["A"]),
    "dt is 0.0, but must be a positive number (s)": lambda: Plant.from_state_space(A, B, C, dt=0.0),
    "A has poles that no system in continuous time has": lambda: Plant.from_state_space(
        [[0.0, 1.0], [0.0, 0.0]], [0, 1], [1, 0], dt=0.1
    ),
    "actuator_limits is [[1.0], [2.0]], but must be a lower limit from -1e+09 to 0 V": lambda: Plant.from_state_space(
        A, B, C, actuator_limits=(1.0, 2.0)
    ),
    "full_scale is [-1.0, -1.0], but must be positive numbers": lambda: Plant.from_state_space(A, B, C, full_scale=-1.0),
    "output_weight has the eigenvalue -1": lambda: Plant.from_state_space(A, B, C, output_weight=[1.0, -1.0]),
    "interval is 0.02, but must be None or dt": lambda: Plant.from_state_space(0.5 * np.eye(4), B, C, dt=0.01, interval=0.02),
}


def test_of_two_equal_modes_one_voltage_reaches_a_single_one():
    twice = block_diag(oscillator(30.0, 0.01), oscillator(30.0, 0.01))
    both = np.array([[0.0, 0.0], [1.0, 0.2], [0.0, 0.0], [0.7, -1.0]])
    with pytest.raises(ValueError, match=r"^A has mode 1 at 30 rad/s \(4.775 Hz\) that no voltage reaches"):
        Plant.from_state_space(twice, both[:, 0], both.T)
    assert len(Plant.from_state_space(twice, both, both.T).A) == 4


LASTING = {
    "is unstable": [[0.0, 9.0], [-9.0, 0.02]],
    "has no damping": [[0.0, 9.0], [-9.0, 0.0]],
    "drifts without end": [[0.0, 1.0], [0.0, 0.0]],
}


@pytest.mark.parametrize("what", LASTING)
@pytest.mark.parametrize("seed", range(3))
def test_modes_that_last_are_named_alike_at_every_door_and_in_any_coordinates(what, seed, tmp_path):
    generator = np.random.default_rng(seed)
    basis, own = generator.normal(size=(4, 4)), block_diag(LASTING[what], [[0.0, 40.0], [-40.0, -0.8]])
    moved = basis @ own @ np.linalg.inv(basis)
    inputs, outputs = basis @ [[0.0], [1.0], [0.0], [1.0]], np.array([[1.0, 0.0, 1.0, 0.0]]) @ np.linalg.inv(basis)
    np.savez(tmp_path / "mine.npz", A=moved, B=inputs, C=outputs)
    held = control.c2d(control.ss(moved, inputs, outputs, 0.0), 0.02)
    for door in (
        lambda: Plant.from_state_space(moved, inputs, outputs),
        lambda: Plant.from_control(control.ss(moved, inputs, outputs, 0.0)),
        lambda: Plant.from_control(held),
        lambda: Plant.from_file(tmp_path / "mine.npz"),
    ):
        with pytest.raises(ValueError, match=rf"A has mode 1 at \S+ rad/s \(\S+ Hz\) that {what}.*, but every mode must die away"):
            door()


@pytest.mark.parametrize("words", REFUSED)
def test_what_cannot_be_is_refused_in_one_sentence(words):
    with pytest.raises(ValueError) as refused:
        REFUSED[words]()
    assert str(refused.value).startswith(words) and str(refused.value).count(". ") == 0


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("model.csv", b"", r"^plant is '.*model.csv', but must be a file that ends in .npz or .mat or .json\.$"),
        ("model.mat", b"nothing", r"^file '.*model.mat' cannot be read: it is no .mat\.$"),
        ("model.npz", b"nothing", r"^file '.*model.npz' cannot be read: it is no .npz archive of arrays\.$"),
        ("model.json", b'{"A": [[-1.0]], "B": [1.0]}', r"^file '.*model.json': C is missing\.$"),
        (
            "model.json",
            b'{"A": [[-1.0]], "B": [1.0], "C": [1.0], "Q": 1}',
            r"^file '.*': the model has no field 'Q': its fields are A, B",
        ),
        ("model.json", b'{"A": [[1.0]], "B": [1.0], "C": [1.0]}', r"^file '.*': A has mode 1 at 1 rad/s .* that is unstable"),
    ],
)
def test_files_that_are_no_models_are_refused_by_name(tmp_path, name, content, words):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(ValueError, match=words):
        Plant.from_file(tmp_path / name)
