// CGAL's Optimal_transportation_reconstruction_2 in the protocol of protocol.hpp: PROGRAM TOLERANCE INPUT CENTER.
//
// What goes to CENTER are the vertices, as many as `support` says, two coordinates each, then the edges, two numbers of
// vertices each. The options are those it takes by default; it simplifies until the tolerance, a length, is reached.
#include "protocol.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Optimal_transportation_reconstruction_2.h>

#include <iterator>
#include <utility>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_2;

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    const double tolerance = std::atof(argv[1]);
    const Input input = read_input(argv[2]);
    std::vector<Point> points;
    for (std::size_t i = 0; i < input.rows; ++i) points.emplace_back(input.row(i)[0], input.row(i)[1]);
    return serve(argv[3], [&](double &seconds) {
        const Stopwatch watch;
        CGAL::Optimal_transportation_reconstruction_2<Kernel> reconstruction(points);
        reconstruction.run_under_wasserstein_tolerance(tolerance);
        seconds = watch.seconds();
        std::vector<Point> vertices;
        std::vector<std::size_t> isolated;
        std::vector<std::pair<std::size_t, std::size_t>> edges;
        reconstruction.indexed_output(std::back_inserter(vertices), std::back_inserter(isolated),
                                      std::back_inserter(edges));
        Found found;
        found.radius = tolerance;
        found.support = vertices.size();
        for (const Point &vertex : vertices) found.center.insert(found.center.end(), {vertex.x(), vertex.y()});
        for (const auto &[from, to] : edges) found.center.insert(found.center.end(), {double(from), double(to)});
        return found;
    });
}
