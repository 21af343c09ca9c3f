"""The package's own sampler beside kept ones: dynesty, nautilus, emcee and blackjax on the same density.

All draw from one unnormalised density: standard normal latents, laws and closures by their prior
probabilities, times the likelihood of the dwells and of the evidence. Samplers of continuous numbers get
law and closure from two more coordinates. The cases are the dwells of the shipped log alone, with two starts
(one sticks at 0.9 of V*, one slides at 1.1), and with the figures of one stick-slip recording. A fourth
case, two narrow normals of unequal weight in the same latents, has a known answer. The reference of the first
three is importance sampling from the prior, which shares nothing with any of the samplers.

Effective draws are one over the mean square of (error over standard deviation) against the reference: of the
rank of V*, of the four numbers of the drive and of two closures, over all seeds. The sampler's own figure
stands beside it.

Usage: python -m benchmarks.samplers [--cases dwells starts] [--samplers hersey emcee] [--seeds 3]
"""

from __future__ import annotations

import argparse
import importlib.util
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import logsumexp, ndtr, ndtri

import hersey
from hersey.arrays import FloatArray, IntArray
from hersey.damping.curves import fit_curves
from hersey.damping.fit import fit
from hersey.posterior.drives import DriveModel, Drives
from hersey.posterior.evidence import CycleFigures, Evidence, Start, StickSlip
from hersey.posterior.likelihood import log_likelihood
from hersey.posterior.priors import CLOSURES, NUMBERS, DrivePriors
from hersey.posterior.result import edges_at
from hersey.posterior.sampler import Moves, sample
from hersey.posterior.sampling import CHAINS, DRAWS, FIRST, decision_temperature

ROOT = Path(__file__).parent.parent
#: Prior probability of each closure.
CHANCES = np.array(list(CLOSURES.values()))
#: Draws of the prior for the reference, those kept by the weight of the dwells, and those whose V* is found.
PRIOR_DRAWS, DWELL_DRAWS, KEPT = 1_000_000, 300_000, 20_000
#: Dwell draws of the reference where following a start makes each expensive.
START_DRAWS = 60_000
#: Share of the transition at which stick-slip is recorded, and relative error of its figures.
SLIP_AT, FIGURE_ERROR = 0.5, 0.01
#: Toy: where the modes lie in each number of the drive, their width, and the weight of the one above zero.
MODE_AT, MODE_WIDTH, MODE_WEIGHT = 2.0, 0.1, 0.2
#: Most draws of a run whose V* is found.
MOST = 10_000
#: Standard deviation of a closure from which its share is compared.
LEAST_SPREAD = 0.05
CASES = ("dwells", "starts", "stick-slip", "two modes")


@dataclass
class Problem:
    """A density to draw from: ln likelihood of draws, and the figure that is compared."""

    laws: FloatArray  #: prior probability of each law
    size: int  #: latents
    likelihood: Callable[[Drives], FloatArray]
    figure: Callable[[Drives], FloatArray]  #: V* in mm/s, or whether a draw is in the lighter mode
    real: bool = True  #: whether it is of the shipped log
    evaluations: int = 0
    seconds: float = 0.0  #: processor time in the likelihood

    def target(self, drives: Drives) -> FloatArray:
        """Return ln likelihood of draws, and count them."""
        began = time.process_time()
        value = self.likelihood(drives)
        self.seconds += time.process_time() - began
        self.evaluations += len(drives)
        return np.where(np.isnan(value), -np.inf, value)

    def from_cube(self, cube: FloatArray) -> Drives:
        """Return draws of rows in the unit cube."""
        rows = np.atleast_2d(cube)
        return self._drives(ndtri(rows[:, : self.size]), rows[:, self.size :])

    def from_normals(self, normals: FloatArray) -> Drives:
        """Return draws of rows of standard normals."""
        return self._drives(normals[:, : self.size].copy(), ndtr(normals[:, self.size :]))

    def _drives(self, latent: FloatArray, discrete: FloatArray) -> Drives:
        return Drives(_index(self.laws, discrete[:, 0]), _index(CHANCES, discrete[:, 1]), latent)

    def prior(self, count: int, random: np.random.Generator) -> Drives:
        """Return independent draws of the prior."""
        discrete = random.random((count, 2))
        return self._drives(random.standard_normal((count, self.size)), discrete)

    @property
    def dimensions(self) -> int:
        """Coordinates of a sampler of continuous numbers."""
        return self.size + 2


