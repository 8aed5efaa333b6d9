"""What scipy makes of weighted stress, of missing pairs and bounds, and of Procrustes problems.

The stress is minimised by BFGS: nothing but the value and the gradient of the stress is shared with
majorisation.

python scipy_fits.py
"""

import numpy as np
import scipy
from scipy.optimize import minimize
from scipy.spatial import procrustes

from problems import HERE, write
from scikit_learn import read_starts


def read_pairs(name):
    rows = np.genfromtxt(HERE / name / "pairs.csv", delimiter=",", skip_header=1)
    i, j = rows[:, 0].astype(int), rows[:, 1].astype(int)
    lower, upper = (rows[:, 4], rows[:, 5]) if rows.shape[1] > 4 else (rows[:, 2], rows[:, 2])
    return i, j, rows[:, 3], lower, upper


def least_stress(name, start):
    i, j, weight, lower, upper = read_pairs(name)

    def stress(flat):
        points = flat.reshape(-1, 2)
        difference = points[i] - points[j]
        r = np.sqrt((difference**2).sum(1)) + 1e-300
        miss = r - np.clip(r, lower, upper)
        pull = (2 * weight * miss / r)[:, None] * difference
        gradient = np.zeros_like(points)
        np.add.at(gradient, i, pull)
        np.add.at(gradient, j, -pull)
        return (weight * miss**2).sum(), gradient.ravel()

    flat = start.ravel()
    for _ in range(5):
        found = minimize(stress, flat, jac=True, method="BFGS", options={"gtol": 1e-12, "maxiter": 100_000})
        flat = found.x
    return found.fun


def write_stress():
    rows = [
        (name, "scipy BFGS", start, repr(float(least_stress(name, points))))
        for name in ("gaps", "bounds")
        for start, points in enumerate(read_starts(name))
    ]
    write(HERE.parent / "expected" / "scipy.csv", ["problem", "method", "start", "stress"], rows)


def write_procrustes():
    rng = np.random.default_rng(3)
    rows = []
    for case, n in enumerate((3, 4, 10, 100)):
        source = np.round(rng.normal(size=(n, 2)), 6)
        turn = np.linalg.qr(rng.normal(size=(2, 2)))[0]
        target = np.round(2.5 * source @ turn + [3, -1] + rng.normal(scale=0.3, size=(n, 2)), 6)
        _, _, disparity = procrustes(target, source)
        rows += [(case, *map(float, s), *map(float, t), repr(float(disparity))) for s, t in zip(source, target)]
    header = ["case", "source_x", "source_y", "target_x", "target_y", "disparity"]
    write(HERE.parent / "expected" / "procrustes.csv", header, rows)


if __name__ == "__main__":
    print("scipy", scipy.__version__, "numpy", np.__version__)
    write_stress()
    write_procrustes()
