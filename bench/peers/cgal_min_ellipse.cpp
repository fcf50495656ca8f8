// CGAL's Min_ellipse_2 over plain doubles, the points in random order: that of the seed 1 in the first round, 2 in the
// second, so that a run can be repeated and no single order decides.
//
// The answer is the center c, then Q by rows: the ellipse is (x - c)'Q(x - c) <= 1; then the support points. c and Q are calculated from CGAL's six
// coefficients in long double, which is not timed. The radius is 1 and means nothing.
#include "protocol.hpp"

#include <CGAL/Min_ellipse_2.h>
#include <CGAL/Min_ellipse_2_traits_2.h>
#include <CGAL/Random.h>
#include <CGAL/Simple_cartesian.h>

using Kernel = CGAL::Simple_cartesian<double>;
using Solver = CGAL::Min_ellipse_2<CGAL::Min_ellipse_2_traits_2<Kernel>>;

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const Input input = read_input(argv[1]);
    if (input.columns != 2) return std::fprintf(stderr, "made for the plane\n"), 2;
    std::vector<Kernel::Point_2> points;
    points.reserve(input.rows);
    for (std::size_t i = 0; i < input.rows; ++i) points.emplace_back(input.row(i)[0], input.row(i)[1]);
    unsigned round = 0;
    return serve(argv[2], [&](double &seconds) {
        CGAL::Random random(++round);
        const Stopwatch watch;
        Solver solver(points.begin(), points.end(), true, random);
        seconds = watch.seconds();
        // r x^2 + s y^2 + t xy + u x + v y + w = 0 is the border.
        double r = 0, s = 0, t = 0, u = 0, v = 0, w = 0;
        solver.ellipse().double_coefficients(r, s, t, u, v, w);
        const long double R = r, S = s, T = t, U = u, V = v, W = w;
        const long double four = 4 * R * S - T * T;
        const long double x = (T * V - 2 * S * U) / four, y = (T * U - 2 * R * V) / four;
        const long double level = -(R * x * x + S * y * y + T * x * y + U * x + V * y + W);
        Found found;
        found.radius = 1;
        found.center = {double(x), double(y), double(R / level), double(T / 2 / level), double(T / 2 / level), double(S / level)};
        for (auto p = solver.support_points_begin(); p != solver.support_points_end(); ++p) {
            found.center.insert(found.center.end(), {p->x(), p->y()});
        }
        found.support = solver.number_of_support_points();
        return found;
    });
}
