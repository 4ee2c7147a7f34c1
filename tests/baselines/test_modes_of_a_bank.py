"""A bank that is followed mode by mode decides as one that is followed by whole matrices, which stay where there are no modes."""

from dataclasses import replace

import numpy as np
import pytest

from baselines import Hypothesis, PersistentLoad, lqg, multiple_model
from baselines.design import weighing
from baselines.design.modes import common_modes, modes_of
from baselines.design.motion import DenseMotion, ModalMotion, motion_of

BLIND = (0.0, 1.0)


def hypotheses(plant, load=True):
    """Delays, faults and biases, whose states all have one and the same eigenvalue; one with two states fewer."""
    own = {"load": PersistentLoad() if load else None, "deflection": 12.0, "holds_lost_readings": True}
    faults = [{}, {"delay": 1}, {"delay": 3}, {"actuator_gain": BLIND}, {"sensor_gain": BLIND}, {"sensor_bias": (1e-3, 0.0)}]
    return [Hypothesis(plant, prior=1.0 + k, **own, **fault) for k, fault in enumerate(faults)]


def both(monkeypatch, those, fallback, **more):
    modal = multiple_model(those, fallback, **more)
    with monkeypatch.context() as patch:
        patch.setattr(weighing, "motion_of", lambda bank, gain, mixed: DenseMotion.of(bank, gain))
        dense = replace(modal)
    assert isinstance(modal._motion, ModalMotion) and isinstance(dense._motion, DenseMotion)
    return modal, dense


def episode(steps, scales, seed=4):
    """Observations (steps, N, 2) of a slow drift, of which some are lost and others clipped."""
    random, seen = np.random.default_rng(seed), np.zeros((steps, len(scales), 2))
    for k in range(1, steps):
        fresh = np.clip(0.95 * seen[k - 1] + np.array(scales)[:, None] * random.normal(size=(len(scales), 2)), -1.0, 1.0)
        seen[k] = np.where(random.random(fresh.shape) < 0.06, seen[k - 1], fresh)
    return seen


def memories_agree(modal, dense, one, other, rtol):
    for name, a, b in zip(weighing.Memory._fields, modal.recall(one), dense.recall(other), strict=True):
        np.testing.assert_allclose(a, b, rtol=rtol, atol=rtol * np.abs(b).max(initial=1e-300), err_msg=name)


@pytest.mark.parametrize("switching", [False, True], ids=["fixed", "switching"])
def test_over_an_episode_modes_and_whole_matrices_decide_alike(small_plant, monkeypatch, switching):
    """To 1e-9 of the drive: hundreds of instants of rounding, times the conditions of modes and of weights."""
    plant = small_plant()
    those = hypotheses(plant)
    more = {"transition": 0.94 * np.eye(6) + 0.01} if switching else {}
    modal, dense = both(monkeypatch, those, lqg(plant), **more)
    one = other = None
    seen = episode(250, [1e-3, 3e-3, 0.02, 0.9])
    assert (np.abs(seen) == 1.0).any() and (seen[1:] == seen[:-1]).any()
    starts = np.zeros((250, 4), dtype=bool)
    starts[150, 1] = True
    for k in range(250):
        a, one = modal.predict(seen[k], one, starts[k])
        b, other = dense.predict(seen[k], other, starts[k])
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-9)
    memories_agree(modal, dense, one, other, 1e-7)
    astray = dense.recall(other).astray
    assert astray[-1] == 1.0 and astray[0] == 0.0
    np.testing.assert_allclose(modal.weights(one), dense.weights(other), atol=1e-8)
    np.testing.assert_allclose(modal.misfits(one), dense.misfits(other), rtol=1e-8)
    change = np.full((4, 2), 0.1)
    memories_agree(modal, dense, modal.overruled(one, change), dense.overruled(other, change), 1e-7)


def test_loads_and_orders_that_differ_stand_side_by_side(small_plant, monkeypatch):
    plant = small_plant()
    modal, dense = both(monkeypatch, [*hypotheses(plant, load=False), *hypotheses(plant)], None)
    assert len(set(modal.bank.sizes)) == 2 and modal.order < dense.order
    one = other = None
    for seen in episode(150, [1e-3, 5e-3]):
        a, one = modal.predict(seen, one)
        b, other = dense.predict(seen, other)
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-9)
    memories_agree(modal, dense, one, other, 1e-7)


