"""How fast it is: environments beside Gymnasium's CartPole in the same process, imports, the beam's assembly.

The module starts itself in a process of its own, which hands its measurements over as JSON.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

from train.shared.interruption import end_with_parent
from train.shared.threads import ONE_THREAD

BATCHES = (256, 4096, 16384)
ROUNDS = 7

TARGETS = {
    "single_over_cartpole": 0.7,
    "batch_over_cartpole": 0.4,
    "batch_of_32_bits_over_cartpole": 0.6,
    "pictures": 30.0,
    "assembly_ms": 15.0,
    "further_speed_ms": 5.0,
    "plant_ms": 60.0,
    "import_s": 1.0,
}
"""Rates are to be at least, times at most this."""

ROWS = (
    ("cartpole", "CartPole-v1, gym.make", "steps/s"),
    ("single", "RotatingBeam-v0, gym.make", "steps/s"),
    ("single_over_cartpole", "the second over the first", ""),
    ("cartpole_4096", "CartPole-v1, native batch of 4096", "steps/s"),
    *((f"batch_{size}", f"RotatingBeam-v0, native batch of {size}", "steps/s") for size in BATCHES),
    ("batch_of_32_bits", 'the same of 4096 with dtype="float32"', "steps/s"),
    ("batch_over_cartpole", "a batch of 4096 over CartPole's", ""),
    ("batch_of_32_bits_over_cartpole", "that of 32 bits over CartPole's", ""),
    ("plants_1024", "a batch of 1024, each blade with a plant of its own speed", "steps/s"),
    ("plants_1024_of_32_bits", 'the same with dtype="float32"', "steps/s"),
    ("history_4096", "the same of 4096 with 12 instants of sensor history", "steps/s"),
    ("pictures", "RotatingBeam-v0, a picture of 960 × 540 for each step", "pictures/s"),
    ("import_s", "import beamenv", "s"),
    ("assembly_ms", "assembly of the default beam, sections and all", "ms"),
    ("assembly_of_known_sections_ms", "the same where another beam has the sections", "ms"),
    ("further_speed_ms", "its steady state and matrices at a further speed", "ms"),
    ("frequencies_ms", "the same with whirling frequencies", "ms"),
    ("plant_ms", "reduced plant of the default blade, all from the laminate on", "ms"),
)


def speed() -> dict[str, float]:
    """All measurements by name: the best of several rounds, on one BLAS thread, in a process of its own. About 20 s."""
    environment = {**os.environ, **ONE_THREAD, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-m", "beamenv.train.tools.speed"]
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
    import gymnasium

    import beamenv

    singles = {"cartpole": gymnasium.make("CartPole-v1"), "single": gymnasium.make(beamenv.ENV_ID)}
    batches = {"cartpole_4096": gymnasium.make_vec("CartPole-v1", num_envs=4096)}
    batches.update({f"batch_{size}": gymnasium.make_vec(beamenv.ENV_ID, num_envs=size) for size in BATCHES})
    different = {"preset": "off-speed", "plants": {"bank": 1024}}
    batches["batch_of_32_bits"] = gymnasium.make_vec(beamenv.ENV_ID, num_envs=4096, dtype="float32")
    batches["plants_1024"] = gymnasium.make_vec(beamenv.ENV_ID, num_envs=1024, scenario=different)
    batches["plants_1024_of_32_bits"] = gymnasium.make_vec(beamenv.ENV_ID, num_envs=1024, scenario=different, dtype="float32")
    batches["history_4096"] = beamenv.VectorSensorHistory(gymnasium.make_vec(beamenv.ENV_ID, num_envs=4096), length=12)
    runs = {name: single_run(env) for name, env in singles.items()}
    runs.update({name: batch_run(envs) for name, envs in batches.items()})
    best = dict.fromkeys(runs, 0.0)
    for _ in range(ROUNDS):
        for name, run in runs.items():
            best[name] = max(best[name], run())
    pictures = gymnasium.make(beamenv.ENV_ID, render_mode="rgb_array")
    return {
        **best,
        "single_over_cartpole": best["single"] / best["cartpole"],
        "batch_over_cartpole": best["batch_4096"] / best["cartpole_4096"],
        "batch_of_32_bits_over_cartpole": best["batch_of_32_bits"] / best["cartpole_4096"],
        "pictures": max(picture_run(pictures)() for _ in range(ROUNDS)),
        **structure_times(),
    }


def single_run(env: Any, steps: int = 20_000) -> Callable[[], float]:
    """Steps/s of one round of a single environment, resets included, with actions drawn beforehand."""
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(100)]
    env.reset(seed=0)

    def run() -> float:
        start = time.perf_counter()
        for k in range(steps):
            _, _, terminated, truncated, _ = env.step(actions[k % 100])
            if terminated or truncated:
                env.reset()
        return steps / (time.perf_counter() - start)

    return run


def picture_run(env: Any, steps: int = 100) -> Callable[[], float]:
    """Pictures/s of one round of a single environment that steps and draws, with the last 0.2 s full of curves."""
    env.action_space.seed(0)
    actions = [env.action_space.sample() for _ in range(steps)]
    env.reset(seed=0)
    for k in range(500):
        env.step(actions[k % steps])

    def run() -> float:
        start = time.perf_counter()
        for action in actions:
            env.step(action)
            env.render()
        return steps / (time.perf_counter() - start)

    return run


def batch_run(envs: Any, steps: int = 1_200_000) -> Callable[[], float]:
    """Environment steps/s of one round of a batch, with all noises, loads, rewards, info and autoresets."""
    envs.action_space.seed(0)
    actions = envs.action_space.sample()
    calls = max(steps // envs.num_envs, 1)
    envs.reset(seed=0)

    def run() -> float:
        start = time.perf_counter()
        for _ in range(calls):
            envs.step(actions)
        return calls * envs.num_envs / (time.perf_counter() - start)

    return run


def structure_times() -> dict[str, float]:
    """Milliseconds for the default beam: its matrices, with its sections and with these known, its steady state and frequencies at
    one more speed, and its reduced plant.
    """
    from beamenv.blade.build import build_plant
    from beamenv.blade.presets import blade_config

    config = blade_config()
    speeds = iter(range(100, 200))
    cold = {
        "assembly_ms": _best_ms(lambda: config.beam.build(model=config.model).matrices),
        "plant_ms": _best_ms(lambda: build_plant(config)),
    }
    beam = config.beam.build(model=config.model)
    _ = beam.matrices

    return cold | {
        "assembly_of_known_sections_ms": _best_ms(lambda: config.beam.build(model=config.model).matrices),
        "further_speed_ms": _best_ms(lambda: beam.at(float(next(speeds)))),
        "frequencies_ms": _best_ms(lambda: beam.natural_frequencies(speed=float(next(speeds)), count=6, gyroscopic=True)),
    }


def _best_ms(call: Callable[[], Any]) -> float:
    best = float("inf")
    for _ in range(ROUNDS):
        start = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - start)
    return 1e3 * best


def met(name: str, value: float) -> bool | None:
    """Whether a measurement meets its target; None if it has none."""
    if name not in TARGETS:
        return None
    return value <= TARGETS[name] if name.endswith(("_s", "_ms")) else value >= TARGETS[name]


if __name__ == "__main__":
    end_with_parent(os.getppid())
    sys.stdout.write(json.dumps(measure()))
