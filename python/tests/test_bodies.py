"""Convex bodies in triangle meshes."""

import numpy as np
import pytest

import taut

OCTAHEDRON = np.vstack([np.eye(3), -np.eye(3)])
FACES = np.array([[x, y, z] for x in (0, 3) for y in (1, 4) for z in (2, 5)])
ROWS = taut.triangle_rows(OCTAHEDRON, FACES)


def test_an_octahedron_is_a_body_with_14_directions():
    found = taut.inscribed_dops(OCTAHEDRON, FACES, directions=14, events=1000)
    assert found.kind == "inscribed-bodies"
    verdict = found.check(ROWS)
    assert verdict.bodies == 1 and abs(verdict.largest - 4 / 3) < 1e-5
    normals, offsets = found.answer.half_spaces(0)
    assert normals.shape == (14, 3) and np.all(OCTAHEDRON @ normals.T <= offsets + 1e-6)
    vertices = found.answer.vertices(0)
    assert np.all(vertices @ normals.T <= offsets + 1e-6)
    # Facets end up to a unit of the grid, 2^-23, before the corners, so that each corner may be several vertices.
    assert all(np.min(np.linalg.norm(vertices - corner, axis=1)) < 1e-5 for corner in OCTAHEDRON)
    for name in ("InscribedBodies(", "BodiesCertificate(", "BodiesVerdict(", "ConvexBody(", "BodyProof("):
        parts = (found.answer, found.certificate, verdict, found.answer.bodies[0], found.certificate.proofs[0])
        assert any(name in repr(part) for part in parts)


def test_bodies_are_closed_meshes_that_face_outward():
    found = taut.inscribed_dops(OCTAHEDRON, FACES, count=3, events=3000)
    for number, body in enumerate(found.answer.bodies):
        vertices, faces = found.answer.mesh(number)
        assert np.array_equal(vertices, found.answer.vertices(number))
        assert np.array_equal(faces, found.answer.faces(number))
        assert vertices.dtype == np.float64 and faces.dtype == np.uint32
        edges = {tuple(face[[k, (k + 1) % 3]].tolist()) for face in faces for k in range(3)}
        assert len(edges) == 3 * len(faces) and all((b, a) in edges for a, b in edges)
        # Six tetrahedra from the origin to each triangle; positive as triangles are counter-clockwise from outside.
        volume = np.linalg.det(vertices[faces]).sum() / 6
        assert abs(volume - body.volume) < 1e-9


def test_occlusion_can_be_the_objective():
    found = taut.inscribed_dops(OCTAHEDRON, FACES, objective="occlusion", events=1000)
    counters = found.trace.counters
    assert 0 < counters["searched_hidden"] < counters["searched_lines"]
    with pytest.raises(ValueError, match="objective"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, objective="surface")
    found = taut.inscribed_dops(OCTAHEDRON, FACES, directions=6, objective="occlusion", hidden=0.5, events=1000)
    counters = found.trace.counters
    assert counters["searched_hidden"] >= 0.5 * counters["searched_lines"]
    with pytest.raises(ValueError, match="hidden"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, hidden=0.5)


def test_bodies_are_merged():
    many = taut.inscribed_dops(OCTAHEDRON, FACES, directions=6, count=20, events=3000)
    few = taut.inscribed_dops(OCTAHEDRON, FACES, directions=6, count=20, events=3000, merge_within=0.3)
    assert len(few.answer.bodies) < len(many.answer.bodies)
    assert few.trace.counters["searched_covered"] >= 0.7 * many.trace.counters["searched_covered"]
    with pytest.raises(ValueError, match="merge_within"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, merge_within=-0.1)


def test_the_procedure_of_the_thesis_gives_disjoint_bodies():
    # All triangles turned outward, as its votes need them.
    turned = [face if (face > 2).sum() % 2 == 0 else face[::-1] for face in FACES]
    outward = np.array(turned)
    found = taut.inscribed_dops(OCTAHEDRON, outward, directions=6, count=3, method="thesis", seeds="random", cells=16)
    assert found.answer.disjoint and found.trace.method == "thesis"
    assert found.check(taut.triangle_rows(OCTAHEDRON, outward)).disjoint
    with pytest.raises(ValueError, match="cells"):
        taut.inscribed_dops(OCTAHEDRON, FACES, method="thesis", cells=1)


