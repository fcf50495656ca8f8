"""Answers about DataFrames of Spark have the bytes of those in memory. Skipped where PySpark or Java are missing."""

import os
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


@pytest.mark.parametrize("partitions", [1, 7])
@pytest.mark.parametrize(("distribution", "d"), [("poisson", 3), ("sphere", 10)])
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


def test_rows_as_they_come_and_from_files(spark, tmp_path):
    import taut.spark

    rows = taut.generate("normal", 100_000, 2, seed=2).astype(np.float32)
    df, columns = frame(spark, rows, np.arange(len(rows)), partitions=3)
    df.orderBy("key").write.parquet(str(tmp_path / "rows"))
    stored = spark.read.parquet(str(tmp_path / "rows")).orderBy("key")
    assert taut.spark.ball(stored, columns).to_json() == taut.ball(rows).to_json()
    sparse = stored.where("key < 30000 or key >= 31000")
    kept = np.delete(rows, np.s_[30_000:31_000], axis=0)
    assert taut.spark.ball(sparse, columns, id="key").to_json() == taut.ball(kept).to_json()


def test_bad_input(spark):
    import taut.spark

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
    # Empty partitions are none of these.
    kept = rows[:50]
    found = ball(df.where("key < 50").repartition(80), columns, id="key", partitions=60)
    assert found.to_json() == taut.ball(kept).to_json()


def executors():
    """The processes of the executors that this process started."""
    listed = subprocess.run(["ps", "-eo", "pid,ppid,args"], capture_output=True, text=True, check=True).stdout
    lines = [line.split(None, 2) for line in listed.splitlines()[1:]]
    children = {os.getpid()}
    for _ in range(5):
        children |= {int(pid) for pid, parent, _ in lines if int(parent) in children}
    return [int(pid) for pid, _, args in lines if int(pid) in children and "CoarseGrainedExecutorBackend" in args]


def test_a_killed_executor_changes_nothing(spark, caplog):
    import taut.spark

    caplog.set_level("INFO", "taut.spark")
    rows = taut.generate("sphere", 200_000, 10, seed=2)
    df, columns = frame(spark, rows, np.arange(len(rows)))
    wanted = taut.ball(rows).to_json()
    with taut.spark.Points(df, columns, id="key") as points:
        assert points.ball().to_json() == wanted
        caplog.clear()

        def kill():
            while not any("pass 2 " in record.getMessage() for record in caplog.records):
                time.sleep(0.001)
            time.sleep(0.02)
            os.kill(executors()[0], signal.SIGKILL)
            killed.append(len(caplog.records))

        killed = []
        thread = threading.Thread(target=kill)
        thread.start()
        assert points.ball().to_json() == wanted
        thread.join()
        messages = [record.getMessage() for record in caplog.records]
        assert "begins" in messages[killed[0] - 1], "the kill fell within a pass"
        assert points.verify(wanted) == taut.verify(wanted, rows)
