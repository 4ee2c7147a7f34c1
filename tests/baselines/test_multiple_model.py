"""Multiple-model adaptive estimation against textbook recursions, Bayes' rule in one piece, and blades that are none of its own."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from scipy.stats import multivariate_normal

import beamenv
from baselines import Hypothesis, MultipleModel, PersistentLoad, evaluate, full_order_lqg, lqg, multiple_model, reference_lqg
from baselines.design import weighing
from baselines.design.loop import closed_loop, spectral_radius
from baselines.laws import multiple_model as builder
from baselines.laws.detuned_lqg import CAUTIOUS, detuned_lqg
from baselines.laws.lqg import known_sensor_noise, sampled_design
from beamenv.plant.plant import sample

OPEN = {"sensor_full_scale": np.array([0.01, 0.01]), "voltage_limits": np.array([[-1e9, -1e9], [1e9, 1e9]])}
"""Instruments that clip nothing, for what is true while nothing clips."""
BLIND, IDLE = (0.0, 1.0), (1.0, 0.0)


@pytest.fixture(name="plant", scope="module")
def _plant(small_plant):
    return small_plant(**OPEN)


def slower(plant, ratio=0.8):
    n = len(plant.A) // 2
    A = plant.A.copy()
    A[:n, n:] *= ratio
    A[n:, :n] *= ratio
    return replace(plant, A=A, natural_frequencies=ratio * plant.natural_frequencies)


def readings(steps, rows=(), seed=3):
    return 1e-6 * np.random.default_rng(seed).normal(size=(steps, *rows, 2))


def run(law, given, starts=None):
    """Voltages and memories, for readings in A."""
    memory, actions, memories = None, [], []
    for k, reading in enumerate(given):
        action, memory = law.predict(reading / law.instruments.measurement_scale, memory, None if starts is None else starts[k])
        actions.append(action * law.instruments.voltage_scale)
        memories.append(memory)
    return np.array(actions), memories


def model_by_hand(plant, load, deflection=0.0):
    """A, B, C, W, V, S₀ with the load's two states behind those of the blade, written anew."""
    held, (n, m), a = sample(plant), plant.B.shape, np.exp(-plant.control_interval / load.duration)
    A = np.zeros((n + 2, n + 2))
    A[:n, :n], A[:n, n:], A[n:, n:] = held.A, held.disturbance_input, a * np.eye(2)
    W = np.zeros_like(A)
    W[:n, :n] = held.disturbance_input @ (plant.process_noise / plant.control_interval) @ held.disturbance_input.T
    W[n:, n:] = (1.0 - a**2) * load.magnitude**2 * np.eye(2)
    start = np.zeros_like(A)
    for direction in np.eye(2):
        bent = np.linalg.solve(plant.A, plant.disturbance_input @ direction * deflection)
        start[:n, :n] += np.outer(bent, bent)
    start[n:, n:] = load.magnitude**2 * np.eye(2)
    B, C = np.vstack([held.B, np.zeros((2, m))]), np.hstack([plant.C, np.zeros((len(plant.C), 2))])
    return A, B, C, W, known_sensor_noise(plant) / plant.control_interval, start


def test_a_hypothesis_alone_is_lqg_with_the_gains_of_the_textbook_s_recursion(plant):
    load = PersistentLoad()
    law = multiple_model([Hypothesis(plant, load=load, deflection=12.0)], rate_weight=0.0)
    A, B, C, W, V, S = model_by_hand(plant, load, 12.0)
    K, x = sampled_design(plant, load)[1].gain, np.zeros(len(A))
    given = readings(len(law.bank.cross) - 1)
    assert len(given) > 30
    for reading, volts in zip(given, run(law, given)[0], strict=True):
        L = S @ C.T @ np.linalg.inv(C @ S @ C.T + V)
        x = x + L @ (reading - C @ x)
        left = np.eye(len(A)) - L @ C
        S = A @ (left @ S @ left.T + L @ V @ L.T) @ A.T + W  # Joseph's form
        np.testing.assert_allclose(volts, -K @ x, rtol=1e-7, atol=1e-7 * np.abs(K @ x).max())
        x = A @ x - B @ K @ x


