"""skrl wraps one blade, Gymnasium's vectorisations, the native batch and the batch of tensors."""

import gymnasium
import pytest

import beamenv
from tests.clients.lines import assert_lines_run

pytest.importorskip("skrl")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]


@pytest.mark.parametrize("count", [None, 3])
def test_its_wrapper_steps(count):
    import torch
    from skrl.envs.wrappers.torch import wrap_env

    made = (
        gymnasium.make(beamenv.ENV_ID, duration=0.01) if count is None else gymnasium.make_vec(beamenv.ENV_ID, count, duration=0.01)
    )
    env = wrap_env(made, wrapper="gymnasium")
    observations, _ = env.reset()
    assert observations.shape == (count or 1, 4)
    for _ in range(20):
        observations, rewards, terminated, truncated, _ = env.step(torch.zeros((count or 1, 4)))
    assert truncated.all() and observations.dtype == torch.float32


def test_its_wrapper_steps_the_batch_of_tensors():
    import torch
    from skrl.envs.wrappers.torch import wrap_env

    env = wrap_env(beamenv.torch_vec(3, device="cpu", duration=0.01), wrapper="gymnasium")
    observations, _ = env.reset()
    assert observations.shape == (3, 4)
    for _ in range(20):
        observations, rewards, terminated, truncated, _ = env.step(torch.zeros((3, 4)))
    assert truncated.all() and observations.dtype == rewards.dtype == torch.float32


def test_the_lines_of_the_page_run(tmp_path):
    assert_lines_run("skrl", tmp_path)
