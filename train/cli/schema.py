"""The command ``beamenv schema``."""

from __future__ import annotations

import json
from enum import Enum
from pathlib import Path
from typing import Annotated

import typer

from beamenv.configuration.writing import write_whole
from train.cli.options import one_sentence, print_json


class Kind(str, Enum):
    """What files there are schemas of."""

    blade = "blade"
    scenario = "scenario"


def schema(
    kind: Annotated[Kind, typer.Argument(help="What the file describes.")],
    output: Annotated[Path | None, typer.Option(help="File to write. Default: standard output.")] = None,
) -> None:
    """Write the JSON schema of blade or scenario files: with it an editor completes names, explains them and marks wrong values."""
    with one_sentence():
        from beamenv.blade.files import blade_schema
        from beamenv.scenarios.scenario import scenario_schema

        content = blade_schema() if kind is Kind.blade else scenario_schema()
        if output is not None and output.is_dir():
            raise ValueError(f"output = {str(output)!r} is a folder, but must be the name of a file.")
        if output is None:
            print_json(content)
        else:
            write_whole(output, json.dumps(content, indent=2, ensure_ascii=False) + "\n")
