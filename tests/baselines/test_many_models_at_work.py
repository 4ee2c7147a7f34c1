"""Many models on many blades: in batches, of other orders, and on blades that are none of their own."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import Hypothesis, PersistentLoad, evaluate, lqg, multiple_model, reference_lqg
from baselines.design import weighing
from baselines.design.loop import closed_loop, spectral_radius
from baselines.laws import multiple_model as builder
from baselines.laws.detuned_lqg import CAUTIOUS, detuned_lqg
from tests.baselines.hypotheses import OPEN, hypotheses, readings, run


@pytest.fixture(name="plant", scope="module")
def _plant(small_plant):
    return small_plant(**OPEN)


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
