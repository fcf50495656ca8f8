"""Answers about rows with the workers of Dask have the bytes of those in memory. Skipped where Dask is missing."""

import numpy as np
import pytest

import taut

distributed = pytest.importorskip("distributed", reason="Dask is not installed: pip install 'taut[dask]'")
pytestmark = pytest.mark.filterwarnings("ignore")


def test_parts_of_any_length():
    import dask

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
                assert points.verify(found) == wanted.check(rows)
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
            with pytest.raises(ValueError, match="is nan|NaN"):
                taut.dask.Points(client, [dask.delayed(np.full)((10, 2), np.nan)]).ball()
