"""Shapes inside others in the protocol of protocol.hpp: inscribe.py WAY INPUT CENTER.

mic-shapely and mic-polylabel find the largest circle in the ring of the input, to a tolerance of 1e-6: center and radius.
solid-iris grows one region of drake's Iris, at most 5 iterations, from the inner point that is farthest from the mesh, around all its
triangles; solid-vhacd makes at most 32 hulls, solid-parry3d as many with the program of peers/rust, solid-coacd as many at a threshold of 0.1. Of these goes to CENTER which share of the inside
they cover, which part of the volume lies outside, as a share of the inside, and the volume of the largest part; of Iris also its seed.
Inside is the winding number of libigl above one half, at the cells of a grid of 64 along the longest side.
"""

import ctypes
import functools
import json
import pathlib
import signal
import subprocess
import sys
import tempfile
import time

import numpy


def shapely_circle(rows):
    import shapely
    ring = shapely.Polygon(rows)
    start = time.perf_counter()
    line = shapely.maximum_inscribed_circle(ring, tolerance=1e-6)
    seconds = time.perf_counter() - start
    return seconds, line.length, 1, list(line.coords[0])


def polylabel_circle(rows):
    import polylabel
    ring = [[list(row) for row in rows]]
    start = time.perf_counter()
    center, radius = polylabel.polylabel(ring, precision=1e-6, with_distance=True)
    return time.perf_counter() - start, radius, 1, list(center)


class Solid:
    """A mesh, the cells of a grid over its box, and which are inside."""

    def __init__(self, rows):
        import igl
        corners = rows.reshape(-1, 3)
        self.vertices, ids = numpy.unique(corners, axis=0, return_inverse=True)
        self.faces = ids.reshape(-1, 3).astype(numpy.int64)
        low, high = self.vertices.min(0), self.vertices.max(0)
        self.low, self.high, step = low, high, (high - low).max() / 64
        axes = [numpy.arange(low[k] + step / 2, high[k], step) for k in range(3)]
        self.cells = numpy.stack(numpy.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
        winding = igl.fast_winding_number(self.vertices, self.faces, self.cells)
        self.is_inside = numpy.abs(winding) > 0.5

    def judged(self, hulls, seconds):
        from scipy.spatial import ConvexHull
        covered, largest = numpy.zeros(len(self.cells), bool), 0.0
        for hull in (ConvexHull(hull) for hull in hulls):
            covered |= (self.cells @ hull.equations[:, :3].T + hull.equations[:, 3] < 0).all(1)
            largest = max(largest, hull.volume)
        inside = self.is_inside.sum()
        shares = [(covered & self.is_inside).sum() / inside, (covered & ~self.is_inside).sum() / inside]
        return seconds, 0.0, len(hulls), [*shares, largest]


def iris(solid):
    import igl
    from pydrake.geometry.optimization import HPolyhedron, Iris, IrisOptions, VPolytope
    inner = solid.cells[solid.is_inside]
    squares = igl.point_mesh_squared_distance(inner, solid.vertices, solid.faces)[0]
    options = IrisOptions()
    options.iteration_limit, options.require_sample_point_is_contained = 5, False
    obstacles = [VPolytope(solid.vertices[face].T) for face in solid.faces]
    box = HPolyhedron.MakeBox(solid.low - 0.01, solid.high + 0.01)
    seed = inner[squares.argmax()]
    start = time.perf_counter()
    region = Iris(obstacles, seed, box, options)
    seconds = time.perf_counter() - start
    *found, judged = solid.judged([VPolytope(region).vertices().T], seconds)
    return *found, [*judged, *seed]


def vhacd(solid):
    import vhacdx
    flat = numpy.hstack([numpy.full((len(solid.faces), 1), 3), solid.faces]).ravel().astype(numpy.uint32)
    start = time.perf_counter()
    hulls = vhacdx.compute_vhacd(solid.vertices, flat, maxConvexHulls=32)
    seconds = time.perf_counter() - start
    return solid.judged([numpy.asarray(hull) for hull, _ in hulls], seconds)


def parry3d(solid):
    build = pathlib.Path(__file__).parent / "build"
    with tempfile.NamedTemporaryFile() as file:
        rows = solid.vertices[solid.faces].reshape(-1, 9)
        numpy.array(rows.shape, dtype="<u8").tofile(file)
        rows.astype("<f8").tofile(file)
        file.flush()
        program = [build / "rust/release/peers", "parry3d", file.name]
        # It ends with this process, which is stopped where it takes too long.
        ends_too = functools.partial(ctypes.CDLL(None).prctl, 1, signal.SIGKILL)
        found = json.loads(subprocess.run(program, check=True, capture_output=True, preexec_fn=ends_too).stdout)
    return solid.judged([numpy.array(hull) for hull in found["hulls"]], found["seconds"])


def coacd(solid):
    import coacd
    coacd.set_log_level("error")
    start = time.perf_counter()
    hulls = coacd.run_coacd(coacd.Mesh(solid.vertices, solid.faces), threshold=0.1, max_convex_hull=32, seed=0)
    seconds = time.perf_counter() - start
    return solid.judged([numpy.asarray(hull) for hull, _ in hulls], seconds)


def main():
    way, input_path, center_path = sys.argv[1:]
    solve = {
        "mic-shapely": shapely_circle, "mic-polylabel": polylabel_circle, "solid-iris": iris, "solid-vhacd": vhacd,
        "solid-parry3d": parry3d, "solid-coacd": coacd,
    }[way]
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        rows = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    given = Solid(rows) if way.startswith("solid-") else rows
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        seconds, radius, parts, found = solve(given)
        numpy.asarray(found, dtype="<f8").tofile(center_path)
        print(json.dumps({"seconds": seconds, "radius": radius, "support": parts}), flush=True)


if __name__ == "__main__":
    main()
