"""The steady state of the blade in an episode: what resets tell of it, and failure by the total strain."""

from dataclasses import replace

import gymnasium
import numpy as np
import pytest

import beamenv
from beamenv.blade.build import Blade
from beamenv.envs.batch import RotatingBeamVectorEnv
from beamenv.envs.single import RotatingBeamEnv
from beamenv.patches.material import MFC_STRAIN
from beamenv.scenarios.named import NAMES
from beamenv.scenarios.scenario import SCENARIOS, scenario
from beamenv.simulation.plants.banks import build_bank
from beamenv.simulation.plants.spin_up import Cycloid
from beamenv.simulation.strain_limit import safe_energy
from beamenv.structure.base_motion import base_loads
from beamenv.structure.steady_deformation import steady_deformation
from beamenv.task import STEADY_INFO


def state_of(config, speed):
    state = steady_deformation(config.beam.build(config.patches), speed)
    return [state.stretch, state.untwist, state.strain, state.strain_at]


@pytest.mark.parametrize("preset", ["thesis", "sound-blade"])
def test_a_reset_tells_how_steady_rotation_deforms_the_blade(preset):
    _, info = RotatingBeamEnv(preset=preset).reset(seed=0)
    config = beamenv.PRESETS[preset]
    assert [info[name] for name in STEADY_INFO] == pytest.approx(state_of(config, config.speed), rel=1e-9)
    assert bool(info["note"]) is (preset == "thesis")


def test_steps_do_not_repeat_it():
    env = RotatingBeamEnv()
    env.reset(seed=0)
    assert not {*STEADY_INFO, "note"} & set(env.step(np.zeros(4))[4])


def test_the_thesis_model_has_no_steady_state_to_tell_of():
    _, info = RotatingBeamEnv(blade={"model": "thesis"}).reset(seed=0)
    assert all(info[name] == 0.0 for name in STEADY_INFO)


def test_each_drawn_blade_tells_its_own():
    envs = RotatingBeamVectorEnv(4, preset="sound-blade", scenario={"preset": "off-speed", "plants": {"bank": 3}})
    _, info = envs.reset(seed=3)
    assert len(set(info["static_strain"].tolist())) > 1
    for row, speed in enumerate(envs.rotor_speed):
        told = [info[name][row] for name in STEADY_INFO]
        assert told == pytest.approx(state_of(envs.task.config, speed), rel=1e-6)


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_batch_tells_it_of_the_blades_that_begin(mode):
    envs = RotatingBeamVectorEnv(3, duration=0.005, autoreset_mode=mode)
    _, info = envs.reset(seed=0, options={"elapsed": [0, 4, 0]})
    assert info["_static_strain"].all() and info["_note"].all()
    began = []
    for _ in range(7):
        info = envs.step(np.zeros((3, 4)))[4]
        began.append(info.get("_static_strain", np.zeros(3, dtype=bool)).tolist())
        if "static_strain" in info:
            assert np.array_equal(info["static_strain"] > 0.02, info["_static_strain"])
    assert began == [[False, k == (6 if mode == "NextStep" else 5), False] for k in range(7)]


def failing_time(**blade):
    """Control intervals until a blade fails that a sudden load bends more than the static deflection a second would fail it by."""
    env = RotatingBeamEnv(preset="sound-blade", blade={"speed": 300.0, **blade})
    load = {"case": "step", "magnitude": 60000.0, "direction_deg": 90.0, "onset": 0.0}
    env.reset(seed=0, options={"load": load})
    for k in range(1000):
        if env.step(np.zeros(4))[2]:
            return k, env
    return 1000, env


def test_total_strain_fails_a_blade_earlier_than_that_of_vibration():
    (total, env), (vibration, _) = failing_time(), failing_time(strain_limit="vibration")
    assert 0 < total < vibration < 1000
    standing = env.task.blade.full.steady_strain
    assert np.abs(env.plant.strain @ env.state).max() < MFC_STRAIN < np.abs(standing + env.plant.strain @ env.state).max()


def test_no_state_of_safe_energy_fails():
    generator = np.random.default_rng(0)
    rows, standing = generator.normal(size=(2, 5, 6)), generator.uniform(-0.004, 0.004, (2, 5))
    limits = np.array([MFC_STRAIN, 2.0 * MFC_STRAIN])
    most = safe_energy(rows, standing, limits)
    worst = 0.0
    for k in range(2):
        for row, strain in zip(rows[k], standing[k], strict=True):
            state = np.sqrt(2.0 * most) * np.sign(strain) * row / np.linalg.norm(row)
            worst = max(worst, np.abs(standing[k] + rows[k] @ state).max() / limits[k])
    assert worst == pytest.approx(1.0, rel=1e-9)


