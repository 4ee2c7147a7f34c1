"""One rule for each sort of value, whatever table it stands in."""

import copy
import json
import pickle
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from beamenv.blade import BeamConfig, BladeConfig, blade_config, from_dict, load_config, to_dict
from beamenv.blade.build import Blade, build_plant
from beamenv.configuration import Count, Flag, Number, Numbers, Patches, Range, Refused, Table, Texts, checked, read
from beamenv.patches import PatchLayout
from beamenv.scenarios.scenario import SCENARIOS, Scenario, scenario
from beamenv.structure import AS4_3501_6, GRAPHITE_EPOXY, Lamina

NAN = float("nan")
ARRAY = np.array([1.0, 2.0])


@pytest.mark.parametrize("value", [3, 3.0, np.float32(3), np.float64(3), np.longdouble(3), np.int8(3), np.uint64(3), np.array(3.0)])
def test_a_number_is_python_s_or_numpy_s_and_becomes_a_float(value):
    assert type(checked("x", value, Number(gt=0.0))) is float
    assert checked("x", value, Number(gt=0.0)) == 3.0


@pytest.mark.parametrize("value", [True, np.True_, "3", b"3", NAN, np.inf, 3 + 0j, np.complex128(3), [3], ARRAY, None, {}, 10**400])
def test_what_is_no_number_is_refused(value):
    with pytest.raises(ValueError, match="^x is .*, but must be a positive number [(]m[)][.]$"):
        checked("x", value, Number(gt=0.0, unit="m"))


@pytest.mark.parametrize("value", [11, 11.0, np.int32(11), np.uint8(11), np.float32(11.0), np.array(11)])
def test_a_count_is_an_integer_or_a_float_without_a_fraction(value):
    assert type(checked("n", value, Count(1, 30))) is int
    assert checked("n", value, Count(1, 30)) == 11


@pytest.mark.parametrize("value", [11.5, True, "11", NAN, np.inf, 0, 31, [11], None, 11 + 0j])
def test_what_is_no_count_is_refused(value):
    with pytest.raises(ValueError, match="^n is .*, but must be a whole number from 1 to 30[.]$"):
        checked("n", value, Count(1, 30))


def test_an_integral_float_is_the_same_blade_whatever_was_built_before():
    first, second = blade_config(overrides={"modes": 9.0}), blade_config(overrides={"modes": 9})
    assert type(first.modes) is int
    assert (first, hash(first), repr(first)) == (second, hash(second), repr(second))


@pytest.mark.parametrize("value", [True, np.True_, np.array(True)])
def test_true_is_true(value):
    assert checked("on", value, Flag()) is True


@pytest.mark.parametrize("value", ["no", "true", 1, 0, 1.0, None, [], [True]])
def test_what_is_neither_true_nor_false_is_refused(value):
    with pytest.raises(ValueError, match="^on is .*, but must be True or False[.]$"):
        checked("on", value, Flag())


@pytest.mark.parametrize("value", [[1, 2], (1, 2), ARRAY, (np.float32(1), 2), np.array([1, 2])])
def test_a_sequence_is_a_list_a_tuple_or_an_array(value):
    assert checked("xs", value, Numbers()) == (1.0, 2.0)
    assert checked("xs", value, Range()) == (1.0, 2.0)
    assert checked("xs", value, Patches()) == (1.0, 2.0)


@pytest.mark.parametrize("value", ["12", b"12", {1: 2}, {1.0, 2.0}, np.eye(2), [1, "2"], [1, NAN], [1, True], ARRAY * 1j, 5])
def test_what_is_no_sequence_of_numbers_is_refused(value):
    with pytest.raises(ValueError, match="^xs is .*, but must be a list of numbers, each a finite number[.]$") as told:
        checked("xs", value, Numbers())
    assert "\n" not in str(told.value)


def test_one_number_means_both_ends_of_a_range_and_a_range_does_not_fall():
    assert checked("r", 2, Range(0.0)) == (2.0, 2.0)
    assert checked("r", [2.0, 3], Range(0, 9, whole=True)) == (2, 3)
    for wrong in ([2.0, 1.0], [1.0], [1.0, 2.0, 3.0], "12", [-1.0, 2.0], NAN, True):
        with pytest.raises(ValueError, match="^r is .*, but must be a number or a range"):
            checked("r", wrong, Range(0.0))


def test_keys_are_strings():
    for wrong in ({3: 1.0}, [("a", 1)], "a", 3):
        with pytest.raises(ValueError, match="^t is .*, but must be a mapping of names to values"):
            checked("t", wrong, Table())
    with pytest.raises(ValueError, match="^blade has no field 3: its fields are beam, patches"):
        blade_config(overrides={3: 1.0})


