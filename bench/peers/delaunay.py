"""Qhull through SciPy, or Triangle: delaunay.py NAME DIM FILE, one build, one line as delaunay.hpp describes it.

The times are those of the call from Python, with what it does to turn arrays into its own structures and back.
"""

import importlib.metadata
import json
import sys
import time

import numpy


def builder(name):
    """What is printed as the program, and a function from points to the simplices it finds."""
    if name == "qhull":
        from scipy.spatial import Delaunay

        program = f"Qhull (SciPy {importlib.metadata.version('scipy')})"
        return program, lambda points: Delaunay(points).simplices
    if name == "triangle":
        import triangle

        # Q: no messages.
        program = f"Triangle (PyPI {importlib.metadata.version('triangle')})"
        return program, lambda points: triangle.triangulate({"vertices": points}, "Q")["triangles"]
    sys.exit(f"{name}: expected qhull or triangle")


def status(field):
    """A size out of /proc/self/status, in bytes; None where it does not tell."""
    try:
        with open("/proc/self/status") as file:
            return next(int(line.split()[1]) << 10 for line in file if line.startswith(field))
    except (OSError, StopIteration):
        return None


def reset():
    """Sets the mark of the largest resident size back to the present one; says whether it could."""
    try:
        with open("/proc/self/clear_refs", "w") as file:
            file.write("5")
        return True
    except OSError:
        return False


def main():
    name, dim, path = sys.argv[1:]
    program, build = builder(name)
    points = numpy.fromfile(path, dtype="<f8").reshape(-1, int(dim))
    held = status("VmRSS:") if reset() else None
    wall, cpu = time.perf_counter(), time.process_time()
    simplices = build(points)
    cpu, wall = time.process_time() - cpu, time.perf_counter() - wall
    mark = status("VmHWM:")
    peak = None if held is None or mark is None else max(0, mark - held)
    print(
        json.dumps(
            {
                "program": program,
                "points": len(points),
                "simplices": len(simplices),
                "cpu": cpu,
                "wall": wall,
                "peak": peak,
            }
        )
    )


if __name__ == "__main__":
    main()
