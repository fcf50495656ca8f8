"""Wrong input is refused with column, partition and id, and nothing is left behind."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import taut
import taut.spark

from .context import Context, Line, columns_of


def refusal(df: Any, columns: list[str], scratch: Any) -> str:
    """The words of the refusal, none if there was no refusal; files that are left behind are told as well."""
    words = ""
    try:
        with taut.spark.Points(df, columns, id="key", partitions=4, scratch=str(scratch)) as points:
            points.ball()
    except ValueError as refused:
        words = str(refused)
    left = [path.name for path in scratch.rglob("*")]
    return f"{words} AND LEFT {left[0]}" if left else words


def run(context: Context) -> Iterator[Line]:
    n = 2000
    rows = taut.generate("normal", n, 2, seed=2)
    df = context.session.read.parquet(context.stored(rows, "rows", np.arange(n)))
    x0, x1 = columns = columns_of(rows)
    scratch = context.folder / "scratch"
    scratch.mkdir()
    cases = [
        ("a null", df.selectExpr(f"if(key = 700, null, {x0}) as {x0}", x1, "key"), columns, r"'x0' of id 700 in partition \d is null"),
        ("a NaN", df.selectExpr(x0, f"if(key = 700, double('NaN'), {x1}) as {x1}", "key"), columns, r"'x1' of id 700 in partition \d is nan"),
        ("an infinity", df.selectExpr(x0, f"if(key = 700, double('-Infinity'), {x1}) as {x1}", "key"), columns,
         r"'x1' of id 700 in partition \d is -inf"),
        ("a column of strings", df.selectExpr(x0, "string(key) as name", "key"), [x0, "name"], r"'name' is of type string"),
        ("an empty DataFrame", df.where(f"{x0} > 1e9"), columns, r"has no rows"),
        ("ids that occur twice", df.selectExpr(x0, x1, "if(key = 700, 3, key) as key"), columns, r"'key', the id, has 3 twice \(partition \d\)"),
        ("an id that is null", df.selectExpr(x0, x1, "if(key = 700, null, key) as key"), columns,
         r"'key', the id, is null in row \d+ of partition \d"),
        ("a column that is not there", df, [x0, "z"], r"no column 'z'"),
    ]
    for what, odd, names, wanted in cases:
        words = refusal(odd, names, scratch)
        holds = re.search(wanted, words) is not None and "AND LEFT" not in words
        print(f"    {what}: {words or 'NOT REFUSED'}")
        yield Line(what, "refused, nothing left" if holds else "ELSE", "must", holds)
    with taut.spark.Points(df.where("key < 3"), columns, id="key", partitions=8) as points:
        same = points.ball().to_json() == taut.ball(rows[:3]).to_json()
    yield Line("partitions without rows", "the same bytes" if same else "OTHER bytes", "must", same)
