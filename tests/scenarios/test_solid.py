"""The blade as a solid: a plant file moves, behind the beam's design; and the laws that know the one or the other."""

import re
from dataclasses import replace

import gymnasium
import numpy as np
import pytest

import beamenv
from baselines import lqg, lqr, no_control, stationary_cost
from beamenv import PlacementWrapper, RotatingBeamEnv, RotatingBeamVectorEnv, build_plant, load_plant, save_plant
from beamenv.blade.given import GivenBlade, counterparts
from beamenv.blade.presets import blade_config
from beamenv.envs.history import SensorHistory
from beamenv.scenarios.scenario import scenario
from beamenv.simulation.blades import reward_scale
from beamenv.simulation.plants.coordinates import seen_from
from beamenv.task import resolve_task

SOLIDS = {"solid": 11, "solid-20": 20}
SOLID = load_plant("solid-blade")
ALONE = {"electronics": {"amplifier_bandwidth": None, "filter_cutoff": None}}
EPISODES, DURATION, SETTLE = 256, 3.0, 1.0
SIGMAS = 4.0
"""Standard errors that a measured cost may be off: by chance one seed in 16,000 is."""


@pytest.mark.parametrize(("name", "modes"), SOLIDS.items())
def test_the_solid_moves_behind_the_beams_design_and_instruments(name, modes):
    task = resolve_task(scenario=name)
    beam = build_plant(blade_config())
    np.testing.assert_array_equal(task.plant.natural_frequencies, SOLID.natural_frequencies[:modes])
    for each in ("A", "B", "C", "natural_frequencies", "strain"):
        np.testing.assert_array_equal(getattr(task.design_plant, each), getattr(beam, each))
    for each in ("input_weight", "process_noise", "sensor_noise", "sensor_full_scale", "voltage_limits", "control_interval"):
        np.testing.assert_array_equal(getattr(task.plant, each), getattr(task.design_plant, each))


def test_the_reward_scale_is_the_strain_energy_of_the_solids_own_modes_at_rest():
    """½ Σ (P_flap 30 N/m / ω)²: gyroscopic forces do nothing at rest."""
    energy = 0.5 * np.sum((30.0 * SOLID.line_load[:, 1] / SOLID.natural_frequencies) ** 2)
    assert reward_scale(resolve_task(scenario="solid-20").plant) == pytest.approx(energy * 0.5e-3, rel=1e-9)


def test_an_undamped_solid_has_the_frequencies_of_its_gyroscopic_system():
    """det(−λ² I + iλ G + ω²) = 0 at every pole iλ of the plant, which is checked without a first-order form."""
    plant = resolve_task(scenario="solid", blade={"damping_ratio": 0.0, **ALONE}).plant
    poles = np.linalg.eigvals(plant.A)
    assert np.abs(poles.real).max() < 1e-6
    omega, G = np.diag(SOLID.natural_frequencies[:11] ** 2), SOLID.gyroscopic[:11, :11]
    for pole in poles:
        smallest = np.linalg.svd(pole**2 * np.eye(11) + pole * G + omega, compute_uv=False)[-1]
        assert smallest < 1e-6 * np.abs(pole) ** 2


def answer(plant, s):
    """Currents per voltage (p, m) at a complex frequency, 1/s."""
    return plant.C @ np.linalg.solve(s * np.eye(len(plant.A)) - plant.A, plant.B) + plant.D


@pytest.mark.parametrize("name", SOLIDS)
def test_the_solid_stands_behind_the_amplifiers_and_filters_of_its_blade(name):
    """Far below the Nyquist frequency they add their own delay, √2/ω_c of a Butterworth filter and 1/ω_a, and a static charge."""
    bare, whole = (resolve_task(scenario=name, blade=blade).plant for blade in (ALONE, None))
    assert (bare.electronic_states, whole.electronic_states) == (0, 4 * (1 + 2))
    assert bare.blade_states == whole.blade_states == 2 * SOLIDS[name]
    np.testing.assert_array_equal(whole.natural_frequencies, bare.natural_frequencies)
    np.testing.assert_array_equal(whole.input_weight, bare.input_weight)
    s = 20.0j
    delay = np.sqrt(2.0) / (2.0 * np.pi * 800.0) + 1.0 / (2.0 * np.pi * 7500.0)
    added = answer(whole, s) * np.exp(s * delay) / s - answer(bare, s) / s
    np.testing.assert_allclose(added.imag, 0.0, atol=1e-3 * np.abs(added).max())
    at_rest = [plant.tip_displacement @ np.linalg.solve(plant.A, plant.B) for plant in (bare, whole)]
    np.testing.assert_allclose(*at_rest, rtol=1e-9)  # a file does not tell how its further modes would displace the tip