def test_in_the_long_run_a_hypothesis_alone_is_the_full_order_lqg(plant):
    """On two blades that meet the same noise: all of it that was different at the start has died away."""
    held, ends = sample(plant), []
    for law in (multiple_model([Hypothesis(plant)]), full_order_lqg(plant)):
        random, x, memory, volts = np.random.default_rng(6), np.zeros(6), None, []
        for _ in range(1500):
            reading = held.C @ x + 4e-7 * random.normal(size=2)
            action, memory = law.predict(reading / plant.sensor_full_scale, memory)
            volts.append(action * law.instruments.voltage_scale)
            x = held.A @ x + held.B @ volts[-1] + held.disturbance_input @ random.normal(size=2)
        ends.append(volts)
    size = np.abs(ends[1]).max()
    assert np.abs(np.subtract(*ends))[2:20].max() > 0.01 * size
    np.testing.assert_allclose(ends[0][-50:], ends[1][-50:], rtol=0.0, atol=1e-6 * size)


def test_with_a_lasting_load_the_last_gains_are_those_of_the_full_order_lqg(plant):
    law, plain = multiple_model([Hypothesis(plant, load=PersistentLoad())]), full_order_lqg(plant, load=PersistentLoad())
    L = np.linalg.solve(law.bank.covariance[-1, 0], law.bank.cross[-1, 0]).T
    np.testing.assert_allclose(-law.state_gain[0] @ L, plain.measurement_gain, rtol=1e-7)
    np.testing.assert_allclose(-law.state_gain[0] @ (np.eye(8) - L @ law.bank.output[0].T), plain.state_gain[:, :8], rtol=1e-6)
    np.testing.assert_allclose(-law.voltage_gain[0], plain.state_gain[:, 8:], rtol=1e-9)


def test_where_voltages_come_late_the_gain_is_that_of_dynamic_programming_on_the_voltages_under_way(plant):
    held, d, m, n = sample(plant), 2, 2, len(plant.A)
    law = multiple_model([Hypothesis(plant, delay=d)], rate_weight=1.0)
    A, B = np.zeros((n + d * m, n + d * m)), np.zeros((n + d * m, m))
    A[:n, :n], A[:n, n + m :], A[n + m :, n : n + m], B[n : n + m] = held.A, held.B, np.eye(m), np.eye(m)
    Q, price = np.zeros_like(A), np.diag(np.diag(held.input_weight))
    inner = np.r_[0:n, n + m : n + 2 * m]
    Q[np.ix_(inner, inner)] = held.cost[: n + m, : n + m]
    Q[n : n + m, n : n + m] += price
    N = np.vstack([np.zeros((n, m)), -price, np.zeros((m, m))])
    P = np.zeros_like(A)
    for _ in range(3000):
        K = np.linalg.solve(price + B.T @ P @ B, B.T @ P @ A + N.T)
        P = A.T @ P @ A + Q - (A.T @ P @ B + N) @ K
    np.testing.assert_allclose(law.state_gain[0], K[:, :n], rtol=1e-6, atol=1e-6 * np.abs(K[:, :n]).max())
    np.testing.assert_allclose(law.voltage_gain[0], K[:, n:], rtol=1e-6, atol=1e-6 * np.abs(K[:, n:]).max())


