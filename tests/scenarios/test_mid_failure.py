"""What breaks within an episode: sound before, broken after, when is drawn."""

import numpy as np
import pytest
from scipy.stats import binomtest, kstest

from beamenv import RotatingBeamEnv, RotatingBeamVectorEnv
from beamenv.scenarios.load_cases import NEVER
from beamenv.scenarios.scenario import scenario
from beamenv.scenarios.tables import Failures
from beamenv.simulation.blades import Blades
from beamenv.simulation.signals.faults import DRAWS, ONSET_DRAWS, draw_onsets, fault_draws
from beamenv.task import resolve_task

QUIET = {**dict.fromkeys(("step", "pulse", "deflection", "harmonic"), 0.0), "white_load": False, "sensor_noise": False}
INTERVAL = 0.5e-3


def test_instants_are_uniform_and_either_kind_breaks_equally_often():
    chosen = scenario("mid-failure").failures
    onsets = draw_onsets(chosen, INTERVAL, np.random.default_rng(0).random((20_000, ONSET_DRAWS)))
    actuator = onsets.actuators < NEVER
    np.testing.assert_array_equal(actuator, onsets.sensors == NEVER)
    assert binomtest(int(actuator.sum()), len(actuator), 0.5).pvalue > 0.001
    instants = np.where(actuator, onsets.actuators, onsets.sensors)
    assert (instants.min(), instants.max()) == (100, 600)  # 0.05 and 0.3 s
    assert kstest(instants * INTERVAL, "uniform", (0.05, 0.25)).pvalue > 0.001


def test_what_is_broken_from_the_start_takes_no_further_chance():
    """Seeds give the same episodes as ever where nothing sets in later."""
    assert fault_draws(scenario("failure").failures) == DRAWS
    assert fault_draws(Failures()) == DRAWS
    assert fault_draws(Failures(onset=(0.0, 0.1))) == DRAWS + ONSET_DRAWS


@pytest.mark.parametrize("instant", [0, 1, 7])
def test_an_actuator_that_dies_acts_until_it_does(instant):
    """The blade moves as a sound one until then, and from then on as a sound one that is asked for nothing there."""
    failures = {"dead_actuators": 4, "onset": instant * INTERVAL}
    dying, sound = RotatingBeamEnv(scenario=QUIET | {"failures": failures}), RotatingBeamEnv(scenario=QUIET)
    dying.reset(seed=5)
    sound.reset(seed=5)
    for k, action in enumerate(np.random.default_rng(0).uniform(-1.0, 1.0, (20, 4))):
        ours, theirs = dying.step(action), sound.step(action if k < instant else np.zeros(4))
        np.testing.assert_allclose(dying.state, sound.state, rtol=0.0, atol=1e-14)
        assert ours[1] == pytest.approx(theirs[1], rel=1e-12)
        np.testing.assert_allclose(ours[4]["volts"], 1500.0 * action)  # what is asked for


@pytest.mark.parametrize("instant", [0, 1, 7])
def test_the_reading_at_the_instant_of_death_is_the_first_that_shows_nothing(instant):
    load = {"load": {"case": "deflection", "magnitude": 30.0, "direction_deg": 60.0}}
    chosen = QUIET | {"failures": {"faulty_sensors": 4, "biased_share": 0.0, "onset": instant * INTERVAL}}
    dying, sound = RotatingBeamEnv(scenario=chosen), RotatingBeamEnv(scenario=QUIET)
    shown, true = ([env.reset(seed=5, options=load)[0]] for env in (dying, sound))
    for readings, env in ((shown, dying), (true, sound)):
        readings.extend(env.step(np.zeros(4))[0] for _ in range(20))
    assert np.all(np.abs(true[1:]).max(axis=1) > 1e-3)  # there is something to show
    np.testing.assert_array_equal(shown[:instant], true[:instant])
    assert not np.any(shown[instant:])


def test_a_sensor_may_become_biased():
    chosen = QUIET | {"failures": {"faulty_sensors": 1, "biased_share": 1.0, "bias": 0.2, "onset": 3 * INTERVAL}}
    env = RotatingBeamEnv(scenario=chosen)
    readings = [env.reset(seed=1)[0], *(env.step(np.zeros(4))[0] for _ in range(5))]
    np.testing.assert_array_equal(np.abs(readings).max(axis=1) > 0.1, [False, False, False, True, True, True])


def test_a_new_episode_begins_sound():
    env = RotatingBeamEnv(scenario=QUIET | {"failures": {"dead_actuators": 4, "onset": 5 * INTERVAL}}, duration=0.01)
    efforts = []
    for _ in range(2):
        env.reset(seed=0)
        efforts.append([env.step(np.ones(4))[4]["effort"] for _ in range(20)])
    np.testing.assert_array_equal(np.array(efforts) > 0.0, [[k < 5 for k in range(20)]] * 2)


def test_nothing_breaks_that_breaks_after_the_end():
    late, sound = ({"failures": {"dead_actuators": 4, "onset": onset}} for onset in (1.0, 0.0))
    assert RotatingBeamEnv(scenario=QUIET | late).reset(seed=0)[0] is not None
    batch = RotatingBeamVectorEnv(3, scenario=QUIET | late, duration=0.02)
    batch.reset(seed=0)
    assert all(np.all(batch.step(np.ones((3, 4)))[4]["effort"] > 0.0) for _ in range(39))
    alive = RotatingBeamVectorEnv(3, scenario=QUIET | sound, duration=0.02)
    alive.reset(seed=0)
    assert not alive.step(np.ones((3, 4)))[4]["effort"].any()


def test_training_through_the_plant_meets_the_same_failures():
    """Torch unrolls on the clock of the blades: the same loads and failures give the same cost."""
    torch = pytest.importorskip("torch")
    from train.learning.through_plant.windows import Windows

    class Held:
        """Full voltage whatever is read."""

        limits = None

        def start(self, count):
            return (torch.zeros(count, 4),)

        def __call__(self, readings, memory):
            return torch.ones(len(readings), 4), memory

    task = resolve_task(scenario=QUIET | {"failures": {"dead_actuators": 4, "onset": [0.0, 0.02]}}, duration=0.02)
    windows = Windows(task, 6, task.steps, np.random.default_rng(3))
    cost, _ = windows.unroll(Held())
    blades = Blades(task.bank, task.scenario, 6)
    blades.begin(generator := np.random.default_rng(3))
    expected = sum(blades.step(np.ones((6, 4)), generator).cost_increment for _ in range(task.steps))
    np.testing.assert_allclose(cost.numpy(), expected, rtol=1e-3)
    assert expected.max() > 1.2 * expected.min()