def test_paths_are_taken_for_their_names():
    assert checked("files", [Path("a") / "b.toml", "delay"], Texts()) == (str(Path("a") / "b.toml"), "delay")
    with pytest.raises(ValueError, match="^files is 'delay', but must be a list of strings"):
        checked("files", "delay", Texts())


SENTENCES = [
    (
        lambda: blade_config(overrides={"beam": {"length": [1.0]}}),
        "blade.beam.length is [1.0], but must be a number above 0 and at most 250 (m).",
    ),
    (lambda: BeamConfig(-1.0), "blade.beam.length is -1.0, but must be a number above 0 and at most 250 (m)."),
    (lambda: replace(BladeConfig(), gyroscopic="no"), "blade.gyroscopic is 'no', but must be True or False."),
    (lambda: blade_config(overrides={"patches": {"passive": "no"}}), "blade.patches.passive is 'no', but must be True or False."),
    (lambda: blade_config(overrides={"beam": {"material": {"E2": -1}}}),
     "blade.beam.material.E2 is -1, but must be a positive number (Pa)."),
    (lambda: blade_config(overrides={"beam": {"material": Lamina.isotropic(69.0, 0.33, 2700.0)}}),  # in GPa
     "blade.beam.material.E1 is 69.0 (did you give GPa?), but must be at least 1e+06 (Pa)."),
    (lambda: blade_config(overrides={"beam": {"material": {"nu12": 9.0}}}),
     "blade.beam.material.nu12 is 9.0, but must be smaller in magnitude than sqrt(E1/E2) = 6.325."),
    (lambda: blade_config(overrides={"beam": 3}), "blade.beam is 3, but must be a table of fields or a BeamConfig."),
    (lambda: BladeConfig(beam={"length": 1.0}), "blade.beam is {'length': 1.0}, but must be a BeamConfig."),
    (lambda: Lamina(1.0, 1.0, 1.0), "lamina.G13 is missing."),
    (lambda: scenario({"plants": {"speed_ratio": "fast"}}),
     "scenario.plants.speed_ratio is 'fast', but must be a number or a range [low, high] from 0.01 to 10."),
    (lambda: Scenario(white_load=1), "scenario.white_load is 1, but must be True or False."),
]  # fmt: skip


@pytest.mark.parametrize(("attempt", "sentence"), SENTENCES)
def test_a_sentence_holds_the_path_the_value_and_what_is_allowed(attempt, sentence):
    with pytest.raises(ValueError) as told:
        attempt()
    assert str(told.value) == sentence
    assert str(pickle.loads(pickle.dumps(told.value))) == sentence  # from a worker process


def test_a_long_value_is_cut_and_stays_on_one_line():
    with pytest.raises(ValueError) as told:
        BladeConfig(speed=np.zeros((60, 60)))
    assert "\n" not in str(told.value)
    assert len(str(told.value)) < 300


def test_an_unknown_field_is_told_with_those_there_are():
    with pytest.raises(ValueError, match="^blade.patches has no field 'colour': its fields are actuators, sensors, material"):
        blade_config(overrides={"patches": {"colour": "red"}})
    with pytest.raises(ValueError, match="^blade.patches has no field 'colour': its fields are actuators"):
        PatchLayout(colour="red")


def test_a_partial_table_completes_from_what_stood_there():
    base = blade_config("chandra-chopra")
    changed = blade_config("chandra-chopra", {"beam": {"taper": 1.2}, "patches": {"width": 0.006}})
    assert changed == replace(base, beam=replace(base.beam, taper=1.2), patches=replace(base.patches, width=0.006))
    gust = scenario({"preset": "rotor", "rotor": {"turbulence": 1}})
    assert gust == replace(SCENARIOS["rotor"], rotor=replace(SCENARIOS["rotor"].rotor, turbulence=1.0))


def test_a_partial_material_completes_from_the_material_that_stood_there():
    changed = {"beam": {"material": {"density": 1600}}}
    assert blade_config("chandra-chopra", changed).beam.material == replace(AS4_3501_6, density=1600.0)
    assert blade_config("thesis", changed).beam.material == replace(GRAPHITE_EPOXY, density=1600.0)
    own = blade_config("chandra-chopra", changed)
    assert read(own, {"beam": {"material": {"E1": 1e11}}}).beam.material == replace(AS4_3501_6, density=1600.0, E1=1e11)
    assert read(own, {"beam": {"material": "as4-3501-6"}}).beam.material == "as4-3501-6"


@pytest.mark.parametrize("each", [BladeConfig(), blade_config(overrides={"beam": {"material": {"E1": 1e11}}}), *SCENARIOS.values()])
def test_configurations_are_values(each):
    for twin in (pickle.loads(pickle.dumps(each)), copy.deepcopy(each), replace(each)):
        assert (twin, hash(twin), repr(twin)) == (each, hash(each), repr(each))
    assert asdict(each)
    back = from_dict(to_dict(each)) if isinstance(each, BladeConfig) else scenario(json.loads(json.dumps(each.to_dict())))
    assert back == each
    with pytest.raises(AttributeError):
        each.white_load = 0.0


