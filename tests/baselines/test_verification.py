"""No law is handed out unstable, with an equation unsolved or above its promised norm, unless it is asked for by name."""

from time import process_time

import numpy as np
import pytest

from baselines import (
    LinearController,
    PersistentLoad,
    RotorHarmonics,
    full_order_lqg,
    h_infinity,
    h_infinity_norm,
    lqg,
    lqr,
    no_control,
    positive_position_feedback,
    reference_lqg,
    rotor_lqg,
    scheduled_lqg_for,
    stationary_cost,
    velocity_feedback,
)
from baselines.design.linear import static_law
from baselines.design.loop import closed_loop
from baselines.design.riccati import (
    SampledEquation,
    Solution,
    doubled,
    improved,
    kalman_filter,
    regulator,
    sampled_kalman_filter,
    sampled_regulator,
)
from baselines.design.verification import verified
from baselines.laws.h_infinity import h_infinity_law, least_attenuation
from beamenv import blade_config, build_plant
from beamenv.blade.build import Blade
from beamenv.plant.plant import sample

ALUMINIUM = {"E1": 7e10, "E2": 7e10, "G12": 7e10 / 2.6, "G13": 7e10 / 2.6, "G23": 7e10 / 2.6, "nu12": 0.3, "density": 2700.0}
BLADES = {
    "decoupled": ("thesis", {"beam": {"pretwist_deg": 0.0, "ply_angles_deg": [0, 90, 90, 0]}}),
    "decoupled, thesis' walls": ("thesis", {"model": "thesis", "beam": {"pretwist_deg": 0.0, "ply_angles_deg": [0, 90, 90, 0]}}),
    "aluminium": ("thesis", {"beam": {"pretwist_deg": 0.0, "material": ALUMINIUM}}),
    "aluminium, thesis' walls": ("thesis", {"model": "thesis", "beam": {"pretwist_deg": 0.0, "material": ALUMINIUM}}),
    "aluminium, pretwisted": ("thesis", {"beam": {"material": ALUMINIUM}}),
    "hardly damped": ("thesis-untwisted", {"damping_ratio": 0.001}),
    "undamped": ("thesis", {"damping_ratio": 0.0}),
}
BUILDERS = {
    "lqr": lqr,
    "lqr, load": lambda plant, **asked: lqr(plant, PersistentLoad(), **asked),
    "lqg": lqg,
    "lqg, thesis": lambda plant, **asked: lqg(plant, "continuous", **asked),
    "lqg, load": lambda plant, **asked: lqg(plant, persistent_load=PersistentLoad(), **asked),
    "full order": full_order_lqg,
    "reference": reference_lqg,
    "rotor": lambda plant, **asked: rotor_lqg(plant, RotorHarmonics(200.0), **asked),
    "h-infinity": h_infinity,
    "velocity": velocity_feedback,
    "ppf": positive_position_feedback,
}


def radius(plant, law):
    return np.abs(np.linalg.eigvals(closed_loop(sample(plant), law)[0])).max()


FAST = ("decoupled, thesis' walls", "aluminium, thesis' walls")


@pytest.fixture(
    name="blade", scope="module", params=[pytest.param(each, marks=[] if each in FAST else pytest.mark.slow) for each in BLADES]
)
def _blade(request):
    preset, changes = BLADES[request.param]
    return Blade(blade_config(preset, changes))


@pytest.mark.parametrize("builder", BUILDERS)
def test_every_law_is_stable_on_the_plant_it_is_built_for_or_refused(blade, builder):
    plant = blade.truth
    try:
        law = velocity_feedback(blade.plant, tuned_on=plant) if builder == "velocity" else BUILDERS[builder](plant)
    except ValueError as refused:
        assert "verify=False" in str(refused)
        assert builder in ("lqg, thesis", "velocity", "ppf"), "LQG, LQR and H∞ have stable laws for all of these blades"
        assert builder == "lqg, thesis" or blade.config.damping_ratio == 0.0, "with no gain at all a damped blade is stable"
    else:
        assert radius(plant, law) < 1.0


@pytest.mark.parametrize(("name", "least"), [("decoupled, thesis' walls", 2.580e-3), ("aluminium, thesis' walls", 6.98e-4)])
def test_least_attenuation_where_modes_are_decoupled(name, least):
    """On the first, no voltage reaches the mode that is worst, and LQG's own norm is the least there can be."""
    plant = build_plant(blade_config(*BLADES[name]))
    assert least_attenuation(plant) == pytest.approx(least, rel=5e-4)
    law = h_infinity(plant)
    assert radius(plant, law) < 1.0
    assert h_infinity_norm(plant, law) < 1.5 * least


@pytest.mark.parametrize("back_off", [1.001, 1.5])
def test_h_infinity_keeps_its_norm_on_every_blade(blade, back_off):
    least = least_attenuation(blade.plant)
    found = h_infinity_norm(blade.plant, h_infinity(blade.plant, back_off))
    assert least * (1.0 - 1e-4) < found < back_off * least


