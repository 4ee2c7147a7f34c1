"""One stepping function for NumPy and torch, with gradients."""

import numpy as np
import pytest

from beamenv.blade.build import build_plant
from beamenv.blade.presets import blade_config
from beamenv.plant.plant import normalised, sample
from beamenv.simulation.kernel import Operators, advance
from beamenv.simulation.plants.cost_axes import lean
from beamenv.task import resolve_task

PLANT = build_plant(blade_config())
OPERATORS = Operators.from_plant(PLANT)


def joined(*batch):
    rng = np.random.default_rng(0)
    return np.concatenate(
        [0.03 * rng.normal(size=(*batch, 22)), 500.0 * rng.normal(size=(*batch, 4)), 10.0 * rng.normal(size=(*batch, 2))], axis=-1
    )


def test_any_leading_axes_give_the_same_numbers():
    z = joined(2, 3)
    together = advance(OPERATORS, z)
    for i, j in np.ndindex(2, 3):
        for whole, alone in zip(together, advance(OPERATORS, z[i, j]), strict=True):
            np.testing.assert_allclose(whole[i, j], alone, rtol=1e-11, atol=1e-16)


def test_a_product_may_be_written_to_an_array_of_any_layout():
    z = joined(4, 5)
    out = np.empty((4, OPERATORS.fused.shape[1], 5)).swapaxes(1, 2)
    for expected, actual in zip(advance(OPERATORS, z), advance(OPERATORS, z, out=out), strict=True):
        np.testing.assert_allclose(actual, expected, rtol=1e-12)
    assert np.shares_memory(advance(OPERATORS, z, out=out)[0], out)


def test_one_step_is_that_of_the_sampled_plant():
    held, z = sample(PLANT), joined()
    x, u, d = z[:22], z[22:26], z[26:]
    state, output, tip, increment = advance(OPERATORS, z)
    expected = held.A @ x + held.B @ u + held.disturbance_input @ d
    np.testing.assert_allclose(state, expected, rtol=1e-12)
    np.testing.assert_allclose(output, PLANT.C @ expected, rtol=1e-10)
    np.testing.assert_allclose(tip, PLANT.tip_displacement @ expected, rtol=1e-10)
    assert increment == pytest.approx(z @ held.cost @ z, rel=1e-12)


def test_torch_runs_the_very_same_code_with_gradients():
    torch = pytest.importorskip("torch")
    operators = OPERATORS.convert(torch.as_tensor)
    z = torch.as_tensor(joined(3)).requires_grad_()
    for expected, actual in zip(advance(OPERATORS, joined(3)), advance(operators, z), strict=True):
        np.testing.assert_allclose(actual.detach().numpy(), expected, rtol=1e-11)
    advance(operators, z)[3].sum().backward()
    np.testing.assert_allclose(z.grad.numpy(), 2.0 * joined(3) @ sample(PLANT).cost, rtol=1e-10, atol=1e-18)


@pytest.mark.parametrize("preset", ["thesis", "sound-blade"])
def test_readings_that_are_states_need_no_columns_of_their_own(preset):
    bank = resolve_task(preset=preset).bank
    whole, fewer = bank.operators, lean(bank.operators, normalised(bank.plant))
    assert whole.fused.shape[1] - fewer.fused.shape[1] == len(bank.plant.C)
    z = np.random.default_rng(0).normal(size=(5, len(whole.fused)))
    for expected, actual in zip(advance(whole, z), advance(fewer, z), strict=True):
        np.testing.assert_allclose(actual, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max())
    assert lean(fewer, normalised(bank.plant)).fused is fewer.fused
