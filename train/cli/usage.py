"""What the command line says of options and arguments that it cannot read: one sentence, status 2."""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Sequence
from typing import Any

from pydantic import ValidationError
from typer.core import TyperGroup

from beamenv.configuration import Refused, unknown_name
from beamenv.configuration.sentence import cut
from train.cli.options import complain
from train.cli.said import OPTIONS, options_of


class OneSentence(TyperGroup):
    """The commands, of which a wrong use is told as any other bad input is."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        """A command by its name, whose options are how its arguments are called from here on."""
        name, command, rest = super().resolve_command(ctx, args)
        OPTIONS.set(options_of(command))
        return name, command, rest

    def main(self, args: Sequence[str] | None = None, *others: Any, standalone_mode: bool = True, **extra: Any) -> Any:
        """Run a command and end with its status."""
        run: Callable[..., Any] = super().main
        if not standalone_mode:
            return run(args, *others, standalone_mode=False, **extra)
        try:
            status = run(args, *others, standalone_mode=False, **extra)
        except Exception as error:  # Typer's own, whose classes have moved from one of its releases to the next
            if not hasattr(error, "format_message"):
                raise
            sys.exit(_told(error))
        sys.exit(status if isinstance(status, int) else 0)


def _told(error: Any) -> int:
    """Say what is wrong, or help where nothing was asked; the status."""
    words = " ".join(map(cut, (_refused(error) or error.format_message()).split()))
    if type(error).__name__ == "NoArgsIsHelpError":
        error.show()
    else:
        complain(f"{words}{'' if words.endswith(('.', '?')) else '.'}")
    return int(error.exit_code)


def _refused(error: Any) -> str:
    """What is said of a value that its option or argument cannot be, as of any other; empty where the error is another."""
    cause, parameter = error.__cause__, getattr(error, "param", None)
    if parameter is None or not isinstance(cause, ValidationError):
        return ""
    name = max(parameter.opts, key=len) if parameter.param_type_name == "option" else str(parameter.name)
    first = cause.errors(include_url=False)[0]
    value, told = first["input"], first["msg"].removeprefix("Value error, ")
    if " is not one of " in told:
        return str(unknown_name(name, value, re.findall(r"'([^']*)'", told.partition(" is not one of ")[2])))
    allowed = told.removeprefix("Input should be ").partition(", unable to")[0]
    for theirs, ours in (("greater than or equal to", "at least"), ("less than or equal to", "at most")):
        allowed = allowed.replace(theirs, ours)
    return str(Refused(name, value, allowed))
