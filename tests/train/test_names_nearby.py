"""A name that nobody has is refused with those it may have been meant for, agents that ship among them."""

import gymnasium
import pytest

import beamenv
from beamenv.configuration.near import LONGEST, meant
from beamenv.task import resolve_task
from train.benchmark.listed import listed_controllers
from train.benchmark.submission import entrant
from train.controllers.choice import chosen
from train.controllers.named import named

LAWS = ["clipped-lqg", "lqg", "lqg-load", "mpc", "none"]


@pytest.mark.parametrize(
    ("name", "end"),
    [
        ("lqgg", " (did you mean lqg?)"),
        ("lgq", " (did you mean lqg?)"),
        ("LQG_load", " (did you mean lqg-load?)"),
        ("clip", " (did you mean clipped-lqg?)"),
        ("lqgload", " (did you mean lqg-load?)"),
        ("pid", ""),
        ("", ""),
        (3, ""),
        ("lqg" * LONGEST, ""),
    ],
)
def test_near_a_name_are_those_that_differ_in_few_letters_or_begin_with_it(name, end):
    assert meant(name, LAWS) == end


def test_a_controller_that_nobody_has_may_have_been_an_agent_that_ships():
    task = resolve_task(duration=0.02)
    with pytest.raises(
        ValueError,
        match=r"controller is 'residul' \(did you mean residual-generalist\?\), but must be one of .* of the agents that ship, ",
    ):
        chosen("residul", task, "nominal")
    with pytest.raises(ValueError, match="did you mean residual-generalist, an agent that ships"):
        named("residual")
    with pytest.raises(ValueError, match=r"controller is 'residual' \(did you mean residual-generalist\?\)"):
        listed_controllers(["residual"], {}, [], False)
    with pytest.raises(ValueError, match=r"submit is 'robust_lqg' \(did you mean robust-lqg"):
        entrant("robust_lqg", None, False)


FIELDS = {
    "a preset": ({"preset": "thesys"}, r"^preset is 'thesys' \(did you mean thesis\?\), but must be one of "),
    "a field": (
        {"blade": {"beam": {"lenght": 2.0}}},
        r"^blade\.beam has no field 'lenght' \(did you mean length\?\): its",
    ),
    "a material": ({"blade": {"beam": {"material": "aluminum"}}}, r"^blade\.beam\.material is 'aluminum' \(did you mean aluminium"),
    "a patch": ({"blade": {"patches": {"material": "mfc"}}}, r"^blade\.patches\.material is 'mfc' \(did you mean MFC\?\)"),
    "a kind": ({"blade": {"sensors": [{"kind": "curent"}]}}, r"^blade\.sensors\[0\]\.kind is 'curent' \(did you mean current\?\)"),
    "a shape": (
        {"blade": {"beam": {"section": {"shape": "airfoi"}}}},
        r"^blade\.beam\.section\.shape is 'airfoi' \(did you mean airf",
    ),
    "a theory": ({"blade": {"beam": {"shear": "firstorder"}}}, r"^blade\.beam\.shear is 'firstorder' \(did you mean first_order"),
    "a scenario": ({"scenario": "dely"}, r"^scenario is 'dely' \(did you mean delay\?\)"),
    "a scenario's field": ({"scenario": {"puls": 3.0}}, r"^scenario has no field 'puls' \(did you mean pulse"),
}


@pytest.mark.parametrize(("given", "told"), FIELDS.values(), ids=FIELDS)
def test_near_names_are_told_wherever_a_name_is_looked_up(given, told):
    with pytest.raises(ValueError, match=told):
        resolve_task(**given)


@pytest.mark.parametrize("make", [gymnasium.make, gymnasium.make_vec])
def test_an_argument_that_an_environment_does_not_have_is_told_with_those_like_it(make):
    with pytest.raises(
        ValueError, match=r"^the environment got an unexpected keyword argument 'scenaro' \(did you mean scenario\?\)"
    ) as refused:
        make(beamenv.ENV_ID, scenaro="nominal")
    assert isinstance(refused.value, TypeError)  # by which other libraries go
