"""cvxpy with the conic solver Clarabel in the protocol of protocol.hpp: conic.py PROBLEM INPUT CENTER.

PROBLEM is `points` (smallest ellipsoid around rows that are points), `ellipsoid` or `ball` (smallest ellipsoid, smallest
ball around rows that are ellipsoids: a center, then the lower triangle of its shape S by rows). The radius is that of
the ball, or the logarithm of the volume.

An ellipsoid {c + Au : |u| <= 1}, AA' = S, lies in {x : |Bx + b| <= 1} if and only if for some t >= 0 the matrix

    [ I         Bc + b   BA  ]
    [ (Bc+b)'   1 - t    0   ]
    [ (BA)'     0        tI  ]

is positive semidefinite: the S-procedure, and Schur's complement. The same with R in place of 1 holds for balls. Seconds
are those of building the problem and of solving it: cvxpy does much of the first in each solve.
"""

import json
import math
import sys
import time

import cvxpy
import numpy

OPTIONS = {"tol_gap_abs": 1e-10, "tol_gap_rel": 1e-10, "tol_feas": 1e-10}


def split(rows):
    """Centers and factors A, AA' = S, of ellipsoids given by rows."""
    columns = rows.shape[1]
    dim = next(d for d in range(1, columns) if d * (d + 3) // 2 == columns)
    ellipsoids = []
    for row in rows:
        shape = numpy.zeros((dim, dim))
        shape[numpy.tril_indices(dim)] = row[dim:]
        shape = shape + numpy.tril(shape, -1).T
        ellipsoids.append((row[:dim], numpy.linalg.cholesky(shape)))
    return ellipsoids


def inside(image, factor, radius):
    """The matrix inequality for an ellipsoid with center `image` and factor `factor` in a ball of so much radius."""
    dim = factor.shape[0]
    t = cvxpy.Variable()
    column = cvxpy.reshape(image, (dim, 1), order="C")
    corner = cvxpy.reshape(radius - t, (1, 1), order="C")
    zero = numpy.zeros((1, dim))
    rows = [
        [radius * numpy.eye(dim), column, factor],
        [column.T, corner, zero],
        [factor.T, zero.T, t * numpy.eye(dim)],
    ]
    return cvxpy.bmat(rows) >> 0


def log_unit_ball(dim):
    return dim / 2 * math.log(math.pi) - math.lgamma(dim / 2 + 1)


def solve(problem, rows):
    """Radius or log-volume, and the center."""
    if problem == "ball":
        ellipsoids = split(rows)
        center, radius = cvxpy.Variable(len(ellipsoids[0][0])), cvxpy.Variable()
        limits = [inside(c - center, cvxpy.Constant(a), radius) for c, a in ellipsoids]
        cvxpy.Problem(cvxpy.Minimize(radius), limits).solve(solver="CLARABEL", **OPTIONS)
        return float(radius.value), center.value
    dim = rows.shape[1] if problem == "points" else len(split(rows)[0][0])
    matrix, shift = cvxpy.Variable((dim, dim), PSD=True), cvxpy.Variable(dim)
    if problem == "points":
        ones = numpy.ones((len(rows), 1))
        images = rows @ matrix + ones @ cvxpy.reshape(shift, (1, dim), order="C")
        limits = [cvxpy.norm(images, 2, axis=1) <= 1]
    else:
        limits = [inside(matrix @ c + shift, matrix @ a, 1.0) for c, a in split(rows)]
    goal = cvxpy.Maximize(cvxpy.log_det(matrix))
    cvxpy.Problem(goal, limits).solve(solver="CLARABEL", **OPTIONS)
    center = -numpy.linalg.solve(matrix.value, shift.value)
    return log_unit_ball(dim) - numpy.linalg.slogdet(matrix.value)[1], center


def main():
    problem, input_path, center_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        rows = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        radius, center = solve(problem, rows)
        seconds = time.perf_counter() - start
        numpy.asarray(center, dtype="<f8").tofile(center_path)
        print(json.dumps({"seconds": seconds, "radius": radius, "support": 0}), flush=True)


if __name__ == "__main__":
    main()
