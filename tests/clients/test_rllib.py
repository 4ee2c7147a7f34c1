"""RLlib runs the environment in worker processes, which do not know the id without its module."""

import numpy as np
import pytest

pytest.importorskip("ray.rllib")

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]

ENV_ID = "beamenv:beamenv/RotatingBeam-v0"


@pytest.fixture(scope="module")
def cluster():
    import ray

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False)
    yield
    ray.shutdown()


@pytest.mark.parametrize("runners", [0, 1])
def test_it_trains(cluster, runners):
    from ray.rllib.algorithms.ppo import PPOConfig

    config = (
        PPOConfig()
        .environment(ENV_ID, env_config={"duration": 0.01})
        .env_runners(num_env_runners=runners, num_envs_per_env_runner=2)
        .training(train_batch_size=128, minibatch_size=64, num_epochs=1)
    )
    algorithm = config.build_algo()
    result = algorithm.train()
    algorithm.stop()
    assert np.isfinite(result["env_runners"]["episode_return_mean"])
    assert result["env_runners"]["episode_len_mean"] == 20
