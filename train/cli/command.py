"""The console command ``beamenv``: starts the command line, or says in one sentence how to install what it needs."""

from __future__ import annotations

import sys

_OWN_PACKAGES = ("beamenv", "baselines", "train")
_EXTRAS = {
    **dict.fromkeys(("rich", "typer"), "cli"),
    **dict.fromkeys(("cma", "pymoo"), "placement"),
    **dict.fromkeys(("matplotlib", "pygame"), "render"),
    **dict.fromkeys(("dash", "werkzeug"), "explore"),
    "daqp": "predictive",
}
"""Which extra brings a package; all others come with ``train``."""


def main() -> None:
    """Run the command line.

    Exits with status 1 and one sentence if a package of an extra is missing. A missing module of our own is
    a defect and stays an error with its traceback.
    """
    try:
        from train.cli.app import app

        app()
    except ModuleNotFoundError as error:
        package = (error.name or "").partition(".")[0]
        if not package or package in _OWN_PACKAGES:
            raise
        extra = _EXTRAS.get(package, "train")
        sys.exit(f"beamenv: the Python package '{package}' is missing; install it with pip install 'beamenv[{extra}]'.")
