"""Answers, certificates, traces and verdicts are data: they compare, travel, print themselves, and cannot be altered."""

import copy
import dataclasses
import json
import pickle
import typing

import numpy as np
import pytest

import taut
from taut import (
    _ball,
    _bodies,
    _centers,
    _curve,
    _delaunay,
    _ellipse,
    _ellipsoid,
    _generate,
    _memory,
    _native,
    _robust,
    _surface,
    _triangle,
)
from taut._record import Record

RNG = np.random.default_rng(5)
PLANE = taut.generate("normal", 60, 2, seed=3)
SPACE = taut.generate("normal", 40, 3, seed=3)
TORUS = taut.generate("torus", 2000, 3, seed=1)
T = np.arange(60) * (2 * np.pi / 60)
RINGS = np.vstack([np.c_[np.cos(T), np.sin(T)] * size for size in (1.0, 0.5)])
RADII = RNG.uniform(0, 1, len(PLANE))
WEIGHTS = RNG.uniform(1, 2, len(PLANE))
SHAPES = [np.diag(sizes) for sizes in RNG.uniform(0.1, 1, (len(PLANE), 2))]
NORMALS, OFFSETS = np.vstack([np.eye(2), -np.eye(2), [[1, 1]]]), [1.0, 2.0, 1.0, 0.5, 1.5]
LINE = np.c_[np.arange(5.0), np.arange(5.0)]
SIMPLEX, SIDES = np.vstack([np.zeros(3), np.eye(3)]), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
SIMPLEX_ROWS = taut.triangle_rows(SIMPLEX, SIDES)

# Solutions of every kind with all that they may hold, each with the arrays that check it.
SOLVED = {
    "ball": (taut.ball(PLANE), (PLANE,), {}),
    "ball of balls": (taut.ball_of_balls(PLANE, RADII), (PLANE, RADII), {}),
    "ball of ellipsoids": (taut.ball(PLANE, shapes=SHAPES), (PLANE,), {"shapes": SHAPES}),
    "centers of ellipsoids": (taut.centers(PLANE, 2, shapes=SHAPES), (PLANE,), {"shapes": SHAPES}),
    "ball far away": (taut.ball(PLANE + 1e9), (PLANE + 1e9,), {}),
    "ellipsoid": (taut.ellipsoid(SPACE), (SPACE,), {}),
    "ellipsoid of balls": (taut.ellipsoid(PLANE, radii=RADII), (PLANE, RADII), {}),
    "ellipsoid in a flat": (taut.ellipsoid(LINE), (LINE,), {}),
    "ellipsoid of one point": (taut.ellipsoid(LINE[:1]), (LINE[:1],), {}),
    "inscribed": (taut.inscribed_ellipsoid(NORMALS, OFFSETS), (NORMALS,), {"offsets": OFFSETS}),
    "circle": (taut.inscribed_circle(RINGS[:60]), (RINGS[:60],), {}),
    "ellipse": (taut.inscribed_ellipse(RINGS[:60]), (RINGS[:60],), {}),
    "rectangle": (taut.inscribed_rectangle(RINGS[:60]), (RINGS[:60],), {}),
    "oriented rectangle": (taut.inscribed_oriented_rectangle(RINGS[:60], epsilon=0.1), (RINGS[:60],), {}),
    "convex polygon": (taut.inscribed_polygon(RINGS[:60], rounds=5), (RINGS[:60],), {}),
    "triangle": (taut.inscribed_triangle(RINGS[:60]), (RINGS[:60],), {}),
    "bodies": (taut.inscribed_dops(SIMPLEX, SIDES, count=2, disjoint=True, events=500), (SIMPLEX_ROWS,), {}),
    "free bodies": (
        taut.inscribed_bodies(SIMPLEX, SIDES[1:], at=[[0.2, 0.2, 0.2]], close_holes=True, events=500),
        (taut.triangle_rows(SIMPLEX, SIDES[1:]),),
        {},
    ),
    "kernel ball": (taut.kernel_ball(SPACE, nu=0.3), (SPACE,), {}),
    "dop": (taut.bounding_dop(SPACE), (SPACE,), {}),
    "flat dop": (taut.bounding_dop(SPACE * [1, 1, 0], directions=6), (SPACE * [1, 1, 0],), {}),
    "mcd": (taut.robust_ellipsoid(PLANE), (PLANE,), {}),
    "mve": (taut.robust_ellipsoid(PLANE, method="mve"), (PLANE,), {}),
    "trim": (taut.robust_ellipsoid(PLANE, method="trim"), (PLANE,), {}),
    "centers": (taut.centers(PLANE, 3, assignment=True, outliers=2), (PLANE,), {}),
    "discrete centers": (taut.centers(PLANE, 3, discrete=True), (PLANE,), {}),
    "centers with weights": (taut.centers(PLANE, 2, weights=WEIGHTS), (PLANE,), {"weights": WEIGHTS}),
    "centers of balls": (taut.centers(PLANE, 2, radii=RADII), (PLANE, RADII), {}),
    "curve": (taut.curve(RINGS, places=True), (RINGS,), {}),
    "tour": (taut.curve(PLANE, method="tour"), (PLANE,), {}),
    "surface": (taut.surface(TORUS), (TORUS,), {}),
    "moved surface": (taut.surface(TORUS, denoise=True), (TORUS,), {}),
    "hilbert": (taut.spatial_order(PLANE), (PLANE,), {}),
    "morton": (taut.spatial_order(SPACE, curve="morton"), (SPACE,), {}),
    "plane": (taut.delaunay(np.vstack([PLANE, PLANE[:3]])), (np.vstack([PLANE, PLANE[:3]]),), {}),
    "space": (taut.delaunay(SPACE), (SPACE,), {}),
    "line": (taut.delaunay(LINE), (LINE,), {}),
}