def test_slow_currents_of_the_solid_are_the_beams_however_many_modes_are_kept():
    """The static charge is whole: what eleven or twenty modes do not show the residual does, by the beam's patches."""
    eleven, twenty, beam = (answer(resolve_task(scenario=name).plant, 2.0j) for name in (*SOLIDS, "nominal"))
    for each in (eleven, twenty):
        np.testing.assert_allclose(each, beam, rtol=1e-3, atol=1e-3 * np.abs(beam).max())


def test_a_files_own_damping_is_that_of_its_plant(tmp_path):
    save_plant(replace(SOLID, damping_ratio=np.linspace(0.001, 0.02, 20), gyroscopic=np.zeros((20, 20))), tmp_path / "damped.npz")
    plant = resolve_task(scenario={"plants": {"truth": str(tmp_path / "damped.npz")}}, blade=ALONE).plant
    poles = np.linalg.eigvals(plant.A)
    poles = poles[poles.imag > 0.0]
    poles = poles[np.argsort(np.abs(poles))]
    np.testing.assert_allclose(-poles.real / np.abs(poles), np.linspace(0.001, 0.02, 20), rtol=1e-9)


def test_a_modes_counterpart_is_the_near_mode_that_answers_like_it():
    own, omega = np.linalg.qr(np.random.default_rng(0).normal(size=(7, 5)))[0], np.array([100.0, 110.0, 120.0, 200.0, 300.0])
    np.testing.assert_array_equal(counterparts(own, omega, own, omega), np.eye(5))
    given = (own * [1.0, -1.0, 1.0, -1.0, 1.0])[:, [1, 0, 2, 3, 4]] + 0.1 * own[:, [2, 3, 4, 0, 1]]
    expected = np.diag([0.0, 0.0, 1.0, -1.0, 1.0])
    expected[1, 0], expected[0, 1] = -1.0, 1.0
    np.testing.assert_array_equal(counterparts(given, omega, own, omega), expected)
    far = omega * [1.0, 1.0, 1.0, 1.0, 1.3]
    np.testing.assert_array_equal(counterparts(given, far, own, omega), expected * [1.0, 1.0, 1.0, 1.0, 0.0])
    mixed = own @ np.linalg.qr(np.ones((5, 5)) + np.eye(5))[0]  # each answers a little like several
    assert np.abs(counterparts(mixed, omega, own, omega)).sum() < 5.0
    assert not counterparts(np.zeros((7, 5)), omega, own, omega).any()


def test_the_first_modes_of_the_solid_have_the_beams_for_counterparts():
    task = resolve_task(scenario="solid-20")
    velocities = seen_from(task.blade, task.design_blade)[20:40, 11:]
    np.testing.assert_allclose(np.abs(velocities[:8, :8]), np.eye(8), atol=1e-6)


@pytest.mark.parametrize("name", SOLIDS)
def test_pictures_and_the_design_see_the_tip_of_the_solid_within_five_percent(name):
    """What the counterparts tell, against the solid's own tip displacement, which is in its file."""
    env = RotatingBeamEnv(scenario=name)
    operator = env.task.blade.displacement_operator([env.task.config.beam.length])[:2, 0]
    seen, drawn, true = [], [], []
    for seed in range(4):
        env.reset(seed=seed, options={"load": {"case": "step", "magnitude": 30.0, "onset": 0.0}})
        for _ in range(200):
            *_, info = env.step(np.zeros(4))
            seen.append(env.design_plant.tip_displacement @ env.design_state)
            drawn.append(operator @ env.state)
            true.append(info["tip_displacement"])
    for told in (seen, drawn):
        assert np.abs(np.array(told) - true).max() < 0.05 * np.abs(true).max()


def test_static_strain_of_the_solid_is_told_within_ten_percent_of_the_beams():
    task = resolve_task(scenario="solid-20")
    strains = [
        np.abs(plant.strain @ np.linalg.solve(plant.A, plant.disturbance_input)).max(axis=0)
        for plant in (task.plant, task.design_plant)
    ]
    np.testing.assert_allclose(*strains, rtol=0.1)


