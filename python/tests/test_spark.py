"""Answers about DataFrames of Spark have the bytes of those in memory. Skipped where PySpark or Java are missing."""

import datetime
import decimal
import functools
import json
import os
import pathlib
import runpy
import shutil
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import taut

pyspark = pytest.importorskip("pyspark", reason="PySpark is not installed: pip install 'taut[spark]'")
pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install 'taut[spark]'")
if shutil.which("java") is None:
    pytest.skip("Java is not installed", allow_module_level=True)

LONG = pytest.mark.skipif("TAUT_LONG_TESTS" not in os.environ, reason="takes minutes: TAUT_LONG_TESTS is not set")
pytestmark = pytest.mark.filterwarnings("ignore")


@pytest.fixture(scope="module")
def spark():
    """Two executors, each a process of its own with one core."""
    from pyspark.sql import SparkSession

    os.environ["PYSPARK_PYTHON"] = sys.executable
    # Workers find what the tests find.
    os.environ["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)
    session = (
        SparkSession.builder.master("local-cluster[2,1,1024]")
        .config("spark.driver.host", "127.0.0.1")
        .config("spark.driver.bindAddress", "127.0.0.1")
        .config("spark.ui.enabled", "false")
        .config("spark.ui.showConsoleProgress", "false")
        .config("spark.driver.memory", "1g")
        .config("spark.sql.shuffle.partitions", "4")
        .config("spark.sql.execution.arrow.pyspark.enabled", "true")
        .config("spark.executorEnv.PYTHONPATH", os.environ["PYTHONPATH"])
        .getOrCreate()
    )
    session.sparkContext.setLogLevel("FATAL")
    yield session
    session.stop()


def frame(spark, rows, ids=None, partitions=4):
    import pandas

    columns = {f"x{at}": rows[:, at] for at in range(rows.shape[1])}
    if ids is not None:
        columns["key"] = ids
    return spark.createDataFrame(pandas.DataFrame(columns)).repartition(partitions), list(columns)[: rows.shape[1]]


@pytest.mark.parametrize(
    ("distribution", "d", "partitions"),
    [("poisson", 3, 7), ("sphere", 10, 1), *[pytest.param(*more, marks=LONG) for more in (("poisson", 3, 1), ("sphere", 10, 7))]],
)
def test_shuffled_rows_with_ids(spark, distribution, d, partitions):
    import taut.spark

    n = 200_000 // d
    rows = taut.generate(distribution, n, d, seed=2)
    order = np.random.default_rng(0).permutation(n)
    df, columns = frame(spark, rows[order], [f"{at:09}" for at in order])
    wanted = taut.ball(rows)
    with taut.spark.Points(df, columns, id="key", partitions=partitions) as points:
        assert points.shape == rows.shape
        found = points.ball()
        assert found.to_json() == wanted.to_json()
        assert points.verify(found) == wanted.check(rows)
        assert points.ids(found.certificate.support) == [f"{at:09}" for at in found.certificate.support]
        radius = found.answer.radius
        smaller = found.to_json().replace(repr(radius), repr(radius * 0.99))
        with pytest.raises(taut.Violation) as wanted:
            taut.verify(smaller, rows)
        with pytest.raises(taut.Violation) as raised:
            points.verify(smaller)
        assert str(raised.value) == str(wanted.value)


def stored(folder, rows, cuts):
    """Records of partitions in files, without Spark, and their layout."""
    from taut import _spark_tasks as tasks, passes

    records = []
    for at, (start, end) in enumerate(zip(cuts, cuts[1:])):
        path = folder / f"{at}-0.rows"
        path.write_bytes(rows[start:end].tobytes())
        records.append((at, end - start, str(path), "hash", ""))
    digests = {at: (count, digest) for at, count, _, digest, _ in records}
    step = passes.rows_of_block(rows.shape[1])
    starts = dict(enumerate(cuts[:-1]))
    return records, tasks.Layout(len(rows), str(rows.dtype), rows.shape[1], step, starts, digests, False)


def dealt(work, records):
    """Groups the pieces of tasks that have one record each, as a shuffle does."""
    groups = {}
    for record in records:
        for key, piece in work(iter([record])):
            groups.setdefault(key, []).append(piece)
    return groups


@pytest.mark.parametrize("lost", [0, 1, 2])
def test_no_shared_block_lacks_rows_of_a_missing_file(tmp_path, lost):
    from taut import _spark_tasks as tasks

    rows = taut.generate("normal", 100_000, 2, seed=2)
    cuts = [0, 20_000, 60_000, 100_000]
    records, layout = stored(tmp_path, rows, cuts)
    pieces = functools.partial(tasks.edge_pieces, layout=layout)
    whole = dict(map(tasks.join_edge, dealt(pieces, records).items()))
    assert sorted(whole) == [0, 32_768]
    for first, block in whole.items():
        assert (block == rows[first : first + 32_768]).all()
    os.remove(records[lost][2])
    for block, group in dealt(pieces, records).items():
        needs_it = cuts[lost] < (block + 1) * 32_768 and cuts[lost + 1] > block * 32_768
        assert (tasks.join_edge((block, group)) is None) == needs_it


def test_no_leaf_lacks_points_of_a_missing_file(tmp_path):
    from taut import _spark_delaunay as delaunay

    rows = taut.generate("uniform", 3000, 2, seed=2)
    records, layout = stored(tmp_path, rows, [0, 1000, 2000, 3000])
    cut, levels = delaunay.Cut(np.array(rows[::7]), 2), 2
    [whole] = functools.reduce(
        lambda a, b: [delaunay.merge_extents(*a, *b)], ([*delaunay.extent(iter([at]), layout, cut)] for at in records)
    )
    deal = functools.partial(delaunay.deal, layout=layout, cut=cut)
    groups = dealt(deal, records)
    assert sorted(groups) == [0, 1, 2, 3]
    assert all(delaunay.triangulate_leaf(group, whole, levels) for group in groups.items())
    os.remove(records[1][2])
    assert not any(delaunay.triangulate_leaf(group, whole, levels) for group in dealt(deal, records).items())
    with pytest.raises(RuntimeError, match=r"call points.delaunay\(\) again"):
        delaunay.climb(None, 1)
    with pytest.raises(ValueError, match=r"node 3 has \d+ points, and \d+ came"):
        delaunay.triangulate_leaf((0, groups[0][:2]), whole, levels)


def test_the_hash_of_a_partition_is_of_its_ids_as_well(tmp_path):
    import pyarrow
    from taut import _spark_tasks as tasks

    def write(names, cut):
        batch = pyarrow.RecordBatch.from_arrays([pyarrow.array(names), pyarrow.array([0.5, 1.5, 2.5])], names=["id", "x"])
        tasks.make_folder((str(tmp_path), "points"))
        path = tmp_path / "taut-points" / "0-0.rows"
        rows, digest = tasks._write(iter([batch[:cut], batch[cut:]]), ["x"], "id", "float64", str(path), 0)
        assert rows == 3
        assert path.parent.stat().st_mode & 0o777 == 0o700
        # Those of a partition may be of more than 2 GiB together.
        kind = tasks.ids((0, rows, str(path), digest, "")).type
        assert kind not in (pyarrow.string(), pyarrow.binary())
        return digest

    day, cent = datetime.date(2026, 11, 26), decimal.Decimal("0.01")
    for first, second, third, other in (
        ("a", "b", "c", "d"), ("a", "bc", "d", "dd"), ("", "b", "c", "bc"), (b"a", b"b", b"c", b"d"), (1, 2, 3, 4),
        (cent, 2 * cent, 3 * cent, 4 * cent), (day, day.replace(day=27), day.replace(day=28), day.replace(day=29)),
    ):
        assert write([first, second, third], 1) == write([first, second, third], 2)
        assert write([first, second, third], 1) != write([first, second, other], 1)
    # The bytes of all ids together are the same.
    assert write(["ab", "c", "d"], 1) != write(["a", "bc", "d"], 1)


def test_rows_as_they_come_and_from_files(spark, tmp_path):
    import taut.spark

    rows = taut.generate("normal", 100_000, 2, seed=2).astype(np.float32)
    df, columns = frame(spark, rows, np.arange(len(rows)), partitions=3)
    df.orderBy("key").write.parquet(str(tmp_path / "rows"), compression="gzip")
    stored = spark.read.parquet(str(tmp_path / "rows")).orderBy("key")
    assert taut.spark.ball(stored, columns).to_json() == taut.ball(rows).to_json()
    sparse = stored.where("key < 30000 or key >= 31000")
    kept = np.delete(rows, np.s_[30_000:31_000], axis=0)
    assert taut.spark.ball(sparse, columns, id="key").to_json() == taut.ball(kept).to_json()


def test_ellipsoids_and_centers(spark):
    import taut.spark

    rows = taut.generate("poisson", 70_000, 3, seed=2)
    order = np.random.default_rng(0).permutation(len(rows))
    df, columns = frame(spark, rows[order], order)
    with taut.spark.Points(df, columns, id="key", partitions=5) as points:
        for found, wanted in (
            (points.ellipsoid(), taut.ellipsoid(rows)),
            (points.centers(6), taut.centers(rows, 6, method="stream")),
            (points.centers(6, discrete=True), taut.centers(rows, 6, method="stream", discrete=True)),
        ):
            assert found.to_json() == wanted.to_json()
            assert points.verify(found.to_json()) == wanted.check(rows)
        for options, problem in (
            ({"epsilon": 0.5}, "option `epsilon` is 0.5: the method stream does not take it"),
            ({"max_nodes": 9, "method": "farthest-first"}, "option `max_nodes` is 9: the method farthest-first does not"),
            ({"discrete": True, "method": "tree"}, "option `discrete` is True: the method tree does not take it"),
            ({"method": "thesis"}, "option `method` is thesis: expected stream or farthest-first or tree"),
        ):
            with pytest.raises(ValueError, match=problem):
                points.centers(6, **options)
        # Faults that need no row are those of memory, too.
        forged = json.loads(points.ball().to_json())
        forged["certificate"]["multipliers"][0] = -1.0
        with pytest.raises(taut.Violation) as wanted:
            taut.verify(json.dumps(forged), rows)
        with pytest.raises(taut.Violation) as raised:
            points.verify(json.dumps(forged))
        assert str(raised.value) == str(wanted.value)
        with pytest.raises(ValueError, match="kind robust-ellipsoid are not verified in parts"):
            points.verify(taut.robust_ellipsoid(rows[:1000]))
        flat = rows.copy()
        flat[:, 2] = 1
    df, columns = frame(spark, flat, np.arange(len(flat)))
    with pytest.raises(ValueError, match="lie in a flat of dimension 2 in 3 dimensions"):
        taut.spark.ellipsoid(df, columns, id="key")


def test_robust_ellipsoids_and_other_centers(spark, tmp_path):
    import taut.spark
    from pyspark.errors import PythonException

    rows = taut.generate("normal", 40_000, 3, seed=2)
    rows[::4] += 30
    order = np.random.default_rng(0).permutation(len(rows))
    df, columns = frame(spark, rows[order], [f"{at:09}" for at in order])
    with taut.spark.Points(df, columns, id="key", partitions=3, scratch=str(tmp_path)) as points:
        fit, outliers = points.robust_ellipsoid()
        wanted = taut.robust_ellipsoid(rows)
        assert fit.kept == wanted.certificate.kept
        assert abs(fit.objective - wanted.certificate.objective) < 1e-3
        table = {name: distance for name, distance in outliers.toPandas().itertuples(index=False)}
        norms = fit.ellipsoid.norm(rows)
        assert sorted(table) == [f"{at:09}" for at in np.flatnonzero(norms > 1)]
        assert set(table) >= {f"{at:09}" for at in range(0, len(rows), 4)}
        offsets = rows - fit.ellipsoid.center
        distances = np.sqrt(np.einsum("ij,jk,ik->i", offsets, np.linalg.inv(fit.scatter), offsets))
        for name, distance in list(table.items())[::50]:
            assert distance == pytest.approx(distances[int(name)], rel=1e-9)
        traversal = points.centers(4, method="farthest-first")
        memory = taut.centers(rows, 4, method="farthest-first")
        assert (traversal.answer, traversal.certificate) == (memory.answer, memory.certificate)
        assert points.verify(traversal) == memory.check(rows)
        with pytest.raises(TypeError, match="not RobustFit: no certificate comes with it"):
            points.verify(fit)
        exact = points.centers(3, method="tree", epsilon=1e-4)
        assert points.verify(exact) == exact.check(rows)
        assert exact.certificate.gap <= 1e-4
        for path in tmp_path.rglob("*.rows"):
            path.unlink()
        with pytest.raises(PythonException, match=r"did not find its file: call points.robust_ellipsoid\(\) again"):
            outliers.count()
    # Nothing is made again once the points are closed.
    with pytest.raises(PythonException, match="the points are closed"):
        outliers.count()
    assert not list(tmp_path.iterdir())
    assert taut.spark.robust_ellipsoid(df, columns, id="key").ellipsoid == fit.ellipsoid


def diagram_of(rows):
    """The edges of the Voronoi diagram by their sites, each with its one or two ends, in ascending order."""
    import taut.spatial

    found = taut.spatial.Triangulation(rows).voronoi()
    edges = {}
    for sites, start, end in zip(found.ridge_points.tolist(), found.ridge_starts, found.ridge_starts[1:]):
        ends = [found.vertices[at] for at in found.ridge_vertices[start:end] if at >= 0]
        edges[tuple(sites)] = np.sort(np.array(ends), axis=0)
    return edges


def assert_same_diagram(table, rows):
    """Rows of a table of edges are the diagram: (a, b, x0, y0, x1, y1, dx, dy), None or NaN where there is nothing."""
    wanted = diagram_of(rows)
    assert len(table) == len(wanted)
    middle = rows.mean(axis=0)
    for a, b, x0, y0, *more in table:
        x1, y1, dx, dy = (np.nan if value is None else value for value in more)
        assert a < b
        ends = [[x0, y0]] if np.isnan(x1) else [[x0, y0], [x1, y1]]
        assert np.allclose(np.sort(ends, axis=0), wanted[a, b], rtol=1e-9, atol=1e-12)
        along = rows[b] - rows[a]
        if np.isnan(x1):
            # It goes off at a right angle, away from the points.
            assert abs(along @ [dx, dy]) <= 1e-12
            assert (rows[a] - middle) @ [dx, dy] > 0
        else:
            # The first end is to the left.
            assert np.isnan(dx)
            assert along[0] * (y0 - y1) - along[1] * (x0 - x1) >= -1e-12


def test_halves_of_edges_that_tiles_share_are_joined(tmp_path):
    from taut import _spark_delaunay as delaunay, _spark_voronoi as diagram

    rows = taut.generate("uniform", 3000, 2, seed=2)
    records, layout = stored(tmp_path, rows, [0, 1000, 2000, 3000])
    cut, levels = delaunay.Cut(np.array(rows[::7]), 2), 2
    whole = functools.reduce(delaunay.merge_extents, (next(delaunay.extent(iter([at]), layout, cut)) for at in records))
    groups = dealt(functools.partial(delaunay.deal, layout=layout, cut=cut), records)
    leaves = [delaunay.triangulate_leaf(group, whole, levels) for group in groups.items()]
    climbed = {}
    for leaf in leaves:
        number, front = delaunay.climb(leaf, levels)
        climbed.setdefault(number, []).append(front)
    [top] = [delaunay.triangulate_fronts(group, whole) for group in climbed.items()]
    nodes = [*leaves, top]
    shared = {}
    for key, half in (pair for node in nodes for pair in diagram.halves(node)):
        shared.setdefault(key, []).append(half)
    table = [diagram.joined_edge(group) for group in shared.items()]
    assert {len(group) for group in shared.values()} == {1, 2}
    for node in nodes:
        tile = taut.Tile.from_bytes(node[1], 2)
        found = diagram.facets(tile)
        for at in np.flatnonzero(~found.is_alone):
            ends = (found.center[at], found.beyond[at])[:: 1 if found.is_left[at] else -1]
            low, high = (int(tile.rows[sites[at]]) for sites in (found.low, found.high))
            table.append((low, high, *ends[0], *ends[1], None, None))
    assert_same_diagram(table, rows)


@pytest.mark.parametrize("distribution", ["grid", *[pytest.param(more, marks=LONG) for more in ("uniform", "clusters")]])
def test_triangulations(spark, distribution, monkeypatch):
    import taut.spark

    rows = taut.generate(distribution, 20_000, 2, seed=2)
    wanted = taut.delaunay(rows)
    df, columns = frame(spark, rows, [f"{at:09}" for at in range(len(rows))])
    with taut.spark.Points(df, columns, id="key", partitions=3) as points:
        # Sixteen leaves, one, and 32, of which fronts go up twice.
        for leaf_points in (1250, 10**6, 625):
            found = points.delaunay(leaf_points=leaf_points)
            assert found.fingerprint == wanted.fingerprint
            assert found.total == len(wanted.simplices)
            assert found.hull == len(wanted.hull)
            assert found.duplicates == len(wanted.duplicates)
            assert (found.passed_up == 0) == (leaf_points == 10**6)
        table = found.simplices.toPandas().astype(int).to_numpy()
        assert {tuple(sorted(row)) for row in table.tolist()} == {tuple(sorted(row)) for row in wanted.simplices.tolist()}
        assert len(table) == found.total
        with pytest.raises(ValueError, match="at least 1"):
            points.delaunay(leaf_points=0)
        # Nothing stays in memory of one that does not end.
        kept = spark.sparkContext._jsc.getPersistentRDDs
        before = kept().size()
        monkeypatch.setattr(taut.spark.delaunay, "counts", lambda found: 1 // 0)
        with pytest.raises(Exception, match="ZeroDivisionError"):
            points.delaunay(leaf_points=10**6)
        assert kept().size() == before
    df, columns = frame(spark, rows)
    with taut.spark.Points(df, [*columns, columns[0]]) as points:
        with pytest.raises(ValueError, match="have 3 coordinates"):
            points.delaunay()


def test_edges_of_voronoi_diagrams(spark):
    import taut.spark

    rows = taut.generate("uniform", 2000, 2, seed=2)
    order = np.random.default_rng(0).permutation(len(rows))
    df, columns = frame(spark, rows[order], order)
    with taut.spark.Points(df, columns, id="key") as points:
        assert points.delaunay(leaf_points=200).voronoi is None
        found = points.delaunay(leaf_points=200, voronoi=True)
        assert_same_diagram([tuple(row) for row in found.voronoi.collect()], rows)
    # Points on a line have none.
    df, columns = frame(spark, np.arange(20.0).reshape(10, 2))
    with taut.spark.Points(df, columns) as points:
        assert points.delaunay(leaf_points=4, voronoi=True).voronoi.count() == 0


def test_the_recipe_runs(spark, monkeypatch, capsys):
    recipe = pathlib.Path(__file__).parents[2] / "docs" / "recipes" / "spark.py"
    if not recipe.exists():
        pytest.skip("the recipe comes with the repository")
    monkeypatch.setattr(sys, "argv", [str(recipe), "5000"])
    runpy.run_path(str(recipe))
    said = capsys.readouterr().out
    assert "verified, gap at most" in said
    # The rows that were moved far off, of which one decides the ball.
    assert "farthest outliers: ['sensor " in said
    assert "cell of sensor 0000000 has" in said


def test_bad_input(spark, tmp_path):
    import taut.spark
    from pyspark.errors import PythonException

    rows = taut.generate("normal", 1000, 2, seed=2)
    df, columns = frame(spark, rows, np.arange(1000))
    ball = taut.spark.ball
    with pytest.raises(ValueError, match="no column 'z'"):
        ball(df, ["x0", "z"])
    with pytest.raises(ValueError, match="'name' is of type string"):
        ball(df.selectExpr("*", "string(key) as name"), ["x0", "name"])
    with pytest.raises(ValueError, match="no columns"):
        ball(df, [])
    with pytest.raises(ValueError, match="has no rows"):
        ball(df.where("x0 > 1e9"), columns)
    odd = df.selectExpr("x0", "if(key = 700, double('NaN'), x1) as x1", "key")
    with pytest.raises(ValueError, match=r"column 'x1' of id 700 in partition \d is nan"):
        ball(odd, columns, id="key")
    with pytest.raises(ValueError, match=r"column 'x1' of row \d+ in partition \d is nan"):
        ball(odd, columns)
    odd = df.selectExpr("if(key = 700, null, x0) as x0", "x1", "key")
    with pytest.raises(ValueError, match=r"column 'x0' of id 700 in partition \d is null"):
        ball(odd, columns, id="key")
    odd = df.selectExpr("x0", "x1", "if(key = 700, 3, key) as key")
    with pytest.raises(ValueError, match=r"'key', the id, has 3 twice"):
        ball(odd, columns, id="key")
    odd = df.selectExpr("x0", "x1", "if(key = 700, null, key) as key")
    with pytest.raises(ValueError, match=r"'key', the id, is null"):
        ball(odd, columns, id="key")
    far = df.selectExpr("key * bigint(9007199254740993) as x0", "key")
    with pytest.raises(ValueError, match=r"column 'x0' of id 1 in partition \d is 9007199254740993, which float64"):
        ball(far, ["x0"], id="key")
    with pytest.raises(ValueError, match="'name', the id, is of type double"):
        ball(df.selectExpr("*", "double(key) as name"), columns, id="name")
    odd = df.selectExpr("x0", "x1", "if(key = 700, string(unhex('FF')), string(key)) as key")
    with pytest.raises(ValueError, match=r"'key', the id, is not UTF-8 in row \d+ of partition \d"):
        ball(odd, columns, id="key")
    with pytest.raises(ValueError, match="column 'x0' is not the only one of that name: the DataFrame has 'x0', 'X0'"):
        ball(df.selectExpr("*", "x1 as X0"), columns)
    with pytest.raises(TypeError, match="columns is 'x0': expected a sequence of names"):
        ball(df, "x0")
    with pytest.raises(ValueError, match="partitions are given without id"):
        ball(df, columns, partitions=2)
    with pytest.raises(ValueError, match="partitions is 0: expected at least 1"):
        ball(df, columns, id="key", partitions=0)
    for scratch in ("points", "~/points"):
        with pytest.raises(ValueError, match=f"scratch is '{scratch}': expected an absolute path"):
            taut.spark.Points(df, columns, scratch=scratch)
    taken = tmp_path / "taken"
    taken.touch()
    with pytest.raises(PythonException, match=f"files cannot be written to {taken}/taut-[0-9a-f]+ on .*: .* Not a directory"):
        taut.spark.Points(df, columns, scratch=str(taken))
    taken.unlink()
    # Nothing is left behind.
    odd = df.selectExpr("x0", "x1", "if(key = 700, null, key) as key")
    with pytest.raises(ValueError, match="is null"):
        taut.spark.Points(odd, columns, id="key", scratch=str(tmp_path))
    assert not list(tmp_path.iterdir())


def test_empty_partitions_and_names_with_dots(spark, monkeypatch):
    import taut.spark

    # Workers merge the answers of few partitions as they do those of many.
    monkeypatch.setattr(taut.spark.tasks, "MERGED_BY_DRIVER_MAX", 4)
    rows = taut.generate("normal", 5, 2, seed=2)
    df, _ = frame(spark, rows, np.arange(5))
    df = df.selectExpr("x0 as `a.b`", "x1 as `c``d`", "key as `the.key`")
    with taut.spark.Points(df, ["a.b", "c`d"], id="the.key", partitions=8) as points:
        found = points.ball()
        assert found.to_json() == taut.ball(rows).to_json()
        assert points.verify(found) == found.check(rows)
        assert points.centers(3).to_json() == taut.centers(rows, 3, method="stream").to_json()
        assert points.delaunay(leaf_points=2).fingerprint == taut.delaunay(rows).fingerprint
        assert points.ids([4, 0]) == [4, 0]
        for row in (-1, 5):
            with pytest.raises(ValueError, match=f"no row {row}: rows are numbered from 0 to 4"):
                points.ids([row])
        for row in (1.0, True, "1"):
            with pytest.raises(TypeError):
                points.ids([row])
    hours = df.selectExpr("`a.b`", "timestamp_seconds(3600 * `the.key` + 0.25) as hour").coalesce(1)
    with taut.spark.Points(hours, ["a.b"], id="hour") as points:
        assert points.ids(range(5)) == [row.hour for row in hours.orderBy("hour").collect()]


def test_files_that_are_lost(spark, tmp_path, monkeypatch):
    import taut.spark
    from pyspark.sql.functions import udf

    def lose():
        lost = [path.unlink() for path in tmp_path.rglob("*.rows")]
        assert lost

    rows = taut.generate("normal", 100_000, 2, seed=2)
    df, columns = frame(spark, rows, np.arange(len(rows)))
    with taut.spark.Points(df, columns, id="key", scratch=str(tmp_path)) as points:
        lose()
        found = points.ball()
        assert found.to_json() == taut.ball(rows).to_json()
        lose()
        assert points.centers(3).to_json() == taut.centers(rows, 3, method="stream").to_json()
        for path in tmp_path.rglob("*.ids"):
            path.unlink()
        assert points.ids(found.certificate.support) == found.certificate.support.tolist()
        # Files made again take the place of those that were still there.
        assert len(list(tmp_path.rglob("*.rows"))) == len(list(tmp_path.rglob("*.ids"))) == 4
    assert not list(tmp_path.iterdir())
    for ask in (points.ball, points.robust_ellipsoid, points.delaunay, lambda: points.centers(2), lambda: points.ids([0])):
        with pytest.raises(ValueError, match="the points are closed"):
            ask()
    points.close()
    # Tasks that miss their files by chance: nothing is made again.
    with taut.spark.Points(df, columns, id="key", scratch=str(tmp_path)) as points:
        again, hidden = points._with_edges, list(tmp_path.rglob("*.rows"))
        for path in hidden:
            path.rename(path.with_suffix(".hidden"))

        def found_again():
            for path in hidden:
                path.with_suffix(".hidden").rename(path)
            return again()

        monkeypatch.setattr(points, "_with_edges", found_again)
        monkeypatch.setattr(points, "_rebuild", lambda: pytest.fail("nothing was lost"))
        assert points.ball().to_json() == found.to_json()
    # Other rows each time they are made.
    odd = udf(lambda key: key + int.from_bytes(os.urandom(2)) / 2**16, "double").asNondeterministic()
    df = spark.range(1000).select(odd("id").alias("x0"))
    with taut.spark.Points(df, ["x0"], scratch=str(tmp_path)) as points:
        lose()
        with pytest.raises(RuntimeError, match=r"partition \d has other rows when the DataFrame is read again"):
            points.ball()


def executors():
    """The processes of the executors that this process started."""
    listed = subprocess.run(["ps", "-ewwo", "pid,ppid,args"], capture_output=True, text=True, check=True).stdout
    # A process that just begins may have no arguments yet.
    lines = [fields for line in listed.splitlines()[1:] if len(fields := line.split(None, 2)) == 3]
    children = {os.getpid()}
    for _ in range(5):
        children |= {int(pid) for pid, parent, _ in lines if int(parent) in children}
    return [int(pid) for pid, _, args in lines if int(pid) in children and "CoarseGrainedExecutorBackend" in args]


def test_closing_reads_no_rows_again(spark, tmp_path):
    import taut.spark

    begun, scratch = tmp_path / "begun", tmp_path / "scratch"
    for folder in (begun, scratch):
        folder.mkdir()

    def source(seconds):
        def read(batches):
            (begun / f"{os.getpid()}-{time.time_ns()}").touch()
            time.sleep(seconds)
            yield from batches

        return spark.range(0, 32, 1, 16).mapInPandas(read, "id long")

    def interrupt():
        while len(list(begun.iterdir())) < 3:
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt, daemon=True)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        taut.spark.Points(source(0.7), ["id"], scratch=str(scratch))
    assert len(list(begun.iterdir())) < 8
    assert not list(scratch.iterdir())
    points = taut.spark.Points(source(0), ["id"], scratch=str(scratch))
    read = len(list(begun.iterdir()))
    os.kill(executors()[0], signal.SIGKILL)
    points.close()
    assert len(list(begun.iterdir())) == read
    assert not list(scratch.iterdir())


def killed_in_pass(points, caplog, number, delay):
    """The ball, with an executor killed some time after a pass began; and whether that was before it ended."""
    caplog.clear()
    before, ended = [], threading.Event()
    # To list processes takes long: it is done before.
    victim = executors()[0]

    def kill():
        while not any(f"pass {number} " in record.getMessage() for record in caplog.records):
            if ended.wait(0.001):
                return
        time.sleep(delay)
        os.kill(victim, signal.SIGKILL)
        before.extend(record.getMessage() for record in caplog.records)

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    try:
        found = points.ball()
    finally:
        ended.set()
        thread.join(60)
    return found, bool(before) and before[-1].startswith(f"pass {number} ") and before[-1].endswith("begins")


def test_a_killed_executor_changes_nothing(spark, caplog):
    import taut.spark

    caplog.set_level("INFO", "taut.spark")
    rows = taut.generate("sphere", 200_000, 10, seed=2)
    df, columns = frame(spark, rows, np.arange(len(rows)))
    wanted = taut.ball(rows).to_json()
    with taut.spark.Points(df, columns, id="key") as points:
        for _ in range(5):
            found, fell_within = killed_in_pass(points, caplog, 2, 0.01)
            assert found.to_json() == wanted
            if fell_within:
                break
        assert fell_within, "five kills came after the pass"
        assert points.verify(wanted) == taut.verify(wanted, rows)