def test_modes_are_those_of_the_matrix_whatever_its_eigenvalues():
    turned, random = np.array([[0.9, -0.3], [0.3, 0.9]]), np.random.default_rng(0)
    A = np.zeros((7, 7))
    A[:2, :2], A[2:, 2:] = turned, np.diag([0.5, 0.5, 0.5, 0.2, -0.1])
    mixed = random.normal(size=(7, 7))
    for matrix in (A, mixed @ A @ np.linalg.inv(mixed)):
        (modes,) = modes_of([matrix])
        np.testing.assert_allclose(modes.states @ modes.of_states, np.eye(7), atol=1e-12)
        through = modes.of_states.T.copy().view(complex) * modes.eigenvalues
        np.testing.assert_allclose(through.view(float) @ modes.states.T, matrix.T, atol=1e-12)


def test_where_eigenvectors_are_parallel_whole_matrices_stay(small_plant):
    assert modes_of([np.array([[1.0, 1.0], [0.0, 1.0]])]) is None
    assert modes_of([np.eye(2), np.array([[0.5, 1.0], [0.0, 0.5 + 1e-9]])]) is None
    law = multiple_model([Hypothesis(small_plant())])
    bank, integrators = law.bank, np.eye(*law.bank.transition.shape[1:], k=1) + 0.9 * np.eye(law.bank.counts[1])
    assert isinstance(motion_of(bank, law.state_gain, mixed=False), ModalMotion)
    assert isinstance(motion_of(replace(bank, transition=integrators[None]), law.state_gain, mixed=False), DenseMotion)


def test_states_that_are_mixed_have_modes_in_common_or_none():
    A = np.diag([0.5, 0.7])
    one, other = common_modes([A, A * (1.0 + 1e-15)])
    assert one is other
    assert common_modes([A, A * (1.0 + 1e-6)]) is None
    assert common_modes([A, np.eye(3)]) is None


@pytest.mark.parametrize("switching", [False, True], ids=["fixed", "switching"])
@pytest.mark.parametrize("modes", [True, False], ids=["by modes", "by whole matrices"])
def test_in_single_precision_a_bank_decides_as_in_double(small_plant, monkeypatch, switching, modes):
    """To 1e-3 of the drive, at every instant: single precision rounds at 6e-8, times the conditions of modes and of weights."""
    plant = small_plant()
    more = {"transition": 0.94 * np.eye(6) + 0.01} if switching else {}
    double = both(monkeypatch, hypotheses(plant), lqg(plant), **more)[0 if modes else 1]
    if not modes:
        monkeypatch.setattr(weighing, "motion_of", lambda bank, gain, mixed: DenseMotion.of(bank, gain))
    single = double.in_single_precision()
    one = other = None
    for seen in episode(250, [1e-3, 3e-3, 0.02]):
        a, one = single.predict(seen, one)
        b, other = double.predict(seen, other)
        np.testing.assert_allclose(a, b, atol=1e-3)
    assert (one.dtype, other.dtype) == (np.float32, np.float64)
    assert single.in_single_precision() is single


def test_a_law_that_is_revised_goes_by_what_is_applied(small_plant):
    """As one that has decided and is then overruled; and the action in place of its own may depend on what it asked for."""
    plant = small_plant()
    law = multiple_model(hypotheses(plant), lqg(plant))
    memory = np.zeros((3, law.order))
    for seen in episode(60, [1e-3, 3e-3, 0.02]):
        told, following = [], np.empty_like(memory)

        def half(some, asked, cautious, misfit, likely, told=told):
            told.append((asked, misfit, likely))
            return 0.5 * asked + 0.01 * cautious

        action = law.revised(seen, memory, half, following)
        asked, decided = law.decide(seen, memory)
        np.testing.assert_array_equal(told[0][0], asked)
        np.testing.assert_allclose(told[0][1], law.misfits(decided), rtol=1e-9)
        np.testing.assert_allclose(told[0][2], law.weights(decided), rtol=1e-9)
        np.testing.assert_allclose(following, law.overruled(decided, action - asked), rtol=1e-9, atol=1e-9)
        memory = following
    with pytest.raises(ValueError, match="has no fallback"):
        multiple_model(hypotheses(plant)).revised(seen, memory, half, following)