def test_disjoint_bodies_travel_as_json():
    found = taut.inscribed_dops(OCTAHEDRON, FACES, count=3, disjoint=True, events=3000)
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.certificate.pairs == found.certificate.pairs
    assert again.check(ROWS).disjoint
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(ROWS + 1)


def test_meshes_that_are_not_closed_are_refused():
    with pytest.raises(ValueError, match="the mesh is not closed: 3 of its edges"):
        taut.inscribed_dops(OCTAHEDRON, FACES[1:])
    with pytest.raises(ValueError, match="triangle 0 names vertex 7"):
        taut.inscribed_dops(OCTAHEDRON, FACES + 7)
    with pytest.raises(ValueError, match="`directions` is 7"):
        taut.inscribed_dops(OCTAHEDRON, FACES, directions=7)
    with pytest.raises(ValueError, match=r"expected \(n, 3\)"):
        taut.inscribed_dops(OCTAHEDRON[:, :2], FACES)


def test_a_notebook_shows_the_bodies():
    assert "<svg" in taut.inscribed_dops(OCTAHEDRON, FACES, events=500)._repr_html_()


def test_free_bodies_contain_their_points_and_holes_are_closed():
    rows = ROWS[1:]
    options = {"at": [[0.1, 0.2, 0.3], [-0.5, 0, 0]], "close_holes": True, "events": 2000}
    found = taut.inscribed_bodies(OCTAHEDRON, FACES[1:], **options)
    verdict = found.check(rows)
    assert (verdict.at, verdict.caps, verdict.bodies) == (2, 1, 2)
    assert found.answer.caps.shape == (1, 3) and np.array_equal(found.answer.at, options["at"])
    # The cap has the corners of the face that was left out.
    corners = rows.reshape(-1, 3)[found.answer.caps[0]]
    assert {tuple(p) for p in corners} == {tuple(p) for p in OCTAHEDRON[FACES[0]]}
    for body, point in enumerate(options["at"]):
        normals, offsets = found.answer.half_spaces(body)
        assert np.all(normals @ point <= offsets)
        assert len(found.answer.vertices(body)) >= 6
    again = taut.Solution.from_json(found.to_json())
    assert again == found
    few = taut.inscribed_bodies(OCTAHEDRON, FACES, facets=9, coverage=0.95, events=2000)
    assert all(len(body.offsets) <= 9 for body in few.answer.bodies)


def test_vertices_are_those_of_all_triples_of_planes():
    found = taut.inscribed_bodies(OCTAHEDRON, FACES, events=2000)
    body = found.answer.bodies[0]
    vertices = found.answer.vertices(0)
    # Each corner of the octahedron is near a vertex: planes are moved inward by at most 1/256.
    assert all(np.min(np.linalg.norm(vertices - corner, axis=1)) < 0.02 for corner in OCTAHEDRON)
    normals, offsets = found.answer.half_spaces(0)
    beyond = vertices @ normals.T - offsets
    scale = np.abs(normals).max() * 1e-9
    assert beyond.max() <= scale and np.all((np.abs(beyond) <= scale).sum(axis=1) >= 3)
    assert len(body.offsets) >= 8


def test_points_without_room_and_shapes_without_inside_are_refused():
    with pytest.raises(ValueError, match="point 0 of those .* is outside of the mesh"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, at=[[2, 0, 0]])
    with pytest.raises(ValueError, match=r"expected \(p, 3\)"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, at=[0, 0, 0])
    with pytest.raises(ValueError, match="`coverage` is"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, coverage=2.0)
    with pytest.raises(ValueError, match="`facets` is 257"):
        taut.inscribed_bodies(OCTAHEDRON, FACES, facets=257)


