"""Plant files: what is in the one that ships, there and back, and what is refused."""

import re
from dataclasses import fields, replace

import numpy as np
import pytest

from beamenv import ModalPlant, build_plant, load_plant, save_plant
from beamenv.blade.presets import blade_config
from beamenv.configuration import writing
from beamenv.patches.material import MFC
from beamenv.plant.named import NAMES

SOLID = load_plant("solid-blade")
SMALL = ModalPlant(
    natural_frequencies=[10.0, 20.0],
    gyroscopic=[[0.0, 1.0], [-1.0, 0.0]],
    actuation=[[1.0], [0.5]],
    charges=[[2.0, 1.0]],
    line_load=np.eye(2),
    tip=np.eye(2),
)


def test_the_solid_ships_with_its_origin():
    assert NAMES == ("solid-blade",)
    assert "27-node solids" in SOLID.origin and "30,000 degrees of freedom" in SOLID.origin and "bare" in SOLID.origin
    assert SOLID.speed == 200.0
    assert SOLID.strain is None and SOLID.damping_ratio is None


def test_gyroscopic_forces_of_the_solid_do_no_work():
    assert len(SOLID.natural_frequencies) == 20
    np.testing.assert_allclose(SOLID.gyroscopic, -SOLID.gyroscopic.T, atol=1e-9)


def test_sensors_of_the_solid_are_its_actuators_on_the_opposite_wall():
    """Force per volt is ē A h/spacing and charge ē A: 0.5 mm over 0.3 mm between them; half a turn about the span maps the CUS box
    onto itself, so that a mode strains both walls alike (stretch and twist) or oppositely (bending).
    """
    ratio = SOLID.charges.T / SOLID.actuation
    np.testing.assert_allclose(np.abs(ratio), MFC.electrode_spacing / MFC.thickness, rtol=1e-6)
    same = ratio[:, 0] > 0.0
    assert (ratio > 0.0).tolist() == np.repeat(same[:, None], 4, axis=1).tolist()
    reach = np.abs(SOLID.tip).max(axis=0)
    assert np.all(reach[~same] > 0.1 * reach.max())
    assert np.all(reach[same] < 1e-3 * reach.max())
    assert np.all(SOLID.gyroscopic[np.ix_(same, same)] < 0.05 * np.abs(SOLID.gyroscopic).max())


LINEAR = blade_config(overrides={"beam": {"steady_state": "linear"}, "patches": {"passive": False}})
"""The bare blade with the linear prestress that the solid has."""


def test_static_tip_deflection_of_the_solid_is_the_beams_within_three_percent():
    """T ω⁻² P of 20 modes; the beam's eleven hold 99.9 % of its own."""
    beam = build_plant(LINEAR)
    solid = SOLID.tip @ (SOLID.line_load / SOLID.natural_frequencies[:, None] ** 2)
    static = -beam.tip_displacement @ np.linalg.solve(beam.A, beam.disturbance_input)
    np.testing.assert_allclose(np.diag(solid), np.diag(static), rtol=0.03)
    assert np.abs(solid[0, 1]) + np.abs(solid[1, 0]) < 0.07 * solid[1, 1]


def test_the_first_eight_modes_of_the_solid_are_the_beams_within_three_percent():
    np.testing.assert_allclose(build_plant(LINEAR).natural_frequencies[:8], SOLID.natural_frequencies[:8], rtol=0.03)


@pytest.mark.parametrize(
    "plant",
    [
        SOLID,
        SMALL,
        replace(SMALL, strain=[[1.0, -1.0], [0.5, 2.0], [0.0, 1.0]], damping_ratio=0.02, speed=0.0, origin="by hand"),
        replace(SMALL, damping_ratio=[0.01, 0.03]),
    ],
)
def test_a_plant_comes_back_from_its_file_to_the_last_bit(plant, tmp_path):
    save_plant(plant, tmp_path / "plant.npz")
    again = load_plant(tmp_path / "plant.npz")
    assert again == plant and hash(again) == hash(plant)
    assert load_plant(str(tmp_path / "plant.npz")) == plant
    for each in fields(plant):
        assert np.array_equal(getattr(again, each.name), getattr(plant, each.name))
    assert again != replace(plant, tip=2.0 * plant.tip)


def test_one_damping_ratio_is_that_of_every_mode():
    np.testing.assert_array_equal(replace(SMALL, damping_ratio=0.02).damping_ratio, [0.02, 0.02])


def test_the_first_modes_alone_are_those_of_the_file():
    first = replace(SOLID, strain=np.ones((3, 20)), damping_ratio=np.linspace(0.01, 0.02, 20)).first(11)
    np.testing.assert_array_equal(first.natural_frequencies, SOLID.natural_frequencies[:11])
    np.testing.assert_array_equal(first.gyroscopic, SOLID.gyroscopic[:11, :11])
    assert (first.strain.shape, first.damping_ratio.shape, first.charges.shape) == ((3, 11), (11,), (4, 11))
    assert SOLID.first(None) is SOLID


def test_nobody_writes_to_a_plant():
    with pytest.raises(ValueError, match="read-only"):
        SOLID.tip[...] = 0.0


def test_an_interrupted_write_leaves_the_old_file(tmp_path, monkeypatch):
    save_plant(SMALL, tmp_path / "plant.npz")

    def fails(*_):
        raise OSError("the disk is full")

    monkeypatch.setattr(writing.os, "replace", fails)
    with pytest.raises(ValueError, match="plant.npz' cannot be written: the disk is full[.]$"):
        save_plant(SOLID, tmp_path / "plant.npz")
    assert load_plant(tmp_path / "plant.npz") == SMALL
    assert [each.name for each in tmp_path.iterdir()] == ["plant.npz"]


