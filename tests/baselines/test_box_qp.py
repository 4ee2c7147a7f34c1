"""Bounded quadratic programs: textbook answers, scales, failures."""

import copy
import pickle
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from baselines.design.box_qp import BoxQP

HESSIAN = np.array([[2.0, 1.0], [1.0, 2.0]])


@pytest.mark.parametrize("scale", [1.0, 1e3])
@pytest.mark.parametrize("cost", [1.0, 1e-12])
def test_the_free_variable_makes_the_best_of_the_bound_one_at_any_scale(scale, cost):
    """Least x² + xy + y² − 6x + 0y with |x|, |y| ≤ 1: x = 1 and y = −x/2; the second program has its least value inside."""
    program = BoxQP(cost * HESSIAN / scale**2, np.full(2, -scale), np.full(2, scale))
    minimisers = program.minimise(cost / scale * np.array([[-6.0, 0.0], [0.3, 0.0]]))
    np.testing.assert_allclose(minimisers, scale * np.array([[1.0, -0.5], [-0.2, 0.1]]), rtol=1e-12)
    assert program.failures == 0


def test_a_program_given_up_is_nan_and_counted_and_the_others_are_solved():
    program = BoxQP(HESSIAN, np.full(2, -1.0), np.full(2, 1.0))
    minimisers = program.minimise(np.array([[-6.0, 0.0], [np.nan, 0.0], [-6.0, 0.0]]))
    np.testing.assert_allclose(minimisers[[0, 2]], [[1.0, -0.5]] * 2)
    assert np.isnan(minimisers[1]).all()
    assert program.failures == 1


@pytest.mark.parametrize("duplicate", [copy.deepcopy, lambda program: pickle.loads(pickle.dumps(program))])
def test_a_copy_solves_for_itself(duplicate):
    program = BoxQP(HESSIAN, np.full(2, -1.0), np.full(2, 1.0))
    np.testing.assert_array_equal(duplicate(program).minimise(np.array([[-6.0, 0.0]])), program.minimise(np.array([[-6.0, 0.0]])))


def test_what_has_no_single_minimiser_is_refused():
    with pytest.raises(ValueError, match="not positive definite"):
        BoxQP(np.diag([1.0, 0.0]), np.full(2, -1.0), np.full(2, 1.0))
    with pytest.raises(ValueError, match="lower ones first"):
        BoxQP(HESSIAN, np.full(2, 1.0), np.full(2, -1.0))
    with pytest.raises(ValueError, match="finite"):
        BoxQP(HESSIAN, np.full(2, -np.inf), np.full(2, 1.0))


def test_without_its_solver_it_says_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "daqp", None)
    with pytest.raises(ModuleNotFoundError, match="pip install daqp"):
        BoxQP(HESSIAN, np.full(2, -1.0), np.full(2, 1.0))


def test_one_program_solved_by_eight_threads_at_once_is_solved_as_by_one():
    """Each thread has a solver of its own: one solver's memory, shared, gave other minimisers and then corrupted the heap."""
    random = np.random.default_rng(4)
    root = random.normal(size=(24, 24))
    program = BoxQP(root @ root.T + 1e-2 * np.eye(24), np.full(24, -1.0), np.full(24, 1.0))
    gradients = 10.0 * random.normal(size=(8, 100, 24))
    alone = [program.minimise(each) for each in gradients]
    with ThreadPoolExecutor(8) as threads:
        for together in (list(threads.map(program.minimise, gradients)) for _ in range(3)):
            np.testing.assert_array_equal(together, alone)
    assert program.failures == 0


def test_failures_of_all_threads_are_counted():
    program = BoxQP(HESSIAN, np.full(2, -1.0), np.full(2, 1.0))
    with ThreadPoolExecutor(8) as threads:
        list(threads.map(program.minimise, [np.full((5, 2), np.nan)] * 200))
    assert program.failures == 1000
