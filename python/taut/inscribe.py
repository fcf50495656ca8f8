"""The shapes inside others under short names: `taut.inscribe.circle` is `taut.inscribed_circle`, and so on.

>>> import taut
>>> round(taut.inscribe.circle([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]).answer.radius, 6)
1.0
"""

from ._bodies import inscribed_bodies as bodies
from ._bodies import inscribed_dops as dops
from ._bodies import triangle_rows
from ._circle import inscribed_circle as circle
from ._ellipse import inscribed_ellipse as ellipse
from ._ellipsoid import inscribed_ellipsoid as ellipsoid
from ._oriented import inscribed_oriented_rectangle as oriented_rectangle
from ._polygon import inscribed_polygon as polygon
from ._rectangle import inscribed_rectangle as rectangle
from ._triangle import inscribed_triangle as triangle

__all__ = [
    "bodies",
    "circle",
    "dops",
    "ellipse",
    "ellipsoid",
    "oriented_rectangle",
    "polygon",
    "rectangle",
    "triangle",
    "triangle_rows",
]
