"""The thesis' own equations where ours differ: by them its statements are judged a second time, in an order fixed beforehand."""

from __future__ import annotations

from dataclasses import dataclass

SHEAR_FLOW, UNIFORM_TENSION, MFC_DENSITY = "shear flow", "uniform tension", "MFC density"
FIELD, INPUT_WEIGHT = "V/thickness", "R of Eq. 5.9"
PRINTED_Q12, PRINTED_Q, FIBRES_ACROSS, SIX_TERMS = "printed Q̄12", "printed Q̄", "θp = 0", "six terms"

Reading = tuple[str, ...]
"""Equations, by name, that are taken as the thesis has them."""


@dataclass(frozen=True, slots=True)
class Equation:
    """One of them."""

    name: str
    place: str
    words: str
    refuted: str = ""
    """What the thesis prints that it contradicts: then it is tried by itself and told, but counts for nothing."""


EQUATIONS = (
    Equation(SHEAR_FLOW, "Eqs. 2.8 to 2.11", "ψ = 2Aₑ/∮ds without the couplings that keep the flow of off-axis plies constant"),
    Equation(UNIFORM_TENSION, "R(z) below Eq. 2.60", "tension b₁(z)[R₀(L − z) + ½(L² − z²)], a uniform beam's, under taper too"),
    Equation(MFC_DENSITY, "Table 5.1", "8528 kg/m³, a part number, for the density of the MFC"),
    Equation(FIELD, "Eq. 5.2", "the MFC's field as V over its thickness, 0.3 mm, not over the 0.5 mm between its electrodes"),
    Equation(
        INPUT_WEIGHT, "Eq. 5.9", "R = η FᵀΨᵀKΨF with F in modal coordinates; η, not printed, such that tr R of θ = 30° is ours"
    ),
    Equation(
        SIX_TERMS,
        "Table 3.3",
        "six trial functions of each field, which the table betrays, not ten",
        "the text, which says ten, refutes it",
    ),
    Equation(PRINTED_Q12, "Eq. 4.5", "Q22 in place of Q12 in Q̄12, of plies and sheets", "Tables 3.3 and 3.4 refute it"),
    Equation(PRINTED_Q, "Eq. 4.5", "Q̄12, Q̄16, Q̄26 and Q̄66 as printed", "Tables 3.3 and 3.4 refute it"),
    Equation(FIBRES_ACROSS, "Eqs. 4.5 and 4.6", "θp = 0: the MFC's fibres along the contour", "Eq. 4.39 refutes it"),
)
"""In the order in which they are tried."""

TOGETHER: Reading = tuple(equation.name for equation in EQUATIONS if not equation.refuted)
REFUTED: Reading = tuple(equation.name for equation in EQUATIONS if equation.refuted)


def refutation(reading: Reading) -> str:
    """What refutes a reading, in words; empty: nothing."""
    return next((equation.refuted for equation in EQUATIONS if equation.refuted and equation.name in reading), "")


def together(rests_on: Reading) -> Reading:
    """All of the thesis' equations but those it refutes that something rests on."""
    return tuple(name for name in TOGETHER if name in rests_on)


def readings(rests_on: Reading) -> tuple[Reading, ...]:
    """How something is computed by the thesis' equations, in their order: all together, then with each refuted one in addition."""
    whole = together(rests_on)
    return (whole, *((*whole, name) for name in REFUTED if name in rests_on))


HOST: Reading = (SHEAR_FLOW,)
"""What a bare blade of off-axis plies rests on; one of θ = 0°, whose walls have no coupling, on nothing that is not ours too."""

TURNING: Reading = (*HOST, PRINTED_Q12, PRINTED_Q)
"""What the bending stiffness over the ply angle does, on whose turn at 45° the misprinted Q̄ might bear."""

CONTROLLED: Reading = (MFC_DENSITY, FIELD, INPUT_WEIGHT, FIBRES_ACROSS)
"""What patches and controllers add."""
