// The simplices of CGAL's Delaunay_triangulation_2 or _3, as -DPEER_DIM says, by rows of the input.
//
// Called with the name of a file of points, as in delaunay.hpp. Writes little-endian 32-bit row numbers to standard
// output, those of one finite simplex after another. Nothing is measured.
#include "delaunay.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#if PEER_DIM == 2
#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#else
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#endif

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Row = std::uint32_t;
#if PEER_DIM == 2
using Point = Kernel::Point_2;
using Structure = CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<Row, Kernel>>;
using Triangulation = CGAL::Delaunay_triangulation_2<Kernel, Structure>;
#else
using Point = Kernel::Point_3;
using Structure = CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_with_info_3<Row, Kernel>,
                                                       CGAL::Delaunay_triangulation_cell_base_3<Kernel>>;
using Triangulation = CGAL::Delaunay_triangulation_3<Kernel, Structure>;
#endif

int main(int argc, char **argv) {
    if (argc != 2) return 2;
    Row next = 0;
    const auto points = read_points<PEER_DIM, std::pair<Point, Row>>(argv[1], [&next](const double *row) {
#if PEER_DIM == 2
        return std::make_pair(Point(row[0], row[1]), next++);
#else
        return std::make_pair(Point(row[0], row[1], row[2]), next++);
#endif
    });
    const Triangulation built(points.begin(), points.end());
#if PEER_DIM == 2
    for (auto simplex : built.finite_face_handles()) {
#else
    for (auto simplex : built.finite_cell_handles()) {
#endif
        Row rows[PEER_DIM + 1];
        for (int i = 0; i <= PEER_DIM; ++i) rows[i] = simplex->vertex(i)->info();
        if (std::fwrite(rows, sizeof rows, 1, stdout) != 1) return 1;
    }
    return std::fflush(stdout) == 0 ? 0 : 1;
}
