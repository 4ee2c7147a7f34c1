"""How fast it is: environments beside Gymnasium's CartPole in the same process, imports, the beam's assembly.

The module starts itself in a process of its own, which hands its measurements over as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

from train.shared.interruption import end_with_parent
from train.shared.threads import ONE_THREAD
from train.speed.rounds import batch_run, picture_run, single_run
from train.speed.rows import BATCHES, OVER_CARTPOLE
from train.speed.structure import structure_times

ROUNDS = 7


def speed() -> dict[str, float]:
    """All measurements by name: the best of several rounds in a process of its own, and its BLAS ``threads``: one.

    About half a minute.
    """
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-m", "beamenv.train.speed.beside_cartpole"]
    results: dict[str, float] = json.loads(_output(command, environment))
    results["import_s"] = min(_import_seconds(environment) for _ in range(3))
    return results


def _import_seconds(environment: dict[str, str]) -> float:
    code = "import time; start = time.perf_counter(); import beamenv; print(time.perf_counter() - start)"
    return float(_output([sys.executable, "-c", code], environment))


def _output(command: list[str], environment: dict[str, str]) -> str:
    """What a process prints that Ctrl-C does not reach: it is ended by this one."""
    return subprocess.run(command, env=environment, check=True, stdout=subprocess.PIPE, text=True, start_new_session=True).stdout


def measure() -> dict[str, float]:
    """What ``speed`` measures in its own process. Rivals take turns, so that both meet the same machine."""
    from threadpoolctl import threadpool_info

    runs = single_runs() | batch_runs() | tensor_runs()
    best = dict.fromkeys(runs, 0.0)
    for _ in range(ROUNDS):
        for name, run in runs.items():
            best[name] = max(best[name], run())
    return {
        **best,
        **ratios(best),
        "pictures": pictures(),
        **structure_times(),
        "threads": max(pool["num_threads"] for pool in threadpool_info()),
    }


def single_runs() -> dict[str, Callable[[], float]]:
    """A round of either single environment."""
    import gymnasium

    import beamenv

    return {name: single_run(gymnasium.make(kind)) for name, kind in (("cartpole", "CartPole-v1"), ("single", beamenv.ENV_ID))}


def batch_runs() -> dict[str, Callable[[], float]]:
    """A round of each batch of NumPy's."""
    import gymnasium

    import beamenv

    def batch(size: int, **arguments: Any) -> Any:
        return gymnasium.make_vec(beamenv.ENV_ID, num_envs=size, **arguments)

    different = {"preset": "off-speed", "plants": {"bank": 1024}}
    batches = {
        "cartpole_4096": gymnasium.make_vec("CartPole-v1", num_envs=4096),
        **{f"batch_{size}": batch(size) for size in BATCHES},
        "batch_of_32_bits": batch(4096, dtype="float32"),
        "plants_1024": batch(1024, scenario=different),
        "plants_1024_of_32_bits": batch(1024, scenario=different, dtype="float32"),
        "history_4096": beamenv.VectorSensorHistory(batch(4096), length=12),
    }
    return {name: batch_run(envs, first_actions(envs)) for name, envs in batches.items()}


def first_actions(envs: Any) -> Any:
    """Those of every step of a batch."""
    envs.action_space.seed(0)
    return envs.action_space.sample()


def tensor_runs() -> dict[str, Callable[[], float]]:
    """A round of a batch of tensors on the processor; none where torch is not installed."""
    if find_spec("torch") is None:
        return {}
    import torch

    import beamenv

    envs = beamenv.torch_vec(4096, "cpu", autoreset_mode="SameStep")
    return {"tensors_4096": batch_run(envs, torch.rand(4096, 4) - 0.5, steps=400_000)}


def ratios(best: dict[str, float]) -> dict[str, float]:
    """Steps/s over those of CartPole, of what was measured."""
    return {f"{name}_over_cartpole": best[name] / best[rival] for name, rival in OVER_CARTPOLE.items() if name in best}


def pictures() -> float:
    """Pictures/s, the best of several rounds."""
    import gymnasium

    import beamenv

    run = picture_run(gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array"))
    return max(run() for _ in range(ROUNDS))


if __name__ == "__main__":
    end_with_parent(os.getppid())
    sys.stdout.write(json.dumps(measure()))
