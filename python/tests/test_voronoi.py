"""`Voronoi` against scipy: ridges by their points, vertices within rounding; points on one circle or sphere."""

import itertools
import pickle

import numpy as np
import pytest
from conftest import grid, random_points

from breakline.spatial import ConvexHull, Delaunay, QhullError, Voronoi

#: All points with whole coordinates on a circle of radius 5, and on a sphere of radius 3.
CIRCLE = np.array([p for p in itertools.product(range(-5, 6), repeat=2) if np.dot(p, p) == 25], float)
SPHERE = np.array([p for p in itertools.product(range(-3, 4), repeat=3) if np.dot(p, p) == 9], float)


def pairs(diagram):
    return {frozenset(pair) for pair in diagram.ridge_points.tolist()}


def pairs_of_scipy(diagram):
    """Return the ridges that scipy has: in space Qhull leaves out those with one finite vertex, which are unbounded."""
    ridges = zip(diagram.ridge_points.tolist(), diagram.ridge_vertices)
    return {frozenset(pair) for pair, ridge in ridges if len(ridge) >= diagram.ndim}


def assert_consistent(diagram):
    """Check what holds for every diagram."""
    points, vertices, ndim = diagram.points, diagram.vertices, diagram.ndim
    assert vertices.dtype == np.float64 and vertices.shape[1:] == (ndim,)
    assert diagram.ridge_points.dtype == np.int32 and diagram.ridge_points.shape == (len(diagram.ridge_vertices), 2)
    assert diagram.point_region.dtype == np.int64 and diagram.point_region.shape == (len(points),)
    assert len(pairs(diagram)) == len(diagram.ridge_points) == len(diagram.ridge_dict)
    of_points = [set() for _ in points]
    for (p, q), ridge in zip(diagram.ridge_points.tolist(), diagram.ridge_vertices):
        assert diagram.ridge_dict[p, q] == ridge and len(set(ridge)) == len(ridge) >= 2
        assert -1 not in ridge[1:]
        of_points[p] |= set(ridge)
        of_points[q] |= set(ridge)
        at = vertices[[vertex for vertex in ridge if vertex >= 0]]
        to_p, to_q = (np.linalg.norm(at - points[k], axis=1) for k in (p, q))
        assert np.allclose(to_p, to_q, rtol=1e-9)
    assert np.unique(diagram.point_region).tolist() == [k for k, region in enumerate(diagram.regions) if region]
    for point, region in enumerate(diagram.point_region.tolist()):
        region = diagram.regions[region]
        assert len(set(region)) == len(region) and -1 not in region[1:]
        assert of_points[point] <= set(region)
        if ndim == 2 and -1 not in region:
            # Counter-clockwise around the point: each side turns left around it.
            x, y = (vertices[region] - points[point]).T
            assert (x * np.roll(y, -1) - y * np.roll(x, -1) > 0).all()


@pytest.mark.parametrize("threads", [1, 2, None])
@pytest.mark.parametrize(("count", "ndim"), [(400, 2), (150, 3), (5000, 2)])
def test_random_points_have_the_diagram_of_scipy(scipy_spatial, count, ndim, threads):
    points = random_points(count, ndim)
    ours, theirs = Voronoi(points, threads=threads), scipy_spatial.Voronoi(points)
    assert pairs_of_scipy(ours) == pairs(theirs)
    assert len(ours.vertices) == len(theirs.vertices)
    distance, to_theirs = scipy_spatial.cKDTree(theirs.vertices).query(ours.vertices)
    size = np.abs(theirs.vertices[to_theirs]).max(axis=1)
    assert (distance <= 1e-9 * np.maximum(size, 1)).all()
    assert len(np.unique(to_theirs)) == len(to_theirs)
    to_theirs = np.append(to_theirs, -1)
    theirs_of = {frozenset(pair): set(ridge) for pair, ridge in theirs.ridge_dict.items()}
    for pair, ridge in ours.ridge_dict.items():
        if frozenset(pair) in theirs_of:
            assert theirs_of[frozenset(pair)] == set(to_theirs[ridge].tolist())
        else:
            assert ridge[0] == -1 and len(ridge) == 2 < ndim
    for point in range(count):
        region, other = (diagram.regions[diagram.point_region[point]] for diagram in (ours, theirs))
        assert set(to_theirs[region].tolist()) == set(other)
    for name in ("min_bound", "max_bound", "points"):
        assert (getattr(ours, name) == getattr(theirs, name)).all()
    assert (ours.ndim, ours.npoints, ours.furthest_site) == (theirs.ndim, theirs.npoints, theirs.furthest_site)
    for name in ("vertices", "ridge_points", "point_region"):
        assert getattr(ours, name).dtype == getattr(theirs, name).dtype, name
    assert len(ours.regions) == len(theirs.regions)
    if count < 1000:
        assert_consistent(ours)


