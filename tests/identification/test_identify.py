"""What is identified from 20 s of a structure with three modes, beside the structure."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import solve_discrete_are
from scipy.signal import cont2discrete

from baselines import identify, lqg, stationary_cost
from baselines.identification.observer import observer
from baselines.identification.prediction_error import Spectra, _covariance, _ends, _log_det, _normal_equations, moved
from baselines.identification.realisation import realise
from beamenv import Plant
from tests.identification.conftest import DAMPING_RATIOS, FREQUENCIES, INTERVAL, RATIO, measurement, record, sampled, structure


def test_held_back_rows_ask_for_as_many_states_as_there_are(identified):
    assert identified.model.order == 6
    assert "worse predicted" in identified.choice.reason


def test_frequencies_and_dampings_lie_within_four_standard_errors(identified):
    modes = identified.modes
    assert np.all(np.abs(modes.frequency - FREQUENCIES) < 4.0 * modes.frequency_spread)
    assert np.all(np.abs(modes.damping_ratio - DAMPING_RATIOS) < 4.0 * modes.damping_spread)
    assert np.all(modes.frequency_spread < 2e-3 * FREQUENCIES)  # and these are no excuse
    assert np.all(modes.certainty > 10.0)


def test_one_load_and_the_noise_of_each_sensor_are_told_apart(identified):
    assert identified.noise.load_input.shape[1] == 1
    rows = identified.learned
    assert identified.sensor_noise == pytest.approx(record(1, 20.0).sigma, rel=6.0 / np.sqrt(2.0 * rows))


def test_white_loads_and_sensor_noise_have_the_kalman_filter_that_was_identified(identified):
    """Innovations are the filter's errors: Riccati's equation of what the loads and the noise are must give K back."""
    model, noise = identified.scaled, identified.noise
    E, V = noise.load_input, np.diag(noise.sensor_variance)
    P = solve_discrete_are(model.A.T, model.C.T, E @ E.T, V)
    innovations = model.C @ P @ model.C.T + V
    K = model.A @ P @ model.C.T @ np.linalg.inv(innovations)
    assert innovations == pytest.approx(model.covariance, abs=0.02 * np.abs(model.covariance).max())
    assert np.linalg.eigvals(model.A - K @ model.C) == pytest.approx(np.linalg.eigvals(model.predictor), abs=0.05)


def test_free_run_is_as_good_as_loads_and_noise_let_it_be(identified):
    fit = identified.fit
    assert np.all(np.abs(fit.free_run - fit.attainable) < 0.02)
    assert np.all(fit.one_step > fit.free_run - 0.02)
    assert np.all(fit.outside < 0.2)  # of 50 correlations 5 % are, more than 10 hardly ever


def test_sampling_the_plant_gives_back_the_model(identified):
    plant, model = identified.state_space, identified.model
    A, B, C, _, _ = cont2discrete((plant.A, plant.B, plant.C, np.zeros((2, 2))), INTERVAL)
    markov = [C @ np.linalg.matrix_power(A, k) @ B for k in range(5)]
    assert np.allclose(markov, [model.C @ np.linalg.matrix_power(model.A, k) @ model.B for k in range(5)], rtol=1e-9, atol=0.0)


def test_energy_of_collocated_patches_is_the_structures_own():
    """The same voltages put the same joules into both."""
    clear = measurement(5, 20.0, noise=0.01, load=0.05)
    of, plant = record(7, 4.0, noise=0.0, load=0.0), identify(clear, order=6, collocated=RATIO).state_space
    A, B = sampled(plant.A, plant.B)
    x, energy = np.zeros(len(A)), []
    for volts in of.volts:
        energy.append(x @ plant.energy @ x)
        x = A @ x + B @ volts
    assert np.mean(energy) == pytest.approx(np.mean(0.5 * (of.states**2).sum(axis=1)), rel=0.01)


def test_without_collocation_no_energy_is_claimed(measured, identified):
    assert identified.state_space.energy is not None
    again = identify(measured, order=6)
    assert again.state_space.energy is None


def test_without_noise_the_balanced_model_is_the_structure():
    clean = measurement(3, 8.0, noise=0.0, load=0.0)
    volts, amperes = clean.voltages.std(), clean.readings.std()
    scaled = replace(clean, voltages=clean.voltages / volts, readings=clean.readings / amperes)
    model = realise(observer(scaled, lags=5), INTERVAL, 6).model(6).scaled(np.full(2, volts), np.full(2, amperes))
    s = model.poles[np.argsort(np.abs(model.poles))]
    assert np.abs(s) == pytest.approx(FREQUENCIES, rel=1e-4)  # least squares are regularised by 1e-10
    assert -s.real / np.abs(s) == pytest.approx(DAMPING_RATIOS, rel=0.02)
    A, B, C, _ = structure()
    A, B = sampled(A, B)
    for k in (0, 3, 30):
        expected = C @ np.linalg.matrix_power(A, k) @ B
        assert model.C @ np.linalg.matrix_power(model.A, k) @ model.B == pytest.approx(expected, abs=1e-3 * np.abs(C @ B).max())


def test_the_gradient_of_the_prediction_error_is_its_difference_quotient(measured, identified):
    spectra, model, start = Spectra(measured), identified.model, np.full(6, 0.1)
    model = moved(model, np.zeros(6 + 6 * 5 + 12))
    covariance = _covariance(spectra, model, start)
    curvature, gradient = _normal_equations(spectra, model, start, covariance, 500)
    direction = np.random.default_rng(0).standard_normal(len(gradient)) / np.sqrt(np.diag(curvature))
    step = 1e-3

    def log_det(size):
        return _log_det(_covariance(spectra, moved(model, size * direction), start + size * _ends(direction, model)))

    quotient = (log_det(step) - log_det(-step)) / (2.0 * step)
    assert -2.0 * gradient @ direction / len(spectra) == pytest.approx(quotient, rel=1e-4)


def test_models_drawn_scatter_as_the_spread_says(identified):
    drawn = identified.ensemble(200, seed=3)
    frequencies = np.array([np.sort(np.abs(np.linalg.eigvals(each.A)))[::2] for each in drawn])
    assert frequencies.std(axis=0) == pytest.approx(identified.modes.frequency_spread, rel=0.25)  # 5 % is one standard error
    assert all(np.linalg.eigvals(each.A).real.max() < 0.0 for each in drawn)


@pytest.mark.slow
def test_the_spread_is_that_of_repeated_measurements():
    found = [identify(measurement(seed, 20.0), order=6) for seed in range(100, 124)]
    z = np.array([(each.modes.frequency - FREQUENCIES) / each.modes.frequency_spread for each in found])
    d = np.array([(each.modes.damping_ratio - DAMPING_RATIOS) / each.modes.damping_spread for each in found])
    for scores in (z, d):  # 72 numbers of unit variance: their mean square is 1 ± 0.17, correlated within a record
        assert 0.5 < np.mean(scores**2) < 1.7


def test_an_order_asked_for_is_the_order(measured):
    few = identify(measured, order=4)
    assert few.model.order == 4
    assert few.choice.reason == "4 states: 4 were asked for."
    assert len(few.modes) <= 2


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"order": 1}, "order is 1, but must be 'auto' or a count of states from 2 to 60."),
        ({"order": "many"}, "order is 'many', but must be 'auto' or a count of states from 2 to 60."),
        ({"held_back": 0.9}, "held_back is 0.9, but must be"),
        ({"collocated": -1.0}, "collocated is -1.0, but must be a positive number."),
    ],
)
def test_bad_arguments_are_one_sentence(measured, options, said):
    with pytest.raises(ValueError, match="^" + said.replace(".", r"\.")):
        identify(measured, **options)


def test_collocated_sensors_must_be_of_current(measured):
    with pytest.raises(ValueError, match="not A"):
        identify(replace(measured, reading_units=("V", "V")), collocated=RATIO)


def test_lqg_on_a_plant_of_a_quiet_bench_damps_the_structure():
    """Nothing but voltages moved it, which says nothing of what will: an LQG of no loads at all would stand still."""
    found = identify(measurement(3, 8.0, load=0.0))
    assert found.quiet
    A, B, C, _ = structure()
    drive = found.arrays()["actuator_limits"]
    truth = Plant.from_state_space(A, B, C, interval=INTERVAL, actuator_limits=drive)
    plant = found.plant(full_scale=truth.sensor_full_scale, sensor_noise=found.sensor_noise)
    assert any(each.startswith("disturbances act where the actuators do") for each in plant.assumed)
    assert stationary_cost(truth, lqg(plant)) < 1.1 * stationary_cost(truth, lqg(truth))


def test_lqg_is_stable_on_every_plant_within_the_spread_and_a_law_of_the_wrong_sign_on_none(identified):
    plant = identified.plant()
    law = lqg(plant)
    wrong = replace(law, state_gain=-30.0 * law.state_gain)
    assert identified.unstable_on(law, 16) == 0
    assert identified.unstable_on(wrong, 16) == 16


def test_loads_that_were_there_are_the_plants(identified):
    assert not identified.quiet and identified.plant().disturbances[0].name == "load 1"
