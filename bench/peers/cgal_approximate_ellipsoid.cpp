// CGAL's Approximate_min_ellipsoid_d over doubles: PROGRAM EPSILON INPUT CENTER.
//
// Its ellipsoid encloses the points and has at most 1 + EPSILON times the least volume. The answer is the center c, then
// Q by rows: {x : (x - c)'Q(x - c) <= 1}, which is not timed. CGAL's numbers M, m, s say x'Mx + x'm + s <= a with
// a = (1 + k)(d + 1), 1 + the epsilon it reached = (1 + k)^((d + 1)/2). Its manual has another a, with that epsilon in
// place of k: the ellipsoid would be larger than promised. The radius is the epsilon that CGAL says it reached.
#include "protocol.hpp"

#include <Eigen/Dense>

#include <cmath>

#include <CGAL/Approximate_min_ellipsoid_d.h>
#include <CGAL/Approximate_min_ellipsoid_d_traits_d.h>
#include <CGAL/Cartesian_d.h>
#include <CGAL/MP_Float.h>

using Kernel = CGAL::Cartesian_d<double>;
using Traits = CGAL::Approximate_min_ellipsoid_d_traits_d<Kernel, CGAL::MP_Float>;
using Solver = CGAL::Approximate_min_ellipsoid_d<Traits>;
using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    const double epsilon = std::atof(argv[1]);
    const Input input = read_input(argv[2]);
    const int dim = int(input.columns);
    std::vector<Kernel::Point_d> points;
    points.reserve(input.rows);
    for (std::size_t i = 0; i < input.rows; ++i) points.emplace_back(dim, input.row(i), input.row(i) + dim);
    return serve(argv[3], [&](double &seconds) {
        const Traits traits;
        const Stopwatch watch;
        Solver solver(epsilon, points.begin(), points.end(), traits);
        seconds = watch.seconds();
        Found found;
        found.radius = solver.achieved_epsilon();
        if (!solver.is_full_dimensional()) return found;
        Matrix matrix(dim, dim);
        Vector slope(dim);
        for (int i = 0; i < dim; ++i) {
            slope(i) = CGAL::to_double(solver.defining_vector(i));
            for (int j = 0; j < dim; ++j) matrix(i, j) = CGAL::to_double(solver.defining_matrix(i, j));
        }
        const Vector center = -matrix.ldlt().solve(slope) / 2;
        const long double k = std::pow(1 + (long double)(found.radius), 2.0L / (dim + 1)) - 1;
        const long double level = (1 + k) * (dim + 1) - CGAL::to_double(solver.defining_scalar()) + center.dot(matrix * center);
        for (int i = 0; i < dim; ++i) found.center.push_back(double(center(i)));
        for (int i = 0; i < dim; ++i)
            for (int j = 0; j < dim; ++j) found.center.push_back(double(matrix(i, j) / level));
        return found;
    });
}