def test_an_initial_state_counts_with_the_steady_strain():
    env = RotatingBeamEnv(preset="sound-blade", blade={"speed": 300.0})
    plant, standing = env.plant, env.task.blade.full.steady_strain
    worst = int(np.abs(standing).argmax())
    row = plant.strain[worst]
    state = 0.003 * np.sign(standing[worst]) * row / (row @ row)
    assert np.abs(plant.strain @ state).max() < MFC_STRAIN
    with pytest.raises(ValueError, match="strains the blade by 0.0"):
        env.reset(options={"initial_state": state})
    env.reset(options={"initial_state": -state})
    RotatingBeamEnv(preset="sound-blade", blade={"speed": 300.0, "strain_limit": "vibration"}).reset(
        options={"initial_state": state}
    )


@pytest.mark.parametrize("make", [RotatingBeamEnv, RotatingBeamVectorEnv])
def test_a_blade_that_fails_as_it_turns_is_refused(make):
    sentence = (
        r"^blade.strain_limit is 'total', but the blade's steady state at 200 rad/s alone strains it by 2.8 %, beyond the 0.45 %"
    )
    with pytest.raises(ValueError, match=sentence):
        make(blade={"strain_limit": "total"})


def test_so_is_one_that_fails_at_a_speed_it_may_be_drawn_with_or_spin_up_to():
    drawn = {"plants": {"speed_ratio": [0.5, 4.5], "bank": 8}}
    with pytest.raises(ValueError, match=r"^blade.strain_limit is 'total', but .* rad/s alone"):
        RotatingBeamEnv(preset="sound-blade", scenario=drawn)
    with pytest.raises(ValueError, match=r"^blade.strain_limit is 'total', but .* rad/s alone"):
        RotatingBeamEnv(preset="sound-blade", scenario={"plants": {"spin_up": [100.0, 420.0]}})


def test_the_thesis_model_is_refused_total_strain():
    with pytest.raises(ValueError, match=r"^blade.strain_limit is 'total', but must be 'vibration' with model = 'thesis'"):
        beamenv.blade_config("thesis", {"model": "thesis", "strain_limit": "total"})


def test_a_spin_up_strains_the_blade_by_each_speed_s_steady_state_and_by_euler_s_force():
    """Against the static deflection of the full model under Euler's force, where the speed rises most and where it does not."""
    blade = Blade(beamenv.PRESETS["sound-blade"])
    course = Cycloid(100.0, 300.0, 0.5)
    bank = build_bank(blade, blade, scenario("spin-up").plants, 1000)
    euler = base_loads(blade.beam).euler
    for k in (0, 300, 500, 999):
        time = np.array(k * blade.config.control_interval)
        speed, acceleration = float(course.speed(time)), float(course.acceleration(time))
        then = blade.changed(replace(blade.config, speed=speed))
        bent = blade.full.strain @ np.linalg.solve(blade.beam.matrices.stiffness(speed), acceleration * euler)
        assert np.abs(bank.standing[k] - then.full.steady_strain - bent).max() < 1e-5
        assert bool(np.abs(bent).max() > 3e-4) is (k in (300, 500))
    assert bank.steady[-1] == pytest.approx(state_of(blade.config, 100.0))


@pytest.mark.parametrize("name", [name for name in NAMES if not name.startswith("solid")])
def test_the_sound_blade_survives_every_scenario(name):
    few = {"plants": {"bank": 3}} if SCENARIOS[name].plants.varies else {}
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=8, preset="sound-blade", scenario={"preset": name, **few})
    envs.reset(seed=0)
    assert not any(envs.step(np.zeros((8, 4)))[2].any() for _ in range(999))


def test_strain_rows_of_a_plant_file_are_of_vibration_alone(tmp_path):
    plant = replace(beamenv.load_plant("solid-blade"), strain=np.zeros((2, 20)))
    beamenv.save_plant(plant, tmp_path / "own.npz")
    blade = {"strain_limit": "total", "beam": {"ply_angles_deg": [75.0, -75.0] * 3}}
    with pytest.raises(ValueError, match=r"^blade.strain_limit is 'total', but must be 'vibration', for the plant"):
        RotatingBeamEnv(blade=blade, scenario={"plants": {"truth": str(tmp_path / "own.npz")}})
    RotatingBeamEnv(blade=blade, scenario="solid").reset(seed=0)
