"""Patches sized and placed together: what is known of one patch on a beam, slopes, and a front that can be made and repeated."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from baselines.design.riccati import kalman_filter, regulator
from baselines.placement import Budget, Sizes, SizingProblem, SizingSearch, size, sized_blade
from baselines.placement.sizing.blades import cost_on_plant
from baselines.placement.sizing.designs import Designs, random_designs, repaired, without_overlap
from baselines.placement.sizing.front import Archive, feasible, point, unbeaten
from baselines.placement.sizing.limits import Limits
from baselines.placement.sizing.sheets import SizeGrid
from baselines.placement.sizing.sized_contributions import drive_of
from beamenv.blade.build import Blade, build_plant
from beamenv.blade.presets import blade_config
from beamenv.structure import ALUMINIUM

STRIP = blade_config("aluminium-cantilever")
QUICK = SizingSearch(population=16, generations=4, polished=3, iterations=6)
QUICKEST = SizingSearch(population=8, generations=2, polished=2, iterations=2)


@cache
def problem_of(preset="thesis", model="blade", **budget):
    return SizingProblem.of(blade_config(preset, {"model": model}), Sizes(actuators=2, sensors=2), Budget(**budget))


@cache
def front_of(seed=0, **budget):
    return size(problem_of(**budget), seed, QUICK)


def slope(mode, share):
    """φ′ of Euler and Bernoulli's cantilever at shares of its span."""
    beta = (1.8751040687, 4.6940911330)[mode]
    ratio = (np.cosh(beta) + np.cos(beta)) / (np.sinh(beta) + np.sin(beta))
    return beta * (np.sinh(beta * share) + np.sin(beta * share) - ratio * (np.cosh(beta * share) - np.cos(beta * share)))


@cache
def light_strip():
    """One patch without mass or stiffness on a uniform cantilever."""
    return SizingProblem.of(replace(STRIP, patches=STRIP.patches.without_mass()), Sizes(length=(0.005, 0.3)))


def authority(starts, lengths):
    """(N, modes): force of a patch per volt in every mode."""
    starts, lengths = np.broadcast_arrays(starts, lengths)
    problem, still = light_strip(), np.full(starts.shape, 0.05)
    designs = Designs(
        np.column_stack([starts, still]), np.column_stack([lengths, still]), np.tile(problem.own_sizes, (len(starts), 1))
    )
    return problem.reduced(designs).input[:, STRIP.modes :, 0]


def test_authority_over_a_mode_is_the_difference_of_its_slopes_at_the_patchs_ends():
    """Crawley and de Luis, AIAA Journal 25, 1987, within 2 % of the largest; not at the clamp, which keeps a strip from curling."""
    starts, length = np.linspace(0.05, 0.25, 21), 0.05
    found = authority(starts, length)
    for mode in (0, 1):
        by_hand = slope(mode, (starts + length) / 0.3) - slope(mode, starts / 0.3)
        scale = found[:, mode] @ by_hand / (by_hand @ by_hand)
        assert np.abs(found[:, mode] - scale * by_hand).max() <= 0.02 * np.abs(found[:, mode]).max()


def test_one_patch_belongs_at_the_root_for_the_first_mode():
    assert np.abs(authority(np.linspace(0.0, 0.25, 51), 0.05)[:, 0]).argmax() == 0


def test_for_the_second_mode_it_runs_from_the_node_of_its_curvature_to_the_tip():
    """The greatest difference of slopes (Devasia, Meressi, Paden and Bayo, J. Guidance 16, 1993): φ″ = 0 at 0.2166 L."""
    starts, ends = (each.ravel() for each in np.meshgrid(np.linspace(0.0, 0.29, 59), np.linspace(0.01, 0.3, 59), indexing="ij"))
    there = ends - starts >= 0.005
    best = np.abs(authority(starts[there], (ends - starts)[there])[:, 1]).argmax()
    assert starts[there][best] / 0.3 == pytest.approx(0.2166, abs=0.005 / 0.3)
    assert ends[there][best] / 0.3 > 0.95  # beyond, there is next to no curvature


