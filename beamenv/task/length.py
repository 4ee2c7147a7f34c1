"""How many control intervals an episode has."""

from __future__ import annotations

from beamenv.configuration import Number, Refused, checked
from beamenv.configuration.numbers import UNBOUNDED


def episode_steps(duration: float | None, usual: float, interval: float, of: str) -> int:
    """Of ``duration`` (s), or the ``usual`` one where it is None, in steps of ``interval`` (s), at least one and a billion at most.

    ``ValueError`` names the duration, or where none was given the interval, the argument ``of`` which it is.
    """
    if duration is None and not interval / 2 < usual <= UNBOUNDED * interval:
        what = f"shorter than {2.0 * usual:.4g} s, so that the usual episode, of {usual:.4g} s, has a step, or a duration be given"
        raise Refused(of, interval, what)
    seconds = usual if duration is None else checked("duration", duration, Number(unit="s"))
    if not interval / 2 < seconds <= UNBOUNDED * interval:
        allowed = f"a number above {interval / 2:g} and at most {UNBOUNDED * interval:g} (s), for {of} is {interval:g}"
        raise Refused("duration", seconds, allowed)
    return round(seconds / interval)
