"""``python -m train.speed``: see ``--help``."""

from __future__ import annotations

import argparse
import math
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

import beamenv
from train.speed.tensors import TARGET, device_name, rates

EXAMPLE = Path(beamenv.__file__).resolve().parents[1] / "examples" / "08_ppo_on_a_gpu.py"


def main(arguments: Sequence[str]) -> int:
    """Measure and tell; 2 for an argument that is refused, in one sentence."""
    options = _parser().parse_args(arguments)
    try:
        _check(options.seconds, options.ppo)
        device = beamenv.torch_vec(1, options.device, dtype=options.dtype, scenario=options.scenario).device
    except ValueError as error:
        sys.stderr.write(f"{error}\n")
        return 2
    _say(f"on {device_name(device)}, {options.dtype}")
    first, best = 0.0, 0.0
    for each in rates(device, options.seconds, options.dtype, options.scenario):
        first = first or each.rate
        best = best if each.label.startswith("CartPole") else max(best, each.rate)
        _say(f"{each.label:>20} {each.size:>8} {each.rate / 1e6:10.2f} M steps/s {each.rate / first:8.2f} × CartPole")
    _say(f"best {best / 1e6:.2f} M blade-steps/s; the target is {TARGET / 1e6:.0f} M on one GPU of the H100's class")
    minutes = options.ppo if options.ppo is not None else 2.0 if device.type == "cuda" else 0.0
    return _ppo(str(device), minutes) if minutes else 0


def _ppo(device: str, minutes: float) -> int:
    """Run the example; the target is J of at most 1.05 times LQG's in two minutes of a GPU."""
    if not EXAMPLE.is_file():
        sys.stderr.write("The PPO is an example of the repository, which is not beside this installation.\n")
        return 2
    blades = 16384 if device.startswith("cuda") else 512
    words = ["--device", device, "--minutes", str(minutes), "--blades", str(blades)]
    _say(f"PPO from readings alone, {minutes:g} minutes; the target is J over LQG's of 1.05 in 2 minutes of a GPU")
    return subprocess.run([sys.executable, str(EXAMPLE), *words], check=False).returncode


def _check(seconds: float, minutes: float | None) -> None:
    for name, value, least in (("--seconds", seconds, 0.01), ("--ppo", minutes, 0.0)):
        if value is not None and not (math.isfinite(value) and least <= value <= 600.0):
            raise ValueError(f"{name} is {value:g}, but must be a number from {least:g} to 600.")


def _say(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m train.speed", description="Batches of tensors on a device, beside CartPole.")
    parser.add_argument("--device", help="cpu, cuda or cuda:1; the GPU if there is one")
    parser.add_argument("--seconds", type=float, default=2.0, help="of each batch")
    parser.add_argument("--dtype", default="float32", help="float32 or float64")
    parser.add_argument("--scenario", help="a scenario's name")
    parser.add_argument("--ppo", type=float, help="minutes of PPO from readings alone; on a GPU 2 unless said otherwise, else none")
    return parser


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
