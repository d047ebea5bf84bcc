"""Run the tests of scipy, as it is installed, on `breakline.spatial`. Nothing is fetched.

    python python/tests/others/scipy_suites.py

Tests that scipy marks as slow are left out. Prints what passes, what is not offered here, and what differs and why; ends with an error if anything else fails.
Tests of what `breakline.spatial` has not (HalfspaceIntersection) are not run: they would test scipy.
"""

import importlib
import re
import sys
from collections import Counter

import pytest
import scipy

import breakline.spatial as ours

SUITES = [
    "scipy.spatial.tests.test_qhull",
    "scipy.interpolate.tests.test_interpnd",
    "scipy.interpolate.tests.test_ndgriddata",
]

#: Where scipy keeps what is replaced.
REPLACED = {
    "scipy.spatial": ["ConvexHull", "Delaunay", "QhullError", "Voronoi"],
    "scipy.spatial._qhull": ["ConvexHull", "Delaunay", "QhullError", "Voronoi", "tsearch"],
    "scipy.interpolate": ["LinearNDInterpolator", "CloughTocher2DInterpolator", "NearestNDInterpolator"],
    "scipy.interpolate._interpnd": ["LinearNDInterpolator", "CloughTocher2DInterpolator", "GradientEstimationWarning"],
    "scipy.interpolate._ndgriddata": ["LinearNDInterpolator", "CloughTocher2DInterpolator", "NearestNDInterpolator"],
}

#: Tests of what is not replaced.
ELSEWHERE = re.compile(
    "Test_Qhull|HalfspaceIntersection|TestEstimateGradients"
)

#: Tests that fail, and why: what is not offered, and what differs. Patterns of names.
NOT_OFFERED = {
    r"test_nd_simplex|(test_incremental|test_ridges|tri)\[random-[4-8]d": "more than three dimensions",
    r"test_joggle|test_incremental\[some-points": "QJ: predicates are exact, so no points are moved",
    r"test_furthest_site": "furthest_site=True",
    r"test_good[23]d": "QG: which facets a point sees; `good` is None",
    r"test_plane_distance": "lift_points and plane_distance: no hull in one dimension more is computed",
    r"test_nearest_options": "tree_options: there is no tree",
    r"test_nearest_query_options": "p=1: distances are Euclidean",
}
DIFFERS = {
    r"test_find_simplex|test_2d_square": "the order of simplices, or which diagonal divides a square",
    r"test_convex_hull": "the order of the facets of the hull, and of their ends",
    r"TestVoronoi::test_simple": "where the list of a region begins, and its direction",
    r"TestVoronoi.*pathological-2": "a point of a grid is moved by 1e-16: two vertices 1e-16 apart, or far away, are one in Qhull",
    r"test_degenerate_barycentric_transforms": "31 simplices that are flat by rounding, expected below 23: Qhull merges more",
}


class Outcomes:
    """Collects what becomes of each test."""

    def __init__(self):
        self.suites = {}
        self.failed = {}
        self.passed = Counter()
        self.skipped = Counter()

    def pytest_collection_modifyitems(self, items):
        """Leave out the tests of what is not replaced."""
        items[:] = [item for item in items if not ELSEWHERE.search(item.nodeid)]
        self.suites = {item.nodeid: item.module.__name__ for item in items}

    def pytest_runtest_logreport(self, report):
        """Count a test."""
        suite = self.suites.get(report.nodeid, "")
        if report.failed:
            self.failed[report.nodeid.split("::", 1)[1]] = str(report.longrepr).strip().splitlines()[-1]
        elif report.when == "call":
            self.passed[suite] += report.passed
            self.skipped[suite] += report.skipped


def main():
    """Run the suites, and print the outcome."""
    for path, names in REPLACED.items():
        module = importlib.import_module(path)
        for name in names:
            setattr(module, name, getattr(ours, name))
    outcomes = Outcomes()
    options = ["-q", "-m", "not slow and not xslow", "-p", "no:cacheprovider", "--no-header", "--tb=line", "--no-summary"]
    pytest.main([*options, "--pyargs", *SUITES], [outcomes])
    print(f"\nscipy {scipy.__version__}")
    for suite in sorted(outcomes.passed):
        print(f"{suite}: {outcomes.passed[suite]} pass, {outcomes.skipped[suite]} skipped by scipy")
    unknown = dict(outcomes.failed)
    for title, known in (("not offered", NOT_OFFERED), ("differs", DIFFERS)):
        for pattern, reason in known.items():
            found = [name for name in unknown if re.search(pattern, name)]
            print(f"{title}: {pattern} ({len(found)}): {reason}")
            for name in found:
                del unknown[name]
    for name, message in unknown.items():
        print(f"FAILED {name}: {message}")
    return 1 if unknown else 0


if __name__ == "__main__":
    sys.exit(main())
