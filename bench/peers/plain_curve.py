"""The centers of section 4.1 of the thesis, word by word, in the protocol of protocol.hpp: plain_curve.py RHO INPUT CENTER.

The points are in units of the least local feature size. What goes to CENTER are the centers that pruning leaves.
"""

import json
import math
import sys
import time

import numpy
from scipy.spatial import ConvexHull, QhullError, cKDTree

OMEGA = 0.1
ANGLES = numpy.linspace(-math.pi / 10, math.pi / 10, 21)


def strip(points):
    """The width of the narrowest strip around points, and the direction of it."""
    try:
        hull = points[ConvexHull(points).vertices]
    except QhullError:
        return 0.0, numpy.array([1.0, 0.0])
    sides = numpy.roll(hull, -1, axis=0) - hull
    sides /= numpy.hypot(*sides.T)[:, None]
    normals = numpy.column_stack([-sides[:, 1], sides[:, 0]])
    widths = (hull @ normals.T - (hull * normals).sum(axis=1)).max(axis=0)
    narrowest = widths.argmin()
    return widths[narrowest], sides[narrowest]


def estimate(points, tree, sample, initial, rho):
    """s* and W of one sample; none where the disk grows beyond the feature size before its points are flat."""
    radius = initial
    while True:
        near = points[tree.query_ball_point(points[sample], radius)] - points[sample]
        width, along = strip(near)
        if rho * width <= radius:
            break
        radius = rho * width
        if radius > max(initial, 1.0):
            return None
    slab = min(math.sqrt(initial), radius / 3)
    across = numpy.array([-along[1], along[0]])
    cosines, sines = numpy.cos(ANGLES)[:, None], numpy.sin(ANGLES)[:, None]
    tangents, normals = cosines * along + sines * across, cosines * across - sines * along
    inside = numpy.abs(near @ tangents.T) <= slab / 2
    heights = near @ normals.T
    low = numpy.where(inside, heights, numpy.inf).min(axis=0)
    high = numpy.where(inside, heights, -numpy.inf).max(axis=0)
    least = (high - low).argmin()
    return points[sample] + (low[least] + high[least]) / 2 * normals[least], slab


def centers(points, rho):
    """The centers left."""
    tree = cKDTree(points)
    count = math.ceil(math.log(len(points)) ** (1 + OMEGA))
    initial = numpy.sqrt(tree.query(points, k=count + 1)[0][:, -1])
    found = (estimate(points, tree, s, initial[s], rho) for s in range(len(points)))
    found = sorted((f for f in found if f is not None), key=lambda f: -f[1])
    places = numpy.array([place for place, _ in found])
    alive, left = numpy.ones(len(places), dtype=bool), []
    for i, (place, slab) in enumerate(found):
        if alive[i]:
            left.append(place)
            alive[numpy.hypot(*(places - place).T) <= slab ** (1 / 3)] = False
    return numpy.array(left)


def main():
    rho, input_path, center_path = sys.argv[1:]
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        points = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        found = centers(points, float(rho))
        seconds = time.perf_counter() - start
        numpy.asarray(found, dtype="<f8").tofile(center_path)
        print(json.dumps({"seconds": seconds, "radius": 0.0, "support": len(found)}), flush=True)


if __name__ == "__main__":
    main()