@dataclass(frozen=True)
class Run:
    """Draws of equal weight, and what the sampler reports of them."""

    drives: Drives
    own: float  #: effective draws by the sampler's own count
    log_evidence: float = np.nan


@dataclass(frozen=True)
class Figures:
    """What is compared of a run."""

    values: FloatArray
    closures: FloatArray
    numbers: FloatArray  #: latents of the numbers of the drive, shape (draws, 4)


@dataclass
class Row:
    """All seeds of one sampler."""

    name: str
    seconds: list[float] = field(default_factory=list)
    in_target: list[float] = field(default_factory=list)
    evaluations: list[int] = field(default_factory=list)
    runs: list[Run] = field(default_factory=list)
    figures: list[Figures] = field(default_factory=list)


def _index(shares: FloatArray, at: FloatArray) -> IntArray:
    return np.minimum(np.searchsorted(np.cumsum(shares), at), shares.size - 1).astype(np.intp)


def _equal(weight: FloatArray, count: int, random: np.random.Generator) -> IntArray:
    """Indices of so many draws of equal weight, systematically and in random order."""
    order = random.permutation(weight.size)
    edges = np.cumsum(weight[order]) / weight.sum()
    at = (np.arange(count) + random.random()) / count
    return random.permutation(order[np.minimum(np.searchsorted(edges, at), weight.size - 1)]).astype(np.intp)


def _weighed(problem: Problem, cube: FloatArray, log_weight: FloatArray, log_z: float, seed: int) -> Run:
    """Draws of equal weight of a nested sampler's weighted ones."""
    weight = np.exp(log_weight - np.max(log_weight))
    own = float(weight.sum() ** 2 / np.sum(weight**2))
    chosen = _equal(weight, min(MOST, max(DRAWS, int(2 * own))), np.random.default_rng(seed))
    return Run(problem.from_cube(cube[chosen]), own, log_z)


def hersey_smc(problem: Problem, seed: int, draws: int = DRAWS, moves: Moves | None = None) -> Run:
    """The package's own sampler, as `hersey.posterior` calls it."""
    parts, evidence = [], []
    for chain in range(CHAINS):
        random, count = np.random.default_rng([seed, chain]), draws // CHAINS
        even = (np.arange(FIRST * count) + 0.5) / (FIRST * count)
        start = Drives(
            random.permutation(_index(problem.laws, even)),
            random.permutation(_index(CHANCES, even)),
            random.standard_normal((FIRST * count, problem.size)),
        )
        moves = moves or Moves()
        found = sample(
            start, lambda drives, _: problem.target(drives), CHANCES, problem.laws, random, moves, count=count
        )
        parts.append(found.drives)
        evidence.append(found.log_evidence)
    law, closure, latent = (
        np.concatenate([getattr(p, key) for p in parts]) for key in ("law", "closure", "latent")
    )
    return Run(Drives(law, closure, latent), float(np.unique(latent[:, 0]).size), float(np.mean(evidence)))


def hersey_large(problem: Problem, seed: int) -> Run:
    """The package's own sampler with ten times the draws."""
    return hersey_smc(problem, seed, 10 * DRAWS)


def hersey_moves(problem: Problem, seed: int) -> Run:
    """The package's own sampler with four times the moves."""
    usual = Moves()
    return hersey_smc(problem, seed, moves=Moves(4 * usual.often, 4 * usual.rounds, 4 * usual.last))


