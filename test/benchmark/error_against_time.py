#!/usr/bin/env python3
"""Draws the error of the estimators of the transform against the time that one thread takes (Figure 6), and prints it.

example: error_against_time.py build-benchmark/test/benchmark/benchmark_accuracy error.png
"""
import argparse
from collections import defaultdict

import numpy as np

import bench


def program(arguments):
    curves = defaultdict(lambda: defaultdict(list))
    for row in bench.google_benchmark(arguments.benchmark):
        method, setting = row["name"].split("/")[:2]
        voting = "voting" in method  # estimates averages over bins, and is judged by them
        error = row["rms_of_averages_percent" if voting else "rms_percent"]
        curves[method.replace("Error_", "").replace("_", " ")][setting].append((row["cpu_ms"], error))

    def draw(axes):
        for method, settings in curves.items():
            points = [(np.mean(np.array(each)[:, 0]), np.sqrt(np.mean(np.square(np.array(each)[:, 1])))) for each in settings.values()]
            for setting, (time, error) in zip(settings, points):
                print(f"{method:20} {setting:22} {time:9.2f} ms {error:7.3f} %")
            axes.loglog(*zip(*points), "o-", label=method)
        axes.axhline(1.0, color="gray", linewidth=0.8)
        axes.set(xlabel="time of one thread [ms]", ylabel="root mean square error of PRST [%], mean of five models")
        axes.legend()

    bench.save_figure(arguments.picture, draw)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("benchmark", help="program benchmark_accuracy")
    parser.add_argument("picture", help="file that is written")
    bench.main(program, parser.parse_args())
