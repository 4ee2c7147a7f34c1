"""The report of an identification in Markdown."""

from __future__ import annotations

import math
from typing import Any

from baselines.identification.identified import QUIET, Identified
from train.identification.trial import Trial
from train.shared.markdown import escaped, table

HERTZ = 2.0 * math.pi
"""rad/s of one."""


def markdown(found: Identified, trial: Trial) -> str:
    """What was found, in tables and a few sentences."""
    about = found.to_dict()
    parts = ["# What was identified", _summary(found), trial.sentence, _modes(about), _readings(about), _orders(about), _figures()]
    return "\n\n".join(parts) + "\n"


def _summary(found: Identified) -> str:
    measurement = found.measurement
    energy = "in joules" if found.collocated is not None else "not known: costs are of outputs"
    return (
        f"{len(measurement)} rows, {measurement.seconds:.4g} s at {1.0 / measurement.interval:.6g} Hz; learned from the first "
        f"{found.learned}, judged by the other {found.fit.rows}.\n\n"
        f"{found.choice.reason} {_loads(found)} "
        f"The energy of its modes is {energy}."
    )


def _loads(found: Identified) -> str:
    if found.quiet:
        return (
            f"Voltages alone moved the structure: what else did is below {QUIET:g} of the sensors' noise. "
            "The plant is taken to have loads at its actuators, white, a tenth of full voltage."
        )
    return f"{found.noise.load_input.shape[1]} white loads stand for what moved the structure besides the voltages."


def _modes(about: dict[str, Any]) -> str:
    rows = [
        [
            str(k),
            f"{mode['frequency']:.2f} ± {mode['frequency_spread']:.2g}",
            f"{mode['frequency'] / HERTZ:.3f} ± {mode['frequency_spread'] / HERTZ:.2g}",
            f"{100.0 * mode['damping_ratio']:.3f} ± {100.0 * mode['damping_spread']:.2g}",
            f"{mode['certainty']:.3g}",
        ]
        for k, mode in enumerate(about["modes"], start=1)
    ]
    heading = (
        "## Modes\n\n± " + about["spread"] + ". Poles damped by a fifth and more are not listed. Certainty is Wald's "
        "statistic over the count of its numbers: about 1 where there is no mode."
    )
    return heading + "\n\n" + table(["mode", "rad/s", "Hz", "damping ratio, %", "certainty"], rows, words=0)


def _readings(about: dict[str, Any]) -> str:
    rows = [
        [
            each["name"],
            *(f"{each[key]:.4f}" for key in ("one_step_fit", "free_run_fit", "attainable_free_run_fit")),
            f"{each['noise']:.3g} {each['unit']}".rstrip(),
            f"{100.0 * each['share_of_correlations_outside']:.0f} %",
        ]
        for each in about["readings"]
    ]
    words = (
        "## Fit on rows held back\n\n1 − ‖y − ŷ‖/‖y − mean‖. Attainable: a free run of the exact model, if loads and noise are as "
        "identified. Errors that are white have 5 % of their correlations outside the band."
    )
    headings = ["reading", "one step", "free run", "attainable", "noise", "correlations outside"]
    return words + "\n\n" + table(headings, rows, words=1)


def _orders(about: dict[str, Any]) -> str:
    rows = [
        [str(each["order"]), _shown(each["loss"], 5), _shown(each["missed"], 1), "yes" if each["kept"] else "no"]
        for each in about["orders_tried"]
    ]
    words = "## Orders tried\n\nEach against the one kept before it, in standard errors of the difference."
    return words + "\n\n" + table(["states", "loss a row held back", "worse by", "kept"], rows, words=0)


def _figures() -> str:
    return escaped("Figures:") + " ![stabilisation diagram](stabilisation.png) ![fit](fit.png)"


def _shown(value: float | None, digits: int) -> str:
    return "∞" if value is None else f"{value:.{digits}f}"
