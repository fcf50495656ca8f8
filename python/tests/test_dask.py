"""Answers about rows with the workers of Dask have the bytes of those in memory. Skipped where Dask is missing."""

import numpy as np
import pytest

import taut

distributed = pytest.importorskip("distributed", reason="Dask is not installed: pip install 'taut[dask]'")
pytestmark = pytest.mark.filterwarnings("ignore")


def test_parts_of_any_length():
    import dask
    import dask.array as da
    import dask.dataframe as dd
    import pandas

    import taut.dask

    rows = taut.generate("poisson", 200_000, 3, seed=2)
    wanted = taut.ball(rows)
    make = dask.delayed(taut.generate)("poisson", 200_000, 3, seed=2)
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        with distributed.Client(cluster) as client:
            for cuts in ([0, 200_000], [0, 1, 21_845, 21_845, 60_000, 60_001, 131_070, 200_000]):
                parts = [make[first:end] for first, end in zip(cuts, cuts[1:])]
                points = taut.dask.Points(client, parts)
                found = points.ball()
                assert found.to_json() == wanted.to_json()
                assert points.verify(found.to_json()) == wanted.check(rows)
            # The last points, of seven parts.
            for found, wanted in (
                (points.ellipsoid(), taut.ellipsoid(rows)),
                (points.centers(5), taut.centers(rows, 5, method="stream")),
                (points.centers(5, discrete=True), taut.centers(rows, 5, method="stream", discrete=True)),
            ):
                assert found.to_json() == wanted.to_json()
                assert points.verify(found) == wanted.check(rows)
            traversal = taut.centers(rows, 5, method="farthest-first")
            assert points.centers(5, method="farthest-first").certificate == traversal.certificate
            assert points.centers(2, method="tree").check(rows).gap <= 0.01
            fit = points.robust_ellipsoid()
            # Of these rows very many are equally far, of which other ones are kept.
            assert fit.objective <= taut.robust_ellipsoid(rows).certificate.objective + 0.01
            with pytest.raises(ValueError, match="option `epsilon` is 0.5: the method stream does not take it"):
                points.centers(5, epsilon=0.5)
            with pytest.raises(TypeError, match="not RobustFit: no certificate comes with it"):
                points.verify(fit)
            with pytest.raises(ValueError, match="is nan|NaN"):
                taut.dask.Points(client, [dask.delayed(np.full)((10, 2), np.nan)]).ball()
            ones = dask.delayed(np.ones)
            # Without rows there is no width to be wrong.
            assert taut.dask.Points(client, [ones((0, 0)), ones((2, 3)), ones((0, 2))]).shape == (2, 3)
            with pytest.raises(ValueError, match="part 2 has rows of 2 numbers, those before have 3"):
                taut.dask.Points(client, [ones((0, 2)), ones((5, 3)), ones((4, 2))])
            with pytest.raises(ValueError, match=r"part 1: points have shape \(5,\): expected \(n, d\)"):
                taut.dask.Points(client, [ones((5, 3)), ones(5)])
            with pytest.raises(TypeError, match="Delayed objects of unspecified length are not iterable"):
                taut.dask.Points(client, ones((5, 3)))
            with pytest.raises(ValueError, match=r"the array has shape \(5,\): expected \(n, d\)"):
                taut.dask.Points(client, da.ones(5))
            few = rows[:100]
            wanted = taut.ball(few)
            assert taut.dask.Points(client, da.from_array(few, chunks=(30, 2))).ball() == wanted
            table = dd.from_pandas(pandas.DataFrame(few, columns=list("xyz")), npartitions=3)
            assert taut.dask.Points(client, table).ball() == wanted