def log_density(plant, given, volts, delay=0, gain=(1.0, 1.0), seen=(1.0, 1.0), bias=(0.0, 0.0), missing=()):
    """Of all readings at once, from the joint Gaussian of loads, noise and bias; ``missing`` are places in the flat sequence."""
    A, B, C, W, V, start = model_by_hand(plant, PersistentLoad(), 12.0)
    C, steps, n = np.array(seen)[:, None] * C, len(given), len(A)
    mean, x = np.zeros((steps, 2)), np.zeros(n)
    spread = np.zeros((steps, n, steps, n))
    S = start
    for k in range(steps):
        mean[k] = C @ x
        x = A @ x + B @ (np.array(gain) * volts[k - delay] if k >= delay else np.zeros(2))
        spread[k, :, k] = S
        for j in range(k + 1, steps):
            spread[j, :, k] = A @ spread[j - 1, :, k]
            spread[k, :, j] = spread[j, :, k].T
        S = A @ S @ A.T + W
    covariance = np.einsum("pi,kilj,qj->kplq", C, spread, C)
    b = (np.array(bias) * plant.sensor_full_scale) ** 2
    for k in range(steps):
        covariance[k, :, k] += V
        for j in range(steps):
            covariance[k, :, j] += np.diag(b) * np.exp(-abs(k - j) * plant.control_interval / 10.0)
    kept = np.setdiff1d(np.arange(2 * steps), missing)
    scale = 1e-6
    covariance = covariance.reshape(2 * steps, -1)[np.ix_(kept, kept)] / scale**2
    return multivariate_normal.logpdf(given.ravel()[kept] / scale, mean.ravel()[kept] / scale, covariance)


def posterior(prior, logs):
    weights = np.array(prior) * np.exp(np.array(logs) - max(logs))
    return weights / weights.sum()


CASES = [{}, {"delay": 2}, {"gain": IDLE}, {"seen": BLIND}, {"bias": (1e-4, 0.0)}]


def hypotheses(plant, **more):
    names = {"delay": "delay", "gain": "actuator_gain", "seen": "sensor_gain", "bias": "sensor_bias"}
    own = {"load": PersistentLoad(), "deflection": 12.0, **more}
    faults = [{names[name]: value for name, value in case.items()} for case in CASES]
    return [Hypothesis(plant, prior=1.0 + k, **own, **fault) for k, fault in enumerate(faults)]


def test_weights_are_bayes_rule_with_the_density_of_all_readings_at_once(plant):
    given = readings(12)
    those = [*hypotheses(plant), Hypothesis(slower(plant), load=PersistentLoad(), deflection=12.0, prior=9.0)]
    law = multiple_model(those, floor=0.0)
    volts, memories = run(law, given)
    for steps in (1, 2, 5, 12):
        logs = [log_density(plant, given[:steps], volts, **case) for case in CASES]
        logs.append(log_density(slower(plant), given[:steps], volts))
        np.testing.assert_allclose(law.weights(memories[steps - 1]), posterior([1, 2, 3, 4, 5, 9], logs), rtol=2e-5, atol=1e-12)


def test_a_reading_that_is_shown_again_exactly_is_lost_to_weights_and_estimates(plant):
    given = readings(6)
    given[5, 1] = given[4, 1]
    law = multiple_model(hypotheses(plant, holds_lost_readings=True), floor=0.0)
    volts, memories = run(law, given)
    logs = [log_density(plant, given, volts, **case, missing=[11]) for case in CASES]
    np.testing.assert_allclose(law.weights(memories[5]), posterior([1, 2, 3, 4, 5], logs), rtol=2e-5)
    plain = multiple_model(hypotheses(plant), floor=0.0)
    kept = [log_density(plant, given, volts, **case) for case in CASES]
    np.testing.assert_allclose(plain.weights(run(plain, given)[1][5]), posterior([1, 2, 3, 4, 5], kept), rtol=2e-5)
    alone = multiple_model(hypotheses(plant, holds_lost_readings=True)[:1], rate_weight=0.0)
    memory = alone.recall(run(alone, given)[1][5][None])
    before = alone.recall(run(alone, given[:5])[1][4][None]).predicted[0, 0]
    A, B, C, _, V, S = model_by_hand(plant, PersistentLoad(), 12.0)
    for _ in range(5):
        S = A @ (S - S @ C.T @ np.linalg.solve(C @ S @ C.T + V, C @ S)) @ A.T + model_by_hand(plant, PersistentLoad())[3]
    one = C[:1]
    x = before + (S @ one.T / (one @ S @ one.T + V[:1, :1]))[:, 0] * (given[5, 0] - one @ before)
    x = A @ x + B @ memory.voltages[0, 0] if len(memory.voltages[0]) else A @ x - B @ alone.state_gain[0] @ x
    np.testing.assert_allclose(memory.predicted[0, 0], x, rtol=1e-6, atol=1e-9 * np.abs(x).max())


