"""The search for the front: NSGA-II by pymoo, whose designs SQP then betters at given masses.

Deb, Pratap, Agarwal and Meyarivan, IEEE Trans. Evolutionary Computation 6, 2002.
"""

from __future__ import annotations

from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from baselines.placement.sizing.designs import Designs, random_designs, repaired
from baselines.placement.sizing.front import Archive, Front, Progress
from baselines.placement.sizing.polish import leaner, polished
from baselines.placement.sizing.problem import SizingProblem
from beamenv.configuration import Count, Instance, Refused, Whole, checked, configuration

Array = NDArray[np.float64]

SHARE = 0.6
"""Of the search's time that generations take, about; the rest is SQP's."""


@configuration("SizingSearch")
class SizingSearch:
    """How long to look."""

    population: Annotated[int, Count(8, 1000)] = 60
    generations: Whole = 40
    polished: Annotated[int, Count(2, 200)] = 10
    """Masses over the front at which SQP descends, three times."""
    iterations: Whole = 25
    """Of each descent."""


def size(
    problem: SizingProblem,
    seed: int = 0,
    search: SizingSearch | None = None,
    progress: Progress | None = None,
    archive: Archive | None = None,
) -> Front:
    """The designs of least cost at every mass that a search finds; the same seed gives the same front.

    Modes beyond the patches' reach are left to their own damping. An ``archive`` made for the problem holds what has been found,
    even where the search is interrupted. Raises ``ValueError`` for what is no problem, seed or search.
    """
    checked("problem", problem, Instance(SizingProblem))
    seed = checked("seed", seed, Count(0, 2**31 - 1))
    search = SizingSearch() if search is None else checked("search", search, Instance(SizingSearch))
    if not (progress is None or callable(progress)):
        raise Refused("progress", progress, "None or a function of the share done and the least cost")
    archive = Archive(problem, progress) if archive is None else checked("archive", archive, Instance(Archive))
    evolve(archive, search, seed)
    refine(archive, search)
    return archive.front(seed, complete=True)


def refine(archive: Archive, search: SizingSearch) -> None:
    """SQP at masses over the whole front: from the evolved designs, then from the best lighter design on the way up, and from what
    the next heavier one leaves when it is made leaner on the way down.
    """
    evolved, masses = archive.designs, masses_of(archive.problem, search.polished)
    if evolved is None or not len(evolved):
        return
    up = [(mass, False) for mass in masses]
    starts = [(*each, evolved) for each in up] + [(*each, None) for each in (*up, *((mass, True) for mass in masses[-2::-1]))]
    for k, (mass, beyond, among) in enumerate(starts):
        start = next_to(archive.problem, among or archive.designs or evolved, mass, beyond)
        better, cost = polished(archive.problem, start, mass, search.iterations)
        archive.evaluations += search.iterations
        archive.keep(better, cost)
        archive.note(SHARE + (1.0 - SHARE) * (k + 1) / len(starts))


def masses_of(problem: SizingProblem, count: int) -> list[float]:
    """So many masses, kg, from the lightest design to what the budget or the largest sizes allow, ever further apart, and that of
    the blade's own patches.
    """
    lightest, heaviest, own = float(problem.mass(problem.least())[0]), problem.most_mass(), problem.own()
    masses: list[float] = np.geomspace(lightest, heaviest, count).tolist()
    mass = heaviest if own is None else float(problem.mass(own)[0])
    return sorted([*masses, mass]) if lightest < mass < heaviest else masses


def next_to(problem: SizingProblem, designs: Designs, mass: float, beyond: bool) -> Designs:
    """The heaviest of designs that are ordered by mass within ``mass`` (kg), or the lightest ``beyond`` it, made leaner."""
    count = int(np.count_nonzero(problem.mass(designs) <= mass * (1.0 + 1e-9)))
    if beyond or not count:
        return leaner(problem, designs[[min(count, len(designs) - 1)]], mass)
    return designs[[count - 1]]


def evolve(archive: Archive, search: SizingSearch, seed: int) -> None:
    """Generations of designs, each repaired before it is evaluated."""
    problem, limits = archive.problem, archive.problem.limits
    generator = np.random.default_rng(seed)
    first = random_designs(limits, search.population, generator)
    own = problem.own()
    if own is not None:
        first = Designs.joined([own, first[slice(1, None)]])
    algorithm = nsga2(problem, search, encoded(problem, repaired(first, limits)), seed)
    for generation in range(search.generations):
        asked = algorithm.ask()
        designs = repaired(decoded(problem, asked.get("X")), limits)
        asked.set("X", encoded(problem, designs))
        asked.set("F", np.column_stack([problem.mass(designs), archive.costs(designs)]))
        asked.set("G", beyond_budget(problem, designs))
        algorithm.evaluator.eval(algorithm.problem, asked)
        algorithm.tell(infills=asked)
        archive.note(SHARE * (generation + 1) / search.generations)


def nsga2(problem: SizingProblem, search: SizingSearch, first: Array, seed: int) -> Any:
    """Pymoo's algorithm, with genes from 0 to 1 and designs to begin with."""
    from pymoo.algorithms.moo.nsga2 import NSGA2
    from pymoo.core.problem import Problem

    genes = first.shape[1]
    algorithm = NSGA2(pop_size=search.population, sampling=first)
    space = Problem(n_var=genes, n_obj=2, n_ieq_constr=2, xl=np.zeros(genes), xu=np.ones(genes))
    algorithm.setup(space, termination=("n_gen", search.generations), seed=seed, verbose=False)
    return algorithm


def beyond_budget(problem: SizingProblem, designs: Designs) -> Array:
    """(N, 2): how far, as a share of it, designs go beyond the budget of mass and of power; −1 where it is not limited."""
    spent = (problem.budget.mass, problem.mass(designs)), (problem.budget.power, problem.power(designs))
    return np.column_stack(
        [np.full(len(designs), -1.0) if limit is None or each is None else each / limit - 1.0 for limit, each in spent]
    )


def encoded(problem: SizingProblem, designs: Designs) -> Array:
    """Genes (N, 2 E + 4) from 0 to 1: starts over the span, lengths from none to the longest, sizes in their ranges."""
    limits = problem.limits
    room = np.maximum(limits.largest_sizes - limits.least_sizes, np.finfo(float).tiny)
    genes = [designs.starts / limits.end, designs.lengths / limits.length[1], (designs.sizes - limits.least_sizes) / room]
    return np.clip(np.concatenate(genes, axis=1), 0.0, 1.0)


def decoded(problem: SizingProblem, genes: Array) -> Designs:
    """Designs from such genes."""
    limits, patches = problem.limits, len(problem.limits.side_of)
    room = limits.largest_sizes - limits.least_sizes
    starts, lengths = genes[:, :patches] * limits.end, genes[:, patches:-4] * limits.length[1]
    return Designs(starts, lengths, limits.least_sizes + genes[:, -4:] * room)
