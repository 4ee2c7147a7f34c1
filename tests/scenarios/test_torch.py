"""NumPy and torch run the very same functions of a scenario, and gradients pass through them."""

from dataclasses import replace

import numpy as np
import pytest

from beamenv.blade.build import Blade
from beamenv.blade.presets import blade_config
from beamenv.scenarios.scenario import SCENARIOS
from beamenv.simulation.kernel import advance
from beamenv.simulation.plants.banks import build_bank
from beamenv.simulation.signals.faults import Faults, SignalMemory, acquire, drive
from beamenv.simulation.signals.hysteresis import prandtl_ishlinskii

torch = pytest.importorskip("torch")
BLADES = 6
RNG = np.random.default_rng(0)


def tensor(values):
    return torch.as_tensor(values)


def faults():
    gain = np.ones((BLADES, 4))
    gain[1, 2] = gain[3, 0] = 0.0
    return Faults(np.array([1, 2, 3, 1, 2, 3]), gain, gain[:, ::-1].copy(), 0.1 * RNG.normal(size=(BLADES, 4)))


def memory():
    commands, plays, readings = (0.3 * RNG.normal(size=(BLADES, *shape)) for shape in ((4, 4), (4, 8), (4,)))
    return SignalMemory(commands, plays, readings)


def test_a_plant_of_its_own_for_every_blade():
    config = blade_config()
    bank = build_bank(Blade(config), Blade(config), replace(SCENARIOS["off-speed"].plants, bank=4), 100)
    operators = bank.operators.pick(np.array([0, 3, 1, 1, 2, 0]))
    z = RNG.normal(size=(BLADES, operators.fused.shape[1]))
    ours, theirs = advance(operators, z), advance(operators.convert(tensor), leaf := tensor(z).requires_grad_())
    for k in range(BLADES):  # and each is what it would be alone
        alone = advance(bank.operators.pick([0, 3, 1, 1, 2, 0][k]), z[k])
        for one, other, whole in zip(alone, ours, theirs, strict=True):
            np.testing.assert_allclose(other[k], one, rtol=1e-9, atol=1e-13)
            np.testing.assert_allclose(whole[k].detach().numpy(), one, rtol=1e-9, atol=1e-13)
    theirs[3].sum().backward()
    for axis in (0, 7, 40, 46, 51):  # J is quadratic, so that central differences are exact but for rounding
        rise = [advance(operators, z + sign * np.eye(z.shape[1])[axis])[3] for sign in (1.0, -1.0)]
        np.testing.assert_allclose(leaf.grad.numpy()[:, axis], 0.5 * (rise[0] - rise[1]), rtol=1e-7, atol=1e-9)


def test_drive_with_delay_hysteresis_and_dead_actuators():
    operator, broken, past = prandtl_ishlinskii(0.2, -1.0 / 3.0, 1.0), faults(), memory()
    asked = RNG.uniform(-0.3, 1.0, size=(BLADES, 4))
    acting, following = drive(broken, operator, past, asked)
    leaf = tensor(asked).requires_grad_()
    before = SignalMemory(tensor(past.commands).requires_grad_(), tensor(past.plays), tensor(past.readings))
    in_torch = replace(operator, radii=tensor(operator.radii))
    acting_torch, following_torch = drive(broken.convert(tensor), in_torch, before, leaf)
    np.testing.assert_allclose(acting_torch.detach().numpy(), acting, rtol=1e-13, atol=1e-16)
    for ours, theirs in zip(following, following_torch, strict=True):
        np.testing.assert_array_equal(theirs.detach().numpy(), ours)
    acting_torch.sum().backward()
    assert not leaf.grad.any()  # every voltage comes at least one interval late
    reached = before.commands.grad.numpy()
    for blade, delay in enumerate(broken.delay):
        live = broken.actuator_gain[blade] > 0.0
        gain = reached[blade, delay - 1]
        assert np.all(gain[live] >= operator.direct - 1e-12)
        assert not gain[~live].any()


def test_acquisition_with_faults_and_lost_readings():
    broken, past = faults(), memory()
    output, noise = RNG.normal(size=(2, BLADES, 4)) * [[[0.6]], [[0.02]]]
    lost = RNG.random((BLADES, 4)) < 0.3
    shown, following = acquire(broken, past, output, noise, lost)
    leaf = tensor(output).requires_grad_()
    shown_torch, following_torch = acquire(
        broken.convert(tensor), SignalMemory(*map(tensor, past)), leaf, tensor(noise), tensor(lost)
    )
    np.testing.assert_array_equal(shown_torch.detach().numpy(), shown)
    np.testing.assert_array_equal(following_torch.readings.detach().numpy(), following.readings)
    assert np.abs(shown).max() <= 1.0
    shown_torch.sum().backward()
    inside = np.abs(output * broken.sensor_gain + broken.sensor_bias + noise) < 1.0
    np.testing.assert_array_equal(leaf.grad.numpy(), np.where(inside & ~lost, broken.sensor_gain, 0.0))


@pytest.mark.parametrize("steps", [1, 40])
def test_hysteresis_step_by_step(steps):
    operator = prandtl_ishlinskii(0.2, -1.0, 1.0)
    in_torch = replace(operator, radii=tensor(operator.radii))
    plays = np.zeros((BLADES, 4, 8))
    plays_torch, total = tensor(plays), 0.0
    leaf = tensor(RNG.uniform(-1.0, 1.0, size=(steps, BLADES, 4))).requires_grad_()
    for voltages in leaf:
        ours, plays = operator.step(voltages.detach().numpy(), plays)
        theirs, plays_torch = in_torch.step(voltages, plays_torch)
        np.testing.assert_allclose(theirs.detach().numpy(), ours, rtol=1e-14, atol=1e-15)
        total = total + theirs.sum()
    total.backward()
    assert torch.isfinite(leaf.grad).all()
    assert (leaf.grad[-1] >= operator.direct - 1e-12).all()
