"""Plants are shared, so nobody can write to them; and each says in one line what it is."""

import copy
import pickle
import re
from collections.abc import Mapping
from dataclasses import fields, replace

import numpy as np
import pytest

from beamenv import PRESETS, SCENARIOS, BoxSection, Layup, RotatingBeamEnv, load_plant
from beamenv.blade.build import Blade, build_beam, build_plant
from beamenv.blade.config import MATERIALS
from beamenv.blade.presets import blade_config
from beamenv.patches.material import PATCH_MATERIALS
from beamenv.plant.plant import sample
from beamenv.plant.reduction import truncate
from beamenv.simulation.kernel import Operators
from beamenv.simulation.plants.speed_family import speed_family
from beamenv.structure import GRAPHITE_EPOXY
from beamenv.structure.section.elements import inverse_vandermonde, lobatto_nodes
from beamenv.structure.stations import gauss_rule, remaining_integrals
from beamenv.structure.trial_functions import legendre_derivative
from beamenv.structure.walls.laminate import Laminate, Ply, wall_law
from beamenv.task import resolve_task

CONFIG = blade_config()


def bank_of(scenario):
    return resolve_task(scenario=scenario, duration=0.01).bank


SHARED = {
    "plant": lambda: build_plant(CONFIG),
    "sampled plant": lambda: sample(build_plant(CONFIG)),
    "modal model": lambda: truncate(build_beam(CONFIG), 200.0, 11),
    "bank of one": lambda: bank_of("nominal"),
    "bank": lambda: bank_of({"preset": "off-model", "plants": {"bank": 3}}),
    "spin-up": lambda: bank_of("spin-up"),
}


def arrays_of(shared):
    values = [getattr(shared, each.name) for each in fields(shared)]
    values += [value.fused for value in values if isinstance(value, Operators)]
    return [value for value in values if isinstance(value, np.ndarray)]


@pytest.mark.parametrize("kind", SHARED)
@pytest.mark.parametrize(
    "through", [lambda shared: shared, copy.deepcopy, lambda shared: pickle.loads(pickle.dumps(shared)), replace]
)
def test_no_array_of_what_is_shared_can_be_written_to(kind, through):
    shared = through(SHARED[kind]())
    assert len(arrays_of(shared)) >= 3
    for values in arrays_of(shared):
        with pytest.raises(ValueError, match="read-only"):
            values[...] = 0.0


KEPT = {
    "Gauss's rule": lambda: gauss_rule(7),
    "derivatives": lambda: (legendre_derivative(7),),
    "integrals to the end": lambda: (remaining_integrals(7),),
    "Lobatto's nodes": lambda: (lobatto_nodes(3),),
    "shapes of an element": lambda: inverse_vandermonde(3),
    "shipped plant": lambda: arrays_of(load_plant("solid-blade")),
    "wall": lambda: arrays_of(wall_law(Laminate((-1e-3, 1e-3), (Ply(GRAPHITE_EPOXY, 30.0),)))),
}


@pytest.mark.parametrize("kind", KEPT)
def test_no_array_kept_from_call_to_call_can_be_written_to(kind):
    assert len(KEPT[kind]()) > 0
    for values in KEPT[kind]():
        with pytest.raises(ValueError, match="read-only"):
            values[...] = 0.0


def test_nobody_changes_the_blade_under_an_environment():
    env = RotatingBeamEnv()
    with pytest.raises(ValueError, match="read-only"):
        env.plant.B[...] *= 3.0


def test_a_plant_keeps_its_numbers_when_the_array_it_was_made_of_changes():
    doubled = 2.0 * build_plant(CONFIG).C
    plant = replace(build_plant(CONFIG), C=doubled)
    before = doubled.copy()
    doubled[:] = 0.0
    np.testing.assert_array_equal(plant.C, before)


@pytest.mark.parametrize("kind", ["plant", "sampled plant", "bank of one", "bank", "spin-up"])
def test_each_says_in_one_line_what_it_is(kind):
    told = repr(SHARED[kind]())
    assert "\n" not in told and len(told) < 120
    assert re.search(r"\d\d states, 4 voltages, 4 sensors; .*rad/s; 0\.5 ms", told)


def test_a_plant_tells_its_first_and_last_frequency_its_clock_and_its_limits():
    plant = replace(build_plant(CONFIG), voltage_limits=np.array([[-500.0] * 4, [1500.0] * 4]))
    first, last = plant.natural_frequencies[[0, -1]]
    assert repr(plant) == f"Plant(22 states, 4 voltages, 4 sensors; {first:.4g} … {last:.4g} rad/s; 0.5 ms; -500 … 1500 V)"


def kept_arrays(root, path, seen):
    """Every array that can be reached from an object, with the way to it."""
    if id(root) in seen or root is None or isinstance(root, (str, bytes, int, float, type)) or callable(root):
        return
    seen[id(root)] = root
    if isinstance(root, np.ndarray):
        yield path, root
    elif isinstance(root, Mapping):
        for key, value in root.items():
            yield from kept_arrays(value, f"{path}[{key!r}]", seen)
    elif isinstance(root, (list, tuple)):
        for value in root:
            yield from kept_arrays(value, f"{path}[]", seen)
    else:
        slots = [name for cls in type(root).__mro__ for name in getattr(cls, "__slots__", ())]
        for name in dict.fromkeys([*getattr(root, "__dict__", {}), *slots]):
            yield from kept_arrays(getattr(root, name, None), f"{path}.{name}", seen)


def used_blade(model):
    blade = Blade(blade_config(overrides={"model": model, "modes": 5, "truth_modes": 8}))
    blade.plant, blade.truth, blade.full, blade.at_rest, blade.beam.modes(10.0)  # noqa: B018 - so that they are there
    blade.displacement_operator([1.0]), blade.beam.surface_strain([1.0], 200.0), blade.beam.steady_strain([1.0], 10.0)
    return blade


LAYUP = Layup.uniform(GRAPHITE_EPOXY, [30] * 6)
REACHED = {
    "a blade": lambda: used_blade("blade"),
    "a blade of the thesis": lambda: used_blade("thesis"),
    "a task": lambda: (task := resolve_task(scenario="failure", duration=0.01), task.bank),
    "a task of a solid": lambda: (task := resolve_task(scenario="solid", duration=0.01), task.bank),
    "a design": lambda: (design := RotatingBeamEnv().design, design.full_plant),
    "a section": lambda: BoxSection(0.254, 0.0508, 0.01016).properties(LAYUP),
    "presets, scenarios, materials": lambda: (PRESETS, SCENARIOS, MATERIALS, PATCH_MATERIALS, load_plant("solid-blade")),
    "speeds": lambda: speed_family(CONFIG, [190.0, 200.0]),
}


@pytest.mark.parametrize("kind", REACHED)
def test_no_array_that_a_user_can_reach_and_others_share_can_be_written_to(kind):
    writable = [path for path, values in kept_arrays(REACHED[kind](), kind, {}) if values.flags.writeable and values.size]
    assert writable == []


@pytest.mark.parametrize("shared", [PRESETS, SCENARIOS, MATERIALS, PATCH_MATERIALS])
def test_what_names_mean_cannot_be_changed(shared):
    with pytest.raises(TypeError):
        shared["mine"] = next(iter(shared.values()))