def test_curvature_over_thickness_is_that_of_a_pair_of_sheets_on_a_strip():
    """κ/Λ of the pair on Euler's beam (Crawley and Anderson, J. Intelligent Material Systems 1, 1990), half as one is driven.

    Its greatest is at the same thickness, and the blade that is made of a design has it within 3 %.
    """
    problem = SizingProblem.of(STRIP, Sizes(length=(0.05, 0.3), width=(0.03, 0.03), thickness=(0.2e-3, 1.6e-3)))
    thicknesses, found = np.array([0.3, 0.5, 0.65, 0.75, 0.85, 1.0, 1.4]) * 1e-3, []
    for thickness in thicknesses:
        design = Designs(np.zeros((1, 2)), np.full((1, 2), 0.3), np.array([[0.03, thickness] * 2]))
        blade = Blade(sized_blade(problem, point(problem, design, 0.0)))
        static = np.linalg.solve(blade.beam.at(0.0).stiffness, blade.full.forces[:, 0])
        strain = STRIP.patches.only("actuators").patch.d11 / thickness  # of a volt
        found.append(np.abs(blade.full.tip @ static).max() * 2.0 / 0.3**2 / abs(strain))
    beam, ratio = 0.002, 0.002 / thicknesses
    stiffer = ALUMINIUM.E1 * 16.1e-12 * ratio
    by_hand = 6.0 * (1.0 + 1.0 / ratio) * (2.0 / beam) / (stiffer + 6.0 + 12.0 / ratio + 8.0 / ratio**2) / 2.0
    assert found == pytest.approx(by_hand, rel=0.03)
    assert np.argmax(found) == np.argmax(by_hand) == 3


@pytest.mark.parametrize(("preset", "model"), [("thesis", "blade"), ("thesis", "thesis"), ("aluminium-cantilever", "blade")])
def test_slopes_by_place_length_width_and_thickness_are_central_differences(preset, model):
    config = blade_config(preset, {"model": model})
    problem = SizingProblem.of(config, None if preset == "aluminium-cantilever" else Sizes(actuators=2, sensors=2))
    design = random_designs(problem.limits, 8, np.random.default_rng(4))[[5]]
    cost, slopes = problem.cost_and_slopes(design)
    steps = np.append(np.full(len(slopes) - 4, 5e-5), 1e-2 * problem.limits.least_sizes)
    numeric = []
    for direction in np.diag(steps):
        at = [problem.cost_and_slopes(Designs.of_rows(design.rows + k * direction))[0] for k in (-2, -1, 1, 2)]
        numeric.append((at[0] - 8.0 * at[1] + 8.0 * at[2] - at[3]) / 12.0)
    per_step = slopes * steps
    assert cost == pytest.approx(problem.cost(design)[0], rel=2e-8)
    assert np.abs(per_step - numeric).max() <= 1e-4 * np.abs(per_step).max()


@pytest.mark.parametrize(
    ("preset", "model", "within"),
    [("thesis", "thesis", 1e-4), ("thesis", "blade", 0.02), pytest.param("sound-blade", "blade", 0.02, marks=pytest.mark.slow)],
)
def test_cost_is_that_of_the_plant_built_of_the_design(preset, model, within):
    """With the sizing's weight of voltages. In the thesis' model only the polynomials in width and thickness are in between."""
    problem = problem_of(preset, model)
    designs = random_designs(problem.limits, 3, np.random.default_rng(5))
    for k, cost in enumerate(problem.cost(designs).tolist()):
        design = point(problem, designs[[k]], cost)
        plant = build_plant(sized_blade(problem, design))
        weight = problem.drive_weight / drive_of(problem.config, design.actuators.thickness) ** 2 * np.eye(plant.B.shape[1])
        P, K = regulator(plant.A, plant.B, plant.state_weight, weight)
        loads = plant.disturbance_input @ plant.process_noise @ plant.disturbance_input.T
        S, _ = kalman_filter(plant.A, plant.C, loads, plant.sensor_noise)
        by_hand = np.trace(P @ loads) + np.trace(S @ K.T @ weight @ K)
        assert cost == pytest.approx(by_hand, rel=within)
        assert cost_on_plant(problem, design) == pytest.approx(by_hand, rel=1e-9)


def test_a_patch_of_no_length_is_none():
    problem, fewer = problem_of(), SizingProblem.of(blade_config(), Sizes(actuators=1, sensors=2))
    sizes = problem.own_sizes[None]
    with_none = Designs(np.array([[0.1, 0.4, 0.2, 0.8]]), np.array([[0.1, 0.0, 0.09, 0.12]]), sizes)
    without = Designs(np.array([[0.1, 0.2, 0.8]]), np.array([[0.1, 0.09, 0.12]]), sizes)
    assert problem.cost(with_none)[0] == pytest.approx(fewer.cost(without)[0], rel=1e-8)


def test_mass_and_power_are_those_of_the_sheets():
    """Eight patches of an M-8557-P1's size, 5440 kg/m³; ½CV²f of four, at 14.5 nF, 1500 V and 10 Hz."""
    problem = SizingProblem.of(blade_config(), budget=Budget(frequency=10.0))
    own = problem.own()
    assert problem.mass(own)[0] == pytest.approx(8 * 5440.0 * 0.085 * 0.057 * 0.3e-3)
    assert problem.power(own)[0] == pytest.approx(4 * 0.5 * 0.30e-9 * 48.45 * 1500.0**2 * 10.0)


