"""Which world a blade is computed in: the blade as it is, or the thesis'."""

from __future__ import annotations

from beamenv.configuration import Choice, Refused, checked
from beamenv.structure.walls.wall_kinematics import SHEAR_FLOWS

MODELS = ("blade", "thesis")
STEADY_STATES = ("nonlinear", "linear")

DEFAULT_TERMS = {"blade": 16, "thesis": 10}
"""Trial functions of each field: ten as in the thesis; with sixteen all modes of the thesis' blade up to 6.3 krad/s are within
0.4 % of those with twenty-five."""

MODEL = Choice(MODELS)
FLOW = Choice(SHEAR_FLOWS)
STEADY_STATE = Choice(STEADY_STATES)


def checked_flow(model: str, shear_flow: str | None, name: str = "shear_flow") -> str:
    """The shear flow of a model, by name: "thesis" only in the thesis' model, where it is the default.

    Raises ``Refused`` for an unknown model or flow, and for the thesis' flow on a blade as it is.
    """
    checked("model", model, MODEL)
    if shear_flow is None:
        return "thesis" if model == "thesis" else "consistent"
    checked(name, shear_flow, FLOW)
    if shear_flow == "thesis" and model != "thesis":
        raise Refused(name, shear_flow, "None or consistent, or come with model = 'thesis'")
    return shear_flow


def terms_of(model: str, terms: int | None) -> int:
    """Trial functions of each field: those asked for, or the model's own number."""
    return DEFAULT_TERMS[model] if terms is None else terms


def check_steady_state(model: str, steady_state: str | None, name: str = "steady_state") -> None:
    """``Refused`` for a steady state in the thesis' model, which vibrates about the blade at rest."""
    if steady_state is not None and model == "thesis":
        raise Refused(name, steady_state, "None with model = 'thesis'")
