"""A clock that makes training deterministic, a page with every part, and a browser."""

import itertools
import shutil
from contextlib import contextmanager
from types import SimpleNamespace

import gymnasium as gym
import numpy as np
import pytest

import beamenv
from baselines import closed_loop_poles, lqg, lqr, no_control


@pytest.fixture(scope="session")
def ticking():
    """Within it the trainers' clock goes on by so many seconds whenever it is read: a budget is a number of steps.

    Looks at the policy, which are no part of the training's time, take none.
    """

    @contextmanager
    def clock(seconds):
        with pytest.MonkeyPatch.context() as patch:
            readings = itertools.count()
            patch.setattr("train.learning.session.time", SimpleNamespace(monotonic=lambda: seconds * next(readings)))
            patch.setattr("train.learning.job.time", SimpleNamespace(monotonic=lambda: 0.0))
            yield

    return clock


@pytest.fixture(scope="session")
def page_content():
    """Every part of a page: true poles and motion of a short episode, made-up numbers in tables and curves."""
    page = pytest.importorskip("train.page", reason="plotly is not installed")
    env = gym.make(beamenv.ENV_ID, duration=0.1)
    plant, design = env.unwrapped.plant, env.unwrapped.task.design_plant
    env.close()
    idle, optimal = no_control(plant), lqg(plant)
    numbers = (("LQG", 9.5), ("no control", 100.0), ("PPO", 10.25), ("lost", np.inf))
    rows = tuple((page.Cell(name), page.Cell(f"{value:g}", value)) for name, value in numbers)
    cost, failed = np.array([[0.4, 1.0, 0.6], [np.inf, 1.0, 0.7]]), np.array([[0.0, 0.0, 0.1], [0.5, 0.0, 0.0]])
    return page.PageContent(
        title="A page with every part",
        lead=page.Lead("J falls.", "A blade moves.", "1 May 2026", "beamenv compare 'a b'"),
        note="Made for tests.",
        table=page.Table(("controller", "peak tip, µm"), rows, "Made-up numbers."),
        heat_map=page.HeatMap(("step", "pulse"), ("LQG", "no control", "PPO"), cost, failed),
        episode=page.record_episode({"duration": 0.1}, 3, {"LQG": optimal, "LQR": lqr(design)}),
        episode_note="Seed 3.",
        poles={law.name: closed_loop_poles(plant, law) for law in (idle, optimal)},
        learning=page.LearningCurves({"PPO": np.array([[1.0, 1e5, 1.2], [2.0, 2e5, 0.9], [3.0, 3e5, 0.6]])}, {"LQG": 0.4}),
        configuration={"blade": {"length": 2.023}, "note": "<none>"},
    )


ALONE = (
    *("--headless=new", "--no-sandbox", "--no-first-run", "--disable-sync", "--disable-background-networking"),
    *("--disable-component-update", "--disable-quic"),
    *("--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
)
"""No network, and WebGL without a graphics card."""


@pytest.fixture(scope="session")
def browser():
    """Chromium, which keeps a log of what its console says."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="selenium is not installed")
    chromium, driver = shutil.which("chromium"), shutil.which("chromedriver")
    if chromium is None or driver is None:
        pytest.skip("Chromium and its driver are not installed")
    options = webdriver.ChromeOptions()
    options.binary_location = chromium
    for argument in ALONE:
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    started = webdriver.Chrome(options=options, service=webdriver.ChromeService(driver))
    yield started
    started.quit()


@pytest.fixture(scope="module")
def client():
    """Of the explorer's server."""
    page = pytest.importorskip("train.explore.app", reason="dash is not installed")
    return page.create_app().server.test_client()


@pytest.fixture(scope="module")
def output(client):
    """What the explorer's page asks to have redrawn."""
    return next(each["output"] for each in client.get("/_dash-dependencies").get_json() if "results.hidden" in each["output"])


@pytest.fixture(scope="module")
def asked(output):
    """The body with which the explorer's page asks for a redraw, as a browser was seen to send it."""
    from tests.train.explorer import START

    outputs = [dict(zip(("id", "property"), each.split("."), strict=True)) for each in output.strip(".").split("...")]
    inputs = [{"id": "wanted", "property": "data", "value": START}]
    return {"output": output, "outputs": outputs, "inputs": inputs, "changedPropIds": ["wanted.data"], "parsedChangedPropsIds": []}