def test_below_the_least_attenuation_noise_costs_more_whatever_the_law(blade):
    """The bisection is right only if no law that the package knows, nor its neighbours, keeps below it."""
    least, plant = least_attenuation(blade.plant), blade.plant
    laws = [
        lqg(plant),
        reference_lqg(plant),
        h_infinity(plant, 1.0005),
        h_infinity(plant, 1.01),
        lqg(plant, R=4 * plant.input_weight),
    ]
    assert min(h_infinity_norm(plant, law) for law in laws) > least * (1.0 - 1e-4)
    with pytest.raises(ValueError, match="^attenuation = .* is too little"):
        h_infinity_law(plant, 0.99 * least)


@pytest.mark.slow
def test_sixty_modes_take_seconds():
    plant = build_plant(blade_config("thesis", {"modes": 60}))
    start = process_time()
    law = h_infinity(plant)
    assert process_time() - start < 30.0
    assert h_infinity_norm(plant, law) < 1.5 * least_attenuation(plant)


def left(A, B, Q, R, N, P):
    """What is left of P = AᵀPA + Q − (AᵀPB + N)(R + BᵀPB)⁻¹(BᵀPA + Nᵀ), relative to P, written out once more."""
    cross = A.T @ P @ B + N
    return np.linalg.norm(A.T @ P @ A + Q - cross @ np.linalg.solve(R + B.T @ P @ B, cross.T) - P) / np.linalg.norm(P)


def test_sampled_solutions_satisfy_their_equations(blade):
    held = sample(blade.truth)
    E, unit = held.disturbance_input, np.sqrt(np.diag(held.input_weight))
    P, _ = sampled_regulator(held.A, held.B, held.state_weight, held.input_weight, held.cross_weight)
    R = held.input_weight / np.outer(unit, unit)
    assert left(held.A, held.B / unit, held.state_weight, R, held.cross_weight / unit, P) < 1e-9
    W, size = E @ held.process_noise @ E.T, np.sqrt(np.diag(held.sensor_noise))
    S, _ = sampled_kalman_filter(held.A, held.C, W, held.sensor_noise)
    C, V = held.C / size[:, None], held.sensor_noise / np.outer(size, size)
    assert left(held.A.T, C.T, W, V, np.zeros_like(C.T), S) < 1e-9


def test_continuous_solutions_satisfy_their_equations(blade):
    plant = blade.plant
    E = plant.disturbance_input
    for A, B, Q, R, (P, _) in (
        (
            plant.A,
            plant.B,
            plant.state_weight,
            plant.input_weight,
            regulator(plant.A, plant.B, plant.state_weight, plant.input_weight),
        ),
        (
            plant.A.T,
            plant.C.T,
            E @ plant.process_noise @ E.T,
            plant.sensor_noise,
            kalman_filter(plant.A, plant.C, E @ plant.process_noise @ E.T, plant.sensor_noise),
        ),
    ):
        both, size = P @ A, np.sqrt(np.diag(R))
        control = (P @ B / size) @ np.linalg.solve(R / np.outer(size, size), (P @ B / size).T)
        assert np.linalg.norm(both + both.T + Q - control) < 1e-9 * np.linalg.norm(both)


def test_doubling_and_newton_lead_to_the_root_of_a_quadratic():
    """1·P = a²P + q − (aPb)²/(r + b²P) in one state."""
    a, b, q, r = 1.1, 0.5, 2.0, 3.0
    middle = r - r * a**2 - q * b**2
    by_hand = (-middle + np.sqrt(middle**2 + 4.0 * b**2 * q * r)) / (2.0 * b**2)
    equation = SampledEquation(*(np.array([[value]]) for value in (a, b, q, r, 0.0)))
    assert doubled(equation)[0, 0] == pytest.approx(by_hand, rel=1e-12)
    P, residual = improved(equation, np.array([[1.3 * by_hand]]))
    assert P[0, 0] == pytest.approx(by_hand, rel=1e-8)
    assert residual < 1e-9


def test_the_thesis_law_that_sampling_makes_unstable_is_had_by_name_alone():
    plant = build_plant(blade_config(*BLADES["aluminium, thesis' walls"]))
    with pytest.raises(ValueError, match=r"^plant gives LQG \(thesis\) a sampled loop that is unstable.*sampled.*verify=False"):
        lqg(plant, "continuous")
    assert radius(plant, lqg(plant, "continuous", verify=False)) > 1.0
    assert radius(plant, lqg(plant)) < 1.0


def test_gains_of_one_s_own_are_verified_too(small_plant):
    plant = small_plant()
    for law in (
        lambda **asked: velocity_feedback(plant, -1e12, **asked),
        lambda **asked: positive_position_feedback(plant, 50.0, **asked),
    ):
        with pytest.raises(ValueError, match="sampled loop that is unstable, of spectral radius .*verify=False"):
            law()
        assert radius(plant, law(verify=False)) > 1.0


