// Gärtner's own miniball (Welzl's method with pivoting), from the header that cyminiball wraps.
#include "protocol.hpp"

#include <cmath>
#include <iterator>

#include "miniball.hpp"

using PointIterator = const double *const *;
using Solver = Miniball::Miniball<Miniball::CoordAccessor<PointIterator, const double *>>;

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const Input input = read_input(argv[1]);
    std::vector<const double *> rows;
    for (std::size_t i = 0; i < input.rows; ++i) rows.push_back(input.row(i));
    return serve(argv[2], [&](double &seconds) {
        const Stopwatch watch;
        Solver solver(static_cast<int>(input.columns), rows.data(), rows.data() + rows.size());
        Found found;
        found.radius = std::sqrt(solver.squared_radius());
        seconds = watch.seconds();
        found.center.assign(solver.center(), solver.center() + input.columns);
        found.support = solver.nr_support_points();
        return found;
    });
}