def test_a_files_own_strain_rows_say_when_the_blade_fails(tmp_path):
    strain = np.zeros((1, 20))
    strain[0, 0] = 1.0
    save_plant(replace(SOLID, strain=strain), tmp_path / "strained.npz")
    env = RotatingBeamEnv(scenario={"plants": {"truth": str(tmp_path / "strained.npz")}})
    state = np.zeros(40)
    state[0] = 0.0044 * SOLID.natural_frequencies[0]
    env.reset(options={"initial_state": state})
    with pytest.raises(
        ValueError, match="options.initial_state strains the blade by 0.0055, but must be finite and stay below 0.0045"
    ):
        env.reset(options={"initial_state": 1.25 * state})


@pytest.mark.parametrize("name", SOLIDS)
def test_the_solid_is_drawn(name):
    pytest.importorskip("pygame")
    env = gymnasium.make(f"beamenv/RotatingBeam-{name}-v0", render_mode="rgb_array")
    env.reset(seed=0)
    pictures = []
    for _ in range(2):
        for _ in range(20):
            env.step(np.ones(4))
        pictures.append(env.render())
    assert pictures[0].shape == (540, 960, 3)
    assert not np.array_equal(*pictures)


def test_the_solid_runs_behind_a_history_and_another_design():
    envs = RotatingBeamVectorEnv(3, scenario="solid", design={"speed": 180.0, "modes": 5})
    assert envs.design_plant.natural_frequencies.shape == (5,)
    assert envs.plant.natural_frequencies.shape == (11,)
    env = SensorHistory(RotatingBeamEnv(scenario="solid-20", duration=0.01))
    assert np.isfinite(env.reset(seed=0)[0]).all()


def test_what_a_plant_file_cannot_be_the_truth_of_is_refused(tmp_path):
    for arguments, sentence in (
        ({"speed": 150.0}, "blade.speed is 150.0, but must be that of the plant 'solid-blade', 200 rad/s"),
        (
            {"blade": {"patches": {"actuators": 3}}},
            "truth is 'solid-blade', of 4 voltages and 4 sensors, but must have .* 3 and 4.",
        ),
        ({"blade": {"patches": {"ganged": True}}}, "of 4 voltages and 4 sensors, but must have as many as the blade, 1 and 4."),
    ):
        with pytest.raises(ValueError, match=sentence):
            RotatingBeamEnv(scenario="solid", **arguments)
    save_plant(replace(SOLID, speed=None), tmp_path / "any.npz")
    RotatingBeamEnv(scenario={"plants": {"truth": str(tmp_path / "any.npz")}}, speed=150.0)
    with pytest.raises(ValueError, match="blade.patches cannot be changed where a plant file says how the blade moves"):
        PlacementWrapper(RotatingBeamEnv(scenario="solid"), actuators=[0.0, 0.3, 0.6, 0.9])
    for name, value in (("beam", replace(blade_config().beam, taper=1.5)), ("speed", 150.0)):
        with pytest.raises(ValueError, match=f"blade.{name} cannot be changed"):
            GivenBlade(blade_config(), SOLID).changed(replace(blade_config(), **{name: value}))


@pytest.mark.parametrize("name", SOLIDS)
@pytest.mark.parametrize(
    ("blade", "fields"),
    [
        ({"beam": {"length": 1.0}}, ["beam.length", "patches.actuators", "patches.sensors"]),
        ({"beam": {"taper": 2.0, "width": 0.3}}, ["beam.width", "beam.taper"]),
        ({"beam": {"pretwist_deg": 0.0, "presetting_deg": 5.0}}, ["beam.pretwist_deg", "beam.presetting_deg"]),
        ({"beam": {"hub_radius": 0.0, "depth": 0.06, "thickness": 0.01}}, ["beam.depth", "beam.thickness", "beam.hub_radius"]),
        ({"patches": {"width": 0.05, "material": "PZT"}}, ["patches.material", "patches.width"]),
        ({"patches": {"sensors": [0.0, 0.4, 0.8, 1.2]}}, ["patches.sensors"]),
    ],
)
def test_the_solid_is_refused_as_the_truth_of_a_blade_of_another_shape(name, blade, fields):
    """In one sentence that names every field that differs, and no other."""
    with pytest.raises(ValueError, match="of such a blade is the plant 'solid-blade'") as refusal:
        resolve_task(scenario=name, blade=blade)
    assert re.findall(r"blade\.([a-z_.]+) is", str(refusal.value)) == fields


