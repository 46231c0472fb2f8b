"""Time of planes() on a machine that does other work: all threads against one.

usage: python3 test/benchmark/busy.py

Keeps two cores busy with loops, then times a cloud of 10 000 points by turns with all threads and with one, 40 times. Prints
the median times and their ratio.
"""
import subprocess
import sys
import time

import numpy as np

import pcl_symmetry


def main():
    points = np.random.default_rng(1).normal(size=(10_000, 3))
    points = (points / np.linalg.norm(points, axis=1, keepdims=True) * (1.0, 0.7, 0.4) + 0.1 * (points[:, :1] > 0) * points).astype(np.float32)
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    try:
        times = {0: [], 1: []}
        for _ in range(40):
            for threads, measured in times.items():
                begin = time.perf_counter()
                pcl_symmetry.planes(points, threads=threads)
                measured.append(1000 * (time.perf_counter() - begin))
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
    default, one = (float(np.median(times[threads])) for threads in (0, 1))
    print(f"{default:.1f} ms with all threads, {one:.1f} ms with one: ratio {default / one:.2f}")


if __name__ == "__main__":
    main()
