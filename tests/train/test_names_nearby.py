"""A name that nobody has is refused with those it may have been meant for, agents that ship among them."""

import pytest

from beamenv.task import resolve_task
from train.benchmark.listed import listed_controllers
from train.benchmark.submission import entrant
from train.controllers.choice import chosen
from train.controllers.named import named
from train.controllers.near import LONGEST, near

LAWS = ["clipped-lqg", "lqg", "lqg-load", "mpc", "none"]


@pytest.mark.parametrize(
    ("name", "end"),
    [
        ("lqgg", "; near it is lqg"),
        ("LQG_load", "; near it is lqg-load"),
        ("clip", "; near it is clipped-lqg"),
        ("pid", ""),
        ("", ""),
        (3, ""),
        ("lqg" * LONGEST, ""),
    ],
)
def test_near_a_name_are_those_that_differ_in_few_letters_or_begin_with_it(name, end):
    assert near(name, LAWS) == end


def test_a_controller_that_nobody_has_may_have_been_an_agent_that_ships():
    task = resolve_task(duration=0.02)
    with pytest.raises(
        ValueError,
        match="controller is 'residul', but must be one of .* of the agents that ship, .*; near it is residual-generalist[.]",
    ):
        chosen("residul", task, "nominal")
    with pytest.raises(ValueError, match="near it is residual-generalist, an agent that ships"):
        named("residual")
    with pytest.raises(ValueError, match="controller is 'residual', .*; near it is residual-generalist"):
        listed_controllers(["residual"], {}, [], False)
    with pytest.raises(ValueError, match="submit is 'robust_lqg', .*; near it are robust-lqg"):
        entrant("robust_lqg", None, False)
