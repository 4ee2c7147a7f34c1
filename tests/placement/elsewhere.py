"""Environments with patches put elsewhere, which tests share."""

import gymnasium

from beamenv import ENV_ID, PlacementWrapper, VectorPlacementWrapper

ELSEWHERE = {"actuators": [0.0, 0.2, 0.4, 0.6], "sensors": [0.1, 0.2, 0.3, 0.4]}


def wrapped(**arguments):
    return PlacementWrapper(gymnasium.make(ENV_ID, duration=0.02), **arguments)


def batch(count, **arguments):
    return VectorPlacementWrapper(gymnasium.make_vec(ENV_ID, num_envs=count, duration=0.02), **arguments)
