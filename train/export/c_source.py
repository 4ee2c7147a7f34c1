"""A block diagram as one self-contained C99 file."""

from __future__ import annotations

from collections.abc import Iterable
from string import Template

from train.export.c_blocks import Body
from train.export.c_words import HELPERS, Words, helper
from train.export.exported import Exported
from train.shared.files import on_one_line

MOST_ON_THE_STACK = 1024
"""Numbers of signals that a step keeps on the stack; where there are more, all lie in the state."""

_HEADER = """\
/* $title
 *
$facts
 *
 * Call ${name}_init once, and ${name}_step at every interval with what the sensors show: it fills in the voltages that are to
 * be held until the next one, and returns 0. Of a measurement that is no number, or beyond 1e30, it returns 1, and state and
 * voltages stay as they were. No memory is allocated, and of the library only math.h is used: link with -lm. Every controller
 * with a state of its own is independent of others. In bytes: tables $tables, a state $state, signals on the stack $stack.
 *
 * Other files get the declarations alone by: #define ${guard}_DECLARATIONS, then #include this file.
 */
"""

_DECLARATIONS = """\
#ifndef ${guard}_H
#define ${guard}_H

#define ${guard}_SENSORS $sensors
#define ${guard}_VOLTAGES $voltages
#define ${guard}_INTERVAL $interval /* s from one step to the next */

/* What the controller remembers; nobody else writes to it. */
typedef struct {
$members
} ${name}_state;

#ifdef __cplusplus
extern "C" {
#endif
void ${name}_init(${name}_state *state);
int ${name}_step(${name}_state *state, $arguments, $real volts_out[$voltages]);
#ifdef __cplusplus
}
#endif

#endif

#ifndef ${guard}_DECLARATIONS

#include <math.h>

"""

_FUNCTIONS = """\
void ${name}_init(${name}_state *state)
{
$zeros
}

int ${name}_step(${name}_state *state, $arguments, $real volts_out[$voltages])
{
$signals
$checks

$statements

$remember
    for (int i = 0; i < $voltages; ++i) volts_out[i] = $output[i];
    return 0;
}

#endif
"""


def c_source(exported: Exported) -> str:
    """The file's text; ``ValueError`` for numbers that its precision cannot hold."""
    exported.check_range()
    words = Words(exported.name, exported.precision)
    body = Body(exported.diagram, words)
    if sum(body.signals.values()) > MOST_ON_THE_STACK:
        body = Body(exported.diagram, words, "state->work.")
    remember = _remember(body)
    parts = _parts(exported, body)
    return "".join(
        (
            _filled(_HEADER, parts),
            _filled(_DECLARATIONS, parts),
            *(f"{table}\n" for table in body.tables),  # large: not searched for words to be filled in
            *(f"{helper(each, words)}\n" for each in HELPERS if each in body.helpers),
            _filled(_FUNCTIONS, {**parts, "remember": remember, "statements": _lines(body.statements)}),
        )
    )


def _filled(text: str, parts: dict[str, str]) -> str:
    return Template(text).substitute(parts)


def _parts(exported: Exported, body: Body) -> dict[str, str]:
    """What the text is filled with."""
    diagram, real, f = exported.diagram, body.words.real, body.words.suffix
    held = {body.names[each].removeprefix("state->"): each.size for each in diagram.following}
    signals = [f"{real} {name}[{size}];" for name, size in body.signals.items()]
    work = ["struct {", *(f"    {each}" for each in signals), "} work; /* of one step */"] if body.where else []
    signalled = sum(body.signals.values())
    members = [*(f"{real} {name}[{size}];" for name, size in held.items()), *work]
    return {
        "title": _in_a_comment(f"{exported.controller}: from sensors to voltages, in C99."),
        "facts": "\n".join(_in_a_comment(f" * {name + ':':<13} {fact}") for name, fact in exported.facts.items()),
        "name": exported.name,
        "guard": exported.name.upper(),
        "tables": str(body.table_bytes),
        "state": str(body.words.bytes * (sum(held.values()) + (signalled if body.where else 0)) or 1),
        "stack": str(0 if body.where else body.words.bytes * signalled),
        "sensors": str(diagram.inputs[0].size),
        "voltages": str(diagram.output.size),
        "interval": repr(float(exported.plant.control_interval)),
        "members": _lines(members or ["char nothing;"]),
        "arguments": ", ".join(f"const {real} {body.names[each]}[{each.size}]" for each in diagram.inputs),
        "real": real,
        "zeros": _lines(
            [f"for (int i = 0; i < {size}; ++i) state->{name}[i] = 0;" for name, size in held.items()] or ["state->nothing = 0;"]
        ),
        "signals": "" if body.where else _lines(signals),
        "checks": _lines(
            f"for (int i = 0; i < {each.size}; ++i) if (!(fabs{f}({body.names[each]}[i]) <= 1e30{f})) return 1;"
            for each in diagram.inputs
        ),
        "output": body.name(diagram.output),
    }


def _remember(body: Body) -> str:
    """Statements that fill the delays, of what was worked out before."""
    found = [(body.names[delay], body.following(delay), delay.size) for delay in body.diagram.following]
    return _lines(
        [f"for (int i = 0; i < {size}; ++i) {name}[i] = {source}[i];" for name, source, size in found] or ["(void)state;"]
    )


def _in_a_comment(text: str) -> str:
    """Text that ends no comment, begins none, and has no trigraph."""
    return on_one_line(text).replace("*/", "* /").replace("/*", "/ *").replace("??", "? ?")


def _lines(statements: Iterable[str]) -> str:
    return "\n".join(f"    {each}" for each in statements)
