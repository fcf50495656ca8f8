"""LKH through elkai in the protocol of protocol.hpp: tours.py elkai INPUT CENTER, points that are whole numbers.

What goes to CENTER is the order of the rows, as doubles. Seconds are those of the call, which writes the problem down for
LKH and reads the tour.
"""

import json
import sys
import time

import elkai
import numpy


def main():
    _, input_path, center_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        rows = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    places = {row: tuple(int(value) for value in place) for row, place in enumerate(rows)}
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        # The tour ends where it begins.
        order = elkai.Coordinates2D(places).solve_tsp(runs=1)[:-1]
        seconds = time.perf_counter() - start
        numpy.asarray(order, dtype="<f8").tofile(center_path)
        tour = rows[order]
        length = float(numpy.hypot(*(tour - numpy.roll(tour, -1, axis=0)).T).sum())
        print(json.dumps({"seconds": seconds, "radius": length, "support": 0}), flush=True)


if __name__ == "__main__":
    main()
