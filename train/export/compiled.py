"""Written C files compiled and run on this computer: in a loop, and against the clock."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from string import Template
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray

from train.export.c_source import c_source
from train.export.exported import Exported

Array = NDArray[np.floating[Any]]
Step = Callable[[Any], Array]
"""Voltages (m,), V, from a row (p,) of what is measured: what the sensors show, and what else the controller reads."""

FLAGS = ("-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-O2")

LONGEST = 300.0
"""s: what compiling, or running, may take."""

_MAIN = """\
#include <stdio.h>
#include <time.h>
#include "$name.c"

static ${name}_state state;
static $real measured[$steps][$columns], volts[$steps][$voltages];

static int in_a_loop(void)
{
    ${name}_init(&state);
    while (fread(measured, sizeof measured[0], 1, stdin) == 1) {
        if (${name}_step(&state, $first, volts[0])) return 3;
        if (fwrite(volts, sizeof volts[0], 1, stdout) != 1 || fflush(stdout)) return 4;
    }
    return 0;
}

static int against_the_clock(void)
{
    clock_t start;
    if (fread(measured, sizeof measured, 1, stdin) != 1) return 2;
    start = clock();
    for (int again = 0; again < $passes; ++again) {
        ${name}_init(&state);
        for (int k = 0; k < $steps; ++k)
            if (${name}_step(&state, $each, volts[k])) return 3;
    }
    fprintf(stderr, "%.9e", (double)(clock() - start) / CLOCKS_PER_SEC);
    return fwrite(volts, sizeof volts, 1, stdout) == 1 ? 0 : 4;
}

int main(void)
{
    return $steps > 1 ? against_the_clock() : in_a_loop();
}
"""


def compiler() -> str | None:
    """The C compiler of this computer: what CC names, or cc, gcc or clang; None without one."""
    candidates = (os.environ.get("CC", ""), "cc", "gcc", "clang")
    return next((found for found in map(shutil.which, filter(None, candidates)) if found), None)


@contextmanager
def running(exported: Exported) -> Iterator[Step]:
    """The compiled controller in a process of its own, at the start of an episode: each call is its next step.

    Raises ``ValueError`` where there is no C compiler, where it refuses the file, and, of a step, where the process has ended: that
    is what it does of a measurement that is no number.
    """
    with TemporaryDirectory() as folder:
        program = _built(exported, Path(folder), steps=1, passes=1)
        with subprocess.Popen([str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE) as process:
            try:
                yield lambda measured: _asked(process, np.asarray(measured, dtype=_kind(exported)), exported)
            finally:
                process.kill()


def seconds_a_step(exported: Exported, measured: Array, passes: int = 1) -> float:
    """Of the processor, from so many passes over measurements (k, p), k > 1; ``ValueError`` as ``running``."""
    rows = np.ascontiguousarray(measured, dtype=_kind(exported))
    with TemporaryDirectory() as folder:
        program = _built(exported, Path(folder), steps=len(rows), passes=passes)
        return float(_run([str(program)], Path(folder), rows.tobytes())) / (passes * len(rows))


def _kind(exported: Exported) -> type[np.floating[Any]]:
    return np.float64 if exported.precision == "double" else np.float32


def _asked(process: subprocess.Popen[bytes], row: Array, exported: Exported) -> Array:
    if process.stdin is None or process.stdout is None:
        raise ValueError("the process has no pipes.")
    process.stdin.write(row.tobytes())
    process.stdin.flush()
    size = exported.diagram.output.size * row.itemsize
    answer = process.stdout.read(size)
    if len(answer) < size:
        raise ValueError(f"{exported.name} ended with status {process.wait()} on the measurements {row.tolist()}.")
    return np.frombuffer(answer, row.dtype)


def _built(exported: Exported, home: Path, steps: int, passes: int) -> Path:
    """The program, compiled without a warning."""
    command = compiler()
    if command is None:
        raise ValueError("no C compiler is found: install one, or name it in the environment variable CC.")
    (home / f"{exported.name}.c").write_text(c_source(exported), encoding="utf-8")
    (home / "main.c").write_text(_main(exported, steps, passes), encoding="utf-8")
    _run([command, *FLAGS, "main.c", "-o", "main", "-lm"], home, b"")
    return home / "main"


def _main(exported: Exported, steps: int, passes: int) -> str:
    sizes = [each.size for each in exported.diagram.inputs]
    firsts = [sum(sizes[:k]) for k in range(len(sizes))]
    return Template(_MAIN).substitute(
        name=exported.name,
        real="double" if exported.precision == "double" else "float",
        steps=steps,
        columns=sum(sizes),
        voltages=exported.diagram.output.size,
        passes=passes,
        first=", ".join(f"measured[0] + {first}" for first in firsts),
        each=", ".join(f"measured[k] + {first}" for first in firsts),
    )


def _run(command: list[str], home: Path, given: bytes) -> bytes:
    """What the program says on standard error."""
    answer = subprocess.run(command, cwd=home, input=given, capture_output=True, timeout=LONGEST, check=False)
    if answer.returncode:
        said = answer.stderr.decode(errors="replace").strip().partition("\n")[0]
        raise ValueError(f"{Path(command[0]).name} ended with status {answer.returncode}: {said or 'it said nothing'}.")
    return answer.stderr
