"""Public data, where TAUT_DATA says that they lie."""

import lzma
import os
from pathlib import Path

import numpy as np
import pytest

import taut

DATA = os.environ.get("TAUT_DATA")


@pytest.mark.skipif(not DATA, reason="TAUT_DATA is not set")
def test_usps_digits():
    """7291 scanned digits of 16 × 16 pixels, the label first; other exact solvers agree on the radius."""
    with lzma.open(Path(DATA) / "ball" / "usps_train.csv.xz", "rt") as lines:
        points = np.loadtxt(lines, delimiter=",", usecols=range(1, 257))
    assert points.shape == (7291, 256)
    found = taut.ball(points, epsilon=0)
    assert found.answer.radius == pytest.approx(13.479343686, abs=1e-8)
    assert found.check(points).gap <= 1e-12
    narrow = taut.ball(points.astype(np.float32), epsilon=0)
    assert narrow.answer.radius == pytest.approx(found.answer.radius, rel=1e-6)