def test_power_is_that_of_the_larger_voltage_of_either_sign():
    of = [SizingProblem.of(blade_config("thesis", {"voltage_limits": limits})) for limits in ((-500.0, 1500.0), (-1500.0, 500.0))]
    assert of[0].power_per_volume == of[1].power_per_volume > 0.0


def test_blade_of_larger_sensors_has_a_larger_range_and_the_noise_of_the_problem():
    problem = problem_of()
    sizes = problem.limits.largest_sizes[None]
    design = Designs(np.array([[0.0, 0.3, 0.0, 0.3]]), np.full((1, 4), problem.limits.length[1]), sizes)
    blade = sized_blade(problem, point(problem, design, 0.0))
    assert blade.sensor_full_scale > problem.config.sensor_full_scale
    np.testing.assert_allclose(build_plant(blade).sensor_noise, problem.sensor_noise * np.eye(2), rtol=1e-12)


def test_repaired_designs_can_be_made_and_what_can_be_made_stays():
    problem, generator = problem_of(), np.random.default_rng(0)
    wild = Designs(generator.uniform(-1, 2, (200, 4)), generator.uniform(0, 2, (200, 4)), generator.uniform(0, 0.3, (200, 4)))
    mended = repaired(wild, problem.limits)
    assert feasible(problem, mended) and np.all(mended.channels(problem.limits) >= 1)
    assert repaired(mended, problem.limits).rows == pytest.approx(mended.rows, abs=1e-12)


def test_polynomials_between_sizes_are_exact_for_what_is_quadratic():
    grid = SizeGrid((0.02, 0.1), (1e-4, 6e-4), (3, 3))
    sizes = np.array([[0.03, 2e-4], [0.09, 5e-4]])
    values = (grid.nodes[:, 0] * grid.nodes[:, 1]) ** 2
    assert grid.weights(sizes) @ values == pytest.approx((sizes[:, 0] * sizes[:, 1]) ** 2, rel=1e-12)
    by_width = grid.weight_slopes(sizes)[:, 0] @ values
    assert by_width == pytest.approx(2.0 * sizes[:, 0] * sizes[:, 1] ** 2, rel=1e-10)


def test_sheets_grow_and_shrink_until_an_edge_comes_to_a_web():
    """A NACA 0012 with a web at 0.4 of its chord: sheets of 18 mm in the middle of a wall would end on it."""
    above, below = Limits.of(blade_config("airfoil-blade"), Sizes(), None).widths
    assert above == pytest.approx((0.0189, 0.056), abs=1e-4)
    assert below == pytest.approx(above)
    assert Limits.of(blade_config("thesis"), Sizes(), None).widths[0] == (0.5 * 0.057, 2.0 * 0.057)


def test_every_point_of_the_front_can_be_made_and_paid_and_none_betters_another():
    budget = {"mass": 0.04, "power": 1.0, "channels": 1}
    problem, front = problem_of(**budget), front_of(**budget)
    assert front.complete and len(front.points) >= 3
    mass, cost = (np.array([getattr(each, name) for each in front.points]) for name in ("mass", "cost"))
    assert np.all(np.diff(mass) > 0.0) and np.all(np.diff(cost) < 0.0)
    for each in front.points:
        assert each.mass <= 0.04 * (1.0 + 1e-9) and each.power <= 1.0 * (1.0 + 1e-9) and each.channels == 1
        blade = sized_blade(problem, each)
        assert build_plant(blade).B.shape[1] == 1
        assert len(blade.patches.groups("sensors")) >= 1


def test_the_same_seed_finds_the_same_front():
    fronts = [size(problem_of(), seed, QUICKEST) for seed in (0, 0, 1)]
    assert fronts[0] == fronts[1] != fronts[2]


def test_the_front_is_below_the_blades_own_layout():
    """Two and two patches of any size, against four and four of the blade's own."""
    four = SizingProblem.of(blade_config())
    lighter = [each.cost for each in front_of().points if each.mass <= four.mass(four.own())[0]]
    assert min(lighter) < four.cost(four.own())[0]


def test_what_was_found_before_an_interruption_is_kept():
    problem = problem_of()

    def interrupt(done, _):
        if done > 0.2:
            raise KeyboardInterrupt

    archive = Archive(problem, interrupt)
    with pytest.raises(KeyboardInterrupt):
        size(problem, 0, QUICK, archive=archive)
    front = archive.front(0, complete=False)
    assert front.points and not front.complete
    assert feasible(problem, archive.designs) and without_overlap(archive.designs, problem.limits)