def moved(law, plant, steps, faults=(), released_from=0.0):
    """Weights along an episode of a plant with white loads and noise; ``faults`` change it as [(step, plant, delay)].

    It starts in the deflection under loads (N/m) in lag and flap.
    """
    random, truths = np.random.default_rng(0), [(0, plant, 0), *faults]
    x, memory, asked, found = -np.linalg.solve(plant.A, plant.disturbance_input @ np.full(2, released_from)), None, [], []
    loads, noise = np.sqrt(np.diag(plant.process_noise / plant.control_interval)), 0.02 * 2e-5
    for k in range(steps):
        _, now, delay = [truth for truth in truths if truth[0] <= k][-1]
        held, scale = sample(now), now.sensor_full_scale
        action, memory = law.predict((held.C @ x + noise * random.normal(size=2)) / scale, memory)
        asked.append(action * law.instruments.voltage_scale)
        found.append(law.weights(memory))
        x = held.A @ x + held.disturbance_input @ (loads * random.normal(size=2))
        x += held.B @ asked[k - delay] if k >= delay else 0.0
    return np.array(found)


@pytest.mark.parametrize("truth", range(3))
def test_the_hypothesis_that_is_right_gets_all_the_weight(plant, truth):
    those = [Hypothesis(plant), Hypothesis(slower(plant)), Hypothesis(plant, sensor_gain=BLIND)]
    law = multiple_model(those)
    weights = moved(law, those[truth].faulty_plant, 300)
    assert weights[0].max() < 0.99
    assert weights[-1, truth] > 0.9999
    assert weights.min() > 0.9e-6


def test_delay_is_found_as_soon_as_voltages_tell(plant):
    law = multiple_model([Hypothesis(plant, delay=d, deflection=20.0) for d in range(4)])
    weights = moved(law, plant, 300, [(0, plant, 2)], released_from=20.0)
    assert weights[-1, 2] > 0.999


def test_with_nothing_to_follow_anything_the_switching_estimator_is_magill_s(plant):
    given = readings(40)
    plain = multiple_model(hypotheses(plant), floor=0.0)
    switching = multiple_model(hypotheses(plant), transition=np.eye(5), floor=0.0)
    np.testing.assert_allclose(run(switching, given)[0], run(plain, given)[0], rtol=1e-6, atol=1e-4)


def test_the_switching_estimator_mixes_as_blom_and_bar_shalom_do(plant):
    markov = np.array([[0.9, 0.1], [0.3, 0.7]])
    those = [Hypothesis(plant, prior=3.0), Hypothesis(plant, sensor_gain=BLIND)]
    law = multiple_model(those, transition=markov, rate_weight=0.0, floor=0.0)
    bank, A, B = law.bank, sample(plant).A, sample(plant).B
    C = [plant.C, np.array(BLIND)[:, None] * plant.C]
    x, weights = [np.zeros(6), np.zeros(6)], np.array([0.75, 0.25])
    for k, (reading, volts) in enumerate(zip(readings(30), run(law, readings(30))[0], strict=True)):
        k = min(k, len(bank.cross) - 1)
        likelihood = [multivariate_normal.pdf(reading * 1e7, C[j] @ x[j] * 1e7, bank.covariance[k, j] * 1e14) for j in (0, 1)]
        x = [x[j] + bank.cross[k, j].T @ np.linalg.solve(bank.covariance[k, j], reading - C[j] @ x[j]) for j in (0, 1)]
        weights = weights * likelihood / (weights @ likelihood)
        asked = -sum(weights[j] * law.state_gain[j] @ x[j] for j in (0, 1))
        np.testing.assert_allclose(volts, asked, rtol=1e-7, atol=1e-7 * np.abs(asked).max())
        following = [weights[0] * markov[0, j] + weights[1] * markov[1, j] for j in (0, 1)]
        mixed = [(weights[0] * markov[0, j] * x[0] + weights[1] * markov[1, j] * x[1]) / following[j] for j in (0, 1)]
        x, weights = [A @ mixed[j] + B @ volts for j in (0, 1)], np.array(following)