def test_a_state_space_law_is_verified_on_the_plant_it_is_given(small_plant):
    plant = small_plant()
    matrices = (np.zeros((0, 0)), np.zeros((0, 2)), np.zeros((2, 0)), 1e12 * np.eye(2))
    with pytest.raises(ValueError, match="^plant gives mine a sampled loop that is unstable"):
        LinearController.from_state_space(*matrices, plant=plant, name="mine")
    law = LinearController.from_state_space(*matrices, plant=plant, name="mine", verify=False)
    assert radius(plant, law) > 1.0
    assert LinearController.from_state_space(*matrices, instruments=law.instruments).order == 0


def test_velocity_feedback_is_verified_on_the_plant_it_is_tuned_on():
    blade = Blade(blade_config("thesis"))
    gain = 3.0 * np.abs(velocity_feedback(blade.plant).measurement_gain).max()
    assert radius(blade.plant, velocity_feedback(blade.plant, 0.0)) < 1.0
    with pytest.raises(ValueError, match="sampled loop that is unstable"):
        velocity_feedback(blade.plant, gain, tuned_on=blade.truth)


def test_what_is_promised_is_what_is_measured(small_plant):
    plant = small_plant()
    law, nothing = lqg(plant), no_control(plant)
    norm = h_infinity_norm(plant, law)
    assert verified(law, plant, norm=h_infinity_norm, norm_below=1.001 * norm) is law
    with pytest.raises(ValueError, match="^plant gives LQG a norm of .*is promised"):
        verified(law, plant, norm=h_infinity_norm, norm_below=0.999 * norm)
    with pytest.raises(ValueError, match="^plant gives no control a Riccati equation left with 2.0e-09 of its terms"):
        verified(nothing, plant, Solution(np.eye(1), np.eye(1), 2e-9))
    with pytest.raises(ValueError, match="^plant gives no control a Riccati equation left with nan of its terms"):
        verified(nothing, plant, Solution(np.eye(1), np.eye(1), np.nan))
    unstable = static_law(plant, "mine", 1e12 * np.eye(2))
    assert verified(unstable, plant, verify=False) is unstable
    with pytest.raises(ValueError, match="^verify is 'no', but must be True or False"):
        verified(unstable, plant, verify="no")


def test_scheduled_laws_are_verified_each_at_its_speed():
    config = blade_config("thesis", {"modes": 3})
    law = scheduled_lqg_for(config, [150.0, 200.0])
    for speed in (150.0, 200.0):
        plant = build_plant(blade_config("thesis", {"modes": 3, "speed": speed}))
        assert radius(plant, law.at(speed)) < 1.0


def test_lasting_loads_are_known_as_they_are_where_no_white_load_hides_them(small_plant):
    """The gain from the load of the past interval to its estimate is then the load's own decay."""
    silent = small_plant(process_noise=np.zeros((2, 2)))
    load = PersistentLoad(duration=0.25)
    law = lqr(silent, load)
    n, decay = 6, np.exp(-silent.control_interval / 0.25)
    held = sample(silent)
    np.testing.assert_allclose(law.measurement_input[n:] @ held.disturbance_input, decay * np.eye(2), atol=1e-9)
    assert radius(silent, law) < 1.0


@pytest.mark.parametrize("modes", [1, 2])
def test_positive_position_feedback_has_as_many_filters_as_there_are_modes(modes):
    plant = build_plant(blade_config("thesis", {"modes": modes}))
    law = positive_position_feedback(plant)
    assert law.order == 4 * (1 + 2 * modes)
    assert stationary_cost(plant, law) < stationary_cost(plant, no_control(plant))


@pytest.mark.slow
def test_laws_on_a_hardly_damped_blade_do_better_than_none():
    blade = Blade(blade_config(*BLADES["hardly damped"]))
    plant = blade.truth
    without = stationary_cost(plant, no_control(plant))
    assert stationary_cost(plant, velocity_feedback(blade.plant, tuned_on=plant)) < 0.9 * without
    assert stationary_cost(plant, positive_position_feedback(plant)) < 0.5 * without


def test_where_the_search_starts_unstable_a_smaller_gain_is_found(small_plant):
    """Fifty thousand times less damping: of the gains tried first, none is stable."""
    plant = small_plant()
    A = plant.A.copy()
    A[3:, 3:] *= 2e-5
    A[3:, 3:] -= np.triu(A[3:, 3:], 1) + np.tril(A[3:, 3:], -1)
    for law in (velocity_feedback, positive_position_feedback):
        lightly = small_plant(A=A)
        assert radius(lightly, law(lightly)) < 1.0


def test_a_blade_that_no_gain_leaves_stable_is_told():
    plant = build_plant(blade_config(*BLADES["undamped"]))
    with pytest.raises(ValueError, match="^plant is unstable under positive position feedback of any gain tried"):
        positive_position_feedback(plant)
    with pytest.raises(ValueError, match="^plant is unstable under velocity feedback of any gain tried"):
        velocity_feedback(plant)
