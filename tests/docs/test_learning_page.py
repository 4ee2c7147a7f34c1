"""The page on what learning buys tells of the benchmark what the benchmark's page tells."""

import re
from pathlib import Path

from beamenv import UNSEEN_SCENARIOS

DOCS = Path(__file__).parents[2] / "docs"
LEARNING, BENCHMARK = ((DOCS / name).read_text(encoding="utf-8") for name in ("learning.md", "benchmark.md"))


def rows(page, head):
    """Cells of the table whose first line begins with this, code marks left out, by the first cell."""
    text = page[page.index(f"\n{head}") :].lstrip().split("\n\n")[0].replace("`", "")
    table = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()]
    return {name: cells for name, *cells in (table[0], *table[2:])}


def test_who_is_ahead_in_scenarios_kept_for_judging_follows_from_the_benchmarks_intervals():
    told = rows(LEARNING, "| scenario | hardest classical controller |")
    verdicts = rows(BENCHMARK, "| scenario | agent | classical | verdict |")
    del told["scenario"]
    assert set(told) == set(UNSEEN_SCENARIOS)
    for scenario, (hardest, difference, ahead) in told.items():
        agent, _, verdict, _, rival, _, to_rival = verdicts[scenario]
        low, high = map(float, re.search(r"\[(\S+), (\S+)\]", difference).groups())
        assert agent.startswith("multiple-model-residual-generalist")
        assert (hardest, difference) == (rival, to_rival), scenario
        assert ahead == ("the agent" if high < 0.0 else "the controller" if low > 0.0 else "not told apart"), scenario
        assert (verdict == "ahead") == (ahead == "the agent"), scenario
    assert [scenario for scenario in told if verdicts[scenario][2] == "behind"] == ["two-dead-actuators"]
    lost = [scenario for scenario in told if verdicts[scenario][2] == "ahead" != verdicts[scenario][3]]
    assert lost == ["delay-off-model"] and "three of the four leads are left, without that in `delay-off-model`" in LEARNING


def test_costs_on_the_solid_are_those_of_the_benchmark():
    told, measured = rows(LEARNING, "| | tier | `solid` |"), rows(BENCHMARK, "| controller | tier | kind | solid |")
    del told[""]
    assert told == {name: [measured[name][0], *measured[name][2:4]] for name in told}
