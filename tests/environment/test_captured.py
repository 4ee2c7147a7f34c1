"""What a CUDA graph would do, on the processor: a step recorded once, and replayed on the same memory without a look at it."""

import copy

import numpy as np
import pytest

import beamenv
from beamenv.arrays import Arrays, on_host
from beamenv.simulation import blades, starts

torch = pytest.importorskip("torch")

from torch._dynamo.exc import BackendCompilerFailed  # noqa: E402
from torch.utils._python_dispatch import TorchDispatchMode  # noqa: E402
from torch.utils._pytree import tree_flatten, tree_map  # noqa: E402

from beamenv.envs import torch_batch  # noqa: E402
from beamenv.envs.torch_graph import StaticStep, leaves  # noqa: E402

COUNT = 5
SMALL = {"modes": 4, "truth_modes": 4, "beam": {"terms": 8}}
SCENARIOS = {
    "nominal": "nominal",
    "brittle": {"magnitude": [100.0, 8000.0], "onset": [0.0, 0.005]},
    "failure on the way": {"preset": "mid-failure", "failures": {"onset": [0.0, 0.01]}},
    "hysteresis": "hysteresis",
    "dropout and turbulence": {"acquisition": {"dropout": 0.2}, "rotor": {"turbulence": 5.0, "harmonics": [3.0, 1.0]}},
    "delay": {"drive": {"delay": [0, 3]}},
    "drawn plants": {"plants": {"speed_ratio": [0.8, 1.2], "bank": 3}},
    "wandering speed": {"plants": {"speed_wander": 0.05, "wander_frequency": 20.0, "bank": 4}},
    "spin-up": {"plants": {"spin_up": [100.0, 110.0]}},
}
WAITS = {"aten::_local_scalar_dense", "aten::nonzero", "aten::equal"}
"""What a device must be waited for."""


class Tape(TorchDispatchMode):
    """Operations in their order, on the memory that they were done on; to play it is to do them again."""

    def __init__(self):
        super().__init__()
        self.done = []

    def __torch_dispatch__(self, function, types, args=(), kwargs=None):
        assert function._schema.name not in WAITS, function
        result = function(*args, **(kwargs or {}))
        self.done.append((function, args, kwargs or {}, result))
        return result

    def play(self):
        """A tensor that was made then stands for what is made now."""
        now = {}
        for function, args, kwargs, then in self.done:
            args, kwargs = tree_map(lambda each: now.get(id(each), each), (args, kwargs))
            made = function(*args, **kwargs)
            for old, new in zip(tree_flatten(then)[0], tree_flatten(made)[0], strict=True):
                if isinstance(old, torch.Tensor):
                    now[id(old)] = new
        return now


@pytest.fixture(autouse=True)
def not_looking(monkeypatch):
    """Batches that look at no value, as on a GPU."""
    monkeypatch.setattr(Arrays, "looks", property(lambda arrays: arrays.of_numpy))


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_recorded_step_played_again_is_the_next_step(name, mode):
    made = {"scenario": SCENARIOS[name], "duration": 0.01, "blade": SMALL, "autoreset_mode": mode}
    envs = beamenv.torch_vec(COUNT, device="cpu", **made)
    envs.reset(seed=4, options={"elapsed": np.arange(COUNT)})
    plain = copy.deepcopy(envs)
    step = StaticStep(envs._episodes, torch.zeros(COUNT, 4), envs.generator)
    tape, random = None, torch.Generator().manual_seed(0)
    for _ in range(50):
        actions = 0.1 * torch.randn(COUNT, 4, generator=random)
        step.actions.copy_(actions)
        if tape is None:
            with Tape() as tape:
                recorded = step.run()
            told = list(leaves(recorded))
        else:
            now = tape.play()
            told = [now[id(leaf)] for leaf in leaves(recorded)]
        expected = list(leaves(plain._episodes.step(actions, plain.generator)))
        assert all(torch.equal(one, other) for one, other in zip(told, expected, strict=True))
        assert torch.equal(envs.state, plain.state)
        assert torch.equal(envs.episode_truth, plain.episode_truth)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::DeprecationWarning:torch.*")