def importance(problem: Problem, seed: int) -> Run:
    """Draws of the prior by the weight of their likelihood, without moves."""
    random = np.random.default_rng(seed)
    prior = problem.prior(10 * DRAWS, random)
    value = problem.target(prior)
    weight = np.exp(value - value.max())
    own = float(weight.sum() ** 2 / np.sum(weight**2))
    log_z = float(np.log(weight.mean()) + value.max())
    return Run(prior.take(_equal(weight, DRAWS, random)), own, log_z)


def dynesty_nested(problem: Problem, seed: int) -> Run:
    """dynesty: static nested sampling with random walks; it evaluates one draw at a time."""
    import dynesty

    sampler = dynesty.NestedSampler(
        lambda cube: float(problem.target(problem.from_cube(cube))[0]),
        lambda cube: cube,
        problem.dimensions,
        nlive=250,
        sample="rwalk",
        rstate=np.random.default_rng(seed),
    )
    sampler.run_nested(print_progress=False)
    found: Any = sampler.results
    return _weighed(problem, found.samples, found.logwt, float(found.logz[-1]), seed)


def nautilus_nested(problem: Problem, seed: int) -> Run:
    """nautilus: importance nested sampling with neural networks, vectorised."""
    from nautilus import Sampler

    sampler = Sampler(
        lambda cube: cube,
        lambda cube: problem.target(problem.from_cube(cube)),
        problem.dimensions,
        n_live=1000,
        n_networks=1,
        vectorized=True,
        pass_dict=False,
        seed=seed,
    )
    sampler.run(n_eff=DRAWS, n_like_max=60_000, verbose=False)
    cube, log_weight, _ = sampler.posterior()
    return _weighed(problem, cube, log_weight, float(sampler.log_z), seed)


