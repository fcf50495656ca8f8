"""What other people's readers make of surfaces that taut wrote: validators.py TAUT FOLDER [NAME...].

TAUT is the command, FOLDER that of the point sets, as `$TAUT_DATA/surface`; without a NAME all sets are tried whose boundary is
known to be closed. `taut surface` writes each as ply, obj, off, stl and glb; trimesh, Open3D and pyvista read the files back and say
whether they are watertight, manifold and alike in winding. A file of stl has no vertices that triangles share, and one of glb has them
in single precision: where corners come apart they are merged by position first. Points that no triangle has are left out.
Whether a surface meets itself is asked of Open3D up to 80 000 triangles, and so is whether it is watertight, as that includes it.
One line of a table for each file; the exit status is 1 if a validator objects.

    python3 -m venv bench/.venv && bench/.venv/bin/pip install trimesh==5.2.0 open3d==0.20.0 pyvista==0.49.1
    bench/.venv/bin/python bench/peers/validators.py target/release/taut $TAUT_DATA/surface

Open3D needs Debian's libusb-1.0-0 and libgl1 to be imported.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy
import open3d
import pyvista
import trimesh

# Euler characteristics: those of PROVENANCE.md beside the data, closed.
SETS = {
    "stanford_bunny": 2,
    "fandisk": 2,
    "horse": 2,
    "reconbench_dc": -14,
    "reconbench_anchor": -6,
    "reconbench_daratech": -12,
    "hoppe_mechpart": -4,
    "knot2": 0,
    "hoppe_blob5": 2,
}
FORMATS = ["ply", "obj", "off", "stl", "glb"]
CROSSING_MAX = 80_000


def by_trimesh(path):
    mesh = trimesh.load(path, force="mesh", process=False)
    if path.suffix in (".stl", ".glb"):
        mesh.merge_vertices(digits_vertex=None)
    mesh.remove_unreferenced_vertices()
    return {
        "watertight": bool(mesh.is_watertight),
        "winding": bool(mesh.is_winding_consistent),
        "volume": bool(mesh.volume > 0),
    }, int(mesh.euler_number), mesh


def by_open3d(path):
    mesh = open3d.io.read_triangle_mesh(str(path))
    if path.suffix in (".stl", ".glb"):
        mesh.merge_close_vertices(0.0) if path.suffix == ".glb" else mesh.remove_duplicated_vertices()
    mesh.remove_unreferenced_vertices()
    said = {
        "edges": mesh.is_edge_manifold(allow_boundary_edges=False),
        "vertices": mesh.is_vertex_manifold(),
        "watertight": mesh.is_watertight() if len(mesh.triangles) <= CROSSING_MAX else None,
        "orientable": mesh.is_orientable(),
        "crossing free": not mesh.is_self_intersecting() if len(mesh.triangles) <= CROSSING_MAX else None,
    }
    return {what: is_so for what, is_so in said.items() if is_so is not None}, len(mesh.triangles)


def by_pyvista(mesh):
    faces = numpy.c_[numpy.full(len(mesh.faces), 3), mesh.faces].ravel()
    found = pyvista.PolyData(numpy.asarray(mesh.vertices), faces)
    return {"manifold": bool(found.is_manifold), "no open edge": found.n_open_edges == 0}


def judge(path, euler):
    """What each says of a file, in words, and whether all agree."""
    trimesh_says, found_euler, mesh = by_trimesh(path)
    trimesh_says[f"χ {found_euler}"] = found_euler == euler
    open3d_says, triangles = by_open3d(path)
    says = {"trimesh": trimesh_says, "Open3D": open3d_says, "pyvista": by_pyvista(mesh)}
    cells = []
    for answers in says.values():
        objections = [what for what, is_so in answers.items() if not is_so]
        cells.append("not " + ", ".join(objections) if objections else "yes: " + ", ".join(answers))
    return triangles, cells, all(all(answers.values()) for answers in says.values())


def main():
    taut, folder, *names = sys.argv[1:]
    print("| set | format | triangles | trimesh | Open3D | pyvista |\n|---|---|---|---|---|---|")
    agreed = True
    with tempfile.TemporaryDirectory() as scratch:
        for name in names or SETS:
            for ending in FORMATS:
                path = pathlib.Path(scratch) / f"{name}.{ending}"
                given = pathlib.Path(folder) / f"{name}.off.xz"
                subprocess.run([taut, "surface", given, "--out", path], check=True, capture_output=True)
                triangles, cells, agree = judge(path, SETS[name])
                agreed &= agree
                print(f"| {name} | {ending} | {triangles} | {' | '.join(cells)} |", flush=True)
                path.unlink()
    return 0 if agreed else 1


if __name__ == "__main__":
    sys.exit(main())
