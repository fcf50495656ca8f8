"""Estimators of scikit-learn that hold the solution, with its certificate, as `solution_`.

| estimator | kind | of |
|---|---|---|
| `KCenter` | clusterer and transformer | `taut.centers` |
| `EnclosingBall` | outlier detector | `taut.ball` |
| `EnclosingEllipsoid` | outlier detector | `taut.ellipsoid` |
| `MinCovDet` | covariance, as `sklearn.covariance.MinCovDet` | `taut.robust_ellipsoid` |
| `EllipticEnvelope` | outlier detector, as `sklearn.covariance.EllipticEnvelope` | `taut.robust_ellipsoid` |
| `BallClassifier` | classifier | `taut.ball` for each class |

They need scikit-learn, which `import taut` does not. None takes `sample_weight`: the answers depend on which rows there are,
not on how often each occurs.

>>> import taut
>>> from taut.sklearn import EnclosingBall
>>> points = taut.generate("normal", 1000, 3)
>>> detector = EnclosingBall(contamination=0.01).fit(points)
>>> int((detector.predict(points) == -1).sum())
10
>>> detector.solution_.check(points).gap <= 1e-9
True
"""

from __future__ import annotations

from ._classifier import BallClassifier
from ._cluster import KCenter
from ._covariance import EllipticEnvelope, MinCovDet
from ._enclosing import EnclosingBall, EnclosingEllipsoid

__all__ = ["BallClassifier", "EllipticEnvelope", "EnclosingBall", "EnclosingEllipsoid", "KCenter", "MinCovDet"]