def parts_of(record):
    """A record and the records in it."""
    yield record
    for field in dataclasses.fields(record):
        within = getattr(record, field.name)
        for part in within if isinstance(within, tuple) else (within,):
            if isinstance(part, Record):
                yield from parts_of(part)


def records():
    """One record of each class, and of those with parts that may be absent some more."""
    wholes = [taut.farthest_first(PLANE, 5), taut.sphere_tree(PLANE)]
    for found, arrays, more in SOLVED.values():
        wholes += [found.answer, found.certificate, found.trace, found.check(*arrays, **more)]
    seen = {}
    for whole in wholes:
        for record in parts_of(whole):
            absent = tuple(getattr(record, field.name) is None for field in dataclasses.fields(record))
            seen.setdefault((type(record), absent), record)
    return list(seen.values())


@pytest.fixture(scope="module")
def all_records():
    return records()


def test_every_public_class_of_data_is_met(all_records):
    public = {getattr(taut, name) for name in taut.__all__}
    expected = {thing for thing in public if isinstance(thing, type) and issubclass(thing, Record)}
    assert {type(record) for record in all_records} == expected - {taut.FileVerdict}
    assert all(thing.__module__ == "taut" for thing in expected)


def arrays_of(record):
    values = [getattr(record, field.name) for field in dataclasses.fields(record)]
    return [value for value in values if isinstance(value, np.ndarray)]


def test_records_compare_and_travel(all_records):
    for record in all_records:
        again = pickle.loads(pickle.dumps(record))
        assert type(again) is type(record) and again == record == copy.deepcopy(record) == copy.copy(record)
        assert again is not record and record != "a record" and record not in (None, 1)
        assert [array.dtype for array in arrays_of(again)] == [array.dtype for array in arrays_of(record)]
        assert [array.shape for array in arrays_of(again)] == [array.shape for array in arrays_of(record)]
        with pytest.raises(TypeError, match="unhashable"):
            hash(record)
    for number, record in enumerate(all_records):
        assert all(record != other for other in all_records[:number])


def test_one_number_more_or_less_is_another_record():
    ball = taut.ball(PLANE).answer
    assert ball != dataclasses.replace(ball, radius=np.nextafter(ball.radius, 9))
    assert ball != dataclasses.replace(ball, center=ball.center + 1)
    assert ball != dataclasses.replace(ball, center=ball.center[:1])
    assert ball == dataclasses.replace(ball, center=ball.center.tolist())


def test_records_print_themselves_in_one_line(all_records):
    for record in all_records:
        line = repr(record)
        assert line.startswith(f"{type(record).__name__}(") and line.endswith(")")
        assert "\n" not in line and "=" in line and len(line) < 250


def test_nothing_can_be_altered(all_records):
    for record in all_records:
        for again in (record, pickle.loads(pickle.dumps(record))):
            assert not any(array.flags.writeable for array in arrays_of(again))
        for field in dataclasses.fields(record):
            with pytest.raises(AttributeError):
                setattr(record, field.name, None)
        with pytest.raises((AttributeError, TypeError)):
            record.other = 1
    own = np.zeros(2)
    ball = taut.Ball(center=own, center_tail=own, radius=1.0)
    own[0] = 9
    assert ball.center.tolist() == [0, 0]


def test_empty_arrays_have_a_type_and_a_shape():
    ball, point = taut.ball(SPACE), taut.ellipsoid(LINE[:1])
    assert ball.certificate.directions.shape == (0, 3) and ball.answer.center_tail.tolist() == [0, 0, 0]
    assert point.answer.factor.shape == point.answer.hull.basis.shape == (0, 2)
    assert point.certificate.left_out.dtype == np.int64
    found = taut.curve(RINGS, method="hnn-crust").answer
    assert found.places is None and found.outliers.dtype == np.int64 and found.outliers.shape == (0,)
    nothing = taut.delaunay(np.empty((0, 2)))
    assert nothing.simplices.shape == nothing.hull.shape == (0, 0) and nothing.duplicates.shape == (0, 2)
    assert nothing.simplices.dtype == nothing.neighbors.dtype == np.int32
    document = json.loads(taut.delaunay(SPACE).to_json())
    del document["certificate"]["neighbors"]
    assert taut.Solution.from_json(json.dumps(document)).neighbors.shape == (0, 4)


