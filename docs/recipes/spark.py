"""A table of readings, and what taut finds in it with Apache Spark: spark-submit docs/recipes/spark.py [ROWS] [TABLE.parquet].

The cells (`# %%`) run one by one in editors that know them. Without a table one is made, of ROWS rows, 100000 by default. A table of
yours has a column "sensor" of different values and columns of numbers.
"""

# %% A session, and a table of readings with names: most from one source, some from a broken sensor
import sys
import tempfile

import numpy as np
import pandas
import taut
import taut.spark
from pyspark.sql import SparkSession

spark = SparkSession.builder.appName("taut").getOrCreate()
count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
if len(sys.argv) > 2:
    path = sys.argv[2]
else:
    path = f"{tempfile.mkdtemp()}/readings.parquet"
    readings = taut.generate("normal", count, 3, seed=1)
    readings[:: count // 20] += [40, 0, 0]
    table = pandas.DataFrame(readings, columns=["x", "y", "z"])
    table["sensor"] = [f"sensor {at:07}" for at in np.random.default_rng(0).permutation(count)]
    # With gzip, as the library for snappy, the default, does not load where the libraries of musl are installed beside those of glibc.
    spark.createDataFrame(table).write.parquet(path, compression="gzip")
df = spark.read.parquet(path)
columns = [name for name in df.columns if name != "sensor"]

# %% The rows go to files of the workers once, in the order of their names
with taut.spark.Points(df, columns, id="sensor") as points:
    # The smallest ball, and which sensors decide it; checked over all rows in one pass.
    ball = points.ball()
    print("ball:", ball.answer.radius, "decided by", points.ids(ball.certificate.support))
    print("verified, gap at most", points.verify(ball).gap)

    # What most of the rows say, and the rows that do not belong to them.
    fit, outliers = points.robust_ellipsoid()
    print("center of most rows:", fit.ellipsoid.center.round(3))
    print("farthest outliers:", [row.id for row in outliers.orderBy("distance", ascending=False).limit(3).collect()])

    # Three places near all rows, and a bound that no three places beat.
    found = points.centers(3)
    print("centers within", found.answer.radius, "at best", found.answer.lower_bound)

# %% In the plane: who is next to whom
with taut.spark.Points(df, columns[:2], id="sensor") as points:
    found = points.delaunay(voronoi=True)
    print(found.total, "simplices; edges of the Voronoi diagram:", found.voronoi.count())
    neighbors = found.voronoi.where("a = 'sensor 0000000' or b = 'sensor 0000000'")
    print("cell of sensor 0000000 has", neighbors.count(), "edges")