def test_a_refusal_is_a_value_error():
    assert issubclass(Refused, ValueError)


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.json", "{", "cannot be read: .*line 1 column 2"),
        ("a.toml", "speed = x", "cannot be read: .*line 1, column 9"),
        ("a.json", "[" * 100_000, "cannot be read"),
        ("a.json", "[1]", r"is \[1\], but must be a table of fields"),
        ("a.json", '{"speed": NaN}', ": blade.speed is nan, but must be zero or a positive number"),
        ("a.toml", "[beam]\nlength = -1", ": blade.beam.length is -1, but must be a number above 0"),
        ("a.yaml", "", "must be a file that ends in .toml or .json"),
    ],
)
def test_what_is_wrong_in_a_file_is_told_with_the_file(name, content, words, tmp_path):
    (tmp_path / name).write_text(content, encoding="utf-8")
    with pytest.raises(ValueError, match=rf"{name}.*{words}") as told:
        load_config(tmp_path / name)
    assert "\n" not in str(told.value)


def test_a_folder_or_nothing_in_a_file_s_place_is_told(tmp_path):
    (tmp_path / "a.json").mkdir()
    for path in (tmp_path / "a.json", tmp_path / "b.toml"):
        with pytest.raises(ValueError, match=rf"{path.name}' cannot be read"):
            load_config(path)


def test_a_scenario_is_read_from_a_path_too(tmp_path):
    (tmp_path / "gust.json").write_text('{"$schema": "scenario.json", "rotor": {"turbulence": 3}}')
    assert scenario(tmp_path / "gust.json").rotor.turbulence == 3.0
    assert scenario(str(tmp_path / "gust.json")) == scenario(tmp_path / "gust.json")


class Unshowable:
    """An object whose own ``repr`` fails."""

    def __repr__(self):
        raise RuntimeError("no")


def test_what_cannot_even_be_shown_is_refused():
    with pytest.raises(ValueError, match="^blade.speed is an object of type Unshowable, but must be zero or a positive number"):
        BladeConfig(speed=Unshowable())


@pytest.mark.parametrize("walls", [[["all", [30]], ["all", [20]]], [("top", [1]), ("left", [1]), ("top", [2])]])
def test_a_wall_given_twice_is_refused(walls):
    with pytest.raises(ValueError, match=r"^blade.beam.ply_angles_deg is .*, every wall once[.]$"):
        blade_config(overrides={"beam": {"ply_angles_deg": walls}})


@pytest.mark.parametrize("wall", ["material", "cls", "self", ""])
def test_a_wall_that_the_section_lacks_is_told_whatever_its_name(wall):
    with pytest.raises(ValueError, match="^blade.beam.ply_angles_deg is .*, but must be for every wall of the section: right, top"):
        build_plant(blade_config(overrides={"beam": {"ply_angles_deg": {wall: [30]}}}))


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"beam": {"length": 1e6}}, "blade.beam.length is 1000000.0, but must be a number above 0 and at most 250 [(]m[)]"),
        ({"beam": {"width": 1e100}}, "blade.beam.width is 1e[+]100, but must be a number above 0 and at most 20 [(]m[)]"),
        ({"beam": {"taper": 5e-324}}, "beam cannot be computed"),
        ({"beam": {"material": {"G13": 1e100}}}, "thickness is 0.01016, but must be large enough"),
        ({"beam": {"material": {"E1": 1e308}}}, "beam cannot be computed"),
        ({"white_load": 1e308}, "blade.white_load is 1e[+]308, but must be a number from 0 to 1e[+]06 [(]N/m[)]"),
        ({"modes": 97}, "blade.modes is 97, but must be a whole number from 1 to 96"),
        ({"patches": {"length": 1e-12}}, "blade.patches.length is 1e-12, but must be above"),
        ({"patches": {"actuators": 10**9}}, "blade.patches.actuators is 1000000000, but must be at least one patch length"),
    ],
)
def test_numbers_that_no_blade_can_have_are_told_in_one_sentence(changes, words):
    with pytest.raises(ValueError, match=f"^{words}") as told:
        build_plant(blade_config(overrides=changes))
    assert type(told.value) in (ValueError, Refused)  # not LinAlgError, which says nothing of the blade
    assert "\n" not in str(told.value)


@pytest.mark.parametrize("of", [lambda blade: blade, lambda blade: pickle.loads(pickle.dumps(blade)), copy.deepcopy])
def test_the_matrices_that_blades_share_cannot_be_written_to(of):
    blade = Blade(BladeConfig())
    blade.plant  # noqa: B018 - so that the matrices are there
    for name in ("mass", "elastic_stiffness", "spin_stiffness", "gyroscopic"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(of(blade).beam.matrices, name)[0, 0] = 1.0