def test_a_sensor_that_dies_in_mid_episode_is_found_sooner_by_the_switching_estimator(plant):
    those = [Hypothesis(plant), Hypothesis(plant, sensor_gain=BLIND), Hypothesis(plant, sensor_gain=IDLE)]
    stay = 0.998
    markov = np.full((3, 3), (1.0 - stay) / 2.0) + (stay - (1.0 - stay) / 2.0) * np.eye(3)
    dies = [(200, those[1].faulty_plant, 0)]
    switching = moved(multiple_model(those, transition=markov), plant, 400, dies)
    fixed = moved(multiple_model(those, floor=0.0), plant, 400, dies)
    assert switching[190, 0] > 0.9
    found = [int(np.argmax(weights[200:, 1] > 0.5)) for weights in (switching, fixed)]
    assert 0 < found[0] < 30
    assert found[1] == 0 or found[1] > 2 * found[0]
    assert switching[-1, 1] > 0.9


def test_a_batch_is_its_blades_one_by_one_whenever_each_begins(small_plant):
    plant = small_plant()
    law = multiple_model(hypotheses(plant, holds_lost_readings=True), lqg(plant), transition=0.9 * np.eye(5) + 0.02)
    given = 0.4 * plant.sensor_full_scale * np.random.default_rng(8).normal(size=(90, 3, 2))
    given[20:30, 1, 0] = given[20, 1, 0]
    given[40, 2] = given[39, 2]
    starts = np.zeros((90, 3), dtype=bool)
    starts[[0, 37, 60], [0, 1, 2]] = True
    together = run(law, given, starts)
    for blade in range(3):
        alone = run(law, given[:, blade], starts[:, blade])
        np.testing.assert_allclose(alone[0], together[0][:, blade], rtol=1e-7, atol=1e-6)
        np.testing.assert_allclose(alone[1][-1], together[1][-1][blade], rtol=1e-7, atol=1e-9)
    seen = given[0] / plant.sensor_full_scale
    assert np.array_equal(law.predict(seen, together[1][-1], np.ones(3))[0], law.predict(seen)[0])
    volts = law.in_physical_units().predict(given[0])[0]
    np.testing.assert_allclose(volts, law.predict(seen)[0] * law.instruments.voltage_scale, rtol=1e-9)


