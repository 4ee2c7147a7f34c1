"""cleanrl's PPO learns from the blade; its text, which was written for Gymnasium below 1.0, is changed in one line."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

found = importlib.util.find_spec("cleanrl")
if found is None:
    pytest.skip("cleanrl is not installed", allow_module_level=True)

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("default")]

OF_GYMNASIUM_0 = "TransformObservation(env, lambda obs: np.clip(obs, -10, 10))"
OF_GYMNASIUM_1 = "TransformObservation(env, lambda obs: np.clip(obs, -10, 10), None)"


def test_its_ppo_for_continuous_actions_learns(tmp_path):
    text = (Path(next(iter(found.submodule_search_locations))) / "ppo_continuous_action.py").read_text()
    assert text.count(OF_GYMNASIUM_0) == 1
    script = tmp_path / "ppo_continuous_action.py"
    script.write_text(text.replace(OF_GYMNASIUM_0, OF_GYMNASIUM_1))
    options = "--total-timesteps 4096 --num-envs 2 --num-steps 512 --num-minibatches 4 --update-epochs 2 --cuda False"
    done = subprocess.run(
        [sys.executable, str(script), "--env-id", "beamenv:beamenv/RotatingBeam-v0", *options.split()],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=500,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("SPS:") == 4
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    events = EventAccumulator(str(next((tmp_path / "runs").rglob("events.*")).parent)).Reload()
    losses = [event.value for event in events.Scalars("losses/value_loss")]
    assert len(losses) == 4
    assert all(0.0 < loss < float("inf") for loss in losses)
