// Surfaces of CGAL in the protocol of protocol.hpp: PROGRAM WAY INPUT CENTER.
//
// WAY is `front`, Advancing_front_surface_reconstruction, or `scales`, Scale_space_surface_reconstruction_3 with four
// rounds of its smoother and the advancing front as its mesher; options are those they take by default. What goes to
// CENTER are two times in seconds, of the Delaunay triangulation and of the extraction from it, or of the smoothing
// and of the mesher with its triangulation; then the triangles, as many as `support` says, three rows each.
#include "protocol.hpp"

#include <CGAL/Advancing_front_surface_reconstruction.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Scale_space_reconstruction_3/Advancing_front_mesher.h>
#include <CGAL/Scale_space_reconstruction_3/Weighted_PCA_smoother.h>
#include <CGAL/Scale_space_surface_reconstruction_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <cstring>
#include <utility>

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

// Vertices carry the row they are from, as in CGAL's own function of this name.
using Row = CGAL::Triangulation_vertex_base_with_info_3<std::size_t, Kernel>;
using Vertex = CGAL::Advancing_front_surface_reconstruction_vertex_base_3<Kernel, Row>;
using Cell = CGAL::Advancing_front_surface_reconstruction_cell_base_3<Kernel>;
using Delaunay = CGAL::Delaunay_triangulation_3<Kernel, CGAL::Triangulation_data_structure_3<Vertex, Cell>>;
using Front = CGAL::Advancing_front_surface_reconstruction<Delaunay>;

using Scales = CGAL::Scale_space_surface_reconstruction_3<Kernel>;
using Smoother = CGAL::Scale_space_reconstruction_3::Weighted_PCA_smoother<Kernel>;
using Mesher = CGAL::Scale_space_reconstruction_3::Advancing_front_mesher<Kernel>;

static Found front(const std::vector<std::pair<Point, std::size_t>> &points, double &seconds) {
    const Stopwatch watch;
    Delaunay delaunay(points.begin(), points.end());
    const double triangulated = watch.seconds();
    Front front(delaunay);
    front.run();
    seconds = watch.seconds();
    Found found;
    found.center = {triangulated, seconds - triangulated};
    const auto &surface = front.triangulation_data_structure_2();
    for (auto face = surface.faces_begin(); face != surface.faces_end(); ++face) {
        if (!face->is_on_surface()) continue;
        ++found.support;
        for (int corner = 0; corner < 3; ++corner) {
            found.center.push_back(double(face->vertex(corner)->vertex_3()->info()));
        }
    }
    return found;
}

static Found scales(const std::vector<Point> &points, double &seconds) {
    const Stopwatch watch;
    Scales scales(points.begin(), points.end());
    scales.increase_scale(4, Smoother());
    const double smoothed = watch.seconds();
    scales.reconstruct_surface(Mesher());
    seconds = watch.seconds();
    Found found;
    found.center = {smoothed, seconds - smoothed};
    for (auto facet = scales.facets_begin(); facet != scales.facets_end(); ++facet) {
        ++found.support;
        for (const std::size_t row : *facet) found.center.push_back(double(row));
    }
    return found;
}

int main(int argc, char **argv) {
    if (argc != 4) return 2;
    const Input input = read_input(argv[2]);
    if (input.columns != 3) return 2;
    std::vector<Point> points;
    std::vector<std::pair<Point, std::size_t>> numbered;
    for (std::size_t i = 0; i < input.rows; ++i) {
        points.emplace_back(input.row(i)[0], input.row(i)[1], input.row(i)[2]);
        numbered.emplace_back(points.back(), i);
    }
    const bool is_front = std::strcmp(argv[1], "front") == 0;
    return serve(argv[3], [&](double &seconds) { return is_front ? front(numbered, seconds) : scales(points, seconds); });
}