def test_blades_that_do_not_fit_into_one_go_are_decided_for_in_several(small_plant, monkeypatch):
    plant = small_plant()
    law = multiple_model(hypotheses(plant), lqg(plant))
    given = 0.4 * plant.sensor_full_scale * np.random.default_rng(9).normal(size=(40, 5, 2))
    whole = run(law, given)
    monkeypatch.setattr(weighing, "AT_ONCE", 2 * law.order)
    parts = run(law, given)
    np.testing.assert_allclose(parts[0], whole[0], rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(parts[1][-1], whole[1][-1], rtol=1e-9, atol=1e-12)


def test_plants_of_other_orders_stand_side_by_side(plant):
    fewer = replace(
        plant,
        **{name: getattr(plant, name)[np.ix_([0, 1, 3, 4], [0, 1, 3, 4])] for name in ("A", "state_weight")},
        **{name: getattr(plant, name)[[0, 1, 3, 4]] for name in ("B", "disturbance_input")},
        **{name: getattr(plant, name)[:, [0, 1, 3, 4]] for name in ("C", "strain", "tip_displacement")},
        natural_frequencies=plant.natural_frequencies[:2],
    )
    given = readings(30)
    both = multiple_model([Hypothesis(plant, prior=1e-300), Hypothesis(fewer)], floor=0.0)
    alone = multiple_model([Hypothesis(fewer)])
    np.testing.assert_allclose(run(both, given)[0], run(alone, given)[0], rtol=1e-6, atol=1e-6)


def test_every_hypothesis_own_loop_is_verified_with_its_delay_and_faults(plant, monkeypatch):
    seen = []
    original = builder.verified
    monkeypatch.setattr(builder, "verified", lambda *given, **named: seen.append((given, named)) or original(*given, **named))
    multiple_model(hypotheses(plant), verify=False)
    assert [named["verify"] for _, named in seen] == [False] * 5
    for (law, held, *solutions), _ in seen:
        assert spectral_radius(closed_loop(held, law)[0]) < 1.0
        assert max(each.residual for each in solutions) < 1e-9
    assert [len(held.A) for (_, held, *_), _ in seen] == [6, 10, 6, 6, 6]
    assert not seen[2][0][1].B[:, 1].any() and not seen[3][0][1].C[0].any()


def test_where_no_hypothesis_fits_the_fallback_takes_over_with_a_memory_of_its_own(small_plant):
    plant = small_plant()
    fallback = reference_lqg(plant, order=4)
    law = multiple_model([Hypothesis(plant)], fallback)
    given = np.clip(np.random.default_rng(2).normal(size=(120, 2)), -0.99, 0.99) * plant.sensor_full_scale
    volts, memories = run(law, given)
    astray = [bool(law.recall(memory[None]).astray[0]) for memory in memories]
    assert astray.index(True) == law.window and all(astray[law.window :])
    own = np.zeros(4)
    for reading, applied, led in zip(given, volts, astray, strict=True):
        asked = np.clip(fallback.state_gain @ own + fallback.measurement_gain @ reading, *plant.voltage_limits)
        if led:
            np.testing.assert_allclose(applied, asked, rtol=1e-9)
        own = fallback.transition @ own + fallback.measurement_input @ reading + fallback.voltage_input @ applied
    trusting = multiple_model([Hypothesis(plant)])
    np.testing.assert_array_equal(run(trusting, given[:40])[0], volts[:40])
    assert not np.allclose(run(trusting, given)[0], volts)


@pytest.fixture(name="delayed", scope="module")
def _delayed():
    """Six blades whose voltages come late, which a bank of the nominal plant alone knows nothing of."""
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=6, scenario="delay", duration=0.25)
    return envs, envs.unwrapped.design.full_plant


def test_on_blades_outside_its_bank_a_cautious_fallback_costs_a_fraction_of_the_reference_and_of_none(delayed):
    envs, plant = delayed
    load, fallback, seeds = PersistentLoad(), detuned_lqg(plant, CAUTIOUS), range(2_000_000, 2_000_006)
    bank = [Hypothesis(plant, load=load, deflection=11.0)]
    plain = evaluate(reference_lqg(plant), envs, seeds)
    robust, safe, trusting = (
        evaluate(law, envs, seeds, reference=plain.reference)
        for law in (fallback, multiple_model(bank, fallback), multiple_model(bank))
    )
    assert robust.cost.value < 0.5 * plain.cost.value
    assert safe.cost.value < 0.5 * plain.cost.value
    assert trusting.cost.value > 2.0 * safe.cost.value
    told = multiple_model([replace(bank[0], delay=d, holds_lost_readings=True) for d in range(4)], fallback)
    informed = evaluate(told, envs, seeds, reference=plain.reference)
    assert informed.cost.value < robust.cost.value


