"""Patches put elsewhere in an environment, single and batched."""

import copy
from dataclasses import replace

import gymnasium
import numpy as np
import pytest
from gymnasium.envs.registration import EnvSpec
from gymnasium.utils.env_checker import check_env

from baselines import lqg, reference_lqg
from baselines.placement import PlacementProblem, place
from baselines.placement.optimal import kept_layout
from baselines.placement.search.genetic import Genetic
from beamenv import ENV_ID, PlacementWrapper, SensorHistory, blade_config, build_plant
from beamenv.blade.bounds import Bounds
from beamenv.blade.build import Blade
from tests.placement.elsewhere import ELSEWHERE, wrapped


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("BEAMENV_CACHE", str(tmp_path))
    kept_layout.cache_clear()


def test_the_plant_is_the_one_with_patches_there():
    env = wrapped(**ELSEWHERE)
    positions = {side: tuple(values) for side, values in ELSEWHERE.items()}
    expected = Blade(blade_config(overrides={"patches": positions}))
    assert env.reset(seed=0)[1]["layout"] == positions
    ours, theirs = env.unwrapped.design_plant, expected.plant
    np.testing.assert_allclose(env.unwrapped.plant.natural_frequencies, expected.truth.natural_frequencies, rtol=1e-9)
    np.testing.assert_allclose(np.abs(ours.B), np.abs(theirs.B), rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(np.abs(ours.C), np.abs(theirs.C), rtol=1e-6, atol=1e-9)


def test_as_they_were_means_as_without_the_wrapper():
    plain, same = gymnasium.make(ENV_ID, duration=0.02), wrapped()
    np.testing.assert_allclose(plain.reset(seed=3)[0], same.reset(seed=3)[0], rtol=0.0, atol=1e-9)
    for k in range(10):
        action = np.full(4, 0.1 * k)
        np.testing.assert_allclose(plain.step(action)[0], same.step(action)[0], rtol=0.0, atol=1e-9)


def test_spaces_follow_the_number_of_patches():
    env = wrapped(actuators=[0.0, 0.3], sensors=5)
    assert env.action_space.shape == (2,) and env.observation_space.shape == (5,)
    with pytest.warns(UserWarning, match="different from the unwrapped version"):
        check_env(env, skip_render_check=True)


def test_data_acquisition_stays_when_sensors_move():
    before = gymnasium.make(ENV_ID).unwrapped.plant
    env = wrapped(sensors=[0.6, 0.8, 1.0, 1.2])
    assert np.array_equal(env.unwrapped.plant.sensor_full_scale, before.sensor_full_scale)
    assert np.array_equal(env.unwrapped.plant.sensor_noise, before.sensor_noise)


@pytest.mark.parametrize(
    ("name", "side", "expected"),
    [
        ("uniform", "actuators", [0.0, 0.4437, 0.88740, 1.3311]),
        ("thesis-table-6.3", "actuators", [0.0, 0.085, 0.27287, 0.42733]),  # printed 0.00624 and 0.07821: 72 mm apart
        ("thesis-table-6.4", "sensors", [0.0, 0.085, 0.17, 0.255]),
    ],
)
def test_layouts_have_names(name, side, expected):
    assert wrapped(**{side: name}).reset()[1]["layout"][side] == pytest.approx(expected, abs=1e-4)


def test_thesis_layout_follows_speed_and_number():
    env = PlacementWrapper(gymnasium.make(ENV_ID, speed=0.0, blade={"patches": {"actuators": 2}}), actuators="thesis-table-6.3")
    assert env.reset()[1]["layout"]["actuators"] == pytest.approx((0.00948, 0.70742))


def test_optimal_layout_is_found_once_and_kept(monkeypatch, tmp_path):
    """A search in small; the second environment reads what the first wrote."""
    import baselines.placement.optimal as optimal

    monkeypatch.setattr(optimal, "METHOD", Genetic(population=6, generations=2))
    monkeypatch.setattr(optimal, "_kept_in", lambda config: tmp_path / "layout.json")
    first = wrapped(actuators="optimal", sensors="optimal").reset()[1]["layout"]
    kept_layout.cache_clear()
    monkeypatch.setattr(optimal, "computed_layout", lambda config: pytest.fail("worked out again"))
    assert wrapped(actuators="optimal", sensors="optimal").reset()[1]["layout"] == first
    assert PlacementProblem.of(blade_config(), "actuators").bounds.checked(first["actuators"]).tolist() == list(first["actuators"])


def test_optimal_layout_does_not_depend_on_where_the_patches_are():
    import baselines.placement.optimal as optimal

    here, elsewhere = (blade_config(overrides={"patches": {"actuators": edges}}) for edges in ([0.0, 0.15], [0.2, 0.6]))
    found = optimal.optimal_positions(elsewhere, "actuators")
    assert found == optimal.optimal_positions(here, "actuators")
    assert found == place(PlacementProblem.of(here, "actuators")).positions


def test_a_range_is_drawn_from_at_each_reset():
    env = wrapped(actuators={"low": 0.1, "high": 0.8}, sensors={"count": 2})
    bounds = Bounds.of(blade_config().patches, 2.023, 4, (0.1, 0.8), "actuators")
    layouts = [env.reset(seed=7)[1]["layout"], *(env.reset()[1]["layout"] for _ in range(3))]
    assert len({layout["actuators"] for layout in layouts}) == 4
    for layout in layouts:
        bounds.checked(layout["actuators"])
        assert len(layout["sensors"]) == 2
    again = wrapped(actuators={"low": 0.1, "high": 0.8}, sensors={"count": 2})
    assert again.reset(seed=7)[1]["layout"] == layouts[0] and again.reset()[1]["layout"] == layouts[1]
    assert env.action_space.shape == (4,) and env.observation_space.shape == (2,)


def test_reset_changes_the_layout_from_then_on():
    env = wrapped()
    _, info = env.reset(seed=0, options={"layout": ELSEWHERE})
    assert info["layout"]["sensors"] == tuple(ELSEWHERE["sensors"])
    assert env.reset()[1]["layout"] == info["layout"] == env.step(np.zeros(4))[4]["layout"]
    env.reset(options={"layout": "uniform", "load": {"case": "step"}})
    np.testing.assert_allclose(env.unwrapped.design_plant.B, gymnasium.make(ENV_ID).unwrapped.design_plant.B, rtol=1e-6, atol=1e-9)


def test_controllers_are_made_from_the_plant_of_the_layout():
    """It damps there, and is another law than where the patches were."""
    env = PlacementWrapper(gymnasium.make(ENV_ID, duration=0.4), **ELSEWHERE)
    gain, elsewhere = (lqg(plant).state_gain for plant in (env.unwrapped.design_plant, build_plant(blade_config())))
    assert np.abs(gain - elsewhere).max() > 0.1 * np.abs(elsewhere).max()
    controller = reference_lqg(env.unwrapped.plant)  # the design, on the nominal blade

    def cost(act):
        observation, _ = env.reset(seed=1, options={"load": {"case": "deflection", "magnitude": 5.0}})
        total, state = 0.0, None
        for _ in range(800):
            action, state = act(observation, state)
            observation, reward, *_ = env.step(action)
            total -= reward
        return total

    assert cost(controller.predict) < 0.99 * cost(lambda observation, state: (np.zeros(4), state))


@pytest.mark.parametrize(
    ("layout", "sentence"),
    [
        ("nowhere", "actuators is 'nowhere', but must be one of uniform, thesis-table-6.3, optimal"),
        (
            {"actuators": "thesis-table-6.4"},
            "actuators is 'thesis-table-6.4' .*, but must be one of uniform, thesis-table-6.3, optimal",
        ),
        ({"actuators": [0.0, 0.01, 0.3, 0.6]}, "must be at least one patch length, 0.085 m, apart"),
        ({"actuators": [0.0, 0.2, 0.3, 2.0]}, "between 0 and 1.3311 m"),
        ({"sensors": [0.0, 0.2, 0.3, float("nan")]}, "must be .* one or more finite positions"),
        ({"sensors": [0.0, 0.2]}, r"options\['layout'\] has 2 sensors, but the spaces are made for 4"),
        ({"sensors": {"low": 1.3}}, "sensors is 4, but must be at most 1, for patches of 0.085 m"),
        ({"sensors": {"from": 1.3}}, "sensors has no field 'from': its fields are low, high, count"),
        ({"top": [0.0]}, "layout has no field 'top': its fields are actuators, sensors"),
        (4, "layout is 4, but must be a name or a mapping"),
    ],
)
def test_a_bad_layout_is_refused_and_nothing_has_changed(layout, sentence):
    env = wrapped()
    env.reset(seed=0)
    before = env.unwrapped.plant
    with pytest.raises(ValueError, match=sentence):
        env.reset(options={"layout": layout})
    assert env.unwrapped.plant is before
    env.step(np.zeros(4))


def test_other_bad_options_leave_the_layout_alone():
    env = wrapped()
    env.reset(seed=0)
    with pytest.raises(ValueError, match="'lode'"):
        env.reset(options={"layout": ELSEWHERE, "lode": {}})
    assert env.step(np.zeros(4))[4]["layout"]["sensors"] != tuple(ELSEWHERE["sensors"])


def test_works_as_an_additional_wrapper_and_round_trips_through_json():
    spec = copy.deepcopy(gymnasium.spec(ENV_ID))
    spec.additional_wrappers = (
        PlacementWrapper.wrapper_spec(actuators=[0.0, 0.3], sensors="uniform"),
        SensorHistory.wrapper_spec(),
    )
    env = gymnasium.make(spec)
    again = gymnasium.make(EnvSpec.from_json(env.spec.to_json()))
    assert env.observation_space.shape == (12 * (4 + 2),)
    assert np.array_equal(env.reset(seed=2)[0], again.reset(seed=2)[0])


@pytest.mark.parametrize("side", ["actuators", "sensors"])
def test_the_side_with_several_groups_is_named_where_the_best_layout_is_asked_for(side):
    config = blade_config("airfoil-blade")
    group = config.patches.groups("actuators")[0]
    several = replace(config, patches=replace(config.patches, actuators=(group, replace(group, face="inner"))))
    with pytest.raises(ValueError, match="^blade.patches.actuators has 2 groups, but must have one where patches are to be placed"):
        PlacementWrapper(gymnasium.make(ENV_ID, blade=several), **{side: "optimal"})


def test_actuators_move_where_listed_sensors_stay(monkeypatch, tmp_path):
    import baselines.placement.optimal as optimal

    monkeypatch.setattr(optimal, "METHOD", Genetic(population=6, generations=2))
    monkeypatch.setattr(optimal, "_kept_in", lambda config: tmp_path / f"{hash(config)}.json")
    for blade in (
        {"sensors": [{"kind": "accelerometer"}, {"kind": "charge"}]},
        {"patches": {"sensors": []}, "sensors": [{"kind": "accelerometer"}]},
    ):
        made = gymnasium.make(ENV_ID, preset="aluminium-cantilever", blade=blade, duration=0.02)
        before = made.unwrapped.plant
        env = PlacementWrapper(made, actuators="optimal")
        observation, info = env.reset(seed=0)
        assert info["layout"]["actuators"] != (0.01,)
        assert info["layout"]["sensors"] == blade_config("aluminium-cantilever", blade).patches.sensor_positions(0.3)
        assert np.array_equal(before.sensor_full_scale, env.unwrapped.plant.sensor_full_scale)
        assert env.observation_space.contains(env.step(env.action_space.sample())[0])


def test_a_side_without_patches_is_named():
    blade = {"patches": {"sensors": []}, "sensors": [{"kind": "accelerometer"}]}
    for sensors, sentence in (
        ("uniform", "blade.patches.sensors has 0 groups, but must have one where patches are to be placed"),
        ("optimal", "blade.patches.sensors has 0 groups"),
        ([0.1], r"blade.patches.sensors is \[0.1\], but must be left out where the blade has none of them"),
    ):
        with pytest.raises(ValueError, match=sentence):
            PlacementWrapper(gymnasium.make(ENV_ID, preset="aluminium-cantilever", blade=blade), sensors=sensors)
