"""The console command ``beamenv``: starts the command line, or says in one sentence how to install what it needs."""

from __future__ import annotations

import os
import sys
import warnings
from pathlib import Path
from typing import Any

_OWN_PACKAGES = ("beamenv", "baselines", "train")
_EXTRAS = {
    **dict.fromkeys(("rich", "typer"), "cli"),
    **dict.fromkeys(("cma", "pymoo"), "placement"),
    **dict.fromkeys(("matplotlib", "pygame"), "render"),
    **dict.fromkeys(("dash", "werkzeug"), "explore"),
    **dict.fromkeys(("minari", "h5py"), "record"),
    "daqp": "predictive",
    "onnx": "export",
    "ray": "cluster",
}
"""Which extra brings a package; all others come with ``train``."""


def main() -> None:
    """Run the command line; a signal to end does as Ctrl-C, a reader that has gone (``| head``) ends it quietly, and a
    terminal that lacks a letter shows a question mark.

    Exits with status 1 and one sentence if a package of an extra is missing. A missing module of our own is
    a defect and stays an error with its traceback.
    """
    from train.shared.interruption import ending_as_interrupted, status_of

    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    warnings.showwarning = _warn
    try:
        with ending_as_interrupted():
            _run()
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # what is left must not fail once more as Python ends
        sys.exit(1)
    except KeyboardInterrupt as error:
        print("beamenv: interrupted.", file=sys.stderr)  # noqa: T201 - before a command could say so
        sys.exit(status_of(error))
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if not package or package in _OWN_PACKAGES:
            raise
        extra = _EXTRAS.get(package, "train")
        sys.exit(f"beamenv: the Python package '{package}' is missing; install it with pip install 'beamenv[{extra}]'.")


def _warn(
    message: Warning | str, category: type[Warning], filename: str, lineno: int, file: Any = None, line: str | None = None
) -> None:
    """Our own warnings as the command's sentences; those of other packages in Python's form."""
    homes = [Path(str(sys.modules[name].__file__)).parent for name in _OWN_PACKAGES if name in sys.modules]
    ours = any(Path(filename).is_relative_to(home) for home in homes)
    sys.stderr.write(f"beamenv: {message}\n" if ours else warnings.formatwarning(message, category, filename, lineno))


def _run() -> None:
    from train.cli.app import app

    try:
        app()
    finally:
        sys.stdout.flush()