def test_a_design_for_the_solid_may_have_other_plies_damping_and_modes_and_no_passive_patches():
    other = {"material": "as4-3501-6", "ply_angles_deg": [45] * 6, "shear": "first_order"}
    task = resolve_task(
        scenario="solid", blade={"beam": other, "damping_ratio": 0.02, "modes": 8, "patches": {"passive": False, "actuators": 4}}
    )
    np.testing.assert_array_equal(task.plant.natural_frequencies, SOLID.natural_frequencies[:11])


@pytest.mark.parametrize(
    ("told", "sentence"),
    [
        ('{"beam": {"chord": 1.0}}', "blade.beam has no field 'chord'"),
        ('{"beam": {"length": -1.0}}', "blade.beam.length is -1.0, but must be a number above 0"),
        ("[1.0]", "plant.blade is '.*', but must be empty or the text of a JSON object"),
        ("a blade", "plant.blade is 'a blade', but must be empty or the text of a JSON object"),
    ],
)
def test_a_file_that_tells_of_no_blade_is_refused(told, sentence, tmp_path):
    with pytest.raises(ValueError, match=sentence):
        save_plant(replace(SOLID, blade=told), tmp_path / "told.npz")
        resolve_task(scenario={"plants": {"truth": str(tmp_path / "told.npz")}})


def test_a_scenarios_file_names_a_plant_that_lies_beside_it(tmp_path, monkeypatch):
    (tmp_path / "mine").mkdir()
    save_plant(SOLID.first(3), tmp_path / "mine" / "blade.npz")
    (tmp_path / "mine" / "blade.toml").write_text('[plants]\ntruth = "blade.npz"\n')
    monkeypatch.chdir(tmp_path)
    chosen = scenario("mine/blade.toml")
    assert resolve_task(scenario=chosen).plant.natural_frequencies.shape == (3,)
    assert scenario(chosen.to_dict()) == chosen


@pytest.fixture(name="solids", scope="module")
def _solids():
    return {name: resolve_task(scenario=name) for name in SOLIDS}


@pytest.mark.parametrize("name", SOLIDS)
def test_no_law_costs_less_on_the_solid_than_lqg_that_is_told_it(name, solids):
    true, design = solids[name].plant, solids[name].design_plant
    optimum = stationary_cost(true, lqg(true))
    assert optimum < stationary_cost(true, lqg(true, "continuous", verify=False))
    assert optimum < stationary_cost(true, lqg(design))
    assert optimum < 0.5 * stationary_cost(true, no_control(true))
    assert stationary_cost(true, lqr(true)) < optimum
    law, random = lqg(true), np.random.default_rng(0)
    for size in np.repeat([0.003, 0.03], 5):
        for gains in (("state_gain", "measurement_gain"), ("measurement_input",)):
            changed = {gain: getattr(law, gain) * (1.0 + size * random.normal(size=getattr(law, gain).shape)) for gain in gains}
            assert stationary_cost(true, replace(law, **changed)) > optimum


@pytest.mark.parametrize("name", SOLIDS)
def test_measured_cost_of_lqg_that_is_told_the_solid_is_the_analytic_optimum(name):
    """White noise only, and a drive that never saturates."""
    white = {"preset": name, "step": 0.0, "pulse": 0.0, "deflection": 0.0, "harmonic": 0.0}
    envs = gymnasium.make_vec(beamenv.ENV_ID, EPISODES, scenario=white, duration=DURATION, blade={"voltage_limits": (-1e6, 1e6)})
    plant = envs.unwrapped.plant
    law, memory, cost = lqg(plant), None, np.zeros(EPISODES)
    observation, _ = envs.reset(seed=0)
    for step in range(round(DURATION / plant.control_interval)):
        action, memory = law.predict(observation, memory)
        observation, *_, info = envs.step(action)
        cost += info["cost_increment"] * (step * plant.control_interval >= SETTLE)
    cost /= DURATION - SETTLE
    error = cost.std(ddof=1) / np.sqrt(EPISODES)
    assert error < 0.02 * cost.mean()
    assert abs(cost.mean() - stationary_cost(plant, law)) < SIGMAS * error