def test_instruments_that_differ_and_what_is_no_hypothesis_are_refused(plant, small_plant):
    one = Hypothesis(plant)
    other = small_plant()
    for given, words in (
        ([], "hypotheses is"),
        (one, "hypotheses is"),
        ([one, plant], "hypotheses is"),
        ([one, Hypothesis(other)], "hypotheses have plants that differ in sensor_full_scale"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            multiple_model(given)
    for named, words in (
        ({"fallback": 3}, "fallback is 3, but must be None or a LinearController"),
        ({"fallback": lqg(other)}, "fallback has another voltage_limits than the hypotheses"),
        ({"transition": [[0.5]]}, r"transition is \[\[0.5\]\], but must be probabilities"),
        ({"transition": np.eye(2)}, r"transition has shape \(2, 2\)"),
        ({"floor": 1.0}, "floor is 1.0"),
        ({"window": 0}, "window is 0"),
        ({"confidence": 1.0}, "confidence is 1.0"),
        ({"allowance": -1.0}, "allowance is -1.0"),
        ({"rate_weight": -1.0}, "rate_weight is -1.0"),
        ({"verify": 1}, "verify is 1"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            multiple_model([one], **named)
    with pytest.raises(ValueError, match="^hypotheses have other plants or loads"):
        multiple_model([one, Hypothesis(slower(plant))], transition=np.eye(2))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"plant": None}, "plant is None, but must be a beamenv.Plant"),
        ({"delay": -1}, "delay is -1"),
        ({"delay": 0.5}, "delay is 0.5"),
        ({"actuator_gain": [1.0, 2.0]}, r"actuator_gain is \[1.0, 2.0\], but must be a number from 0 to 1"),
        ({"sensor_gain": [1.0]}, r"sensor_gain = \[1.0\] must be a finite number, or 2 of them"),
        ({"sensor_bias": -0.1}, "sensor_bias is"),
        ({"load": 3}, "load is 3"),
        ({"deflection": np.inf}, "deflection is inf"),
        ({"prior": 0.0}, "prior is 0.0"),
        ({"holds_lost_readings": None}, "holds_lost_readings is None"),
    ],
)
def test_a_hypothesis_that_cannot_be_is_refused(plant, changes, words):
    with pytest.raises(ValueError, match=f"^{words}"):
        Hypothesis(**{"plant": plant, **changes})


def test_parts_of_a_multiple_model_law_that_do_not_fit_are_told(plant):
    law = multiple_model([Hypothesis(plant)])
    assert isinstance(law, MultipleModel)
    for changes, words in (
        ({"bank": None}, "bank is None"),
        ({"prior": [1.0, 2.0]}, r"prior has shape \(2,\)"),
        ({"state_gain": np.zeros((1, 2, 5))}, r"state_gain has shape \(1, 2, 5\)"),
    ):
        with pytest.raises(ValueError, match=f"^{words}"):
            replace(law, **changes)


def test_hypotheses_that_nothing_leads_to_are_left_and_the_others_decide(small_plant):
    """As where next to nothing does."""
    those = [Hypothesis(small_plant(), **fault) for fault in ({}, {"actuator_gain": (0.0, 1.0)}, {"sensor_gain": (0.0, 1.0)})]
    matrices = [
        np.array([[share, 1.0 - share, 0.0], [share, 0.9 - share, 0.1], [share, 0.5 - share, 0.5]]) for share in (0.0, 1e-14)
    ]
    never, hardly = (multiple_model(those, transition=matrix, floor=0.0) for matrix in matrices)
    one = other = None
    for seen in 0.01 * np.random.default_rng(0).normal(size=(40, 3, 2)):
        action, one = never.predict(seen, one)
        wanted, other = hardly.predict(seen, other)
        np.testing.assert_allclose(action, wanted, atol=1e-6)
    assert (never.weights(one)[:, 0] < 1e-300).all() and np.abs(action).max() > 1e-3
