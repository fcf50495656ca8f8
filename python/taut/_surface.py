"""Surfaces through points of space."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.surface import Surface
from ._arrays import as_rows
from ._solution import Solution

SurfaceMethod = Literal["tree", "thesis", "alpha", "hull"]
Priority = Literal["circumcentre-distance", "circumradius", "empty-ball"]


def surface(
    points: ArrayLike,
    *,
    method: SurfaceMethod = "tree",
    open: bool = False,  # noqa: A002, the public name
    denoise: bool = False,
    neighbors: int | None = None,
    iterations: int = 2,
    original: bool = False,
    alpha: float | None = None,
    epsilon: float = 2e-5,
    sliver_angle: float | None = None,
    forbidden_angle: float | None = None,
    priority: Priority = "circumcentre-distance",
    restarts: bool = False,
    threads: int | None = None,
) -> Solution[Surface]:
    """The surface that points of space were sampled from: triangles between them, and whether they are a surface.

    Parameters
    ----------
    points : array_like of shape (n, 3)
        Finite real numbers, taken as by `ball`.
    method : str, default "tree"
        The way to find it: "tree" labels all space as inside or outside, by the strongest of what neighboring Delaunay cells say
        about each other; "thesis" grows a front over facets with empty equatorial spheres; "alpha" is the alpha shape; "hull" are
        all facets with empty equatorial spheres.
    open : bool, default False
        Of "tree": whether sheets end where their points end. Else every part is closed, as the boundary of a body.
    denoise : bool, default False
        Whether noise is taken out of the points first: outliers are left out, each other point is moved onto the sheet that its
        neighbors show, and points that are nearer to each other than they are exact are put into one place. The places are then
        in ``answer.vertices``; the surface need not pass through the points.
    neighbors : int in [4, 1000], optional
        With `denoise`: how many nearest points show the sheet of a point, itself among them; by default 24 to 272, by the noise.
    iterations : int, 0 to 100, default 2
        With `denoise`: how many times each point is moved; 0 leaves out outliers alone.
    original : bool, default False
        With `denoise`: whether the vertices stay where the points are given. The triangles are those of the moved points, and can meet.
    alpha : float >= 0, optional
        Of "alpha" the radius, by default the least at which all points are on one solid or in it; of "thesis" and "hull" the
        largest circumradius of a triangle, by default any.
    epsilon : float in [0, 1), default 2e-5
        Of "thesis" and "hull": by which part of its radius the sphere of a triangle is shrunk before it has to be empty.
    sliver_angle : float in [0, pi/2], optional
        Of "thesis": the angle below which two triangles at an edge are on slivers, by default pi/12.
    forbidden_angle : float in [0, pi/2], optional
        Of "thesis": the least angle between two triangles, by default pi/4.
    priority : str, default "circumcentre-distance"
        Of "thesis", what the front prefers: "circumcentre-distance", "circumradius" or "empty-ball".
    restarts : bool, default False
        Of "thesis": whether another front starts where no triangle reaches.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.

    Returns
    -------
    Solution
        ``answer.triangles`` of shape (m, 3), rows of `points`; the parts, boundaries and handles; the rows that no triangle has, by
        reason; ``certificate``; ``trace``.

    Raises
    ------
    ValueError
        When points do not have 3 coordinates, lie in a plane, or hold NaN or infinity (the message names row and column), or an
        option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    Notes
    -----
    Vertices are the points themselves, so that a mesh is ready at once: ``trimesh.Trimesh(points, found.answer.triangles)``,
    ``pyvista.PolyData.from_regular_faces(points, found.answer.triangles)``, or for Open3D ``Vector3dVector(points)`` and
    ``Vector3iVector(found.answer.triangles.astype("int32"))``.

    What `Solution.check` proves, by exact signs: topology, that the surface meets itself nowhere, that each triangle has an empty ball,
    and which side is outside.

    See Also
    --------
    delaunay : the triangulation that all this stands on.

    Examples
    --------
    A torus:

    >>> import numpy as np
    >>> import taut
    >>> u, v = np.meshgrid(np.arange(40) * (2 * np.pi / 40), np.arange(20) * (2 * np.pi / 20))
    >>> u, v = u.ravel(), v.ravel() + 0.01 * u.ravel()
    >>> ring = 2 + 0.7 * np.cos(v)
    >>> points = np.c_[ring * np.cos(u), ring * np.sin(u), 0.7 * np.sin(v)]
    >>> found = taut.surface(points)
    >>> found.answer.genus, found.answer.boundary_loops, len(found.answer.triangles)
    (1, 0, 1600)
    >>> found.check(points).certified
    True
    """
    rows = as_rows(points)
    found = _native.surface(
        rows,
        method,
        open,
        denoise,
        neighbors,
        iterations,
        original,
        alpha,
        epsilon,
        sliver_angle,
        forbidden_angle,
        priority,
        restarts,
        threads,
    )
    return Solution(found, rows)
