"""cyminiball or miniball from PyPI, in the protocol of protocol.hpp: pypi.py PACKAGE INPUT CENTER."""

import json
import sys
import time

import numpy


def solver(package):
    """The package's function from points to (center, squared radius)."""
    if package == "cyminiball":
        import cyminiball

        return lambda points: cyminiball.compute(points)[:2]
    if package == "miniball":
        import miniball

        # Its random restarts draw from a generator that is given, so that runs can be repeated.
        return lambda points: miniball.get_bounding_ball(points, rng=numpy.random.default_rng(0))
    sys.exit(f"{package}: expected cyminiball or miniball")


def main():
    package, input_path, center_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        rows, columns = numpy.fromfile(file, dtype="<u8", count=2)
        points = numpy.fromfile(file, dtype="<f8").reshape(int(rows), int(columns))
    solve = solver(package)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        center, squared_radius = solve(points)
        seconds = time.perf_counter() - start
        numpy.asarray(center, dtype="<f8").tofile(center_path)
        print(
            json.dumps({"seconds": seconds, "radius": float(squared_radius) ** 0.5, "support": 0}),
            flush=True,
        )


if __name__ == "__main__":
    main()
