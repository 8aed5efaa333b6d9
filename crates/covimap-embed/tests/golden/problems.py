"""Writes the problems that all programs are given, and the starts that they start from.

Rscript eurodist.R && python problems.py
"""

import csv
import pathlib

import numpy as np

HERE = pathlib.Path(__file__).parent / "problems"
RANDOM_STARTS = 10


def distances(points):
    difference = points[:, None, :] - points[None, :, :]
    return np.sqrt((difference**2).sum(-1))


def noisy_plane(rng):
    """40 points of a square, distances wrong by 15 %."""
    table = distances(rng.uniform(size=(40, 2)))
    return symmetric(table * rng.lognormal(sigma=0.15, size=table.shape))


def five_dimensions(rng):
    """50 points of a cube of five dimensions: no plane fits well."""
    return distances(rng.uniform(size=(50, 5)))


def bent(rng):
    """40 points of a square, the distances after a steep rising curve and with noise."""
    table = distances(rng.uniform(size=(40, 2)))
    return symmetric((table**2.5 + 0.1) * rng.lognormal(sigma=0.1, size=table.shape))


def marks(rng):
    """30 objects whose differences are given as marks from 1 to 9: many ties."""
    table = distances(rng.uniform(size=(30, 3)))
    return np.ceil(9 * table / table.max()) + (table == 0)


def offset(rng):
    """35 points of a square, distances times 3 plus 2, with noise."""
    table = distances(rng.uniform(size=(35, 2)))
    return symmetric(3 * table + 2 + rng.normal(scale=0.15, size=table.shape))


def symmetric(table):
    upper = np.triu(table, 1)
    return upper + upper.T


def gaps(rng):
    """45 points of a square: nearer pairs are listed more often and weigh more, 45 % are missing."""
    table = symmetric(distances(rng.uniform(size=(45, 2))) * rng.lognormal(sigma=0.1, size=(45, 45)))
    listed = symmetric(rng.uniform(size=table.shape) < np.exp(-1.2 * table)) > 0
    return [
        (i, j, table[i, j], rng.uniform(0.2, 1.0) / table[i, j] ** 2)
        for i, j in pairs_of(len(table))
        if listed[i, j] or j == i + 1
    ]


def bounds(rng):
    """30 points of a square: distances below 0.35 with noise, of the others a lower bound."""
    table = distances(rng.uniform(size=(30, 2)))
    rows = []
    for i, j in pairs_of(len(table)):
        if table[i, j] < 0.35 or j == i + 1:
            d = table[i, j] * rng.lognormal(sigma=0.08)
            rows.append((i, j, d, 1.0, d, d))
        else:
            rows.append((i, j, 0.6, 0.5, rng.uniform(0.25, 0.45), np.inf))
    return rows


def pairs_of(n):
    return [(i, j) for i in range(n) for j in range(i + 1, n)]


def classical(table):
    """Classical scaling: the two leading eigenvectors of the centred inner products."""
    n = len(table)
    centring = np.eye(n) - 1 / n
    values, vectors = np.linalg.eigh(-0.5 * centring @ table**2 @ centring)
    return vectors[:, [-1, -2]] * np.sqrt(values[[-1, -2]])


def read_table(name):
    rows = np.loadtxt(HERE / name / "pairs.csv", delimiter=",", skiprows=1)
    n = int(rows[:, 1].max()) + 1
    table = np.full((n, n), np.nan)
    np.fill_diagonal(table, 0)
    i, j = rows[:, 0].astype(int), rows[:, 1].astype(int)
    table[i, j] = table[j, i] = rows[:, 2]
    return table


def shortest_paths(table):
    paths = np.where(np.isnan(table), np.inf, table)
    for k in range(len(paths)):
        paths = np.minimum(paths, paths[:, [k]] + paths[[k], :])
    return np.where(np.isnan(table), paths, table)


def write(path, header, rows):
    path.parent.mkdir(parents=True, exist_ok=True)
    with open(path, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def write_problems():
    rng = np.random.default_rng(20260401)
    for make in (noisy_plane, five_dimensions, bent, marks, offset):
        table = make(rng)
        rows = [(i, j, f"{table[i, j]:.6g}", 1) for i, j in pairs_of(len(table))]
        write(HERE / make.__name__ / "pairs.csv", ["i", "j", "dissimilarity", "weight"], rows)
    rows = [(i, j, f"{d:.6g}", f"{w:.4g}") for i, j, d, w in gaps(rng)]
    write(HERE / "gaps" / "pairs.csv", ["i", "j", "dissimilarity", "weight"], rows)
    header = ["i", "j", "dissimilarity", "weight", "lower", "upper"]
    rows = [(i, j) + tuple(f"{x:.6g}" for x in rest) for i, j, *rest in bounds(rng)]
    write(HERE / "bounds" / "pairs.csv", header, rows)


def write_starts():
    """Start 0 is classical scaling (of shortest paths where pairs are missing), the others are random."""
    for number, folder in enumerate(sorted(path.parent for path in HERE.glob("*/pairs.csv"))):
        rng = np.random.default_rng(number)
        table = read_table(folder.name)
        scale = np.sqrt(np.nanmean(table**2))
        starts = [classical(shortest_paths(table))]
        starts += [scale * rng.uniform(-1, 1, size=(len(table), 2)) for _ in range(RANDOM_STARTS)]
        rows = [
            (start, i, f"{x:.6g}", f"{y:.6g}") for start, points in enumerate(starts) for i, (x, y) in enumerate(points)
        ]
        write(folder / "starts.csv", ["start", "object", "x", "y"], rows)


if __name__ == "__main__":
    write_problems()
    write_starts()
