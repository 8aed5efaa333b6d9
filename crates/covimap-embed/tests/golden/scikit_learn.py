"""What scikit-learn makes of the complete problems, and its isotonic regression.

python scikit_learn.py
"""

import numpy as np
import sklearn
from sklearn.isotonic import IsotonicRegression
from sklearn.manifold import smacof

from problems import HERE, read_table, write

COMPLETE = ["bent", "eurodist", "five_dimensions", "marks", "noisy_plane", "offset"]


def read_starts(name):
    rows = np.loadtxt(HERE / name / "starts.csv", delimiter=",", skiprows=1)
    return [rows[rows[:, 0] == start, 2:] for start in range(int(rows[:, 0].max()) + 1)]


def scaled(table, start, metric, normalised):
    return smacof(
        table,
        metric=metric,
        init=start,
        n_init=1,
        max_iter=100_000,
        eps=1e-14,
        normalized_stress=normalised,
        return_n_iter=True,
    )


def write_mds():
    """The stress as scikit-learn reports it by default: raw for metric scaling, stress-1 for the other."""
    rows = []
    for name in COMPLETE:
        table = read_table(name)
        for method in ("metric", "nonmetric"):
            for start, points in enumerate(read_starts(name)):
                metric = method == "metric"
                _, reported, steps = scaled(table, points, metric, normalised=not metric)
                _, stress1, _ = scaled(table, points, metric, normalised=True)
                rows.append((name, f"scikit-learn {method}", start, repr(float(reported)), repr(float(stress1)), steps))
    header = ["problem", "method", "start", "stress", "stress1", "steps"]
    write(HERE.parent / "expected" / "scikit-learn.csv", header, rows)


def write_isotonic():
    rng = np.random.default_rng(1)
    rows = []
    for case, n in enumerate((1, 2, 5, 60, 400)):
        x = np.round(np.sort(rng.uniform(0, n / 3, size=n)), 0 if case % 2 else 6)
        y = np.round(np.sqrt(x) + rng.normal(scale=0.5, size=n), 6)
        weights = np.round(rng.uniform(0.1, 5, size=n), 6)
        fitted = IsotonicRegression().fit_transform(x, y, sample_weight=weights)
        rows += [(case, repr(float(a)), repr(float(b)), repr(float(w)), repr(float(f))) for a, b, w, f in zip(x, y, weights, fitted)]
    write(HERE.parent / "expected" / "isotonic.csv", ["case", "x", "y", "weight", "fitted"], rows)


if __name__ == "__main__":
    print("scikit-learn", sklearn.__version__, "numpy", np.__version__)
    write_mds()
    write_isotonic()
