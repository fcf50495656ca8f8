"""Ball pivoting and Poisson reconstruction in the protocol of protocol.hpp: surface.py WAY INPUT CENTER.

WAY is open3d-pivoting, open3d-poisson, pymeshlab-pivoting or pymeshlab-poisson. Normals are those of the 12 nearest points, for Open3D
turned along a tangent tree; they are what the peers need and are part of the time. Open3D's balls have 1, 1.5, 2 and 3 times the mean
distance to the 6 nearest points; pymeshlab chooses its own. Poisson has depth 9. What goes to CENTER are the seconds of the normals and
of the surface, the triangles, as many as `support` says, and the vertices: none where they are the rows of the input.
"""

import json
import sys
import time

import numpy

NEIGHBORS = 12
DEPTH = 9


def open3d_surface(rows, is_pivoting):
    import open3d
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(rows))
    start = time.perf_counter()
    cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(NEIGHBORS))
    cloud.orient_normals_consistent_tangent_plane(NEIGHBORS)
    normals = time.perf_counter() - start
    start = time.perf_counter()
    if is_pivoting:
        tree = open3d.geometry.KDTreeFlann(cloud)
        near = [tree.search_knn_vector_3d(row, 7)[2] for row in rows[:: max(1, len(rows) // 2000)]]
        spacing = float(numpy.mean([numpy.sqrt(squares)[1:].mean() for squares in near]))
        radii = open3d.utility.DoubleVector([factor * spacing for factor in (1.0, 1.5, 2.0, 3.0)])
        mesh = open3d.geometry.TriangleMesh.create_from_point_cloud_ball_pivoting(cloud, radii)
    else:
        mesh, _ = open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(cloud, depth=DEPTH, n_threads=1)
    return normals, time.perf_counter() - start, numpy.asarray(mesh.vertices), numpy.asarray(mesh.triangles)


def pymeshlab_surface(rows, is_pivoting):
    import pymeshlab
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(rows))
    start = time.perf_counter()
    if not is_pivoting:
        meshes.compute_normal_for_point_clouds(k=NEIGHBORS)
    normals = time.perf_counter() - start
    start = time.perf_counter()
    if is_pivoting:
        meshes.generate_surface_reconstruction_ball_pivoting()
    else:
        meshes.generate_surface_reconstruction_screened_poisson(depth=DEPTH, threads=1)
    mesh = meshes.current_mesh()
    return normals, time.perf_counter() - start, mesh.vertex_matrix(), mesh.face_matrix()


def main():
    way, input_path, center_path = sys.argv[1:]
    program, _, method = way.partition("-")
    solve = {"open3d": open3d_surface, "pymeshlab": pymeshlab_surface}[program]
    with open(input_path, "rb") as file:
        count, columns = (int(number) for number in numpy.fromfile(file, dtype="<u8", count=2))
        rows = numpy.fromfile(file, dtype="<f8").reshape(count, columns)
    print(json.dumps({"ready": True}), flush=True)
    for _ in sys.stdin:
        normals, seconds, vertices, triangles = solve(rows, method == "pivoting")
        kept = numpy.zeros((0, 3)) if numpy.array_equal(vertices, rows) else vertices
        flat = [[normals, seconds], triangles.ravel(), kept.ravel()]
        numpy.concatenate(flat).astype("<f8").tofile(center_path)
        print(json.dumps({"seconds": normals + seconds, "radius": 0.0, "support": len(triangles)}), flush=True)


if __name__ == "__main__":
    main()
