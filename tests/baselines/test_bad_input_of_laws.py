"""Every law and every analysis answers what it cannot be built from in one sentence."""

import inspect

import gymnasium as gym
import numpy as np
import pytest

import baselines
import beamenv
from baselines import ClippedLQG, Instruments, PredictiveController, ScheduledLQG, clipped_lqg, lqg, mpc, no_control
from baselines.laws.scheduled_lqg import scheduled_lqg
from beamenv import blade_config
from beamenv.simulation.plants.speed_family import speed_family

ENV = gym.make(beamenv.ENV_ID, blade={"modes": 3})
CONFIG = blade_config("thesis", {"modes": 3})
WRONG = {"None": None, "an environment": ENV, "a configuration": CONFIG, "text": "x", "{}": {}, "a class": object}
DOORS = (
    "clipped_lqg",
    "closed_loop_poles",
    "full_order_lqg",
    "h_infinity",
    "h_infinity_norm",
    "lqg",
    "lqr",
    "mpc",
    "multiple_model",
    "no_control",
    "positive_position_feedback",
    "reference_lqg",
    "rotor_lqg",
    "scheduled_lqg",
    "scheduled_lqg_for",
    "stability_margins",
    "stationary_cost",
    "velocity_feedback",
)


@pytest.fixture(name="right", scope="module")
def _right(small_plant):
    plant = small_plant()
    family = speed_family(CONFIG, [190.0, 200.0])
    harmonics = baselines.RotorHarmonics(200.0)
    return {
        "plant": plant,
        "config": CONFIG,
        "family": family,
        "harmonics": harmonics,
        "controller": lqg(plant),
        "hypotheses": [baselines.Hypothesis(plant)],
    }


@pytest.mark.parametrize("door", DOORS)
def test_what_is_of_the_wrong_kind_is_refused_in_one_sentence_that_names_it(door, right):
    function = getattr(baselines, door)
    parameters = inspect.signature(function).parameters
    needed = {name: right[name] for name, each in parameters.items() if each.default is each.empty}
    if door == "scheduled_lqg_for":
        needed["speeds"] = [190.0, 200.0]  # which is quicker than the nine by default
    for name, parameter in parameters.items():
        for what, value in WRONG.items():
            taken = (value is None and parameter.default is None) or (name, what) in (
                ("name", "text"),
                ("config", "a configuration"),
            )
            if taken:
                continue
            with pytest.raises(ValueError, match=f"^{name}") as told:
                function(**{**needed, name: value})
            assert "\n" not in str(told.value)


def test_a_law_tuned_to_no_harmonics_is_not_plain_lqg_under_another_name(right):
    with pytest.raises(ValueError, match="^harmonics is None, but must be a RotorHarmonics"):
        baselines.rotor_lqg(right["plant"], None)


@pytest.mark.parametrize("question", [baselines.stationary_cost, baselines.closed_loop_poles, baselines.h_infinity_norm])
@pytest.mark.parametrize("build", [clipped_lqg, mpc])
def test_what_is_said_of_linear_loops_is_not_said_of_others(right, question, build):
    with pytest.raises(ValueError, match=r"^controller = .* is not linear"):
        question(right["plant"], build(right["plant"]))


def test_laws_that_are_not_linear_have_no_state_space(right):
    for law in (clipped_lqg(right["plant"]), mpc(right["plant"]), scheduled_lqg(right["family"])):
        with pytest.raises(ValueError, match=r"^law = .* is not linear, so it is no control.StateSpace"):
            law.to_control()


def test_a_blade_at_rest_has_no_speeds_to_be_scheduled_with():
    with pytest.raises(ValueError, match="^speeds is None, but must be given for a blade at rest"):
        baselines.scheduled_lqg_for(blade_config("thesis", {"modes": 3, "speed": 0.0}))
    law = baselines.scheduled_lqg_for(blade_config("thesis", {"modes": 3, "speed": 0.0}), [0.0, 20.0])
    assert np.isfinite(law.predict(np.zeros(5))[0]).all()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"name": None}, "name is None, but must be a string"),
        ({"instruments": None}, "instruments is None, but must be an Instruments"),
        ({"feedback_gain": np.ones((2, 5))}, r"feedback_gain has shape \(2, 5\), but must hold finite numbers in shape \(2, 6\)"),
        ({"transition": "A"}, "transition = 'A' must be a matrix of real numbers"),
        ({"full_scale": [np.nan, 1.0]}, r"full_scale has shape \(2,\), but must hold finite numbers"),
    ],
)
def test_parts_of_a_clipped_lqg_that_do_not_fit_are_told(right, changes, words):
    law = clipped_lqg(right["plant"])
    parts = {name: getattr(law, name) for name in inspect.signature(ClippedLQG).parameters}
    assert ClippedLQG(**parts).order == 6
    with pytest.raises(ValueError, match=f"^{words}"):
        ClippedLQG(**{**parts, **changes})


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"program": None}, "program is None, but must be a BoxQP"),
        ({"filter_gain": np.ones((6, 3))}, r"filter_gain has shape \(6, 3\)"),
    ],
)
def test_parts_of_a_predictive_law_that_do_not_fit_are_told(right, changes, words):
    law = mpc(right["plant"])
    parts = {name: getattr(law, name) for name in inspect.signature(PredictiveController).parameters}
    with pytest.raises(ValueError, match=f"^{words}"):
        PredictiveController(**{**parts, **changes})