WRONG = [
    ({"tip": None}, "plant.tip is missing."),
    (
        {"tips": np.eye(2)},
        "plant has no field 'tips' (did you mean tip?): its fields are natural_frequencies, gyroscopic, actuation, charges",
    ),
    (
        {"natural_frequencies": [20.0, 10.0]},
        "plant.natural_frequencies is [20.0, 10.0], but must be numbers from 0.001 to 1e+09 (rad/s) that asc",
    ),
    (
        {"natural_frequencies": [0.0, 10.0]},
        "plant.natural_frequencies is [0.0, 10.0], but must be numbers from 0.001 to 1e+09 (rad/s) that asce",
    ),
    ({"natural_frequencies": 10.0}, "plant.natural_frequencies has shape (), but must have shape (any): one for each mode."),
    ({"natural_frequencies": []}, "plant.natural_frequencies has shape (0,), but must have shape (any): one for each mode."),
    ({"natural_frequencies": [10.0, np.inf]}, "plant.natural_frequencies[1] is inf, but every number must be finite."),
    (
        {"natural_frequencies": ["10", "20"]},
        "plant.natural_frequencies is array(['10', '20'], dtype='<U2'), but must be an array of re",
    ),
    (
        {"gyroscopic": [[0.0, 1.0], [1.0, 0.0]]},
        "plant.gyroscopic differs from minus its transpose by 2, but must be skew: such forces",
    ),
    (
        {"gyroscopic": np.zeros((2, 3))},
        "plant.gyroscopic has shape (2, 3), but must have shape (2, 2): a row and a column for each mode",
    ),
    (
        {"actuation": np.zeros((3, 1))},
        "plant.actuation has shape (3, 1), but must have shape (2, any): a row for each mode, a column",
    ),
    ({"actuation": [[1.0], [np.nan]]}, "plant.actuation[1, 0] is nan, but every number must be finite."),
    ({"actuation": [[1.0j], [0.0]]}, "plant.actuation is array([[0.+1.j], [0.+0.j]]), but must be an array of real numbers."),
    ({"charges": [1.0, 2.0]}, "plant.charges has shape (2,), but must have shape (any, 2): a row for each sensor"),
    ({"line_load": np.zeros((2, 3))}, "plant.line_load has shape (2, 3), but must have shape (2, 2): a row for each mode"),
    ({"tip": np.zeros((1, 2))}, "plant.tip has shape (1, 2), but must have shape (2, 2): rows for lag and flap"),
    ({"strain": np.zeros((0, 2))}, "plant.strain has shape (0, 2), but must have shape (any, 2): a row for each point"),
    ({"damping_ratio": 1.0}, "plant.damping_ratio is 1.0, but must be a number of at least 0 and below 1."),
    ({"damping_ratio": [0.1, -0.1]}, "plant.damping_ratio is [0.1, -0.1], but must be each a number of at least 0 and below 1."),
    ({"damping_ratio": [0.1]}, "plant.damping_ratio has shape (1,), but must have shape (2): one for each mode, or be one number."),
    ({"speed": -1.0}, "plant.speed is -1.0, but must be zero or a positive number (rad/s)."),
    ({"origin": 3}, "plant.origin is 3, but must be a string."),
]


@pytest.mark.parametrize(("change", "sentence"), WRONG)
def test_what_a_plant_file_cannot_hold_is_named_in_one_sentence(change, sentence, tmp_path):
    path = tmp_path / "wrong.npz"
    arrays = {each.name: getattr(SMALL, each.name) for each in fields(SMALL)}
    arrays = {name: value for name, value in {**arrays, **change}.items() if value is not None}
    np.savez(path, **arrays)
    with pytest.raises(ValueError, match=re.escape(f"file {str(path)!r}: {sentence}")) as caught:
        load_plant(path)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "it is no .npz archive of arrays."),
        (b"PK\x03\x04 but then nothing", "it is no .npz archive of arrays."),
        (None, "No such file or directory."),
    ],
)
def test_a_file_that_is_none_is_named_in_one_sentence(content, sentence, tmp_path):
    path = tmp_path / "broken.npz"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ValueError, match=re.escape(f"file {str(path)!r} cannot be read: {sentence}")):
        load_plant(path)


def test_an_archive_of_python_objects_and_a_single_array_are_refused(tmp_path):
    np.savez(tmp_path / "objects.npz", tip=np.array([object()]))
    with pytest.raises(ValueError, match="cannot be read: it holds Python objects"):
        load_plant(tmp_path / "objects.npz")
    np.save(tmp_path / "single.npy", np.eye(2))
    (tmp_path / "single.npy").rename(tmp_path / "single.npz")
    with pytest.raises(ValueError, match="cannot be read: it is no .npz archive of arrays"):
        load_plant(tmp_path / "single.npz")


@pytest.mark.parametrize("source", ["liquid-blade", "plant.npy", 3])
def test_what_names_no_plant_is_refused(source):
    with pytest.raises(ValueError, match="but must be one of solid-blade, or the path of a .npz file"):
        load_plant(source)


def test_a_plant_is_written_to_no_other_file(tmp_path):
    with pytest.raises(ValueError, match="plant.txt', but must be a file that ends in .npz"):
        save_plant(SMALL, tmp_path / "plant.txt")
