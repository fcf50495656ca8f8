// CGAL's Min_sphere_of_spheres_d, for points or (with -DBALLS) for balls, in the fixed dimension -DPEER_DIM.
#include "protocol.hpp"

#include <CGAL/Cartesian_d.h>
#include <CGAL/Min_sphere_of_points_d_traits_d.h>
#include <CGAL/Min_sphere_of_spheres_d.h>
#include <CGAL/Min_sphere_of_spheres_d_traits_d.h>

using Kernel = CGAL::Cartesian_d<double>;
#ifdef BALLS
using Traits = CGAL::Min_sphere_of_spheres_d_traits_d<Kernel, double, PEER_DIM>;
#else
using Traits = CGAL::Min_sphere_of_points_d_traits_d<Kernel, double, PEER_DIM>;
#endif
using Solver = CGAL::Min_sphere_of_spheres_d<Traits>;

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const Input input = read_input(argv[1]);
#ifdef BALLS
    const std::size_t columns = PEER_DIM + 1;
#else
    const std::size_t columns = PEER_DIM;
#endif
    if (input.columns != columns) return std::fprintf(stderr, "built for %zu columns\n", columns), 2;
    std::vector<Traits::Sphere> items;
    items.reserve(input.rows);
    for (std::size_t i = 0; i < input.rows; ++i) {
        const double *row = input.row(i);
        const Kernel::Point_d point(PEER_DIM, row, row + PEER_DIM);
#ifdef BALLS
        items.emplace_back(point, row[PEER_DIM]);
#else
        items.push_back(point);
#endif
    }
    return serve(argv[2], [&](double &seconds) {
        const Stopwatch watch;
        Solver solver(items.begin(), items.end());
        Found found;
        found.radius = solver.radius();
        seconds = watch.seconds();
        found.center.assign(solver.center_cartesian_begin(), solver.center_cartesian_end());
        for (auto it = solver.support_begin(); it != solver.support_end(); ++it) ++found.support;
        return found;
    });
}
