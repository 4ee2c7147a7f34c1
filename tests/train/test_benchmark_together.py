"""Cells that are measured together in one batch are those that each would be alone."""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest

from beamenv.scenarios.scenario import scenario
from train.benchmark.bench import Bench, Setting
from train.benchmark.cells import SERIES, Job, measured, together
from train.controllers.named import named
from train.controllers.shipped import FOLDER, shipped
from train.controllers.sources import Classical, Given, Trained

SHORT = '{"duration": 0.04}'


def setting(name, seeds=3):
    """With a few plants, which are soon built."""
    of = scenario(name)
    return Setting(name, replace(of, plants=replace(of.plants, bank=4)), seeds, SHORT, validation=True)


def jobs_of(names, of):
    laws = [Job(of, name, "", Classical(named(name))) for name in names]
    return laws + [Job(of, each.agent, str(each.seed), Trained(each.folder)) for each in shipped(FOLDER) if wanted(each)]


def wanted(each):
    return each.agent == "gradient" and each.scenario == "generalist" and str(each.seed) in "01"


@pytest.mark.parametrize("name", ["failure", "off-model", "mid-failure"])
def test_what_is_measured_together_is_what_is_measured_alone(name):
    """To rounding, in single precision of agents; with blades that fail and a law that is told the truth."""
    of, bench = setting(name), Bench()
    jobs = jobs_of(["velocity", "lqg", "lqr", "lqr-load", "clairvoyant"], of)
    groups = list(together(jobs))
    assert [len(each) for each in groups] == [2, 1, 1, 1, 2]
    for group in groups:
        for job, cell in zip(group, measured(group, bench), strict=True):
            (alone,) = measured([Job(of, job.controller, job.run, Given(job.source.build(bench.blades(of).task)))], bench)
            assert cell.title == alone.title and not cell.sentence
            for series in SERIES:
                np.testing.assert_allclose(cell.metrics[series], alone.metrics[series], rtol=1e-5, atol=1e-12, err_msg=series)
    bench.close()


@dataclass(frozen=True)
class Broken(Classical):
    """Of a law that cannot be built."""

    def build(self, task: Any) -> Any:
        raise ValueError("it cannot be built.")


def test_one_that_fails_fails_alone():
    of, bench = setting("nominal"), Bench()
    good, bad = Job(of, "velocity", "", Classical(named("velocity"))), Job(of, "lqg", "", Broken(named("lqg")))
    ((first, second),) = together([good, bad])
    cells = measured([first, second], bench)
    assert (cells[0].sentence, cells[1].sentence) == ("", "it cannot be built.")
    assert cells[0].metrics is not None and cells[1].metrics is None
    bench.close()


def test_no_control_is_the_reference_itself():
    of, bench = setting("rotor"), Bench()
    (cell,) = measured([Job(of, "none", "", Classical(named("none")))], bench)
    np.testing.assert_array_equal(cell.metrics["cost"], cell.uncontrolled)
    bench.close()


def test_batches_stay_of_a_size_that_memory_has():
    few, many = setting("nominal", 16), setting("nominal", 256)
    names = ["velocity", "lqg", "lqg-load", "lqg-thesis", "robust-lqg", "clipped-lqg", "rotor-lqg"]
    laws = [Classical(named(name)) for name in names]
    sizes = {
        of.seeds: [len(each) for each in together([Job(of, str(k), "", law) for k, law in enumerate(laws)])] for of in (few, many)
    }
    assert sizes == {16: [5, 2], 256: [2, 2, 2, 1]}
