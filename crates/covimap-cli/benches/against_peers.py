"""A whole build against the layout programs that one would take instead, in one run on all cores.

    cargo build --release
    covimap simulate blocks --landmarks 20000 --steps 400000 --seed 1 -o blocks
    python crates/covimap-cli/benches/against_peers.py target/release/covimap blocks

Peers get the distances `sqrt(-0.3 ln f)` of all pairs seen together; counting and distances are free. Ours is
timed as a process, from the log to the written map. PyMDE starts from an Isomap (of 200 pivots, the fastest form of
it), whose time has a row of its own, and runs twice: to its own convergence (`eps` 1e-5), and for two thousand
iterations whatever they gain. The maps are judged by the same
program: positions take the place of ours in a copy of the map.
Needs NumPy, SciPy, PyMDE and s_gd2; with `--networkit` NetworKit too, which is slow.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

import numpy as np
import pymde
import s_gd2
import scipy.sparse as sparse
import torch
from scipy.sparse.csgraph import dijkstra

COVIMAP, FOLDER = os.path.abspath(sys.argv[1]), sys.argv[2]
LOG, TRUTH = (os.path.join(FOLDER, name) for name in ("observations.jsonl", "truth.csv"))
PIVOTS = 200


def linked_pairs(numbers):
    """Pairs seen together and their distances."""
    rows, columns = [], []
    with open(LOG) as log:
        for step, line in enumerate(log):
            seen = [numbers[name] for name in json.loads(line)["seen"]]
            rows += [step] * len(seen)
            columns += seen
    seen = sparse.csr_array((np.ones(len(rows), np.int32), (rows, columns)), shape=(step + 1, len(numbers)))
    both = sparse.triu((seen.T @ seen).tocoo(), k=1).tocoo()
    alone = np.asarray(seen.sum(axis=0)).ravel()
    frequency = both.data / (alone[both.row] + alone[both.col] - both.data)
    # Pairs always seen together have no distance; the log of half a look less.
    frequency = np.minimum(frequency, 1 - 0.5 / np.maximum(both.data, 1))
    return both.row, both.col, np.sqrt(-0.3 * np.log(frequency))


def isomap(n, first, second, distances):
    """Classical scaling of the paths to some pivots."""
    graph = sparse.csr_array((distances, (first, second)), shape=(n, n))
    pivots = np.random.default_rng(0).choice(n, min(PIVOTS, n), replace=False)
    squares = dijkstra(graph, directed=False, indices=pivots) ** 2
    centred = squares - squares.mean(0) - squares.mean(1, keepdims=True) + squares.mean()
    left, sizes, _ = np.linalg.svd(centred.T @ centred[:, pivots], full_matrices=False)
    start = left[:, :2] * np.sqrt(sizes[:2])
    lengths = np.linalg.norm(start[first] - start[second], axis=1)
    return start * (distances @ lengths) / (lengths @ lengths)


def errors(document, positions):
    """What `covimap evaluate` says of these positions."""
    for landmark, (x, y) in zip(document["landmarks"], positions):
        landmark["x"], landmark["y"] = float(x), float(y)
    with tempfile.NamedTemporaryFile("w", suffix=".json") as copy:
        json.dump(document, copy)
        copy.flush()
        command = [COVIMAP, "evaluate", copy.name, TRUTH, "--json"]
        said = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    return [said[key] for key in ("orientation_error", "local_orientation_error", "delaunay_error")]


def row(name, seconds, figures):
    print(f"| {name} | {seconds:.1f} | " + " | ".join(f"{figure:.4f}" for figure in figures) + " |", flush=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "map.json")
        begin = time.monotonic()
        subprocess.run([COVIMAP, "build", LOG, "-o", file, "--quiet"], check=True)
        ours = time.monotonic() - begin
        with open(file) as text:
            document = json.load(text)
    print("| program | seconds | triangles | near triangles | Delaunay |\n|---|---:|---:|---:|---:|")
    places = [(landmark["x"], landmark["y"]) for landmark in document["landmarks"]]
    row("covimap, log to map", ours, errors(document, places))

    numbers = {landmark["id"]: number for number, landmark in enumerate(document["landmarks"])}
    n = len(numbers)
    first, second, distances = linked_pairs(numbers)
    begin = time.monotonic()
    start = isomap(n, first, second, distances)
    row("Isomap, the start of PyMDE", time.monotonic() - begin, errors(document, start))

    torch.manual_seed(0)
    edges = torch.tensor(np.stack([first, second], 1).astype(np.int64))
    loss = pymde.losses.Quadratic(torch.tensor(distances, dtype=torch.float32))
    for eps, iterations in ((1e-5, 300), (0.0, 2_000)):
        problem = pymde.MDE(n, 2, edges, loss)
        begin = time.monotonic()
        found = problem.embed(X=torch.tensor(start, dtype=torch.float32), eps=eps, max_iter=iterations)
        taken = problem.solve_stats.iterations
        row(f"PyMDE, `eps` {eps:g}, {taken} iterations", time.monotonic() - begin, errors(document, found.numpy()))

    begin = time.monotonic()
    first, second = first.astype(np.int32), second.astype(np.int32)
    found = s_gd2.layout_sparse(first, second, PIVOTS, V=distances, random_seed=0)
    row(f"s_gd2, {PIVOTS} pivots", time.monotonic() - begin, errors(document, found))

    if "--networkit" in sys.argv:
        import networkit

        graph = networkit.Graph(n, weighted=True)
        for i, j, distance in zip(first, second, distances):
            graph.addEdge(int(i), int(j), float(distance))
        begin = time.monotonic()
        layout = networkit.viz.MaxentStress(graph, 2, 1, tolerance=1e-3)
        layout.run()
        found = [(point[0], point[1]) for point in layout.getCoordinates()]
        row("NetworKit MaxentStress", time.monotonic() - begin, errors(document, found))


main()
