"""What the command line says of options and arguments that it cannot read: one sentence, status 2."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from typing import Any

from typer.core import TyperGroup

from beamenv.configuration.sentence import cut
from train.cli.options import complain


class OneSentence(TyperGroup):
    """The commands, of which a wrong use is told as any other bad input is."""

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
    words = " ".join(map(cut, error.format_message().replace(": Value error, ", ": ").split()))
    if type(error).__name__ == "NoArgsIsHelpError":
        error.show()
    else:
        complain(f"{words}{'' if words.endswith(('.', '?')) else '.'}")
    return int(error.exit_code)