def test_the_cells_of_a_grid_are_squares(scipy_spatial):
    points = grid(9, 2)
    diagram = Voronoi(points)
    assert_consistent(diagram)
    assert sorted(diagram.vertices.tolist()) == (grid(8, 2) + 0.5).tolist()
    assert len(diagram.ridge_points) == 2 * 9 * 8
    assert (np.abs(points[diagram.ridge_points[:, 0]] - points[diagram.ridge_points[:, 1]]).sum(axis=1) == 1).all()
    inside = ((points > 0) & (points < 8)).all(axis=1)
    assert [len(diagram.regions[k]) for k in diagram.point_region[inside]] == [4] * 49
    assert pairs(diagram) == pairs(scipy_spatial.Voronoi(points))


def test_the_cells_of_a_grid_in_space_are_cubes(scipy_spatial):
    points = grid(5, 3)
    diagram = Voronoi(points)
    assert_consistent(diagram)
    assert sorted(diagram.vertices.tolist()) == (grid(4, 3) + 0.5).tolist()
    assert len(diagram.ridge_points) == 3 * 5 * 5 * 4
    assert pairs(scipy_spatial.Voronoi(points)) == pairs_of_scipy(diagram)
    of_edges = [ridge for ridge in diagram.ridge_vertices if len(ridge) == 2]
    assert len(of_edges) == 12 * 4 and all(ridge[0] == -1 for ridge in of_edges)
    inside = ((points > 0) & (points < 4)).all(axis=1)
    assert [len(diagram.regions[k]) for k in diagram.point_region[inside]] == [8] * 27


def test_points_on_a_circle_have_one_vertex():
    diagram = Voronoi(CIRCLE + [2.0, -7.0])
    assert_consistent(diagram)
    assert diagram.vertices.tolist() == [[2.0, -7.0]]
    assert len(CIRCLE) == 12 and diagram.ridge_vertices == [[-1, 0]] * 12
    assert sorted(map(sorted, diagram.regions)) == [[]] + [[-1, 0]] * 12


def test_points_on_a_sphere_have_one_vertex():
    diagram = Voronoi(SPHERE)
    assert_consistent(diagram)
    assert diagram.vertices.tolist() == [[0.0, 0.0, 0.0]]
    assert diagram.ridge_vertices == [[-1, 0]] * len(diagram.ridge_points)
    # The ridges are those of the edges of the solid, without the diagonals of its flat sides.
    hull = ConvexHull(SPHERE)
    edges = set()
    for facet, normal in enumerate(hull.equations[:, :3]):
        for k in range(3):
            if np.dot(normal, hull.equations[hull.neighbors[facet, k], :3]) < 1 - 1e-9:
                edges.add(frozenset(np.delete(hull.simplices[facet], k).tolist()))
    assert pairs(diagram) == edges


def test_a_point_in_the_middle_of_a_sphere_has_a_closed_cell():
    diagram = Voronoi(np.vstack([SPHERE, [[0.0, 0.0, 0.0]]]))
    assert_consistent(diagram)
    region = diagram.regions[diagram.point_region[-1]]
    assert -1 not in region
    # The dual of the solid: a vertex for each side.
    sides = {tuple(np.round(row, 9)) for row in ConvexHull(SPHERE).equations}
    assert len(region) == len(sides)


