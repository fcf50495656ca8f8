// CGAL's older Min_sphere_d, in the plane (-DPEER_DIM=2) or in space (-DPEER_DIM=3), over plain doubles.
#include "protocol.hpp"

#include <CGAL/Min_sphere_d.h>
#include <CGAL/Simple_cartesian.h>
#if PEER_DIM == 2
#include <CGAL/Min_sphere_annulus_d_traits_2.h>
#else
#include <CGAL/Min_sphere_annulus_d_traits_3.h>
#endif

#include <cmath>

using Kernel = CGAL::Simple_cartesian<double>;
#if PEER_DIM == 2
using Point = Kernel::Point_2;
using Solver = CGAL::Min_sphere_d<CGAL::Min_sphere_annulus_d_traits_2<Kernel>>;
#else
using Point = Kernel::Point_3;
using Solver = CGAL::Min_sphere_d<CGAL::Min_sphere_annulus_d_traits_3<Kernel>>;
#endif

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const Input input = read_input(argv[1]);
    if (input.columns != PEER_DIM) return std::fprintf(stderr, "built for dimension %d\n", PEER_DIM), 2;
    std::vector<Point> points;
    points.reserve(input.rows);
    for (std::size_t i = 0; i < input.rows; ++i) {
        const double *row = input.row(i);
#if PEER_DIM == 2
        points.emplace_back(row[0], row[1]);
#else
        points.emplace_back(row[0], row[1], row[2]);
#endif
    }
    return serve(argv[2], [&](double &seconds) {
        const Stopwatch watch;
        Solver solver(points.begin(), points.end());
        Found found;
        found.radius = std::sqrt(solver.squared_radius());
        seconds = watch.seconds();
        const Point center = solver.center();
        for (int k = 0; k < PEER_DIM; ++k) found.center.push_back(center[k]);
        found.support = solver.number_of_support_points();
        return found;
    });
}
