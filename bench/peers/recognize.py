"""scikit-learn's OneClassSVM in the protocol of protocol.hpp: recognize.py NU-GAMMA INPUT CENTER.

NU is `hard` for a ball around all points, that is 1/n. Its dual is that of the ball in the feature space of the Gaussian kernel: the radius
that is told is D, half the mean squared distance of the points by its multipliers, from exact sums over its support vectors.
"""

import json
import sys
import time

import numpy
from sklearn.svm import OneClassSVM


def main():
    way, input_path, center_path = sys.argv[1:]
    nu, gamma = way.split("-", 1)
    with open(input_path, "rb") as file:
        rows, columns = (int(count) for count in numpy.fromfile(file, dtype="<u8", count=2))
        points = numpy.fromfile(file, dtype="<f8").reshape(rows, columns)
    share = 1.0 / rows if nu == "hard" else float(nu)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        found = OneClassSVM(kernel="rbf", gamma=float(gamma), nu=share, tol=1e-5, cache_size=2000).fit(points)
        seconds = time.perf_counter() - start
        weights = found.dual_coef_[0] / found.dual_coef_.sum()
        support = found.support_vectors_
        total = 0.0
        for row, weight in zip(support, weights):
            total += weight * (weights * -2.0 * numpy.expm1(-float(gamma) * ((support - row) ** 2).sum(1))).sum()
        numpy.array([total / 2]).astype("<f8").tofile(center_path)
        print(json.dumps({"seconds": seconds, "radius": total / 2, "support": len(support)}), flush=True)


if __name__ == "__main__":
    main()