def test_bodies_stay_clear_of_points():
    points = np.random.default_rng(1).random((200, 3))
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    among = np.concatenate([points, corners])
    for found, rows in [
        (taut.inscribed_bodies(OCTAHEDRON, FACES, obstacles=points, events=2000, count=3),
         taut.triangle_rows(OCTAHEDRON, FACES, obstacles=points)),
        (taut.inscribed_bodies(among, None, events=2000, count=3), taut.triangle_rows(among, None)),
        (taut.inscribed_dops(among, None, directions=[[1, 2, 0], [-2, 1, 0], [0, 0, 1]], events=2000, count=3),
         taut.triangle_rows(among, None)),
    ]:
        verdict = found.check(rows)
        assert verdict.points >= 200 and verdict.bodies == 3
        for body in range(3):
            normals, offsets = found.answer.half_spaces(body)
            assert not np.any(np.all(points @ normals.T < offsets, axis=1))
        with pytest.raises(taut.Violation):
            found.check(taut.triangle_rows(OCTAHEDRON, FACES))
    with pytest.raises(ValueError, match=r"obstacles have shape \(1, 2\)"):
        taut.triangle_rows(OCTAHEDRON, FACES, obstacles=[[1.0, 2.0]])


def test_no_body_is_in_a_solid():
    box = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    faces = np.array([triangle for a, b, c, d in quads for triangle in ([a, b, c], [a, c, d])])
    # A block that leaves the box, and a wall.
    surfaces = [(box * 0.5 + [0.75, 0.25, 0.25], faces), ([[0.2, 0, 0], [0.2, 1, 0], [0.2, 0, 1]], [[0, 1, 2]])]
    points = np.array([[0.5, 0.9, 0.9], [0.5, 0.9, 0.9]])
    given = {"obstacles": points, "surfaces": surfaces}
    rows = taut.triangle_rows(box, faces, **given)
    assert rows.shape == (26, 10) and rows[:, 9].tolist() == [0.0] * 12 + [1.0] * 12 + [-1.0] * 2
    inside = 0.75 + 0.5 * np.random.default_rng(2).random((500, 3)) - [0, 0.5, 0.5]
    for found in [
        taut.inscribed_bodies(box, faces, **given, events=2000, count=3),
        taut.inscribed_dops(box, faces, **given, events=2000, count=3),
    ]:
        verdict = found.check(rows)
        assert (verdict.triangles, verdict.solids, verdict.walls, verdict.points) == (12, 1, 1, 1)
        for body in range(3):
            normals, offsets = found.answer.half_spaces(body)
            assert not np.any(np.all(inside @ normals.T < offsets, axis=1))
    with pytest.raises(ValueError, match="solid obstacle"):
        taut.inscribed_bodies(box, faces, **given, at=[[1.1, 0.5, 0.5]])
    among = taut.triangle_rows(points + [[0, 0, 0], [1, 1, 1]], None, surfaces=surfaces[1:])
    assert among[:, 9].tolist() == [0.0] * 12 + [-1.0] * 3


def test_bodies_contain_segments():
    segments = np.array([[[0.5, 0.1, 0], [-0.5, 0, 0.1]], [[0, 0, 0.2], [0, 0, 0.2]]])
    found = taut.inscribed_bodies(OCTAHEDRON, FACES, at=segments, events=2000)
    assert found.check(ROWS).at == 2 and np.array_equal(found.answer.ends, segments[:, 1])
    for body, ends in enumerate(segments):
        normals, offsets = found.answer.half_spaces(body)
        assert np.all(ends @ normals.T <= offsets)
    assert taut.Solution.from_json(found.to_json()) == found


def test_directions_can_be_given():
    found = taut.inscribed_dops(OCTAHEDRON, FACES, directions=[[1, 1, 1], [1, 1, -1], [1, -1, 1], [-1, 1, 1]], events=1000)
    assert found.check(ROWS).largest > 1.3333 and found.answer.bodies[0].normals.shape == (8, 3)
    with pytest.raises(ValueError, match="no two are parallel"):
        taut.inscribed_dops(OCTAHEDRON, FACES, directions=[[1, 0, 0], [0, 1, 0], [-2, 0, 0]])
    with pytest.raises(ValueError, match=r"whole numbers, \(k, 3\)"):
        taut.inscribed_dops(OCTAHEDRON, FACES, directions=[[1.5, 0, 0]])


@pytest.mark.parametrize("options", [{"votes": 7}, {"cells": 9}, {"seeds": "center"}, {"translate": True}, {"merge": True}])
def test_options_of_other_methods_are_refused(options):
    name = next(iter(options))
    with pytest.raises(ValueError, match=f"option `{name}` is of method thesis, not of recreate"):
        taut.inscribed_dops(OCTAHEDRON, FACES, **options)