@pytest.mark.parametrize(
    ("speeds", "laws", "words"),
    [
        ([2.0, 1.0], 2, r"speeds is \[2.0, 1.0\], but must be numbers in rad/s"),
        ([1.0], 2, r"speeds has shape \(1,\)"),
        ([], 0, "laws is"),
        ([1.0, 2.0], None, "laws is None, but must be"),
    ],
)
def test_parts_of_a_scheduled_law_that_do_not_fit_are_told(right, speeds, laws, words):
    plant = right["plant"]
    each = None if laws is None else (no_control(plant),) * laws
    with pytest.raises(ValueError, match=f"^{words}"):
        ScheduledLQG("mine", Instruments.of(plant, "observation and speed"), np.array(speeds), each)


@pytest.mark.parametrize("reading", [np.inf, -np.inf, np.nan])
@pytest.mark.parametrize("law", [clipped_lqg, lqg, mpc, no_control, baselines.velocity_feedback])
def test_a_reading_that_is_not_finite_is_refused_and_not_remembered(law, reading):
    with pytest.raises(ValueError, match="^observation is .*, but must be finite observation vectors"):
        law(beamenv.build_plant(beamenv.blade_config())).predict(np.array([0.0, reading, 0.0, 0.0]))


@pytest.mark.parametrize("size", [1e101, 1e307])
@pytest.mark.parametrize("law", [clipped_lqg, lqg, mpc])
def test_a_reading_whose_products_no_number_can_hold_is_refused(law, size, right):
    law = law(right["plant"])
    with pytest.raises(ValueError, match="^observation is .*, but must be finite observation vectors of numbers not beyond 1e"):
        law.predict(np.full(2, size))
    action, memory = law.predict(np.array([1e100, -1e100]))
    assert np.isfinite(action).all() and np.isfinite(memory).all()


@pytest.mark.parametrize(("magnitude", "duration"), [(1e300, 1e300), (1e7, 1.0), (1.0, 1e4), (1e-7, 1.0), (1.0, 1e-320)])
@pytest.mark.parametrize("kind", [baselines.PersistentLoad, lambda **given: baselines.RotorHarmonics(200.0, **given)])
def test_loads_that_no_blade_meets_are_refused(kind, magnitude, duration):
    with pytest.raises(ValueError, match=r"\.(magnitude|duration) is .*, but must be a number from 1e-06 to"):
        kind(magnitude=magnitude, duration=duration)


@pytest.mark.parametrize("magnitude", [1e-6, 1e6])
@pytest.mark.parametrize("duration", [1e-6, 1e3])
def test_the_least_and_the_largest_load_have_a_filter(magnitude, duration, right):
    law = lqg(right["plant"], persistent_load=baselines.PersistentLoad(magnitude, duration))
    assert np.isfinite(law.transition).all()


def test_equal_loads_and_orders_given_twice_are_refused(right):
    with pytest.raises(ValueError, match=r"^harmonics.orders is \(1, 1\), but must be orders that differ from each other"):
        baselines.RotorHarmonics(200.0, orders=[1, 1])
    twice = [baselines.PersistentLoad(), baselines.PersistentLoad()]
    for law in (baselines.full_order_lqg, baselines.reference_lqg):
        with pytest.raises(ValueError, match="^load is .*, but must be a list of loads that differ from each other"):
            law(right["plant"], load=twice)
    assert baselines.full_order_lqg(right["plant"], load=[baselines.PersistentLoad(5.0), baselines.PersistentLoad(10.0, 0.1)])


@pytest.mark.parametrize("name", ["", " ", "a\nb", "a\rb", "a\u2028b", "a\tb", "\x1b[31m"])
def test_a_name_that_no_table_can_show_is_refused(name, right):
    for law in (baselines.full_order_lqg, baselines.reference_lqg):
        with pytest.raises(ValueError, match="^name is .*, but must be a string that is not blank, on one line.$"):
            law(right["plant"], name=name)


@pytest.mark.parametrize("speed", [[100.0, 200.0], float("nan"), float("inf"), "fast", None, True])
def test_a_speed_that_is_no_number_is_called_the_speed(speed, right):
    law = scheduled_lqg(right["family"])
    with pytest.raises(ValueError, match=r"^speed is .*, but must be a finite number \(rad/s\).$"):
        law.at(speed)
    assert law.at(195).order == law.at(np.float64(195.0)).order == law.order


@pytest.mark.parametrize(("name", "size"), [("Q", 6), ("R", 2)])
@pytest.mark.parametrize("law", [lqg, mpc, clipped_lqg])
def test_a_weight_beyond_all_numbers_is_named(law, name, size, right):
    with pytest.raises(ValueError, match=f"^{name} has the entry 1e.300, but must hold numbers from -1e.100 to 1e.100.$"):
        law(right["plant"], **{name: 1e300 * np.eye(size)})


def test_velocity_feedback_asks_for_sensors_that_show_velocities():
    design = gym.make(beamenv.ENV_ID, preset="takacs-beam").unwrapped.design_plant  # whose sensor is a displacement
    with pytest.raises(ValueError, match="^plant shows nowhere the velocity that its voltages change: allowed are sensors of "):
        baselines.velocity_feedback(design)
