#!/usr/bin/env python3
"""Draws the error of the estimators of the transform against the time that one thread takes (Figure 6), and prints it.

example: error_against_time.py build-benchmark/test/benchmark/benchmark_accuracy error.png
"""
import json
import subprocess
import sys
from collections import defaultdict

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    run = subprocess.run([sys.argv[1], "--benchmark_format=json"], stdout=subprocess.PIPE, check=True)
    curves = defaultdict(lambda: defaultdict(list))
    for row in json.loads(run.stdout)["benchmarks"]:
        method, setting = row["name"].split("/")[:2]
        voting = "voting" in method  # estimates averages over bins, and is judged by them
        error = row["rms_of_averages_percent" if voting else "rms_percent"]
        curves[method.replace("Error_", "").replace("_", " ")][setting].append((row["cpu_time"], error))
    for method, settings in curves.items():
        points = [(np.mean(np.array(each)[:, 0]), np.sqrt(np.mean(np.square(np.array(each)[:, 1])))) for each in settings.values()]
        for setting, (time, error) in zip(settings, points):
            print(f"{method:20} {setting:22} {time:9.2f} ms {error:7.3f} %")
        pyplot.loglog(*zip(*points), "o-", label=method)
    pyplot.axhline(1.0, color="gray", linewidth=0.8)
    pyplot.xlabel("time of one thread [ms]")
    pyplot.ylabel("root mean square error of PRST [%], mean of five models")
    pyplot.legend()
    pyplot.savefig(sys.argv[2], dpi=120)


if __name__ == "__main__":
    main()
