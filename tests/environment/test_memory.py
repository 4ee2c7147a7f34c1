"""Counts that no memory has room for are refused before anything is built."""

import gymnasium
import pytest

import beamenv
from beamenv.configuration import memory
from beamenv.envs.history import VectorSensorHistory


def test_more_blades_than_memory_has_room_for_are_refused():
    with pytest.raises(ValueError, match=r"^num_envs is 1000000000, but must be at most \d+ blades: so many fit into memory[.]$"):
        gymnasium.make_vec(beamenv.ENV_ID, num_envs=10**9)


def test_a_longer_history_than_memory_has_room_for_is_refused(monkeypatch):
    with pytest.raises(ValueError, match="^length is 1000000000, but must be a whole number not below 1 and not above 10000[.]$"):
        beamenv.SensorHistory(gymnasium.make(beamenv.ENV_ID), length=10**9)
    envs = gymnasium.make_vec(beamenv.ENV_ID, num_envs=1000)
    monkeypatch.setattr(memory, "memory", lambda: 10**9)
    with pytest.raises(ValueError, match="^length is 10000, but must be at most 6250 instants: so many fit into memory[.]$"):
        VectorSensorHistory(envs, length=10_000)
