"""Laws that anyone has at hand for runs of a stochastic model, beside which an emulator has to stand.

Each takes x [run_count, input_count], y [run_count, output_count], NaN where a run has no outputs, and groups, and
gives what draws `count` outputs of runs that have some at points, [point_count, count, output_count].
"""

from collections.abc import Callable

import numpy as np
from sklearn.ensemble import RandomForestRegressor
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, ConstantKernel, WhiteKernel
from sklearn.mixture import GaussianMixture

Sampler = Callable[[np.ndarray, int, np.random.Generator], np.ndarray]
NEIGHBOURS = (5, 10, 20, 40, 80, 160)
FOLDS, TREES, LEAF, MOST_COMPONENTS = 10, 200, 5, 10


def near_rows(x: np.ndarray, y: np.ndarray, group: np.ndarray) -> Sampler:
    """The k nearest runs, k of least energy score on groups left out."""
    centre, spread = x.mean(axis=0), x.std(axis=0)
    z, fold = (x - centre) / spread, np.unique(group, return_inverse=True)[1] % FOLDS
    unit = y.std(axis=0)
    losses = []
    for k in NEIGHBOURS:
        loss = 0.0
        for one in range(FOLDS):
            rest, test = fold != one, fold == one
            members = y[rest][_nearest(z[test], z[rest], min(k, int(rest.sum())))] / unit
            away = np.linalg.norm(members - y[test][:, None] / unit, axis=2).mean()
            loss += test.sum() * (away - 0.5 * np.linalg.norm(members[:, :, None] - members[:, None], axis=3).mean())
        losses.append(loss)
    best = min(NEIGHBOURS[int(np.argmin(losses))], len(x))

    def sample(points: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
        near = _nearest((points - centre) / spread, z, best)
        return y[np.take_along_axis(near, random.integers(best, size=(len(points), count)), axis=1)]

    return sample


def _nearest(points: np.ndarray, runs: np.ndarray, count: int) -> np.ndarray:
    return np.argsort(((points[:, None] - runs) ** 2).sum(axis=2), axis=1)[:, :count]


def process_and_residuals(x: np.ndarray, y: np.ndarray, group: np.ndarray) -> Sampler:
    """A Gaussian process with a length for each input for the mean, and its leave-one-out residuals as whole rows."""
    centre, spread = x.mean(axis=0), x.std(axis=0)
    z, processes, residuals = (x - centre) / spread, [], []
    for column in y.T:
        kernel = ConstantKernel(1.0) * RBF(np.ones(x.shape[1]), (0.1, 1e3)) + WhiteKernel(0.1, (1e-6, 1e2))
        process = GaussianProcessRegressor(kernel, normalize_y=True, n_restarts_optimizer=1, random_state=0)
        process.fit(z, column)
        inverse = np.linalg.inv(process.L_ @ process.L_.T)
        residuals.append(process._y_train_std * process.alpha_.ravel() / np.diag(inverse))
        processes.append(process)
    rows = np.column_stack(residuals)

    def sample(points: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
        mean = np.column_stack([one.predict((points - centre) / spread) for one in processes])
        return mean[:, None] + rows[random.integers(len(rows), size=(len(points), count))]

    return sample


def forest_rows(x: np.ndarray, y: np.ndarray, group: np.ndarray) -> Sampler:
    """Whole runs by the weights of a forest: how often a run shares a leaf with the point."""
    forest = RandomForestRegressor(
        TREES, min_samples_leaf=LEAF, bootstrap=False, max_features=1.0 / 3.0, random_state=0
    )
    forest.fit(x, y / y.std(axis=0))
    leaves = forest.apply(x)

    def sample(points: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
        drawn = np.empty((len(points), count, y.shape[1]))
        for k, own in enumerate(forest.apply(points)):
            same = leaves == own
            chances = (same / same.sum(axis=0)).mean(axis=1)
            drawn[k] = y[random.choice(len(y), size=count, p=chances / chances.sum())]
        return drawn

    return sample


def gaussian_mixture(x: np.ndarray, y: np.ndarray, group: np.ndarray) -> Sampler:
    """A normal mixture of inputs and outputs together, its number of parts by BIC, given the inputs."""
    both = np.column_stack([x, y])
    centre, spread = both.mean(axis=0), both.std(axis=0)
    z, inputs = (both - centre) / spread, x.shape[1]
    most = min(MOST_COMPONENTS, len(x) // (2 * both.shape[1]))
    fits = [GaussianMixture(k, n_init=2, reg_covar=1e-4, random_state=0).fit(z) for k in range(1, most + 1)]
    best = min(fits, key=lambda one: one.bic(z))

    def sample(points: np.ndarray, count: int, random: np.random.Generator) -> np.ndarray:
        u = (points - centre[:inputs]) / spread[:inputs]
        logs, means, roots = [], [], []
        for share, mean, covariance in zip(best.weights_, best.means_, best.covariances_, strict=True):
            own, cross = covariance[:inputs, :inputs], covariance[inputs:, :inputs]
            slope = np.linalg.solve(own, cross.T)
            away = u - mean[:inputs]
            quadratic = (away * np.linalg.solve(own, away.T).T).sum(axis=1)
            logs.append(np.log(share) - 0.5 * quadratic - 0.5 * np.linalg.slogdet(own)[1])
            means.append(mean[inputs:] + away @ slope)
            roots.append(np.linalg.cholesky(covariance[inputs:, inputs:] - cross @ slope))
        chances = np.exp(np.array(logs) - np.max(logs, axis=0))
        chances /= chances.sum(axis=0)
        ends = np.cumsum(chances, axis=0).T
        part = (random.random((len(points), count))[:, :, None] > ends[:, None]).sum(axis=2).clip(max=len(logs) - 1)
        noise = random.standard_normal((len(points), count, y.shape[1]))
        where = np.array(means)[part, np.arange(len(points))[:, None]]
        return centre[inputs:] + spread[inputs:] * (where + np.einsum("pcij,pcj->pci", np.array(roots)[part], noise))

    return sample


RIVALS = {
    "near rows": near_rows, "process and residuals": process_and_residuals, "forest rows": forest_rows,
    "Gaussian mixture": gaussian_mixture,
}  # fmt: skip
