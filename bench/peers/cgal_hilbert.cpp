// CGAL's Hilbert order in the plane or in space, as -DPEER_DIM says, in the protocol of protocol.hpp: PROGRAM POLICY INPUT ORDER.
//
// POLICY is median or middle. Points are sorted with their numbers, as CGAL's manual has it, and the numbers are written,
// as doubles. Seconds are processor time of this thread: copying the points, sorting, taking the numbers.
#include "protocol.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Spatial_sort_traits_adapter_2.h>
#include <CGAL/Spatial_sort_traits_adapter_3.h>
#include <CGAL/hilbert_sort.h>
#include <CGAL/property_map.h>

#include <cstring>
#include <ctime>
#include <utility>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
#if PEER_DIM == 2
using Point = Kernel::Point_2;
template <typename Map> using Traits = CGAL::Spatial_sort_traits_adapter_2<Kernel, Map>;
#else
using Point = Kernel::Point_3;
template <typename Map> using Traits = CGAL::Spatial_sort_traits_adapter_3<Kernel, Map>;
#endif
using Numbered = std::pair<Point, std::uint32_t>;

static double cpu() {
    timespec time;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return time.tv_sec + 1e-9 * time.tv_nsec;
}

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    const bool median = std::strcmp(argv[1], "median") == 0;
    if (!median && std::strcmp(argv[1], "middle") != 0) return 2;
    std::vector<Point> points;
    {
        const Input input = read_input(argv[2]);
        points.reserve(input.rows);
        for (std::size_t i = 0; i < input.rows; ++i) {
            const double *row = input.row(i);
#if PEER_DIM == 2
            points.emplace_back(row[0], row[1]);
#else
            points.emplace_back(row[0], row[1], row[2]);
#endif
        }
    }
    const Traits<CGAL::First_of_pair_property_map<Numbered>> traits;
    return serve(argv[3], [&](double &seconds) {
        const double start = cpu();
        std::vector<Numbered> sorted;
        sorted.reserve(points.size());
        for (std::size_t i = 0; i < points.size(); ++i) sorted.emplace_back(points[i], i);
        if (median) CGAL::hilbert_sort(sorted.begin(), sorted.end(), traits, CGAL::Hilbert_sort_median_policy());
        else CGAL::hilbert_sort(sorted.begin(), sorted.end(), traits, CGAL::Hilbert_sort_middle_policy());
        std::vector<std::uint32_t> order;
        order.reserve(points.size());
        for (const Numbered &point : sorted) order.push_back(point.second);
        seconds = cpu() - start;
        Found found;
        found.center.assign(order.begin(), order.end());
        return found;
    });
}
