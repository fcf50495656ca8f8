"""scikit-learn's MinCovDet in the protocol of protocol.hpp: mcd.py H INPUT ROWS.

H is `h` for h = (n + d + 1) // 2 points, as taut keeps, or `own` for as many as scikit-learn keeps by itself. The answer
is three lists of rows, from 0, with -1 between them: those kept before outliers are weighed; those weighed out; those
farther than the quantile 0.975 of chi-squared in the final metric. One thread; random starts draw from seed 0. The
radius means nothing.
"""

import json
import sys
import time

import numpy
from scipy.stats import chi2
from sklearn.covariance import MinCovDet


def main():
    which, input_path, rows_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        rows, columns = (int(count) for count in numpy.fromfile(file, dtype="<u8", count=2))
        points = numpy.fromfile(file, dtype="<f8").reshape(rows, columns)
    kept = (rows + columns + 1) // 2
    # It rounds the product of the fraction and n down.
    fraction = (kept + 0.5) / rows if which == "h" else None
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        found = MinCovDet(support_fraction=fraction, random_state=0).fit(points)
        seconds = time.perf_counter() - start
        beyond = found.mahalanobis(points) > chi2(columns).ppf(0.975)
        lists = [found.raw_support_, ~found.support_, beyond]
        lists = [numpy.append(numpy.flatnonzero(marks), -1) for marks in lists]
        numpy.concatenate(lists).astype("<f8").tofile(rows_path)
        support = int(found.raw_support_.sum())
        print(json.dumps({"seconds": seconds, "radius": 1.0, "support": support}), flush=True)


if __name__ == "__main__":
    main()
