"""scikit-learn's MinCovDet in the protocol of protocol.hpp: mcd.py INPUT ROWS.

The answer is the rows, from 0, of the h = (n + d + 1) // 2 points that it keeps before it weighs outliers. The seconds
are those of the processor, with one thread; its random starts draw from seed 0. The radius means nothing.
"""

import json
import sys
import time

import numpy
from sklearn.covariance import MinCovDet


def main():
    input_path, rows_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        rows, columns = (int(count) for count in numpy.fromfile(file, dtype="<u8", count=2))
        points = numpy.fromfile(file, dtype="<f8").reshape(rows, columns)
    kept = (rows + columns + 1) // 2
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.process_time()
        # It rounds the product of the fraction and n down.
        found = MinCovDet(support_fraction=(kept + 0.5) / rows, random_state=0).fit(points)
        seconds = time.process_time() - start
        numpy.flatnonzero(found.raw_support_).astype("<f8").tofile(rows_path)
        print(json.dumps({"seconds": seconds, "radius": 1.0, "support": kept}), flush=True)


if __name__ == "__main__":
    main()
