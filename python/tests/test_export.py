"""Answers as pictures, meshes and frames of other libraries."""

import numpy as np
import pytest

import taut
import taut.spatial


def library(name):
    return pytest.importorskip(name, reason=f"{name} is not installed")


PLANE, SPACE = taut.generate("normal", 300, 2), taut.generate("normal", 300, 3)

DRAWN = {
    "ball": lambda: taut.ball(PLANE),
    "ball in space": lambda: taut.ball(SPACE),
    "ellipsoid": lambda: taut.ellipsoid(PLANE),
    "ellipsoid in space": lambda: taut.ellipsoid(SPACE),
    "robust ellipsoid": lambda: taut.robust_ellipsoid(PLANE),
    "centers": lambda: taut.centers(PLANE, 3, epsilon=0.5),
    "delaunay": lambda: taut.delaunay(PLANE),
    "delaunay in space": lambda: taut.delaunay(SPACE),
    "curve": lambda: taut.curve([[np.cos(t), np.sin(t)] for t in np.arange(0, 6.2, 0.1)]),
}


@pytest.mark.parametrize("kind", DRAWN)
def test_answers_are_drawn(kind):
    matplotlib = library("matplotlib")
    matplotlib.use("Agg")
    from matplotlib import pyplot

    axes = DRAWN[kind]().plot()
    assert axes.lines or axes.collections
    axes.figure.canvas.draw()
    pyplot.close(axes.figure)


def test_axes_can_be_given():
    library("matplotlib").use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots()
    assert taut.ball(PLANE).plot(axes) is axes
    # The circle is drawn with the radius of the answer.
    found = taut.ball(PLANE).answer
    line = np.column_stack(axes.lines[0].get_data())
    np.testing.assert_allclose(found.distance(line), found.radius)
    pyplot.close(figure)


def test_what_has_no_plot_is_named():
    with pytest.raises(ValueError, match="order answers have no plot"):
        taut.spatial_order(PLANE).plot()
    with pytest.raises(ValueError, match="answers in 5 dimensions have no plot"):
        taut.ball(taut.generate("normal", 30, 5)).plot()
    with pytest.raises(ValueError, match="not known any more"):
        taut.Solution.from_json(taut.delaunay(PLANE).to_json()).plot()


def test_meshes_are_meshes_of_trimesh():
    library("trimesh")
    mesh = taut.delaunay(SPACE).to_trimesh()
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(taut.spatial.hull(SPACE).volume)
    sphere = SPACE / np.sqrt(np.square(SPACE).sum(axis=1))[:, None]
    found = taut.surface(sphere)
    assert len(found.to_trimesh().faces) == len(found.answer.triangles)
    with pytest.raises(ValueError, match="is no mesh"):
        taut.ball(SPACE).to_trimesh()


def test_tables_are_frames():
    library("pandas")
    found = taut.centers(PLANE, 3, epsilon=0.5)
    np.testing.assert_array_equal(found.to_pandas().to_numpy(), found.answer.centers)
    assert taut.delaunay(SPACE).to_pandas().columns.tolist() == ["vertex0", "vertex1", "vertex2", "vertex3"]
    assert taut.ball(PLANE).to_pandas().loc[0, "radius"] == taut.ball(PLANE).answer.radius
    assert taut.spatial_order(PLANE).to_pandas()["row"].tolist() == taut.spatial_order(PLANE).answer.rows.tolist()
    assert set(DRAWN["curve"]().to_pandas()["curve"]) == {0}