@pytest.mark.parametrize("ndim", [2, 3])
def test_points_on_a_line_or_a_plane_are_refused(ndim):
    flat = random_points(9, ndim)
    flat[:, -1] = 0.5
    with pytest.raises(QhullError, match=f"all 9 points lie on one {'line' if ndim == 2 else 'plane'}"):
        Voronoi(flat)
    with pytest.raises(QhullError):
        Voronoi(flat[:2])
    with pytest.raises(ValueError, match="no points"):
        Voronoi(np.empty((0, ndim)))


def test_coordinates_of_a_map_lose_no_ridges(scipy_spatial, cloud):
    points = cloud[:2000, :2]
    near_origin = points - np.floor(points.min(axis=0))
    assert (near_origin + np.floor(points.min(axis=0)) == points).all()
    # scipy itself loses ridges, because it computes with squares of coordinates.
    assert pairs(Voronoi(points)) == pairs(Voronoi(near_origin)) == pairs(scipy_spatial.Voronoi(near_origin))


@pytest.mark.parametrize("ndim", [2, 3])
def test_equal_points_share_a_region(scipy_spatial, ndim):
    points = random_points(40, ndim)
    repeated = np.vstack([points, points[[3, 3, 8]]])
    diagram = Voronoi(repeated)
    assert_consistent(Voronoi(points))
    assert (diagram.point_region[40:] == diagram.point_region[[3, 3, 8]]).all()
    assert diagram.regions == Voronoi(points).regions
    assert pairs_of_scipy(diagram) == pairs(scipy_spatial.Voronoi(points))
    assert Delaunay(repeated).coplanar[:, [0, 2]].tolist() == [[40, 3], [41, 3], [42, 8]]


def test_the_option_for_the_point_at_infinity_adds_an_empty_region():
    points = random_points(30, 2)
    cases = [(None, False, True), ("Qbb Qc Qz", False, True), ("Qbb Qc", False, False), (None, True, False)]
    for options, incremental, has_empty in cases:
        diagram = Voronoi(points, incremental=incremental, qhull_options=options)
        assert len(diagram.regions) == 30 + has_empty
        assert ([] in diagram.regions) == has_empty
        assert diagram.point_region.tolist() == list(range(has_empty, 30 + has_empty))


@pytest.mark.parametrize("ndim", [2, 3])
def test_added_points_are_in_the_diagram(ndim):
    points = np.vstack([random_points(60, ndim), grid(3, ndim)])
    at_once = Voronoi(points)
    one_by_one = Voronoi(points[:50], incremental=True)
    one_by_one.add_points(points[50:55])
    one_by_one.add_points(points[55:])
    assert_consistent(one_by_one)
    assert pairs(one_by_one) == pairs(at_once)
    assert len(one_by_one.vertices) == len(at_once.vertices)
    one_by_one.close()
    with pytest.raises(RuntimeError, match="already closed"):
        one_by_one.add_points(points[:1])


def test_a_pickle_has_the_same_diagram():
    diagram = Voronoi(random_points(50, 2), qhull_options="Qbb")
    again = pickle.loads(pickle.dumps(diagram))
    assert again.regions == diagram.regions
    assert again.ridge_vertices == diagram.ridge_vertices
    assert (again.vertices == diagram.vertices).all()


def test_what_is_not_offered_is_refused_with_the_reason():
    points = random_points(9, 2)
    with pytest.raises(NotImplementedError, match="furthest_site=True: only the Voronoi diagram"):
        Voronoi(points, furthest_site=True)
    with pytest.raises(NotImplementedError, match="qhull_options: QJ moves points"):
        Voronoi(points, qhull_options="QJ")
    with pytest.raises(NotImplementedError, match="2 and 3 dimensions"):
        Voronoi(random_points(9, 4))
    with pytest.raises(ValueError, match="row 1"):
        Voronoi([[0, 0], [np.nan, 1], [2, 2]])


def test_the_scale_of_coordinates_does_not_matter():
    points = grid(6, 2)
    for scale in (2.0**-120, 2.0**150):
        diagram = Voronoi(points * scale)
        assert sorted((diagram.vertices / scale).tolist()) == (grid(5, 2) + 0.5).tolist()