def test_of_equal_designs_the_first_is_kept():
    assert unbeaten(np.array([2.0, 1.0, 1.0, 3.0]), np.array([1.0, 2.0, 2.0, 1.0])).tolist() == [1, 0]


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        (
            {"budget": {"mass": 1e-4}},
            r"budget\.mass is 0\.0001, but must be at least 0\.001977 kg, the smallest actuator and sensor",
        ),
        (
            {"budget": {"power": 1e-4}},
            r"budget\.power is 0\.0001, but must be at least 0\.0\d+ W, what the smallest actuator draws",
        ),
        ({"budget": {"mass": -1.0}}, r"budget\.mass is -1\.0, but must be"),
        ({"budget": {"channels": 0}}, r"budget\.channels is 0, but must be None or a whole number not below 1"),
        (
            {"sizes": {"length": (0.2, 0.1)}},
            r"sizes\.length is \(0\.2, 0\.1\), but must be the least first, then the largest \(m\)",
        ),
        ({"sizes": {"length": (0.2, 5.0)}}, r"sizes\.length is .* but must be at most the 1\.4161 m that patches may lie on"),
        ({"sizes": {"width": (0.05, 0.5)}}, r"sizes\.width is \[0\.05, 0\.5\], but must be between 0\.01425 and 0\.228 m"),
        (
            {"blade": {"beam": {"taper": 2.0}}, "sizes": {"width": (0.05, 0.2)}},
            r"width is 0\.2, but must be positive and at most the top wall's 0\.127 m",
        ),
        (
            {"sizes": {"thickness": (0.001, 0.02)}},
            r"sizes\.thickness is \[0\.001, 0\.02\], but must be between 7\.5e-05 and 0\.0012 m",
        ),
        ({"sizes": {"length": (1e-9, 0.1)}}, r"length is 1e-09, but must be above"),
        ({"blade": {"patches": {"ganged": True}}}, r"blade\.patches\.ganged is True, but must be False"),
        ({"blade": {"white_load": 0.0}}, r"white_load = 0\.0 must be positive"),
        ({"blade": {"sensors": [{"kind": "accelerometer"}]}}, r"config\.sensors is \['accelerometer'\], but must be empty"),
    ],
)
def test_what_buys_nothing_or_does_not_fit_is_refused_in_one_sentence(given, sentence):
    with pytest.raises(ValueError, match=sentence):
        config = blade_config("thesis", given.get("blade", {}))
        SizingProblem.of(config, Sizes(**given.get("sizes", {})), Budget(**given.get("budget", {})))


def test_power_of_sheets_of_unknown_permittivity_is_refused():
    unknown = replace(STRIP.patches.only("actuators").patch, permittivity=None)
    groups = tuple(replace(STRIP.patches.only(side), material=unknown) for side in ("actuators", "sensors"))
    config = replace(STRIP, patches=replace(STRIP.patches, actuators=groups[:1], sensors=groups[1:]))
    assert SizingProblem.of(config).power(SizingProblem.of(config).own()) is None
    with pytest.raises(ValueError, match=r"budget\.power is 1\.0, but must be None where the actuators' permittivity is unknown"):
        SizingProblem.of(config, budget=Budget(power=1.0))


@pytest.mark.slow
def test_areas_under_the_fronts_of_several_seeds_differ_by_a_per_cent_at_most():
    """In logarithms of mass and cost, up to the heaviest design and the dearest."""
    problem = SizingProblem.of(blade_config())
    fronts = [size(problem, seed) for seed in (0, 1)]
    dearest, heaviest = (max(getattr(each, name) for front in fronts for each in front.points) for name in ("cost", "mass"))
    areas = []
    for front in fronts:
        mass, cost = (np.log([getattr(each, name) for each in front.points]) for name in ("mass", "cost"))
        areas.append(np.diff(np.append(mass, np.log(heaviest))) @ (np.log(dearest) - cost))
    assert areas[0] == pytest.approx(areas[1], rel=0.01)


@pytest.mark.parametrize("preset", ["aluminium-cantilever", pytest.param("chandra-chopra", marks=pytest.mark.slow)])
def test_strips_and_small_boxes_have_fronts_too(preset):
    problem = SizingProblem.of(blade_config(preset), Sizes(actuators=1, sensors=1))
    front = size(problem, 0, QUICK)
    assert front.points[-1].cost < 0.7 * front.points[0].cost
    assert build_plant(sized_blade(problem, front.points[-1])).C.shape[0] == 1
