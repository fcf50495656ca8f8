// CGAL's Delaunay_triangulation_2 or _3, as -DPEER_DIM says: exact predicates, the containers it takes by default.
#include "delaunay.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>
#if PEER_DIM == 2
#include <CGAL/Delaunay_triangulation_2.h>
#else
#include <CGAL/Delaunay_triangulation_3.h>
#endif

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

int main(int argc, char **argv) {
    if (argc != 2) return 2;
#if PEER_DIM == 2
    using Point = Kernel::Point_2;
    const auto points = read_points<2, Point>(argv[1], [](const double *row) { return Point(row[0], row[1]); });
#else
    using Point = Kernel::Point_3;
    const auto points = read_points<3, Point>(argv[1], [](const double *row) { return Point(row[0], row[1], row[2]); });
#endif
    const Meter meter;
    // A range of points is sorted along a space-filling curve before it is inserted.
#if PEER_DIM == 2
    const CGAL::Delaunay_triangulation_2<Kernel> built(points.begin(), points.end());
    const std::size_t simplices = built.number_of_faces();
#else
    const CGAL::Delaunay_triangulation_3<Kernel> built(points.begin(), points.end());
    const std::size_t simplices = built.number_of_finite_cells();
#endif
    meter.print("CGAL " CGAL_VERSION_STR, points.size(), simplices);
}
