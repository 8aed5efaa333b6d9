"""The speed of scaling against scikit-learn's, in one run on one thread.

    cargo build --release -p covimap-embed --example speed
    OMP_NUM_THREADS=1 python crates/covimap-embed/benches/against_scikit_learn.py target/release/examples/speed

Both start from the same random configuration of the same distances. scikit-learn runs `smacof` to its own
convergence, ours until its stress is at most that. Times are CPU seconds, which other work on the
machine hardly disturbs: of scikit-learn the least of some runs, of ours the mean of many, less the reading of the problem.
Needs scikit-learn and a Unix.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np
import sklearn
from sklearn.isotonic import isotonic_regression
from sklearn.manifold import smacof

SPEED = os.path.abspath(sys.argv[1])


def ours(*arguments, repeats):
    """What `speed` prints, and its CPU seconds a repeat."""
    text, with_repeats = child(*arguments, repeats)
    _, without = child(*arguments, 0)
    return text, (with_repeats - without) / repeats


def child(*arguments):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    environment = {**os.environ, "RAYON_NUM_THREADS": "1"}
    command = [SPEED, *map(str, arguments)]
    text = subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    # System time too: what is allocated must be paid for.
    return text.split(), after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def timed(run, repeats):
    times = []
    for _ in range(repeats):
        start = time.process_time()
        result = run()
        times.append(time.process_time() - start)
    return result, min(times)


def complete(n, eps, repeats):
    rng = np.random.default_rng(n)
    objects = rng.uniform(size=(n, 3))
    table = np.sqrt(((objects[:, None] - objects[None]) ** 2).sum(-1))
    start = rng.uniform(-0.5, 0.5, size=(n, 2))

    def run():
        return smacof(table, init=start, n_init=1, max_iter=100_000, eps=eps, normalized_stress=False, return_n_iter=True)

    (_, stress, steps), theirs = timed(run, repeats)
    with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
        np.savetxt(file, np.hstack([objects, start]), fmt="%.17g")
        file.flush()
        text, seconds = ours("complete", file.name, repr(float(stress) * (1 + 1e-12)), repeats=max(3, 20_000 // n))
    print(f"| {n} | {eps:g} | {stress:.6g} | {steps} | {theirs:.3f} | {text[0]} | {seconds:.4f} | {theirs / seconds:.0f} |", flush=True)


def main():
    print("scikit-learn", sklearn.__version__, "numpy", np.__version__, "threads", os.environ.get("OMP_NUM_THREADS"))
    print("| objects | eps | stress | their steps | their s | our steps | our s | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    for n, repeats in ((300, 3), (1000, 2)):
        for eps in (1e-6, 1e-9):
            complete(n, eps, repeats)
    for steps in ("plain", "relaxed", "quasi-newton"):
        text, seconds = ours("neighbours", steps, repeats=1)
        print(f"100 000 objects, 10 neighbours, 100 {steps} steps: {seconds:.2f} s, stress-1 {text[0]}", flush=True)
    _, seconds = ours("isotonic", repeats=5)
    values = 1e-6 * np.arange(10_000_000) + np.random.default_rng(3).uniform(size=10_000_000)
    _, theirs = timed(lambda: isotonic_regression(values), 2)
    print(f"monotone regression of 10 000 000 values: {seconds:.3f} s, scikit-learn {theirs:.3f} s")


if __name__ == "__main__":
    main()
