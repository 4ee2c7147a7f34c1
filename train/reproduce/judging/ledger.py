"""The thesis' concluding statements, each decided by judgements of studies."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from train.reproduce.judging.verdicts import Judged, Verdict, weakest

Judgements = Mapping[str, Mapping[str, Judged]]
"""By study and key: in nature, or by the thesis' own equations."""


@dataclass(frozen=True, slots=True)
class Row:
    """One concluding statement. Its verdict is the weakest of the judgements that decide it."""

    section: str
    text: str
    decided_by: tuple[tuple[str, str], ...]
    """(study, key) of each."""
    remark: str = ""

    def verdict(self, judgements: Judgements) -> Verdict | None:
        """The verdict: untestable when no number decides it, None while a deciding study has not been run."""
        if any(study not in judgements for study, _ in self.decided_by):
            return None
        return weakest([judgements[study][key].verdict for study, key in self.decided_by])


def of(study: str, *keys: str) -> tuple[tuple[str, str], ...]:
    """Several keys of one study."""
    return tuple((study, key) for key in keys)


NO_RESULT = "It states no result that could hold or fail."

ROWS = (
    Row(
        "3.7",
        "Gyroscopic coupling between lag and extension has considerable effect on natural frequency, mode shape and forced "
        "response",
        of("figure-3.5", "considerable") + of("figure-3.2", "significant") + of("figure-3.6", "considerable"),
        "At 200 rad/s it shifts mode shapes by less than 3 %; the effect grows with the square of the speed.",
    ),
    Row(
        "3.7",
        "With speed the first lag frequency becomes zero with coupling, the extension's without",
        of("figure-3.8", "lag-buckles", "critical"),
        "At 1428 rad/s, not 1480, and only about the blade at rest: about its steady state the blade is unstable before 850 rad/s.",
    ),
    Row("3.7", "Pretwist bends the first lag mode and straightens the second and third", of("figure-3.17", "first", "higher")),
    Row(
        "3.7",
        "Pretwist stiffens the first and third flap mode and softens the second",
        of("figure-3.18", "odd", "second"),
        "At 90° pretwist what counts as the third flap mode is half a lag mode; up to 60° the statement holds.",
    ),
    Row(
        "3.7",
        "Pretwist has a shallow effect on the first two frequencies, stiffens the third and softens the fourth",
        of("figure-3.19", "shallow", "third", "fourth"),
        "The first lag frequency at rest falls by 23 %; third and fourth behave as stated in bending alone, up to 200 rad/s.",
    ),
    Row(
        "3.7",
        "Pretwist increases settling time and tip displacement",
        of("figure-3.20", "tip", "settling"),
        "It does in lag. In flap it hardly matters.",
    ),
    Row(
        "3.7",
        "Taper softens the first flap and lag mode and stiffens the second and third (shapes)",
        of("figure-3.11", "first", "higher") + of("figure-3.12", "first", "higher"),
    ),
    Row(
        "3.7",
        "Taper raises the first two frequencies and lowers the third and fourth",
        of("figure-3.13", "lower", "higher"),
        "It does in bending; but twist, which taper stiffens, is among the first four modes of this box.",
    ),
    Row(
        "3.7",
        "Taper reduces the tip displacement",
        of("figure-3.16", "peak"),
        "Under the same load per metre it raises it by 40 to 140 %. Only a load in lag that falls with the chord gives the "
        "statement, and with the tension of a uniform beam one in flap as well.",
    ),
    Row("3.7", "Presetting reduces the tip displacement", of("figure-3.24", "peak"), "In flap; in lag it must increase it."),
    Row(
        "5.6",
        "MFC actuators and sensors can be successfully employed for vibration suppression",
        of("figure-5.7", "control") + of("figure-5.8", "control"),
    ),
    Row(
        "5.6",
        "Inclusion of MFC reduces the natural frequencies significantly",
        of("figure-5.3", "softened", "significant") + of("figure-5.4", "softened", "significant"),
        "Twelve sheets of 0.3 mm change no frequency by more than 0.8 %, nor do they "
        "with the printed density and shear flow. They stiffen a host that is softer "
        "than they are.",
    ),
    Row(
        "5.6",
        "Actuators at the tip have a negative effect",
        of("figure-5.9", "whole-tip", "whole-settling"),
        "With the whole span covered the blade settles later, but its peak is not higher.",
    ),
    Row(
        "5.6",
        "MFC needs less control effort than monolithic sheets",
        of("figure-5.7", "voltage") + of("figure-5.8", "voltage"),
        "Per volt a monolithic sheet of the same thickness acts 2.5 times as much.",
    ),
    Row("5.6", "The effects of pretwist, taper and gyroscopic coupling on controlled responses are highlighted", (), NO_RESULT),
    Row(
        "6.6",
        "Poles of correctly placed sensors and actuators shift deep inside the left half plane",
        of("figure-6.7", "slowest", "mean"),
        "The slowest pole of every loop does; the observer's of the pretwisted blade do not on the mean.",
    ),
    Row(
        "6.6",
        "Settling time, tip displacement and control effort can be reduced by optimal locations",
        of("figure-6.5", "settling", "tip", "effort", "voltage") + of("figure-6.6", "settling", "tip", "effort", "voltage"),
        "Settling time falls by about a tenth, the effort as the index weighs it by a quarter, the tip displacement by 1 %, as "
        "±1500 V change the first peak little. The voltages, which the thesis calls effort too, rise.",
    ),
    Row(
        "6.6",
        "With speed the optimal locations of sensors and actuators shift towards the root",
        of("table-6.3", "shift") + of("table-6.4", "shift"),
        "Actuators do. Sensors do not: at rest they lie at the root, but there their place hardly matters.",
    ),
    Row(
        "6.6",
        "Optimal sensors converge near the root",
        of("table-6.4", "near", "nearer"),
        "One always lies at the root; at 200 rad/s the others lie further out.",
    ),
    Row(
        "6.6",
        "Optimal locations depend on speed, pretwist, presetting and number of actuators",
        of("table-6.3", "depends"),
    ),
    Row(
        "6.6",
        "GA then SQP is far superior to GA or SQP",
        of("table-6.3", "superior") + of("table-6.4", "superior"),
        "SQP alone ends at the same layout in most cases; GA alone costs a little more.",
    ),
    Row(
        "7.1",
        "GA is likely to come closer to the global optimum, so that GA and then SQP place actuators by tr(P) and sensors by tr(S)",
        of("figure-6.4", "neighbourhood")
        + of("table-6.1", "ga-below-sqp")
        + of("table-6.2", "ga-below-sqp")
        + of("table-6.3", "then")
        + of("table-6.4", "then"),
        "GA comes near; but with four patches SQP from equally spaced ones ends lower.",
    ),
    Row(
        "7.1",
        "Hybrid deformation variables capture gyroscopic coupling and centrifugal stiffening",
        of("table-2.1", "couplings") + of("table-2.2", "couplings") + of("table-3.3", "six-terms"),
    ),
    Row(
        "7.1",
        "The model gives consistent correlation with experiment and other theories",
        of("table-3.2", "experiment", "theory") + of("table-3.3", "oh") + of("table-3.4", "chandiramani"),
        "With the thesis' own shear flow Table 3.2 would lie 11 to 19 % above what it prints.",
    ),
    Row(
        "7.1",
        "The effects of pretwist, taper and presetting on free, forced and controlled vibration are emphasised",
        (),
        NO_RESULT,
    ),
    Row(
        "7.1",
        "LQR and LQG reduce the vibration of the rotating blade",
        of("figure-5.7", "control") + of("figure-5.8", "control"),
        "On the eleven modes that they are designed on. On the blade with all its modes this LQG is unstable.",
    ),
    Row(
        "7.1",
        "Control effort with MFC is less than with monolithic PZT",
        of("figure-5.7", "voltage") + of("figure-5.8", "voltage"),
        "See 5.6.",
    ),
    Row(
        "7.1",
        "Gyroscopic coupling between lag and extension has significant influence on vibration characteristics",
        of("figure-3.5", "considerable") + of("figure-3.6", "considerable") + of("figure-5.17", "visible"),
    ),
)


def counts(verdicts: Sequence[Verdict | None]) -> dict[Verdict, int]:
    """How many of each, in the order of the verdicts."""
    return {verdict: verdicts.count(verdict) for verdict in Verdict}
