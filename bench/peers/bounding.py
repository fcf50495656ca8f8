"""dynesty's bounding ellipsoid of points in the protocol of protocol.hpp: bounding.py INPUT CENTER.

That of their covariance, widened until all are inside: it encloses, and is not meant to be the smallest. The answer is
the center c, then Q by rows: {x : (x - c)'Q(x - c) <= 1}. The radius is the logarithm of the volume it claims.
"""

import json
import sys
import time

import numpy
from dynesty import bounding


def main():
    input_path, center_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        points = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        found = bounding.bounding_ellipsoid(points)
        seconds = time.perf_counter() - start
        numbers = numpy.concatenate([found.ctr, numpy.linalg.inv(found.cov).ravel()])
        numbers.astype("<f8").tofile(center_path)
        answer = {"seconds": seconds, "radius": float(found.logvol), "support": 0}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
