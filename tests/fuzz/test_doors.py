"""Every door with wrong values: one sentence or what was meant, nothing changed, soon."""

import inspect
import warnings
from tempfile import NamedTemporaryFile

import gymnasium as gym
import numpy as np
import pytest
import typer
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import baselines
import beamenv
from tests.fuzz import (
    archive_doors,
    blade_doors,
    command_doors,
    env_doors,
    episode_doors,
    export_doors,
    file_doors,
    identification_doors,
    informed_law_doors,
    judging_doors,
    law_doors,
    model_doors,
    placement_doors,
    section_doors,
    signal_doors,
    train_doors,
    wrapper_doors,
)
from tests.fuzz.command_words import COMMANDS
from tests.fuzz.meaning import FLAG, NUMBER
from tests.fuzz.oracle import Door, examined, shown
from tests.fuzz.wrong import arguments, copied, value_at
from train.cli.app import app

OF_LAWS = (law_doors, informed_law_doors, judging_doors, placement_doors, identification_doors)
OF_BLADES = (
    blade_doors,
    section_doors,
    signal_doors,
    env_doors,
    episode_doors,
    wrapper_doors,
    file_doors,
    archive_doors,
    model_doors,
)
DOORS = [door for room in (*OF_BLADES, *OF_LAWS, train_doors, export_doors, command_doors) for door in room.DOORS]

OUTCOMES = ("refused", "accepted", "fault")

FAST = settings(
    max_examples=15,
    derandomize=True,
    database=None,
    deadline=None,
    phases=[Phase.generate],
    suppress_health_check=list(HealthCheck),
)
SLOW = settings(FAST, max_examples=300)


@pytest.fixture(scope="module")
def default_blade():
    """What the default environment does before any example; it is compared with one that is made after them."""
    return deeds()


def deeds():
    env = gym.make(beamenv.ENV_ID, duration=0.01)
    observation, info = env.reset(seed=11)
    step = env.step(np.full(env.action_space.shape, 0.5))
    env.close()
    return repr([observation.tolist(), info["energy"].item(), step[0].tolist(), step[1], env.unwrapped.plant.A.tobytes()])


def tried(door, how, counts):
    """Count what examples end as: refused, accepted as meant, a fault; fails at the first fault."""

    @how
    @given(st.data())
    def each(data):
        values, paths = data.draw(arguments(door.kinds, copied(door.valid()), door.junk))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            outcome = examined(door, values, paths)
        counts[outcome.kind] += 1
        wrong = {".".join(map(str, path)): shown(value_at(values, path)) for path in paths}
        assert outcome.kind != "fault", f"{door.name} with {wrong}: {outcome.what}"

    each()


@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.name)
def test_a_door_refuses_in_a_sentence_or_takes_what_was_meant(door, default_blade, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    counts = dict.fromkeys(OUTCOMES, 0)
    tried(door, FAST, counts)
    assert sum(counts.values()) == FAST.max_examples
    assert deeds() == default_blade


@pytest.mark.slow
@pytest.mark.parametrize("door", DOORS, ids=lambda door: door.name)
def test_a_door_holds_for_three_hundred_examples(door, default_blade, tmp_path, monkeypatch, record_property):
    monkeypatch.chdir(tmp_path)
    counts = dict.fromkeys(OUTCOMES, 0)
    record_property("door", door.name)
    record_property("examples", counts)
    tried(door, SLOW, counts)
    assert 20 < sum(counts.values()) <= 300  # a door with few arguments has fewer wrong values
    assert deeds() == default_blade


RECORDS = {
    "BENCHMARK_SCENARIOS", "ENV_ID", "OPEN_SCENARIOS", "PRESETS", "SCENARIOS", "UNSEEN_SCENARIOS",  # no callables
    "Controller", "Episodes", "EpisodeMetrics", "Estimate", "Evaluation", "Identified", "StabilityMargins",  # what functions give
    "PredictiveController", "ScheduledLQG", "ClairvoyantLQG",  # what mpc, scheduled_lqg and clairvoyant_lqg give
    "InverseHysteresis", "SpinUpLQG",  # what inverse_hysteresis and spin_up_lqg give
    "BeamConfig",
}  # fmt: skip


def test_every_public_name_has_a_door():
    doors = {door.public or door.name for door in DOORS}
    assert {*beamenv.__all__, *baselines.__all__} - RECORDS <= doors


@pytest.mark.parametrize(
    ("name", "made"),
    [(name, getattr(beamenv, name)) for name in ("RotatingBeamEnv", "RotatingBeamVectorEnv", "TorchRotatingBeamVectorEnv")],
)
def test_every_argument_of_an_environment_is_among_those_tried(name, made):
    door = next(door for door in DOORS if door.name == name)
    assert set(inspect.signature(made.__init__).parameters) - {"self"} == set(door.kinds)


def test_every_option_of_every_command_is_among_those_tried():
    commands = typer.main.get_command(app).commands
    assert set(commands) == {name for name in COMMANDS if " " not in name}
    for name, command in commands.items():
        positional, options, flags, _ = COMMANDS[name]
        told = {option for each in command.params for option in (*each.opts, *each.secondary_opts) if option.startswith("--")}
        tried = {*options, *flags, "--help"}
        opposites = {f"--{name[5:]}" if name.startswith("--no-") else f"--no-{name[2:]}" for name in flags}
        assert told - tried <= opposites
        assert len([each for each in command.params if each.param_type_name == "argument"]) == len(positional)


def doing(call, **named):
    return Door("a door", call, {"on": FLAG, "size": NUMBER}, lambda: {"on": True, "size": 1.0}, **named)


def _refuse(size):
    if isinstance(size, bool) or not isinstance(size, (int, float)) or not -1e300 < size < 1e300:
        raise ValueError(f"size is {shown(size)}, but must be a number.".replace("\n", " "))
    return float(size)


def _right(on, size):
    if not isinstance(on, (bool, np.bool_)):
        raise ValueError(f"on is {shown(on)}, but must be True or False.".replace("\n", " "))
    return {"on": bool(on), "size": _refuse(size)}


def _takes_anything(on, size):
    return {"on": bool(on), "size": _refuse(size)}


def _raw(on, size):
    return _right(on, size + 0.0)


def _two_lines(on, size):
    try:
        return _right(on, size)
    except ValueError as error:
        raise ValueError(f"{error}\nSee above.") from None


def _other_value(on, size):
    return {**_right(on, size), "size": abs(float(size))}


def _draws(on, size):
    np.random.random()  # noqa: NPY002 - the global state is what it is about
    return _right(on, size)


def _warns(on, size):
    warnings.warn("so", stacklevel=1)
    return _right(on, size)


def _names_nothing(on, size):
    try:
        return _right(on, size)
    except ValueError:
        raise ValueError("that is wrong.") from None


def _writes(on, size):
    with NamedTemporaryFile(dir=".", delete=False):
        pass
    return _right(on, size)


def _spoils(on, size):
    if isinstance(on, dict):
        on["spoilt"] = True
    return _right(on, size)


def test_a_right_door_has_no_fault(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # files are looked at all around
    counts = dict.fromkeys(OUTCOMES, 0)
    tried(doing(_right, read=lambda made: made), SLOW, counts)
    assert counts["refused"] > 100


@pytest.mark.parametrize(
    "wrong", [_takes_anything, _raw, _two_lines, _other_value, _draws, _warns, _names_nothing, _writes, _spoils]
)
def test_a_wrong_door_is_found_out(wrong, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(AssertionError, match="^a door with"):
        tried(doing(wrong, read=lambda made: made), SLOW, dict.fromkeys(OUTCOMES, 0))