@pytest.mark.parametrize(
    ("name", "mode"), [("nominal", "NextStep"), ("failure on the way", "Disabled"), ("wandering speed", "SameStep")]
)
def test_a_compiled_step_is_the_plain_one(name, mode):
    made = {"scenario": SCENARIOS[name], "duration": 0.01, "blade": SMALL, "autoreset_mode": mode, "dtype": "float64"}
    plain, compiled = (beamenv.torch_vec(COUNT, device="cpu", compiled=which, **made) for which in (False, True))
    random = torch.Generator().manual_seed(0)
    for seed in (4, 5):  # a reset goes on with what is compiled
        for envs in (plain, compiled):
            envs.reset(seed=seed, options={"elapsed": np.arange(COUNT)})
        recorded = compiled._recorded
        for _ in range(6 if mode == "Disabled" else 25):
            actions = 0.1 * torch.randn(COUNT, 4, generator=random)
            (*told, info), (*expected, expected_info) = compiled.step(actions), plain.step(actions)
            assert info.keys() == expected_info.keys()
            for one, other in zip(told, expected, strict=True):
                torch.testing.assert_close(one, other, rtol=1e-11, atol=1e-11)
            torch.testing.assert_close(compiled.state, plain.state, rtol=1e-11, atol=1e-11)
        assert compiled._recorded is (recorded or compiled._recorded)
    kept = compiled.state_dict()
    first = compiled.step(actions)[0]
    compiled.load_state_dict(kept)
    assert torch.equal(compiled.step(actions)[0], first)


def test_without_a_compiler_that_is_said_and_nothing_moves(monkeypatch):
    envs = beamenv.torch_vec(COUNT, device="cpu", compiled=True, duration=0.01, blade=SMALL)
    plain = beamenv.torch_vec(COUNT, device="cpu", duration=0.01, blade=SMALL)
    for each in (envs, plain):
        each.reset(seed=1)

    def failing(graph, **options):
        def run(*arguments):
            raise BackendCompilerFailed(run, RuntimeError("no compiler"), None)

        return run

    monkeypatch.setattr(torch, "compile", failing)
    for _ in range(2):
        with pytest.raises(ValueError, match="^compiled is True, but must be False on this machine, where torch"):
            envs.step(torch.zeros(COUNT, 4))
    torch.testing.assert_close(envs.state, plain.state, rtol=1e-5, atol=1e-9)
    assert torch.equal(envs.generator.get_state(), plain.generator.get_state())


@pytest.fixture
def no_memory(monkeypatch):
    """A device of torch's that has shapes and no numbers, in the place of a GPU; what is drawn is made there."""

    class Generator(torch.Generator):
        def __new__(cls, device):
            return super().__new__(cls, "cpu")

    for name in ("rand", "randn"):
        drawn = getattr(torch, name)
        monkeypatch.setattr(
            torch, name, lambda shape, dtype, device, generator, drawn=drawn: drawn(shape, dtype=dtype, device="meta")
        )
    monkeypatch.setattr(torch, "Generator", Generator)
    monkeypatch.setattr(torch_batch, "checked_device", lambda device: torch.device("meta"))


@pytest.mark.usefixtures("no_memory")
@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
@pytest.mark.parametrize("name", SCENARIOS)
def test_a_step_looks_at_no_number_of_a_device(name, mode, monkeypatch):
    envs = beamenv.torch_vec(COUNT, scenario=SCENARIOS[name], duration=0.01, blade=SMALL, autoreset_mode=mode)
    for room in (blades, starts):  # a whole reset asks which rows are all
        monkeypatch.setattr(room, "on_host", lambda rows: np.arange(COUNT) if isinstance(rows, torch.Tensor) else rows)
    envs.reset(seed=0)
    for room in (blades, starts):
        monkeypatch.setattr(room, "on_host", on_host)
    for _ in range(2):
        *told, info = envs.step(torch.zeros(COUNT, 4, device="meta"))
    told += [each for value in info.values() for each in (value.values() if isinstance(value, dict) else [value])]
    assert {each.device.type for each in told} == {"meta"}
    with pytest.raises((RuntimeError, NotImplementedError)):
        bool(told[2].any())


def test_a_graph_is_refused_where_there_is_none():
    with pytest.raises(ValueError, match=r"^graph is True, but must be False on cpu: only a GPU has graphs\.$"):
        beamenv.torch_vec(2, device="cpu", graph=True)


@pytest.mark.parametrize("name", ["graph", "compiled"])
def test_a_recorded_step_has_no_gradients(name, monkeypatch):
    monkeypatch.setattr(torch_batch, "checked_device", lambda device: torch.device("meta" if name == "graph" else "cpu"))
    with pytest.raises(ValueError, match=f"^{name} is True, but must be False"):
        beamenv.torch_vec(2, differentiable=True, **{name: True})