# Where an entry of the JSON is found, if not by its own name.
ELSEWHERE = {
    "answer.kernel.name": "answer.kernel",
    "answer.kernel.gamma": "answer.gamma",
    "certificate.proof.by": "certificate.proof",
    "certificate.tour.lower": "certificate.tour_lower",
    "certificate.enclosure.certificate.gap": "certificate.gap",
    "certificate.counts.sites": "certificate.sites",
    "certificate.neighbors": "answer.neighbors",
}

# What has no attribute: the JSON has it.
NOWHERE = (
    "certificate.placement",  # `discrete` in Python
    "certificate.proof.items",
    "certificate.proof.held_out",
    "certificate.proof.nogoods",
    "certificate.tour.potentials",
    "certificate.unweighted",
    "certificate.enclosure.",
    "certificate.counts.",
    "certificate.mode",
    "answer.topology.vertices",
    "answer.topology.edges",
)


def leaves(entry, path):
    """The numbers, words and arrays of a document, each with its path."""
    if isinstance(entry, dict):
        for name, within in entry.items():
            yield from leaves(within, f"{path}.{name}" if path else name)
    elif isinstance(entry, list) and entry and isinstance(entry[0], dict):
        for number, within in enumerate(entry):
            yield from leaves(within, f"{path}.{number}")
    else:
        yield path, entry


def attribute(found, path):
    for name in path.split("."):
        if name in ("topology", "unused"):
            continue
        if name.isdecimal():
            found = found[int(name)]
        else:
            found = found[name] if isinstance(found, dict) else getattr(found, name)
    return found


def as_lists(value):
    """Arrays and tuples as the lists of a document."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    return [as_lists(part) for part in value] if isinstance(value, tuple) else value


@pytest.mark.parametrize("name", SOLVED)
def test_attributes_are_the_numbers_of_the_json(name):
    found, arrays, more = SOLVED[name]
    document = json.loads(found.to_json())
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.answer == found.answer
    assert again.certificate == found.certificate and again.trace == found.trace
    assert again.check(*arrays, **more) == found.check(*arrays, **more)
    met = 0
    for path, said in leaves({part: document[part] for part in ("kind", "answer", "certificate", "trace")}, ""):
        if path in ELSEWHERE or not path.startswith(NOWHERE):
            value = attribute(again, ELSEWHERE.get(path, path))
            assert as_lists(value) == said, path
            met += 1
    assert met > 8
    if found.kind == "centers":
        assert found.certificate.discrete == (document["certificate"]["placement"] == "rows")


def test_files_have_the_same_face(tmp_path):
    np.arange(100, dtype="<u8")[::-1].tofile(tmp_path / "in")
    found = taut.sort_file(tmp_path / "in", tmp_path / "out", width=8)
    document = json.loads(found.to_json())
    assert [document[part] for part in ("kind", "answer", "certificate")] == [
        found.kind,
        found.answer,
        found.certificate,
    ]
    assert found.trace.method == document["trace"]["method"]
    verdict = found.check(tmp_path / "out", tmp_path / "in")
    assert verdict == pickle.loads(pickle.dumps(verdict)) == taut.FileVerdict(items=100, compared=True)
    assert repr(verdict) == "FileVerdict(items=100, compared=True)"
    with pytest.raises(AttributeError):
        verdict.items = 1


WORDS = {
    "ball.method": _ball.BallMethod,
    "centers.method": _centers.CentersMethod,
    "curve.method": _curve.CurveMethod,
    "delaunay.order": _delaunay.InsertionOrder,
    "ellipsoid.method": _ellipsoid.EllipsoidMethod,
    "generate.distribution": _generate.Distribution,
    "inscribed_dops.method": _bodies.BodiesMethod,
    "inscribed_dops.objective": _bodies.Objective,
    "inscribed_dops.seeds": _bodies.ThesisSeeds,
    "inscribed_ellipse.method": _ellipse.EllipseMethod,
    "inscribed_triangle.method": _triangle.TriangleMethod,
    "robust_ellipsoid.method": _robust.RobustMethod,
    "sort_file.kind": _memory.KeyKind,
    "spatial_order.curve": _memory.OrderCurve,
    "surface.method": _surface.SurfaceMethod,
    "surface.priority": _surface.Priority,
}


def test_types_of_options_list_the_words_that_the_library_knows():
    assert {option: list(typing.get_args(words)) for option, words in WORDS.items()} == _native.names()