def emcee_ensemble(problem: Problem, seed: int) -> Run:
    """emcee: differential evolution of 200 walkers from the prior, vectorised; the first half is dropped."""
    import emcee

    def density(normals: FloatArray) -> FloatArray:
        return problem.target(problem.from_normals(normals)) - 0.5 * np.sum(normals**2, axis=1)

    walkers, steps, every = 200, 400, 20
    random = np.random.default_rng(seed)
    start = random.standard_normal((walkers, problem.dimensions))
    moves = [(emcee.moves.DEMove(), 0.8), (emcee.moves.DESnookerMove(), 0.2)]
    sampler = emcee.EnsembleSampler(walkers, problem.dimensions, density, vectorize=True, moves=moves)
    sampler.random_state = np.random.RandomState(seed).get_state()
    sampler.run_mcmc(start, steps)
    length = sampler.get_autocorr_time(discard=steps // 2, quiet=True, tol=0)
    kept = sampler.get_chain(discard=steps // 2, thin=every, flat=True)
    return Run(problem.from_normals(kept), walkers * (steps / 2) / float(np.nanmean(length)))


def blackjax_smc(problem: Problem, seed: int) -> Run:
    """blackjax: adaptive tempered SMC, ten random-walk steps by the covariance of the draws, vectorised."""
    import blackjax
    import jax
    import jax.numpy as jnp
    from blackjax.mcmc import random_walk
    from blackjax.smc import extend_params, resampling
    from blackjax.smc.tuning.from_particles import particles_covariance_matrix

    jax.config.update("jax_enable_x64", True)
    shape = 2.38 / np.sqrt(problem.dimensions)

    def likelihood(normals: Any) -> Any:
        def outside(rows: Any) -> FloatArray:
            flat = np.asarray(rows).reshape(-1, problem.dimensions)
            value = np.maximum(problem.target(problem.from_normals(flat)), -1e10)
            return value.reshape(np.shape(rows)[:-1])

        out = jax.ShapeDtypeStruct(normals.shape[:-1], jnp.float64)
        return jax.pure_callback(outside, out, normals, vmap_method="broadcast_all")

    def step(key: Any, state: Any, density: Any, root: Any) -> Any:
        return random_walk.build_additive_step()(key, state, density, random_walk.normal(root))

    def tuned(_key: Any, state: Any, _info: Any) -> dict[str, Any]:
        covariance = particles_covariance_matrix(state.particles)
        root = jnp.linalg.cholesky(covariance + 1e-9 * jnp.eye(problem.dimensions))
        return extend_params({"root": shape * root})

    algorithm = blackjax.inner_kernel_tuning(
        smc_algorithm=blackjax.adaptive_tempered_smc,
        logprior_fn=lambda normals: -0.5 * jnp.sum(normals**2),
        loglikelihood_fn=likelihood,
        mcmc_step_fn=step,
        mcmc_init_fn=random_walk.init,
        resampling_fn=resampling.systematic,
        mcmc_parameter_update_fn=tuned,
        initial_parameter_value=extend_params({"root": shape * jnp.eye(problem.dimensions)}),
        num_mcmc_steps=10,
        target_ess=0.5,
    )
    key = jax.random.key(seed)
    key, first = jax.random.split(key)
    state = algorithm.init(jax.random.normal(first, (DRAWS, problem.dimensions)))
    advance, log_z = jax.jit(algorithm.step), 0.0
    while float(state.sampler_state.tempering_param) < 1.0:
        key, now = jax.random.split(key)
        state, info = advance(now, state)
        log_z += float(info.log_likelihood_increment)
    # its draws move before they are weighed, so that the last weights are still to be counted
    weight = np.array(state.sampler_state.weights)
    chosen = _equal(weight, DRAWS, np.random.default_rng(seed))
    drawn = np.asarray(state.sampler_state.particles)[chosen]
    return Run(problem.from_normals(drawn), float(np.unique(drawn[:, 0]).size), log_z)


#: Name, package that it needs, and function of each sampler.
SAMPLERS: dict[str, tuple[str, Callable[[Problem, int], Run]]] = {
    "hersey": ("hersey", hersey_smc),
    "hersey, 10 x draws": ("hersey", hersey_large),
    "hersey, 4 x moves": ("hersey", hersey_moves),
    "importance": ("hersey", importance),
    "dynesty": ("dynesty", dynesty_nested),
    "blackjax": ("blackjax", blackjax_smc),
    "emcee": ("emcee", emcee_ensemble),
    "nautilus": ("nautilus", nautilus_nested),
}


@cache
def _model() -> tuple[DriveModel, float | None]:
    machine = hersey.read_machine(ROOT / "examples" / "machine.toml")
    assert machine.rest is not None
    points = hersey.read(ROOT / "examples" / "bench.csv").steady(tare="standing").without(machine.rest)
    surface = fit(points)
    model = DriveModel(fit_curves(points, surface), surface, machine, DrivePriors.of(machine))
    return model, decision_temperature(surface, machine)


def _evidence(case: str) -> list[Evidence]:
    """What the draw with the middle V* shows, of those whose belt comes to rest gradually."""
    model, kelvin = _model()
    of_prior = _problem_of(())
    drives = hersey_smc(of_prior, 1).drives
    drives = drives.take(np.flatnonzero(drives.closure == 0).astype(np.intp))
    folds = edges_at(model, drives, kelvin)
    middle = np.argsort(folds.fold)[len(drives) // 2]
    truth = drives.take(np.array([middle], dtype=np.intp))
    if case == "starts":
        return [Start(kelvin, share * float(folds.fold[middle]), share > 1.0) for share in (0.9, 1.1)]
    speed = SLIP_AT * float(folds.transition[middle])
    seen = model.starts(truth, kelvin, speed)
    assert seen.sticks[0]
    period, top, low = float(seen.period[0]), float(seen.pull_max[0]), float(seen.pull_min[0])
    figures = CycleFigures((period, FIGURE_ERROR), (top, FIGURE_ERROR), (top - low, FIGURE_ERROR), None)
    return [StickSlip(kelvin, speed, 20.0, figures)]


def _problem_of(evidence: Sequence[Evidence]) -> Problem:
    model, kelvin = _model()

    def likelihood(drives: Drives) -> FloatArray:
        value = model.log_weight(drives)
        return value + log_likelihood(model, drives, evidence) if evidence else value

    def fold(drives: Drives) -> FloatArray:
        return 1e3 * edges_at(model, drives, kelvin).fold

    return Problem(model.curves.weights, model.size, likelihood, fold)


def problem_of(case: str) -> Problem:
    """Return the density of a case."""
    if case == "two modes":
        model, _ = _model()
        count = len(NUMBERS)

        def likelihood(drives: Drives) -> FloatArray:
            at = drives.latent[:, :count]
            logs = [
                np.log(weight) - 0.5 * np.sum(((at - side * MODE_AT) / MODE_WIDTH) ** 2, axis=1)
                for side, weight in ((1.0, MODE_WEIGHT), (-1.0, 1.0 - MODE_WEIGHT))
            ]
            density = logsumexp(logs, axis=0) - count * np.log(MODE_WIDTH)
            return np.asarray(density + 0.5 * np.sum(at**2, axis=1))

        return Problem(
            model.curves.weights, model.size, likelihood, lambda d: (d.latent[:, 0] > 0).astype(float), False
        )
    return _problem_of(() if case == "dwells" else _evidence(case))


def reference(case: str, problem: Problem) -> Run:
    """Draws of the answer: by importance from the prior, or exactly."""
    random = np.random.default_rng(12345)
    if not problem.real:
        drives = problem.prior(KEPT, random)
        side = np.where(np.arange(KEPT) < MODE_WEIGHT * KEPT, 1.0, -1.0)[:, None]
        noise = random.standard_normal((KEPT, len(NUMBERS)))
        drives.latent[:, : len(NUMBERS)] = side * MODE_AT + MODE_WIDTH * noise
        return Run(drives, KEPT, 0.0)
    model, _ = _model()
    prior = problem.prior(PRIOR_DRAWS, random)
    first = model.log_weight(prior)
    weight = np.exp(first - first.max())
    own, log_z = weight.sum() ** 2 / np.sum(weight**2), np.log(weight.mean()) + first.max()
    if case == "dwells":
        return Run(prior.take(_equal(weight, KEPT, random)), float(own), float(log_z))
    count = START_DRAWS if case == "starts" else DWELL_DRAWS
    chosen = _equal(weight, count, random)
    drives = prior.take(chosen)
    value = problem.likelihood(drives) - first[chosen]
    weight = np.where(np.isnan(value), 0.0, np.exp(value - np.nanmax(value)))
    log_z += np.log(weight.mean()) + np.nanmax(value)
    # a draw of the prior that was taken several times counts once
    own = weight.sum() ** 2 / np.sum(np.bincount(chosen, weight) ** 2)
    return Run(drives.take(_equal(weight, KEPT, random)), float(own), float(log_z))


def figures_of(problem: Problem, drives: Drives) -> Figures:
    """Return what is compared of draws."""
    count = len(drives)
    if count > max(MOST, KEPT):
        drives = drives.take(np.linspace(0, count - 1, MOST).astype(np.intp))
    closures = np.bincount(drives.closure, minlength=CHANCES.size) / len(drives)
    return Figures(problem.figure(drives), closures, drives.latent[:, : len(NUMBERS)])


def effective(problem: Problem, runs: Sequence[Figures], truth: Figures) -> float:
    """Return one over the mean square of error over standard deviation against the reference."""
    out = []
    spread = np.sqrt(truth.closures * (1.0 - truth.closures))
    # the share of a closure that hardly any draw has says nothing
    told = spread > LEAST_SPREAD
    ordered = np.sort(truth.values)
    for run in runs:
        off = [float(o) for o in ((run.closures - truth.closures)[told] / spread[told])[:2]]
        if problem.real:
            rank = 0.5 * sum(
                np.searchsorted(ordered, run.values, side) / ordered.size for side in ("left", "right")
            )
            off.append((float(np.mean(rank)) - 0.5) * np.sqrt(12.0))
            off += list((run.numbers.mean(axis=0) - truth.numbers.mean(axis=0)) / truth.numbers.std(axis=0))
        else:
            share = truth.values.mean()
            off.append((run.values.mean() - share) / np.sqrt(share * (1.0 - share)))
        out.append(np.mean(np.square(off)))
    return 1.0 / float(np.mean(out))


def _spread(values: Sequence[float], digits: str = ".3g") -> str:
    """Mean, least and greatest of the seeds."""
    low, high = format(min(values), digits), format(max(values), digits)
    return format(float(np.mean(values)), digits) + (f" ({low} to {high})" if low != high else "")


def _line(problem: Problem, row: Row, truth: Figures | None) -> str:
    """One row of the table."""
    if problem.real:
        ends = np.array([np.quantile(f.values, (0.5, 0.025, 0.975)) for f in row.figures]).T
        shown = " / ".join(_spread(list(end)) for end in ends)
    else:
        shown = _spread([100.0 * float(f.values.mean()) for f in row.figures])
    shares = 100.0 * np.array([f.closures for f in row.figures]).T
    closures = " / ".join(_spread(list(share), ".0f") for share in shares)
    by_error = f"{effective(problem, row.figures, truth):.0f}" if truth is not None else ""
    return (
        f"| {row.name} | {np.mean(row.seconds):.3g} | {np.mean(row.in_target):.3g} "
        f"| {np.mean(row.evaluations):.3g} | {_spread([r.own for r in row.runs], '.0f')} | {by_error} "
        f"| {shown} | {closures} | {_spread([r.log_evidence for r in row.runs], '.2f')} |"
    )


def compare(case: str, names: Sequence[str], seeds: int) -> None:
    """Run the samplers on one case and print the table."""
    problem = problem_of(case)
    began = time.process_time()
    exact = reference(case, problem)
    truth = figures_of(problem, exact.drives)
    row = Row("reference", [time.process_time() - began], [np.nan], [0], [exact], [truth])
    figure = "V*, mm/s: median / 2.5 % / 97.5 %" if problem.real else "share of the lighter mode, %"
    print(f"\n{case}, {seeds} seeds: mean (least to greatest)\n")
    print(
        "| sampler | processor, s | of it likelihood | draws evaluated | effective, own | by error "
        f"| {figure} | {' / '.join(CLOSURES)}, % | ln evidence |\n" + "|---" * 9 + "|"
    )
    print(_line(problem, row, None), flush=True)
    for name in names:
        run, row = SAMPLERS[name][1], Row(name)
        for seed in range(1, seeds + 1):
            one = replace(problem, evaluations=0, seconds=0.0)
            began = time.process_time()
            row.runs.append(run(one, seed))
            row.seconds.append(time.process_time() - began)
            row.in_target.append(one.seconds)
            row.evaluations.append(one.evaluations)
            row.figures.append(figures_of(problem, row.runs[-1].drives))
        print(_line(problem, row, truth), flush=True)


def main() -> None:
    """Compare the samplers on the cases asked for."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--cases", nargs="+", choices=CASES, default=list(CASES))
    parser.add_argument("--samplers", nargs="+", choices=list(SAMPLERS), default=list(SAMPLERS))
    parser.add_argument("--seeds", type=int, default=3)
    given = parser.parse_args()
    names = []
    for name in given.samplers:
        package = SAMPLERS[name][0]
        if importlib.util.find_spec(package) is None:
            print(f"{name} is skipped: package {package} is not installed")
        else:
            names.append(name)
    for case in given.cases:
        compare(case, names, given.seeds)


if __name__ == "__main__":
    main()
