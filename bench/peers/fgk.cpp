// The code of Fischer, Gärtner and Kutz (hbf/miniball, cpp/main), with its own point type and its own defaults.
#include "protocol.hpp"

#include "Seb.h"

using Point = Seb::Point<double>;
using Solver = Seb::Smallest_enclosing_ball<double>;

int main(int argc, char **argv) {
    if (argc != 3) return 2;
    const Input input = read_input(argv[1]);
    std::vector<Point> points;
    points.reserve(input.rows);
    for (std::size_t i = 0; i < input.rows; ++i) points.emplace_back(static_cast<int>(input.columns), input.row(i));
    return serve(argv[2], [&](double &seconds) {
        const Stopwatch watch;
        Solver solver(input.columns, points);
        Found found;
        found.radius = std::sqrt(solver.squared_radius());
        seconds = watch.seconds();
        found.center.assign(solver.center_begin(), solver.center_end());
        return found;
    });
}
